"""Limit stop: one-sided, ramped, on both bodies; point on wall, angle and stroke."""

import numpy as np
import pytest

from trsim.assemble.outputs import measured
from trsim.errors import ScenarioError

from ..runs import built
from .bench import (
    TWO_BODIES,
    bench,
    check_action_is_reaction,
    check_gradient,
    check_power,
    now,
    put_right,
)

AXIS, PLACE = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
K, DAMPING, RAMP = 1e4, 200.0, 0.01
LAW = "stiffness: 1e4, damping: 200, ramp: 0.01"
WALL = f"""
forces:
  stop: {{type: limit_stop, point: {{body: right, at: [0.2, 0.1, 0]}},
         wall: {{body: left, at: [0.2, 0.1, 0], normal: [0.96, 1.2, 1.28]}}, {LAW}}}
"""
JOINT = f"""
joints: {{joint: {{type: KIND, bodies: [left, right], at: [0.2, 0.1, 0], axis: [0.48, 0.6, 0.64]}}}}
forces:
  stop: {{type: limit_stop, joint: joint, lower: -0.2, upper: 0.3, {LAW}}}
"""


def pressed(kind, depth, seed=1, side=1.0):
    """A stop pressed in by a depth, bodies thrown about; side: 1 upper, -1 lower limit."""
    rng = np.random.default_rng(seed)
    if kind == "wall":
        b = bench(WALL, rng)
        along = np.cross(AXIS, rng.normal(size=3))
        put_right(b, PLACE, rng.normal(size=3), -depth * AXIS + along)
        return b
    b = bench(JOINT.replace("KIND", kind), rng)
    x = 0.3 + depth if side > 0 else -0.2 - depth
    turn, shift = (x, 0.0) if kind == "revolute" else (0.0, x)
    put_right(b, PLACE, turn * AXIS, shift * AXIS)
    return b


def closing(b, kind, rate, side=1.0):
    """Velocities that change the penetration at a rate, and nothing else."""
    axis = now(b, AXIS)
    b.V[2, 3:] = b.V[1, 3:]
    b.V[2, :3] = b.V[1, :3] + np.cross(b.V[1, 3:], b.r[2] - b.r[1])
    if kind == "revolute":
        b.V[2, 3:] += side * rate * axis
    else:
        b.V[2, :3] += (-rate if kind == "wall" else side * rate) * axis


def force_on_right(b, kind):
    """Along the axis of the joint, or the wall's normal."""
    return b.wrenches()[2, 3:] @ now(b, AXIS) if kind == "revolute" else (
        b.wrenches()[2, :3] @ now(b, AXIS))  # fmt: skip


KINDS = [
    ("wall", 1.0),
    ("revolute", 1.0),
    ("revolute", -1.0),
    ("prismatic", 1.0),
    ("prismatic", -1.0),
]


@pytest.mark.parametrize("kind, side", KINDS)
def test_force_is_minus_the_gradient_of_the_energy(kind, side):
    check_gradient(pressed(kind, 0.02, side=side), rel=3e-7)


@pytest.mark.parametrize("kind, side", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_action_is_reaction_and_the_book_closes(kind, side, seed):
    b = pressed(kind, 0.007, seed, side)
    b.V *= 0.01
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[3] <= 0.0


@pytest.mark.parametrize("kind, side", KINDS)
def test_force_of_the_law(kind, side):
    for depth, share in ((RAMP / 2, 0.5), (2 * RAMP, 1.0)):
        b = pressed(kind, depth, side=side)
        closing(b, kind, 0.1, side)
        pushed = 1.0 if kind == "wall" else -side
        expected = K * depth + share * DAMPING * 0.1
        assert force_on_right(b, kind) == pytest.approx(pushed * expected, rel=1e-9)


@pytest.mark.parametrize("kind, side", KINDS)
def test_never_pulls_and_nothing_before_the_touch(kind, side):
    b = pressed(kind, 0.02, side=side)
    closing(b, kind, -100.0, side)
    assert not np.abs(b.wrenches()).max()
    assert b.book[3] <= 0.0
    b = pressed(kind, -0.01, side=side)
    closing(b, kind, 100.0, side)
    assert not b.wrenches().any()


def test_damping_ramp_is_smooth_at_both_ends():
    """F - k d and its slope are continuous at the touch and where the damping is complete."""

    def damping(depth):
        b = pressed("wall", depth)
        closing(b, "wall", 0.5)
        return force_on_right(b, "wall") - K * max(depth, 0.0)

    h = 1e-5
    for depth in (0.0, RAMP):
        left, right = damping(depth) - damping(depth - h), damping(depth + h) - damping(depth)
        assert abs(left - right) / h < 20 * h / RAMP * DAMPING * 0.5 / RAMP


@pytest.mark.parametrize(
    "old, new, path",
    [
        ("lower: -0.2, upper: 0.3", "lower: 0.3, upper: -0.2", ("forces", "stop")),
        ("joint: joint, lower", "joint: jont, lower", ("forces", "stop", "joint")),
        ("lower: -0.2, upper: 0.3, ", "", ("forces", "stop")),
    ],
)
def test_bad_joint_limits_are_refused(old, new, path):
    text = JOINT.replace("KIND", "revolute")
    assert old in text
    with pytest.raises(ScenarioError) as caught:
        built(TWO_BODIES + text.replace(old, new))
    assert caught.value.path == path


def test_wall_and_point_of_one_body_are_refused():
    for body in ("left", "ground"):
        text = WALL.replace("body: right", f"body: {body}").replace("body: left", f"body: {body}")
        with pytest.raises(ScenarioError) as caught:
            built(TWO_BODIES + text)
        assert caught.value.path[:2] == ("forces", "stop")


@pytest.mark.parametrize("kind, side", KINDS)
def test_what_is_recorded_is_what_acts(kind, side):
    """The force, or torque, on the second body and how far it is pressed in."""
    b = pressed(kind, 2 * RAMP, side=side)
    closing(b, kind, 0.1, side)
    w, columns = b.scene(), {c.name: c.start for c in b.mechanism.columns}
    measured(w, b.t, b.state(), 0.0, 0.0)
    acts = w.F[2, 3:] if kind == "revolute" else w.F[2, :3]
    start = columns["stop.force"]
    assert w.out[start : start + 3] == pytest.approx(acts, rel=1e-9, abs=1e-9)
    assert w.out[columns["stop.normal_force"]] == pytest.approx(np.linalg.norm(acts), rel=1e-9)
    assert w.out[columns["stop.penetration"]] == pytest.approx(2 * RAMP, rel=1e-6)
