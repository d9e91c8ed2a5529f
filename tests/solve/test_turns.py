"""Angles of joints in space keep all their turns, at any tolerance and by any method."""

import numpy as np
import pytest

from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, ONSET, USER

from ..runs import run

METHODS = {
    "auto": "",
    "dop853": "",
    "radau": "",
    "generalized_alpha": ", step: 2e-3",
    "rk4": ", step: 2e-3",
    "scipy:RK45": "",
    "scipy:Radau": "",
}
SLOW = ("generalized_alpha", "scipy:RK45", "scipy:Radau")  # at tight tolerances: they make 30 rad


def shaft(rate, end, tolerance, axis=(1, 2, 2), method="auto", more=""):
    a = np.array(axis, float) / np.linalg.norm(axis)
    return run(f"""
planar: false
bodies:
  shaft: {{mass: 2, inertia: [0.05, 0.05, 0.05], angular_velocity: {(rate * a).tolist()}}}
joints:
  hinge: {{type: revolute, bodies: [ground, shaft], at: [0, 0, 0], axis: {list(axis)}}}
sensors: {{turn: {{joint: hinge}}}}
solver: {{end: {end}, tolerance: {tolerance}, method: "{method}"{METHODS[method]}}}
output: {{every: {end / 20}}}
{more}
""")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-8])
def test_a_hundred_radians(method, tolerance):
    end = 3 if tolerance < 1e-4 and method in SLOW else 10
    r = shaft(10, end, tolerance, method=method)
    assert r["turn"] == pytest.approx(10 * r.t, rel=100 * tolerance, abs=2 * tolerance)


@pytest.mark.parametrize("rate", [-1000, 3, 300])
@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 0, 0), (0, 1, -1)])
def test_any_rate_about_any_axis(rate, axis):
    r = shaft(rate, 1, 1e-3, axis)
    assert r["turn"] == pytest.approx(rate * r.t, rel=0.1, abs=1e-3)


def test_an_event_and_a_stop_many_turns_ahead():
    """The event at 30 rad, and the stop at 50 rad that sends the shaft back."""
    more = """
events: {there: {when: turn, value: 30, crosses: up, do: {record: true}}}
forces: {stop: {type: limit_stop, joint: hinge, upper: 50, stiffness: 1e4}}
"""
    r = shaft(10, 10, 1e-4, more=more)
    kinds = r.events[:, EVENT_KIND]
    assert r.events[kinds == USER, EVENT_TIME] == pytest.approx([3.0], rel=1e-2)
    assert r.events[kinds == ONSET, EVENT_TIME] == pytest.approx([5.0], rel=1e-2)
    stay = np.pi / np.sqrt(1e4 / 0.05)
    assert r["turn"][-1] == pytest.approx(50 - 10 * (5 - stay), abs=0.5)


def test_a_fixed_step_that_cannot_count_ends_the_run():
    r = run(
        """
planar: false
bodies: {shaft: {mass: 2, inertia: [0.05, 0.05, 0.05], angular_velocity: [200, 0, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, shaft], at: [0, 0, 0], axis: [1, 0, 0]}}
sensors: {turn: {joint: hinge}}
solver: {end: 1, method: rk4, step: 0.02, force: true}
""",
        fails=True,
    )
    assert "turns cannot be counted" in r.outcome.reason
