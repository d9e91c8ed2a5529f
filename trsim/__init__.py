"""trsim: batch simulation of rigid-flexible mechanisms with joint clearance.

Importing the package starts nothing and imports nothing heavy: `trsim --help` stays quick.
"""

from trsim.version import __version__

__all__ = ["__version__"]
