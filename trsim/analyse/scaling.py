"""Where a curve is a straight line: the region over which a rate of growth is fitted.

Of all stretches of the curve the one that rises most is taken among those that are straight, where
what is left of a least-squares line is no more than STRAIGHT of its rise (rms).
"""

from typing import NamedTuple

import numpy as np

from trsim.arrays import Array

STRAIGHT = 0.03
FEWEST = 5  # values in a region
PLACES = 48  # ends that are tried


class Line(NamedTuple):
    """A least-squares line through the values begin..end (end excluded) of a curve."""

    begin: int
    end: int
    slope: float
    offset: float
    left: float  # rms of what it leaves


def line(t: Array, y: Array, begin: int, end: int) -> Line:
    """The line through y[begin:end] over t (n)."""
    weight = weights(t[begin:end])
    slope = float(weight @ y[begin:end])
    offset = float(np.mean(y[begin:end]) - slope * np.mean(t[begin:end]))
    rest = y[begin:end] - offset - slope * t[begin:end]
    return Line(begin, end, slope, offset, float(np.sqrt(np.mean(rest**2))))


def weights(t: Array) -> Array:
    """What the values at t (n) count in the slope of their least-squares line."""
    off = t - t.mean()
    return np.asarray(off / np.sum(off**2))


def straightest(t: Array, y: Array, least: float = 0.0) -> Line | None:
    """The straight stretch of y (n) over t (n) that rises most; None where none rises.

    least: of t it has to span.
    """
    ends = np.unique(np.linspace(0, len(y), PLACES).astype(int))
    best, most = None, 0.0
    for begin in ends.tolist():
        for end in ends[ends >= begin + FEWEST].tolist():
            if t[end - 1] - t[begin] < least:
                continue
            one = line(t, y, begin, end)
            rise = one.slope * float(t[end - 1] - t[begin])
            if rise > most and one.left <= STRAIGHT * rise:
                best, most = one, rise
    return best
