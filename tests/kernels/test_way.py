"""Versions of numba: where its inside is not known, its own way is taken, with the same results."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numba
import pytest

from trsim.kernels import pipeline

ROOT = Path(__file__).parents[2]
CHANGES = {
    "newer": "numba.version_info = (0, 99); numba.__version__ = '0.99.0'",
    "a name that is gone": "del numba.core.codegen.JITCodeLibrary",
    "a module that is gone": "sys.modules['numba.core.postproc'] = None",
}
COMPILES = """
import json, sys
import trsim.kernels.numba_quick
import numba.core.codegen, numba.core.postproc
{}
from tests.kernels.test_machine import Compiled, TOTAL, arguments, total
from tests.kernels.test_plain import by_address, numbers, ratio
function = Compiled(total, TOTAL)
told = [function(*arguments()), by_address(ratio.address(), numbers(), 3.0)]
print(json.dumps([*map(repr, told), function.key, function.file.stat().st_size > 0]))
"""


def compiled(change, folder):
    """What a process says that compiles with a numba changed so, and its standard error."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder)}
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", COMPILES.format(change)],
        cwd=ROOT, env=environment, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout), done.stderr


@pytest.fixture(scope="module")
def known(tmp_path_factory):
    """The same of numba as it is."""
    return compiled("", tmp_path_factory.mktemp("known"))


def test_the_version_that_is_there_is_known(known):
    assert known[1] == ""


@pytest.mark.parametrize("change", CHANGES)
def test_what_is_not_known_is_compiled_in_numbas_own_way(change, known, tmp_path):
    results, told = compiled(CHANGES[change], tmp_path)
    assert results == known[0]
    assert len(told.splitlines()) == 1 and "compiling takes longer, with the same results" in told
    assert change != "newer" or "numba 0.99.0" in told


def test_what_the_package_asks_for_is_what_is_known():
    asked = re.search(r'"numba>=0\.([0-9]+)"', (ROOT / "pyproject.toml").read_text())
    assert int(asked[1]) == pipeline.KNOWN[0]
    assert numba.version_info[1] in pipeline.KNOWN
