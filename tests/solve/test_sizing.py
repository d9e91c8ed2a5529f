"""A load that takes over what a drive gives, against balances solved by hand."""

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.linkages import UPRIGHT_CRANK
from tests.runs import run
from trsim.errors import ScenarioError, SolverError
from trsim.scenario.load import loads
from trsim.solve.sizing import sized

G = 9.81
LEVER = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [BODIES], at: [0, 0]}
drives:
  motor: {joint: hinge, position: "SIGN*1.2*t"}
sensors: {turn: {joint: hinge}}
forces:
  hand: {type: applied_load, body: rod, at: [0.4, 0], frame: rod, direction: [0, 1], force: 0}
sizing: {drive: motor, load: forces.hand.force, of: turn, below: 1e-9, passes: 8}
gravity: [0, -9.81, 0]
solver: {method: static_path, end: 1 s}
output: {every: 50 ms}
"""
RUB = """
  rub: {type: joint_friction, joint: hinge, radius: 30 mm,
        friction: {law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1 mm/s}}
sizing:"""


def lever(bodies="ground, rod", sign=1):
    return LEVER.replace("BODIES", bodies).replace("SIGN", str(sign))


@pytest.mark.parametrize("bodies, sign", [("ground, rod", 1), ("rod, ground", -1)])
def test_one_pass_is_exact_where_nothing_depends_on_the_load(bodies, sign):
    found = sized(loads(lever(bodies, sign)))
    assert len(found.left) == 3 and found.relative[-1] < 1e-12
    assert found.load == pytest.approx(2 * G * 0.2 * np.cos(found.x) / 0.4, abs=1e-9)
    assert found.left[0] == pytest.approx(2 * G * 0.2)
    again = run(found.scenario)
    assert np.abs(again["motor.force"]).max() < 1e-9 * found.left[0]


def by_hand(a):
    """F 0.4 = m g 0.2 cos + mu r |R|, R the reaction with this F in it."""

    def left(F):
        R = np.hypot(F * np.sin(a), 2 * G - F * np.cos(a))
        return 0.4 * F - 2 * G * 0.2 * np.cos(a) - 0.3 * 0.03 * R

    return brentq(left, 0, 100, xtol=1e-13)


def test_friction_that_the_load_makes():
    seen = []
    found = sized(loads(lever().replace("sizing:", RUB[1:])), lambda *one: seen.append(one))
    assert found.relative[-1] < 1e-9 and len(found.left) <= 7
    assert [left for _, left in seen] == found.relative
    assert found.load == pytest.approx([by_hand(a) for a in found.x], rel=1e-8)


CRANK = (
    UPRIGHT_CRANK
    + """
drives:
  motor: {joint: a, position: "-20*t"}
sensors: {turn: {joint: a}}
forces:
  hand: {type: applied_load, body: slider, direction: [1, 0], force: 0}
sizing: {drive: motor, load: forces.hand.force, of: turn}
solver: {method: METHOD, end: 50 ms}
output: {every: 1 ms}
"""
)


@pytest.mark.parametrize("method", ["kinematic", "dop853"])
def test_inverse_dynamics_put_back(method):
    """Inertia included: with the force on the slider the crank turns evenly by itself."""
    found = sized(loads(CRANK.replace("METHOD", method)))
    assert len(found.left) == 3 and found.relative[-1] < 1e-6
    tables = found.scenario.resolved["forces"]["hand"]["force"]["table"]
    assert [x for x, _ in tables] == sorted(x for x, _ in tables)


@pytest.mark.parametrize(
    "old, new, said",
    [
        ("drive: motor", "drive: moter", "no drive named 'moter'"),
        ("of: turn", "of: tern", "no sensor named 'tern'"),
        ("forces.hand.force,", "forces.hand.torque,", "no key"),
        ("forces.hand.force,", "forces.hans.force,", "no entry"),
        ('"SIGN*1.2*t"', '"sin(5*t)"', "turns round"),
        ("direction: [0, 1]", "direction: [1, 0]", "does no work"),
    ],
)
def test_refused(old, new, said):
    text = LEVER.replace(old, new).replace("BODIES", "ground, rod").replace("SIGN", "1")
    with pytest.raises(ScenarioError, match=said):
        sized(loads(text))


def test_too_few_passes():
    text = lever().replace("sizing:", RUB[1:]).replace("passes: 8", "passes: 2")
    with pytest.raises(SolverError, match="after 2 passes"):
        sized(loads(text))
