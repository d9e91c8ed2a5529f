"""Where most of a curve happens: the shortest stretch of its abscissa with most of its change.

V(a, b) = sum |y_k+1 - y_k|  over the rows of [a, b]        V(a, b) >= SHARE V
"""

import numpy as np

from trsim.arrays import Array

SHARE = 0.8  # of the change of a curve
FEW = 0.06  # of the abscissa: a longer stretch is seen as it is
LEAST = 8  # rows: fewer show no more when they are enlarged
BESIDE = 0.3  # of the stretch, shown on either side of it


def busy(x: Array, y: Array) -> tuple[float, float] | None:
    """The stretch of x (n), which rises, to enlarge; None where y (n) changes all over."""
    if len(x) < LEAST or not np.all(np.isfinite(x)) or np.any(np.diff(x) < 0.0):
        return None
    far, change = float(x[-1] - x[0]), np.abs(np.diff(y))
    total = float(change.sum())
    if not (far > 0.0 and np.isfinite(total) and total > 0.0):
        return None
    done = np.concatenate([[0.0], np.cumsum(change)])
    # for each begin the first end with enough of it between
    end = np.searchsorted(done, done + SHARE * total * (1.0 - 1e-12))
    begin = np.flatnonzero(end < len(x))
    width = x[end[begin]] - x[begin]
    a = int(begin[width.argmin()])
    low, high = float(x[a]), float(x[end[a]])
    inside = np.count_nonzero((x >= low) & (x <= high))
    if high - low > FEW * far or inside < LEAST or high <= low:
        return None
    spare = BESIDE * (high - low)
    return max(low - spare, float(x[0])), min(high + spare, float(x[-1]))


def common(found: list[tuple[float, float]], far: float) -> tuple[float, float] | None:
    """One stretch for several curves over an abscissa as long as `far`; None if they are apart."""
    if not found:
        return None
    low, high = min(a for a, _ in found), max(b for _, b in found)
    return (low, high) if high - low <= 2.0 * FEW * far else None
