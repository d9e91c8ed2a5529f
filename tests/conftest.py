"""What all tests share."""

import compileall
import gc
import io
import os
import sys
from contextlib import contextmanager
from pathlib import Path

# as the command does, before numpy is imported: workers side by side would share the processors
# with threads of BLAS that wait by turning, and small matrices gain nothing from them
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings

from tests.sizes import RELEASE
from trsim.kernels.lazy import PYTHON

# the first example of a law compiles it: a time says nothing about the law
settings.register_profile("trsim", deadline=None, max_examples=10 if PYTHON else 100)
settings.load_profile("trsim")
# each worker rewrites the assertions of all tests, five seconds; pytest keeps them where it may
sys.dont_write_bytecode = False


def pytest_configure(config):
    """Keep the bytecode of trsim, also where Python is told to write none: hundreds of processes
    begin in these tests, and without it half of the time of each goes into reading sources."""
    if not hasattr(config, "workerinput"):
        compileall.compile_dir(Path(__file__).parent.parent / "trsim", quiet=2)
    if RELEASE:
        from tests import resumed

        resumed.begun(config)


def pytest_collection_modifyitems(items):
    """What runs tests in a process of its own comes last: what these need has been compiled by
    then, and a further process would do once more what the functions of both have in common."""
    items.sort(key=lambda item: "test_under_other_kernels" in item.name)


def pytest_collection_finish():
    """What was collected lives to the end: a tenth to a sixth of the time of these tests went into
    looking it through for what nobody holds any more."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)


@pytest.fixture
def at_once(monkeypatch):
    """The rows of a dead run are read without a process of its own, which takes half a second."""
    from trsim.store import resume

    @contextmanager
    def sender(part, wanted):
        rows = io.BytesIO()
        resume.send(part, wanted, rows)
        rows.seek(0)
        yield rows

    monkeypatch.setattr(resume, "sender", sender)
