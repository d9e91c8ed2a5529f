"""Pieces of Radau IIA."""

import numpy as np
import pytest

from trsim.solve.methods.radau import norm

from ..pieces import piece


@pytest.mark.parametrize("n", [1, 2, 5])
def test_the_norm_is_the_root_mean_square_of_what_is_weighed(n):
    """Entries without a weight, such as works, neither count nor thin out the others."""
    rng = np.random.default_rng(n)
    e, weight = rng.normal(size=n), rng.uniform(1.0, 2.0, n)
    assert piece(norm)(e, weight) == pytest.approx(np.sqrt(np.mean((e * weight) ** 2)), rel=1e-12)
    more = np.insert(e, 0, 1e9), np.insert(weight, 0, 0.0)
    assert piece(norm)(*more) == pytest.approx(piece(norm)(e, weight), rel=1e-12)
    assert piece(norm)(e, np.zeros(n)) == 0.0
