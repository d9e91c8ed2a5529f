"""Moments that go with rotation vectors do the work they are asked to."""

import numpy as np
import pytest

from trsim.elements.rotations import gradient


def turned(theta):
    """Rotation matrix of a rotation vector."""
    angle = np.linalg.norm(theta)
    x, y, z = theta
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, versed = np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle**2
    return np.eye(3) + sine * cross + versed * cross @ cross


@pytest.mark.parametrize("size", [1e-3, 0.4, 2.0])
def test_a_moment_does_the_work_along_the_rotation_vector(size):
    """theta moves by d, and the body turns by the small rotation of R(theta + d) R(theta)^T: the
    moment times that is g times d."""
    rng, h = np.random.default_rng(3), 1e-5
    theta, g = size * rng.normal(size=3), rng.normal(size=3)
    moment = np.array(gradient(tuple(theta), tuple(g)))
    for d in np.eye(3):
        step = (turned(theta + h * d) - turned(theta - h * d)) / (2 * h) @ turned(theta).T
        spin = np.array([step[2, 1], step[0, 2], step[1, 0]])
        assert moment @ spin == pytest.approx(g @ d, abs=1e-8)
