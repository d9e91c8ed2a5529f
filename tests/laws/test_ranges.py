"""Intervals of expressions hold what they are to hold, whatever the last bit is."""

from math import inf, nan

import pytest

from trsim.laws.ranges import ALL, ROUNDING, widened


@pytest.mark.parametrize("low, high", [(-3.0, -1.0), (-1.0, 3.0), (1.0, 3.0), (-1e9, -1e9)])
def test_an_interval_is_widened_on_both_sides(low, high):
    for wide, end, way in zip(widened.python(low, high), (low, high), (-1, 1), strict=True):
        assert way * (wide - end) == pytest.approx(ROUNDING * abs(end), rel=0.2)


def test_what_is_no_interval_has_no_bounds():
    assert widened.python(1.0, -1.0) == widened.python(nan, 1.0) == ALL == (-inf, inf)
