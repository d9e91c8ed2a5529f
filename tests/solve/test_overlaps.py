"""Contacts drawn in each other are told, with the speed they part at; pressed ones are not."""

from math import sqrt

import pytest

from trsim.solve.diagnose.overlaps import of_overlaps

from ..runs import run

DRAWN = """
bodies: {{ball: {{mass: 0.1, inertia: 1.6e-5, at: [0, {height}]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, ball], at: [0, {height}], axis: [0, 1, 0]}}}}
forces:
  floor: {{type: limit_stop, point: {{body: ball, at: [0, {low}]}}, stiffness: 1e5,
          wall: {{body: ground, at: [0, 0], normal: [0, 1]}}}}
  {more}
gravity: [0, -9.81]
initial: {initial}
solver: {{end: 0.01}}
"""


def told(low, more="", initial="{}"):
    got = run(DRAWN.format(height=low + 0.02, low=low, more=more, initial=initial))
    return list(of_overlaps(got.mechanism, got.outcome.start))


def test_an_overlap_is_told_with_its_speed():
    (text,) = told(-5e-3)
    assert "forces.floor: is 0.005 m deep" in text
    assert f"{sqrt(1e5 * 5e-3**2 / 0.1):.3g} m/s" in text


@pytest.mark.parametrize("low, more, initial", [
    (1e-3, "", "{}"),  # apart
    (-0.981e-5, "", "{}"),  # where it rests
    (-5e-3, "", "{equilibrium: all}"),
    (-5e-3, "push: {type: applied_load, body: ball, at: [0, 0], force: 500, direction: [0, -1, 0]}",
     "{}"),
])  # fmt: skip
def test_what_is_pressed_together_is_not(low, more, initial):
    assert told(low, more, initial) == []
