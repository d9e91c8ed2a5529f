"""The suite on a system without what only POSIX has: `python -m tests.elsewhere [tests ...]`.

The names are taken out of `os`, `signal` and their neighbours before anything else is imported, in
the process of the tests and in all that they start (sitecustomize.py).  What a test itself needs of
POSIX, a signal that kills for one, makes it skip: `needs`.
"""

import os
import signal
from importlib import import_module
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
BARE = "TRSIM_ELSEWHERE" in os.environ  # whether they are taken out here
# PYTHONPATH of processes that tests start
PATH = os.pathsep.join([str(HERE), str(ROOT)]) if BARE else str(ROOT)


def importable(name: str) -> bool:
    try:
        import_module(name)
    except ImportError:
        return False
    return True


def needs(*names: str) -> pytest.MarkDecorator:
    """A mark for tests that use these names of `os` or `signal`, or modules, themselves."""
    lost = [name for name in names if not (hasattr(os, name) or hasattr(signal, name))]
    lost = [name for name in lost if not importable(name)]
    return pytest.mark.skipif(bool(lost), reason=f"the test itself uses {', '.join(lost)}")
