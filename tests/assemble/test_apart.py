"""Mechanisms of one structure and other numbers: none knows which was assembled before it."""

import json
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.scenario.load import load, loads
from trsim.solve.outcome import settings
from trsim.solve.start.consistent import start

from ..small import SLIDER_CRANK

ROOT = Path(__file__).parents[2]
SCENARIOS = ROOT / "scenarios" / "validation"
ADDRESS = 2**32  # no index is as large, and every address of code
# with play and a section; with redundant rows in space; with a flexible bar
PAIRS = {
    "play": (
        lambda sets: loads(SLIDER_CRANK, sets),
        ("bodies.rod.mass=0.5", "joints.B.clearance=0.2 mm", "drives.motor.velocity=900 rpm"),
    ),
    "redundant": (
        lambda sets: load(SCENARIOS / "four_bar_3d.yaml", sets),
        ("bodies.coupler.mass=3", "gravity=[0, 1, -5]"),
    ),
    "flexible": (
        lambda sets: load(SCENARIOS / "flexible_pendulum.yaml", sets),
        ("gravity=[1, -3, 0]", "solver.tolerance=1e-4"),
    ),
}


def told(value):
    """The bits of a number or of an array, but for addresses of code."""
    array = np.asarray(value)
    if array.dtype.kind == "i":
        array = np.where(array > ADDRESS, ADDRESS, array)
    return sha256(array.tobytes()).hexdigest()


def bits(case, changed):
    """All numbers of a mechanism and of its start, and its columns."""
    made, sets = PAIRS[case]
    scenario = made(sets if changed else ())
    mechanism = assemble(scenario)
    begun = start(scenario, mechanism, settings(scenario, mechanism).locate > 0)
    model = mechanism.model
    numbers = {name: getattr(model, name) for name in model.places} | {"y0": mechanism.y0}
    numbers |= {f"start.{name}": value for name, value in vars(begun).items()}
    found = {name: told(value) for name, value in numbers.items()}
    return found | {"columns": repr(mechanism.columns)}


def in_turn(first):
    """Of each case both mechanisms; first: whether the changed one is made before the other."""
    return {case: {str(k): bits(case, k) for k in (first, not first, first)} for case in PAIRS}


@pytest.fixture(scope="module")
def elsewhere():
    """What a process finds that makes the changed one first."""
    words = "import json; from tests.assemble.test_apart import *; print(json.dumps(in_turn(True)))"
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", words], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def here():
    """The same the other way round."""
    return in_turn(False)


@pytest.mark.parametrize("case", PAIRS)
def test_what_came_before_leaves_no_trace(case, here, elsewhere):
    assert here[case] == elsewhere[case]
    one, other = here[case].values()
    assert one["start.y"] != other["start.y"] or one["par"] != other["par"]
