"""Numbers no mechanism has are refused by name, or checked to the end: arithmetic never fails."""

import copy
import functools
import json
import operator
import random
from pathlib import Path

import pytest

from trsim.assemble.assemble import assemble
from trsim.assemble.release import release
from trsim.errors import TrsimError
from trsim.scenario.load import load, loads
from trsim.scenario.scenario import SHORTEST
from trsim.solve.diagnose.scales import scales
from trsim.solve.diagnose.skipped import skipped
from trsim.solve.march.land import NOTHING
from trsim.solve.simulate import simulate
from trsim.solve.start.consistent import start
from trsim.solve.start.projected import projected

from . import small
from .runs import run
from .sizes import size

SCENARIOS = Path(__file__).parents[1] / "scenarios"
FILES = ("thrust_reverser/clearance_ab_0.3mm", "validation/slider_crank_friction",
         "validation/four_bar_3d", "validation/slider_crank_3d")  # fmt: skip
ABSURD = (1e50, -1e50, 1e45, 1e30, -1e30, 1e25, 1e12, 0.0, -1.0, 1e-12, 1e-30, 1e-160, 5e-324)
CASES = size(20, 60)  # of each file


def numbers(data, path=()):
    """The path of every number, quantities among them."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        if isinstance(value, dict | list):
            yield from numbers(value, (*path, key))
        elif isinstance(value, int | float) or (value and str(value)[0].isdigit()):
            yield (*path, key)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of numpy, at 1e30 kg
@pytest.mark.parametrize("name", FILES)
def test_absurd_numbers(name):
    tree, dice = load(SCENARIOS / f"{name}.yaml").resolved, random.Random(name)
    counts = {0: 0, 3: 0, 4: 0}
    for _ in range(CASES):
        changed = copy.deepcopy(tree)
        for _ in range(dice.randint(1, 2)):
            *above, key = dice.choice(sorted(numbers(changed), key=str))
            functools.reduce(operator.getitem, above, changed)[key] = dice.choice(ABSURD)
        try:
            scenario = loads(json.dumps(changed))
            mechanism = assemble(scenario)
            release(scenario, mechanism)
            begun = start(scenario, mechanism, located=True)
            scales(scenario, mechanism, begun)
            projected(mechanism, begun)
            assert skipped(scenario, mechanism)
            counts[0] += 1
        except TrsimError as error:
            assert error.show()
            counts[error.exit_code] += 1
    print(name, counts)
    assert min(counts.values()) > 0


# --- and to the end of a run -------------------------------------------------------------------

MOVING = """
bodies:
  sliding: {mass: 2, inertia: 0.01, velocity: [0.5, 0]}
  pushed: {mass: 2, inertia: 0.01}
joints:
  along: {type: prismatic, bodies: [ground, sliding], axis: [1, 0, 0]}
  across: {type: prismatic, bodies: [ground, pushed], axis: [0, 1, 0]}
sensors: {x: {joint: along}, y: {joint: across}}
forces:
  push: {type: applied_load, body: pushed, direction: [0, 1], force: 2}
  stop: {type: limit_stop, joint: across, upper: 1, lower: -1, stiffness: 1e5, damping: 8}
  spring: {type: spring_damper, bodies: [ground, pushed], points: [[0, -1], [0, 0]],
           stiffness: 10, damping: 3, free_length: 1}
poincare: {beat: {every: 0.02, plot: [x, x.rate]}, touch: {at_onset: stop, plot: [y, y.rate]}}
solver: {end: 0.1, max_step: 0.01, first_step: 1e-4, locate_events: true}
output: {every: 0.01}
"""
TINY_OR_HUGE = (1e-300, 1e-200, 1e-100, 1e-50, 1e-20, 1e20, 1e50, 1e100, 1e200, 1e300)
FEW = "solver.max_steps=300"
CLEARANCE = small.SLIDER_CRANK.replace("internal", "1e9")


def of_a_run(text, *sets):
    """How a run ends: the status, or that the scenario was refused."""
    try:
        scenario = loads(text, sets)
        mechanism = assemble(scenario)
        marching = simulate(scenario, mechanism)
        while True:
            next(marching)
    except StopIteration as end:
        return end.value.status
    except TrsimError as error:
        assert error.show()
        return "refused"


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("key", [
    "bodies.pushed.mass", "bodies.pushed.inertia", "forces.stop.stiffness", "forces.stop.damping",
    "forces.stop.upper", "forces.spring.stiffness", "forces.spring.free_length",
    "poincare.beat.every", "output.every", "solver.end", "solver.max_step", "solver.first_step",
])  # fmt: skip
def test_absurd_numbers_of_a_run(key):
    found = {size: of_a_run(MOVING, FEW, f"{key}={size}") for size in TINY_OR_HUGE}
    assert {*found.values()} <= {"done", "failed", "refused"}
    assert found[1e300] == "refused"


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("key", [
    "joints.B.clearance", "contact_laws.pin.stiffness", "contact_laws.pin.bearing_radius",
    "contact_laws.pin.slowest_impact", "bodies.rod.mass", "bodies.rod.inertia", "solver.end",
])  # fmt: skip
def test_absurd_numbers_of_a_run_with_play(key):
    found = [of_a_run(CLEARANCE, FEW, f"{key}={size}") for size in TINY_OR_HUGE]
    assert {*found} <= {"done", "failed", "refused"}


@pytest.mark.parametrize("end", [1e-300, 1e-200, 1e-100, 1e-60, 1e-30, 0.99 * SHORTEST])
def test_a_run_shorter_than_any_motion_is_refused(end):
    with pytest.raises(TrsimError, match="than any motion that can be resolved") as caught:
        loads(MOVING, [f"solver.end={end}"])
    assert "1e-60" in caught.value.hint and NOTHING == 1e-60
    assert "1e-20 s" in caught.value.hint and SHORTEST == 1e-20


@pytest.mark.parametrize("method", ["auto", "dop853", "radau", "generalized_alpha", "rk4"])
def test_the_shortest_run_moves_as_it_should(method):
    """Both what goes on and what a load of 1e-6 m/s^2 begins to move."""
    step = SHORTEST / 100
    r = run(MOVING, f"solver.end={SHORTEST}", f"solver.method={method}", f"solver.max_step={step}",
            f"solver.step={step}", "forces.push.force=2e-6", "output={every: 1e-22}")  # fmt: skip
    assert r["x"][-1] == pytest.approx(0.5 * SHORTEST, rel=1e-9, abs=0.0)
    assert r["y"][-1] == pytest.approx(0.5e-6 * SHORTEST**2, rel=1e-9, abs=0.0)
    assert r["y.rate"][-1] == pytest.approx(1e-6 * SHORTEST, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("method, key", [("auto", "max_step"), ("rk4", "step")])
def test_steps_that_cannot_come_to_the_end(method, key):
    scenario = loads(MOVING, [f"solver.method={method}", "solver.step=1e-3", f"solver.{key}=1e-20"])
    with pytest.raises(TrsimError, match=r"steps of 1e-20 s would be 1e\+19 in 0.1 s") as no:
        list(simulate(scenario, assemble(scenario)))
    assert no.value.path == ("solver", key)
