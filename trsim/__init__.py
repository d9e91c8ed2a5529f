"""trsim: batch simulation of rigid-flexible mechanisms with joint clearance.

Importing the package starts nothing and imports nothing heavy: `trsim --help` stays quick.
"""

import hashlib
import os
from pathlib import Path

from trsim.version import __version__

__all__ = ["__version__"]


def _cache_folder() -> Path:
    """One numba cache per source tree, in the user's cache directory.

    Numba notices a changed file only for functions of that file, not for functions they call
    directly in another one: an edited helper would go on running its old equations.  Element
    kernels are reached through tables of addresses; whatever is called directly is hashed here.
    """
    here = Path(__file__).parent
    shared = ("calls", "contract", "frames", "packed", "packed_numba", "scene", "vectors")
    direct = [f"elements/{name}.py" for name in shared]
    direct += ["laws/*.py", "assemble/*.py", "solve/*.py"]
    sources = sorted(path for pattern in direct for path in here.glob(pattern))
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:16]
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return home / "trsim" / digest


os.environ.setdefault("NUMBA_CACHE_DIR", str(_cache_folder()))
