"""TRSIM_PYTHON=1: the same numbers without machine code, and without numba."""

import os
import subprocess
import sys
from math import sqrt
from pathlib import Path

import numpy as np
import pytest

from trsim.elements import load
from trsim.elements.contract import compiled
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, T3, Packed, f8, i8
from trsim.kernels.plain import LEAST, SAME, address, run, whole
from trsim.kernels.signatures import float64, int64

from .. import small
from ..runs import short_run
from .test_fingerprint import kernels, reached, read

ROOT = Path(__file__).parents[2]
PENDULUM = load("revolute").example
SPHERICAL = """
gravity: [0, 0, -9.81]
bodies: {ball: {mass: 1, inertia: [1e-3, 1e-3, 1e-3], at: [0.6, 0, -0.8], velocity: [0, 0.5, 0]}}
joints: {pivot: {type: spherical, bodies: [ground, ball], at: [0, 0, 0]}}
solver: {end: 20 ms, tolerance: 1e-6}
output: {every: 5 ms}
"""
BAR = """
gravity: [0, -9.81]
bodies:
  rope: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 2, section: {width: 20 mm},
         youngs_modulus: 5 MPa, density: 1100}
joints: {pin: {type: revolute, bodies: [ground, rope], at: [0, 0]}}
solver: {end: 5 ms, tolerance: 1e-5}
output: {every: 1 ms}
"""
SCENES = {
    "pendulum": (PENDULUM, "solver.end=50 ms", "output.every=10 ms"),
    "clearance": (small.SLIDER_CRANK, "solver.end=0.5 ms", "output.every=0.1 ms"),
    "spherical": (SPHERICAL,),
    "radau": (SPHERICAL, "solver.method=radau"),
    "bar": (BAR,),
}
IN_PYTHON = """
import sys
import numpy as np
from tests.kernels.test_plain import SCENES, short_run
np.savez(sys.argv[1], **{name: short_run(*scene).rows for name, scene in SCENES.items()})
print(*sorted({"numba", "llvmlite"} & {*sys.modules}))
"""


@pytest.fixture(scope="module")
def in_python(tmp_path_factory):
    """The rows of all scenes, and what of the compiler was imported."""
    folder = tmp_path_factory.mktemp("plain")
    environment = {**os.environ, "TRSIM_PYTHON": "1", "XDG_CACHE_HOME": str(folder)}
    command = [sys.executable, "-c", IN_PYTHON, str(folder / "rows.npz")]
    done = subprocess.run(  # noqa: S603
        command, cwd=ROOT, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [] and done.stderr == ""
    assert [path.name for path in folder.iterdir()] == ["rows.npz"]  # and nothing was kept
    return np.load(folder / "rows.npz")


@pytest.mark.parametrize("name", SCENES)
def test_a_run_gives_the_same_numbers(name, in_python):
    rows = short_run(*SCENES[name]).rows
    scale = np.max(np.abs(rows), axis=0)
    assert in_python[name].shape == rows.shape
    assert np.all(np.abs(in_python[name] - rows) <= 1e-9 * scale + 1e-12)


class Numbers(Packed):
    x: A1
    table: T3
    h: f8
    k: i8


@internal
def share(a, b):
    return a / b


@internal
def root(x):
    return sqrt(x)


RATIO = float64(Numbers.kind, f8)
call_ratio = caller(RATIO)


@compiled(RATIO)
def ratio(s, y):
    s.x[0] = share(1.0, y)
    s.table[1, 2] = float(s.k) / s.h
    return share(y, 0.0) + root(s.x[1])


@compiled(float64(i8, Numbers.kind, f8))
def by_address(at, s, y):
    return call_ratio(at, s, y)


@compiled(int64(f8))
def integer(x):
    return int(x)


def numbers():
    return Numbers(x=np.array([0.0, -1.0]), table=np.zeros((2, 3)), h=0.0, k=3)


@pytest.mark.parametrize("y", [0.0, -0.0, 2.0, -np.inf, np.nan])
def test_numbers_that_python_refuses(y):
    """x / 0, the root of -1: as in machine code."""
    machine, plain = numbers(), numbers()
    expected = by_address(ratio.address(), machine, y)
    result = run(by_address.python, address(ratio.python), plain, y)
    np.testing.assert_equal(result, expected)
    np.testing.assert_equal(plain.x, machine.x)
    np.testing.assert_equal(plain.table, machine.table)


@pytest.mark.parametrize("x", [0.0, 2.9, -2.9, 1e18, 1e19, -1e300, np.inf, np.nan])
def test_whole_numbers(x):
    assert whole(np.float64(x)) == (int(x) if abs(x) < 2**63 else LEAST)
    if abs(x) < 2**63:
        assert integer(x) == whole(np.float64(x))


def test_each_function_of_math_has_one_that_refuses_no_number():
    everything = set().union(*(reached(kernel.python) for kernel in kernels()))
    called = {scope[name] for python in everything for scope, name in read(python)
              if getattr(scope[name], "__module__", "") == "math"}  # fmt: skip
    assert called and called <= set(SAME)


def test_a_debugger_sees_the_lines():
    """Where a function stands is told by what runs."""
    seen = set()

    def look(frame, event, _):
        seen.add((frame.f_code.co_filename, frame.f_lineno))
        return look

    before = sys.gettrace()
    sys.settrace(look)
    try:
        run(ratio.python, numbers(), 1.0)
    finally:
        sys.settrace(before)
    first = ratio.python.__code__.co_firstlineno
    assert {(__file__, first + n) for n in (2, 3, 4)} <= seen
