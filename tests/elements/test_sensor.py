"""Sensor: sign, origin, rate and acceleration of a joint coordinate."""

import numpy as np
import pytest

from ..runs import run
from .bench import bench, now, put_right

AXIS, PLACE = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
SENSED = """
joints:
  joint: {{type: {}, bodies: [left, right], at: [0.2, 0.1, 0], axis: [0.48, 0.6, 0.64]}}
sensors:
  x: {{joint: joint, sign: -1, at_start: 0.25}}
"""


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_sign_and_origin(kind):
    b = bench(SENSED.format(kind), np.random.default_rng(1))
    turn, shift = (1.3, 0.0) if kind == "revolute" else (0.0, 1.3)
    put_right(b, PLACE, turn * AXIS, shift * AXIS)
    # right moves against left along the joint, at a rate of 2
    axis = now(b, AXIS)
    b.V[2, 3:] = b.V[1, 3:]
    b.V[2, :3] = b.V[1, :3] + np.cross(b.V[1, 3:], b.r[2] - b.r[1])
    if kind == "prismatic":
        b.V[2, :3] += 2.0 * axis
    else:
        b.V[2, 3:] += 2.0 * axis
    joint, sensor = b.scene().S
    assert joint == pytest.approx([1.3, 2.0], rel=1e-12)
    assert sensor == pytest.approx([0.25 - 1.3, -2.0], rel=1e-12)


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_acceleration_is_the_rate_of_the_rate(kind):
    """A joint between two tumbling bodies, in a free flight."""
    spinning = ", velocity: [1, 0, 0], angular_velocity: [3, 1, -2]}"
    bodies = (
        "planar: false\nbodies:\n  left: {mass: 2, inertia: [0.02, 0.03, 0.04]" + spinning
        + "\n  right: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, -0.1]}\n"
    )  # fmt: skip
    r = run(bodies + SENSED.format(kind) + "solver: {end: 0.4, tolerance: 1e-10}")
    for a, b in (("x", "x.rate"), ("x.rate", "x.acceleration")):
        slope = np.gradient(r[a], r.t)[1:-1]
        assert slope == pytest.approx(r[b][1:-1], abs=1e-4 * np.abs(r[b]).max())
