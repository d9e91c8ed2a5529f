"""Gravity: the weight of every body, and the gradient of its energy."""

import numpy as np

from .bench import bench, check_gradient, check_power

GRAVITY = "gravity: [1.0, -9.0, 3.0]\n"


def test_force_is_minus_the_gradient_of_the_energy():
    b = bench(GRAVITY, np.random.default_rng(1))
    check_gradient(b)
    check_power(b)


def test_weight_acts_at_the_centre_of_mass_and_not_on_the_ground():
    F = bench(GRAVITY, np.random.default_rng(2)).wrenches()
    expected = [[0, 0, 0], [2, -18, 6], [3, -27, 9]]
    np.testing.assert_allclose(F[:, :3], expected, rtol=1e-15)
    assert not F[:, 3:].any()
