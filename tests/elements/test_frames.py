"""Rows of what an impact acts with, as bodies feel them."""

import numpy as np
import pytest

from trsim.elements.frames import impulse


@pytest.mark.parametrize("k", [0, 1])
def test_an_impulse_acts_on_both_bodies_in_its_own_row(k):
    """The same on both, turned round, with the moments of their own arms; no other row is met."""
    blow = np.zeros((3, 12))
    p_i, p_j, f = (1.0, 2.0, 3.0), (-2.0, 0.5, 1.0), (0.3, -0.4, 0.7)
    impulse(blow, k, p_i, p_j, f)
    expected = np.zeros_like(blow)
    expected[k, :3], expected[k, 3:6] = f, np.cross(p_j, f)
    expected[k, 6:9], expected[k, 9:] = np.negative(f), -np.cross(p_i, f)
    assert blow == pytest.approx(expected, abs=1e-15)
