"""Applied load: force at a point or torque, fixed or following, and its power in the book."""

import numpy as np
import pytest

from .bench import bench, check_power, drawn, matrix, product

NAMED = "forces: {{load: {{type: applied_load, body: right, {}}}}}\n"
DEAD = NAMED.format("at: [0.7, 0.3, 0.2], direction: [3, 0, 4], force: 20*t")
FOLLOWING = NAMED.format("at: [0.7, 0.3, 0.2], frame: left, direction: [3, 0, 4], force: 20*t")
TORQUE = NAMED.format("frame: right, direction: [0, 2, 0], torque: 7")


def turn_since_drawn(b, name, frame):
    """Rotation of a body since the drawing."""
    return matrix(product(b.p[frame], drawn(b, name)[1] * [1, -1, -1, -1]))


def test_dead_force_at_a_point():
    b = bench(DEAD, np.random.default_rng(1))
    F = b.wrenches()
    arm = turn_since_drawn(b, "right", 2) @ (np.array([0.7, 0.3, 0.2]) - drawn(b, "right")[0])
    force = 20 * b.t * np.array([0.6, 0.0, 0.8])
    np.testing.assert_allclose(F[2, :3], force, rtol=1e-14)
    np.testing.assert_allclose(F[2, 3:], np.cross(arm, force), rtol=1e-12)
    assert not F[:2].any()


def test_following_force_turns_with_its_frame():
    b = bench(FOLLOWING, np.random.default_rng(2))
    force = turn_since_drawn(b, "left", 1) @ (20 * b.t * np.array([0.6, 0.0, 0.8]))
    np.testing.assert_allclose(b.wrenches()[2, :3], force, rtol=1e-12)


def test_torque_has_no_force():
    b = bench(TORQUE, np.random.default_rng(3))
    F = b.wrenches()
    assert not F[:, :3].any()
    np.testing.assert_allclose(F[2, 3:], turn_since_drawn(b, "right", 2) @ [0, 7, 0], rtol=1e-12)


@pytest.mark.parametrize("text", [DEAD, FOLLOWING, TORQUE])
def test_power_is_force_times_velocity(text):
    b = bench(text, np.random.default_rng(4))
    check_power(b)
    assert b.book[1] == pytest.approx(b.book.sum())  # loads, nothing else


def test_load_of_a_sensor_and_of_a_table():
    text = """
joints: {hinge: {type: revolute, bodies: [left, right], at: [0.2, 0.1, 0]}}
sensors: {turn: {joint: hinge, sign: -1, at_start: 2}}
forces:
  load: {type: applied_load, body: left, direction: [1, 0], force: "10*turn"}
  more: {type: applied_load, body: left, direction: [0, 1],
         force: {table: [[0, 0], [1, 5], [2, 8], [3, 9]], of: turn}}
"""
    from .bench import put_right

    b = bench(text, np.random.default_rng(5))
    put_right(b, np.array([0.2, 0.1, 0.0]), np.array([0.0, 0.0, 1.0]), np.zeros(3))
    np.testing.assert_allclose(b.wrenches()[1, :2], [10.0, 5.0], rtol=1e-12)
