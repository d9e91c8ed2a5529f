"""The comparison of long channels is that of pytest."""

import numpy as np
import pytest

from .comparing import approx


@pytest.mark.parametrize(
    "given", [{}, {"rel": 1e-3}, {"abs": 1e-3}, {"rel": 1e-3, "abs": 1e-2}, {"abs": 0.0}], ids=str
)
def test_it_is_that_of_pytest(given):
    rng, seen = np.random.default_rng(1), set()
    for power in range(-14, 0):
        for wanted in (rng.normal(size=3), np.zeros((2, 2)), 0.7, np.array([np.inf, 2.0])):
            found = wanted + 10.0**power * np.ones(np.shape(wanted))
            same = np.array_equal(found, wanted)
            if not same and np.all(np.isfinite(found)):
                plain = found == pytest.approx(wanted, **given)
                assert (found == approx(wanted, **given)) == plain, (power, wanted)
                seen.add(plain)
    assert False in seen and (True in seen) == (given != {"abs": 0.0})


def test_what_has_another_shape_or_is_no_number_is_not_equal():
    assert np.ones(3) == approx(1.0) == np.ones((2, 2))
    assert np.ones(3) != approx(np.ones(2))
    assert np.array([1.0, np.nan]) != approx(np.ones(2))
    assert np.ones(2) != approx(np.array([1.0, np.nan]))
