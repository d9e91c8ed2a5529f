"""Torsion spring: the torque is minus the gradient of the energy, and the pair adds no moment."""

import numpy as np
import pytest

from .bench import bench, check_action_is_reaction, check_gradient, check_power, put_right

AXIS, PIN = np.array([0.48, 0.6, 0.64]), np.array([0.2, 0.1, 0.0])
SPRING = """
joints:
  hinge: {type: revolute, bodies: [left, right], at: [0.2, 0.1, 0], axis: [0.48, 0.6, 0.64]}
forces:
  spring: {type: torsion_spring, joint: hinge, stiffness: 3, damping: 0.2, preload: 5}
"""


def turned(angle, seed, text=SPRING):
    """The hinge turned by an angle from the drawing, thrown somewhere, moving on the joint."""
    rng = np.random.default_rng(seed)
    b = bench(text, rng)
    put_right(b, PIN, angle * AXIS, np.zeros(3))
    return b


@pytest.mark.parametrize("angle", [-2.5, -0.3, 0.0, 1.7])
def test_torque_is_minus_the_gradient_of_the_energy(angle):
    check_gradient(turned(angle, seed=1))


@pytest.mark.parametrize("angle", [-2.5, -0.3, 0.0, 1.7])
def test_action_is_reaction_and_the_book_closes(angle):
    b = turned(angle, seed=2)
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] < 0.0


def test_preload_as_drawn_and_stiffness_from_there():
    b = turned(0.4, seed=3)
    b.V[:] = 0.0
    moment = b.wrenches()[2, 3:]
    assert np.linalg.norm(moment) == pytest.approx(5.0 - 3.0 * 0.4, rel=1e-12)
