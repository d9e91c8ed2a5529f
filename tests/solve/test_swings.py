"""Points of sections that rounding makes are told, and only those."""

import re

import numpy as np
import pytest

from trsim.solve.diagnose.doubts import doubts
from trsim.solve.diagnose.swings import below, reached
from trsim.solve.march.record import DECADES, LEAST

from ..runs import run

METHODS = {"dop853": "", "radau": "", "generalized_alpha": "", "rk4": ", step: 1e-3"}

LOCKED = """
bodies:
  arm: {{mass: 1, inertia: 0.02, at: [0, -0.3]}}
  hand: {{mass: 0.5, inertia: 0.01, at: [0, -0.9]}}
joints:
  shoulder: {{type: revolute, bodies: [ground, arm], at: [0, 0]}}
  elbow: {{type: revolute, bodies: [arm, hand], at: [0, -0.6]}}
sensors: {{bend: {{joint: elbow}}}}
drives: {{motor: {{joint: shoulder, velocity: "5*sin(20*t)"}}}}
gravity: [0, -9.81]
events: {{catch: {{when: bend, crosses: down, do: {{lock: [elbow]}}}}}}
solver: {{method: {method}, end: 5, tolerance: 1e-7}}
poincare: {{turn: {{when: {when}, crosses: both, plot: [bend, bend.rate]}}}}
"""

GUIDED = """
bodies: {{b: {{mass: 1, inertia: 1, at: [0.1, 0], velocity: [1, 0]}}}}
joints: {{guide: {{type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}}}
forces: {{s: {{type: spring_damper, bodies: [ground, b], points: [[-1, 0.5], [0.1, 0]],
            stiffness: 100}}}}
solver: {{method: {method}, end: 5, tolerance: 1e-7}}
poincare:
  across: {{when: b.position.y, crosses: both, plot: [b.position.x, b.velocity.x]}}
  along: {{when: b.velocity.x, crosses: both, plot: [b.position.x, b.velocity.x]}}
"""


def told(r):
    """Of each section: how many swings there are, and how many are not resolved."""
    said = [x for x in doubts(r.scenario, r.mechanism, r.outcome) if x.startswith("poincare.")]
    found = {}
    for text in said:
        every, faint = re.search(r"of the (\d+) swings .* crossings (\d+) go", text).groups()
        found[text.split(":")[0][len("poincare.") :]] = int(every), int(faint)
    return found


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("when", ["bend", "bend.rate"])
def test_a_locked_joint(when, method):
    # of second order: at 1e-7 it takes half a million steps
    loose = ("solver.tolerance=1e-5",) if method == "generalized_alpha" else ()
    r = run(LOCKED.format(method=method + METHODS[method], when=when), *loose)
    points, (locked,) = r.section("turn")[:, 0], r.events[:, 0]
    behind, said = int(np.sum(points > locked + 1e-9)), told(r)
    assert said or not behind
    if said:  # what the lock leaves of the motion may end in the last swing, or begin the first
        every, faint = said["turn"]
        assert every == len(points)
        assert behind - 1 <= faint <= behind + 1


@pytest.mark.parametrize("method", METHODS)
def test_what_a_guide_holds_at_zero(method):
    # of second order, which takes 100,000 steps at 1e-7
    loose = ("solver.tolerance=1e-6",) if method == "generalized_alpha" else ()
    r = run(GUIDED.format(method=method + METHODS[method]), *loose)
    across, along, said = r.section("across"), r.section("along"), told(r)
    assert len(along) > 10
    assert "along" not in said
    assert said.get("across", (0, 0)) == (len(across), len(across))


PAIR = """
planar: true
bodies:
  large: {{mass: 1, inertia: 1, at: [0, 1], velocity: [1, 0]}}
  small: {{mass: 1, inertia: 1, velocity: [{speed}, 0]}}
forces:
  of_large: {{type: spring_damper, bodies: [ground, large], points: [[-1, 1], [0, 1]],
             stiffness: 400}}
  of_small: {{type: spring_damper, bodies: [ground, small], points: [[-1, 0], [0, 0]],
             stiffness: 400}}
solver: {{end: 3, tolerance: {tolerance}}}
poincare:
  turn: {{when: small.velocity.x, crosses: both, plot: [small.position.x, small.velocity.x]}}
"""


@pytest.mark.parametrize(
    "speed, tolerance, told_of", [(1e-3, 1e-4, 0), (1e-6, 1e-4, 1), (1e-6, 1e-9, 0)]
)
def test_a_small_motion_beside_a_large_one(speed, tolerance, told_of):
    """It is right all the same here, being a motion by itself, and its points stay."""
    r = run(PAIR.format(speed=speed, tolerance=tolerance))
    every = len(r.section("turn"))
    assert every > 15
    assert told(r) == ({"turn": (every, every)} if told_of else {})


def test_decades():
    swings = np.zeros(DECADES)
    swings[0], swings[1], swings[10] = 5, 1, 2  # below LEAST; below ten of it; 1e-15 to 1e-14
    assert below(swings, LEAST / 2) == 0
    assert below(swings, 9 * LEAST) == 5
    assert below(swings, 11 * LEAST) == 6
    assert below(swings, 0.9e-14) == 6
    assert below(swings, 1.1e-14) == 8
    assert reached(swings) == pytest.approx(1e-15)
