"""Fluctuation: what is left of a curve when its slow part is taken out.

    x_hp = x - m(m(x)),     fluctuation = rms of x_hp over a window

m is a moving average over `width`; applied twice its kernel is a triangle.  Near the ends of the
record it averages over the samples there are.  Rows more than half of `width` apart show nothing
that is faster than it: what is left of them is rounding.
"""

import numpy as np

from trsim.analyse.window import between
from trsim.arrays import Array

WIDTH = 0.010  # s
ROUNDING = 1e-9  # of the distance of two rows


def moving_average(x: Array, n: int) -> Array:
    """Mean of the n samples around each one (n odd), fewer at the ends."""
    half = n // 2
    total = np.concatenate([[0.0], np.cumsum(x)])
    low = np.maximum(np.arange(x.size) - half, 0)
    high = np.minimum(np.arange(x.size) + half + 1, x.size)
    return np.asarray((total[high] - total[low]) / (high - low))


def high_pass(t: Array, x: Array, width: float = WIDTH) -> Array:
    """x without its slow part; t (n) s evenly spaced, width of the average s."""
    n = max(1, 2 * round(0.5 * width / (t[1] - t[0])) + 1)
    return np.asarray(x - moving_average(moving_average(x, n), n))


def shows(t: Array, width: float = WIDTH) -> bool:
    """Whether rows, two at least, are near enough to show what is faster than width."""
    return len(t) > 1 and bool(t[1] - t[0] <= 0.5 * width * (1 + ROUNDING))


def fluctuation(t: Array, x: Array, begin: float, end: float, width: float = WIDTH) -> float:
    """Root mean square of the high-passed curve for begin <= t <= end; nan of fewer than 2 rows."""
    if len(t) < 2:
        return np.nan
    inside = between(t, (begin, end))
    return float(np.sqrt(np.mean(high_pass(t, x, width)[inside] ** 2)))
