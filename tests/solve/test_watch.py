"""What events watch: the band about a value that counts as the value."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.march import record as rec
from trsim.solve.march.watch import VALUE, band_of

from ..pieces import piece


@pytest.mark.parametrize(
    "value, low, high, size",
    [(2.0, -1.0, 1.5, 2.0), (2.0, -1.0, 7.0, 7.0), (-2.0, -9.0, 7.0, 9.0), (2.0, 1e300, -1e300, 2)],
)
def test_the_band_of_a_channel_is_the_tolerance_of_the_largest_it_has_been(value, low, high, size):
    """Its own extremes, not those of a channel beside it; before there are any, of the value."""
    peak = np.zeros((4, 3))
    peak[rec.PEAK_MAX], peak[rec.PEAK_MIN] = 1e3, -1e3
    peak[rec.PEAK_MAX, 1], peak[rec.PEAK_MIN, 1] = high, low
    s = SimpleNamespace(
        hear=1, heard=np.array([1]), watch_at=np.zeros((1, 3)), tolerance=1e-3
    )  # fmt: skip
    s.watch_at[0, VALUE] = value
    assert piece(band_of)(s, SimpleNamespace(peak=peak), 0) == pytest.approx(1e-3 * size)
