"""trsim: batch simulation of rigid-flexible mechanisms with joint clearance.

Importing the package starts nothing and imports nothing heavy: `trsim --help` stays quick.
"""

import os

from trsim.version import __version__

__all__ = ["__version__"]

# pydantic would look for plugins of its own in every package installed
os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
