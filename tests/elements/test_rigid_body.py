"""Rigid body: the inertia as written, and its channels in a free flight."""

import numpy as np
import pytest

from trsim.elements.inertia import written as as_numbers
from trsim.elements.rigid_body import RigidBody
from trsim.errors import TrsimError
from trsim.scenario.load import loads

from ..mechanisms import free_top
from ..runs import run


def tensor(inertia):
    return RigidBody(mass=1.0, inertia=inertia).tensor


@pytest.mark.parametrize("moments", [(1.0, 2.0, 3.0), (3.0, 1.0, 2.0), (2.0, 3.0, 1.0)])
def test_products_that_are_rounding_are_nothing(moments):
    """Of a plate too, whose largest moment is the sum of the others."""
    other = 1e-15 * (np.ones((3, 3)) - np.eye(3))
    assert as_numbers(np.diag(moments) + other) == (*moments, 0.0, 0.0, 0.0)
    assert as_numbers(np.diag(moments) + 1e3 * other) == (*moments, 1e-12, 1e-12, 1e-12)


def test_tensor_of_one_three_and_six_numbers():
    assert tensor(4.0) == ((0, 0, 0, 0, 0, 0, 0, 0, 4.0), False)
    assert tensor((1.0, 2.0, 3.0)) == ((1, 0, 0, 0, 2, 0, 0, 0, 3), True)
    full, known = tensor((1.0, 2.0, 3.0, 0.1, 0.2, 0.3))  # xx yy zz xy xz yz
    assert known
    np.testing.assert_array_equal(
        np.reshape(full, (3, 3)), [[1, 0.1, 0.2], [0.1, 2, 0.3], [0.2, 0.3, 3]]
    )


def test_channels_are_derivatives_of_each_other():
    r = run(free_top(end=0.2)[0])
    inner = slice(1, -1)
    position, velocity = r["top.position"], r["top.velocity"]
    np.testing.assert_allclose(
        np.gradient(position, r.t, axis=0)[inner], velocity[inner], atol=1e-9
    )
    rate = np.gradient(r["top.angular_velocity"], r.t, axis=0)[inner]
    np.testing.assert_allclose(rate, r["top.angular_acceleration"][inner], atol=2e-3)


def test_rotation_turns_with_the_angular_velocity():
    r = run(free_top(end=0.2)[0], 'output.channels=["top.*"]')
    R = r["top.rotation"].reshape(-1, 3, 3)
    rate = np.gradient(R, r.t, axis=0)[1:-1]
    spin = rate @ R[1:-1].transpose(0, 2, 1)
    omega = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
    assert omega == pytest.approx(r["top.angular_velocity"][1:-1], abs=2e-3)
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1) - np.eye(3), 0.0, atol=1e-12)


def test_one_number_is_no_angular_velocity():
    text = "bodies: {disc: {mass: 1, inertia: 1, angular_velocity: 3 rad/s}}"
    with pytest.raises(TrsimError) as error:
        loads(text)
    assert error.value.hint == "About z it is [0, 0, 3 rad/s]."
