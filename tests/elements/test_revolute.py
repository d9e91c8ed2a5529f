"""Revolute joint: angle as drawn and unwrapped, and the reaction on the second body."""

import numpy as np
import pytest

from ..runs import run

HINGE = """
planar: {planar}
gravity: [0, -9.81, 0]
bodies: {{rod: {{mass: 2, inertia: [0.1, 0.1, 0.05], at: [0.4, 0], angle: 20 deg}}}}
joints: {{hinge: {{type: revolute, bodies: {bodies}, at: [0, 0], axis: {axis}}}}}
drives: {{motor: {{joint: hinge, velocity: 10}}}}
sensors: {{turn: {{joint: hinge}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("axis, sign", [("[0, 0, 1]", 1), ("[0, 0, -1]", -1)])
def test_angle_counts_turns_from_the_drawing(planar, axis, sign):
    r = run(HINGE.format(planar=planar, bodies="[ground, rod]", axis=axis))
    assert r["turn"] == pytest.approx(10 * r.t, abs=1e-9)  # about three turns
    assert r["motor.position"][0] == pytest.approx(sign * np.radians(20))
    assert r["motor.position"] == pytest.approx(sign * np.radians(20) + 10 * r.t, abs=1e-9)


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("bodies, sign", [("[ground, rod]", 1), ("[rod, ground]", -1)])
def test_reaction_acts_on_the_second_body(planar, bodies, sign):
    """The pin holds the weight and turns the centre around itself; the motor holds the moment."""
    r = run(HINGE.format(planar=planar, bodies=bodies, axis="[0, 0, 1]"))
    c = np.stack([np.cos(10 * r.t), np.sin(sign * 10 * r.t)], axis=1) * 0.4
    assert r["rod.position"][:, :2] == pytest.approx(c, abs=1e-9)
    on_rod = -2 * 100 * c + [0, 2 * 9.81]
    assert r["hinge.reaction"][:, :2] == pytest.approx(sign * on_rod, abs=1e-6)
    assert r["hinge.reaction_moment"] == pytest.approx(0.0, abs=1e-6)
    assert r["motor.force"] == pytest.approx(sign * 2 * 9.81 * c[:, 0], abs=1e-6)
