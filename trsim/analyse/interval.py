"""How well a stretch of a run knows its own mean: confidence intervals from batch means.

    half = t(B - 1) sqrt(var(b) / B * (1 + r) / (1 - r))

b are the means of B batches, one after the other, r is their lag-1 correlation where that is
positive, t the quantile of Student's distribution.  Neighbouring values of a motion tell the same,
so values are no sample, but means of batches much longer than its memory are: B is halved until the
correlation is no more than chance (one-sided, 10 %) [Schmeiser1982, FishmanYarberry1997]; what is
left of it is allowed for as in [Steiger2005].  Where the FEWEST batches are correlated still, the
stretch is too short, or drifts, and has no interval.
"""

import numpy as np

from trsim.arrays import Array

LEVEL = 0.95  # of all intervals
MOST, FEWEST = 64, 8  # batches
SMALLEST = 4  # values in one
QUANTILE = {8: 2.3646, 16: 2.1314, 32: 2.0395, 64: 1.9983}  # of LEVEL, two-sided
CHANCE = 1.2816  # standard deviations of a correlation


def batches(n: int) -> int:
    """How many batches n values are cut into at first: a power of two, 0 for too few values."""
    fitting = [count for count in QUANTILE if count * SMALLEST <= n]
    return max(fitting, default=0)


def half_widths(means: Array) -> Array:
    """Half the interval of the mean of each column of batch means (B, m); nan without one.

    B is one of QUANTILE, or anything less than FEWEST, which has no intervals.
    """
    found = np.full(means.shape[1], np.nan)
    count, waiting = len(means), np.ones(means.shape[1], bool)
    while count >= FEWEST and waiting.any():
        off = means - means.mean(axis=0)
        square = np.sum(off**2, axis=0)
        lag = np.sum(off[1:] * off[:-1], axis=0)
        # the correlation of independent values is -1 / B on average
        r = np.divide(lag, square, out=np.full_like(lag, -1.0), where=square > 0.0) + 1.0 / count
        good = waiting & (r * np.sqrt(count) <= CHANCE)
        left = np.maximum(r[good], 0.0)
        variance = square[good] / (count - 1) / count * (1.0 + left) / (1.0 - left)
        found[good] = QUANTILE[count] * np.sqrt(variance)
        waiting &= ~good
        count //= 2
        means = means.reshape(count, 2, -1).mean(axis=1)
    return found


def half_width(values: Array) -> float:
    """Half the interval of the mean of a series (n), evenly spaced; nan without one."""
    count = batches(len(values))
    if not count:
        return float("nan")
    kept = values[len(values) % count :]
    return float(half_widths(kept.reshape(count, -1).mean(axis=1)[:, None])[0])


class Batches:
    """Means and batch means of many columns, kept while rows pass by.

    Rows that fill no batch are the first ones, and count in the mean alone.
    """

    def __init__(self, rows: int, columns: int) -> None:
        self.count = batches(rows)
        self.size = rows // self.count if self.count else 0
        self.skipped = rows - self.count * self.size
        self.sums = np.zeros((self.count, columns))
        self.total, self.taken = np.zeros(columns), 0

    def take(self, values: Array) -> None:
        """The next rows (n, columns)."""
        at = self.taken + np.arange(len(values)) - self.skipped
        self.total += values.sum(axis=0)
        self.taken += len(values)
        if not self.count:
            return
        values, at = values[at >= 0], at[at >= 0] // self.size
        if len(at):
            first = np.flatnonzero(np.diff(at, prepend=at[0] - 1))
            self.sums[at[first]] += np.add.reduceat(values, first, axis=0)

    @property
    def mean(self) -> Array:
        """The means of the columns over all rows taken."""
        return self.total / max(self.taken, 1)

    @property
    def half(self) -> Array:
        """Half the intervals of the means of the columns; nan without one."""
        return half_widths(self.sums / max(self.size, 1))
