"""Figures that come of dense linear algebra, under kernels that are not the machine's own.

Those of an old family without AVX, which no processor of today takes by itself; before a release
those of Haswell too, at most one of both being its own.  `make portable` tries more, of everything
that is a number.
"""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.sizes import size

from .arithmetics import ARITHMETICS, flags
from .part import SMALL

ROOT = Path(__file__).parents[2]
CHOSEN = ("OpenBLAS Prescott", "OpenBLAS Haswell")[: size(1, 2)]


@pytest.mark.parametrize("one", [a for a in ARITHMETICS if a.name in CHOSEN], ids=lambda a: a.name)
def test_under_other_kernels(one):
    if one.missing:
        pytest.skip(f"the processor lacks {one.missing}")
    command = [sys.executable, "-m", "pytest", "-p", "no:xdist", "-p", "no:cacheprovider", *SMALL]
    # at the usual size: a release check leaves out what has passed, and this would be all
    usual = {k: v for k, v in one.surroundings().items() if k != "TRSIM_SIZE"}
    given = {"cwd": ROOT, "env": usual, "capture_output": True, "text": True}
    done = subprocess.run(command, **given)  # noqa: S603
    assert done.returncode == 0, done.stdout[-4000:]


def test_surroundings(monkeypatch):
    """Of each other arithmetic nothing is left."""
    monkeypatch.setenv("OPENBLAS_CORETYPE", "Zen")
    for one in ARITHMETICS:
        given = one.surroundings()
        assert given.items() >= one.environment.items()
        assert given.get("OPENBLAS_CORETYPE") == one.environment.get("OPENBLAS_CORETYPE")


def test_what_a_processor_lacks(monkeypatch):
    """Kernels with instructions it does not have would end the process."""
    monkeypatch.setattr("platform.machine", lambda: "x86_64")
    monkeypatch.setattr("tests.portable.arithmetics.flags", lambda: flags() - {"avx512f"})
    assert "avx512f" in ARITHMETICS[0].missing
    monkeypatch.setattr("platform.machine", lambda: "aarch64")
    assert all("x86_64" in one.missing for one in ARITHMETICS)
