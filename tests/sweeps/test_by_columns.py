"""Numbers of many channels at once are those of each by itself, to the bit."""

import numpy as np
import pytest

from trsim.sweeps.summary import by_columns


@pytest.mark.parametrize(
    "shape", [(1, 1), (2, 7), (3, 1), (9, 40), (130, 3), (1025, 17), (4097, 2)]
)
def test_each_column_as_if_it_were_alone(shape):
    rng = np.random.default_rng(5)
    rows = np.asfortranarray(rng.normal(size=shape) * 10.0 ** rng.integers(-9, 9, shape[1]))
    means, peak, least = by_columns(rows)
    for k in range(shape[1]):
        x = rows[:, k].copy()
        alone = [np.mean(x), np.sqrt(np.mean(x**2)), np.std(x), x[-1]]
        assert means[:, k].tolist() == alone
        assert (peak[k], least[k]) == (x.max(), x.min())


def test_what_is_no_number_is_no_extreme():
    rows = np.asfortranarray([[np.nan, np.nan], [3.0, np.nan], [-2.0, np.nan]])
    _, peak, least = by_columns(rows)
    assert (peak[0], least[0]) == (3.0, -2.0)
    assert (peak[1], least[1]) == (-np.inf, np.inf)
