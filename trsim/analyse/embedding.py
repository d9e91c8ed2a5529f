"""A series as points of a space of delays, and the neighbours in it.

    X(i) = x(i), x(i + J), ... x(i + (m - 1) J)        i = 0 .. n - 1 - (m - 1) J

Points that are neighbours because they follow each other are left out: they have to be more than a
mean period apart in time [Theiler1986].
"""

import numpy as np

from trsim.arrays import Array, Indices

LARGEST = 8  # dimension
FALSE = 0.02  # share of false neighbours that is none
FURTHER = 15.0  # times a false neighbour is further away in one dimension more
SAMPLED = 2000  # points whose neighbours are tested
FEW = 1e-10  # standard deviations: nearer is rounding


def period(x: Array) -> float:
    """The mean period of x (n) in rows: that of its mean frequency, weighted by power."""
    power = np.abs(np.fft.rfft((x - x.mean()) * np.hanning(len(x)))) ** 2
    frequency = np.arange(len(power)) / len(x)
    return float(power.sum() / max(float(frequency @ power), 1e-300))


def delay(x: Array) -> int:
    """Rows until the autocorrelation of x (n) has fallen to 1 - 1/e; at least one."""
    n = len(x)
    power = np.abs(np.fft.rfft(x - x.mean(), 2 * n)) ** 2
    correlation = np.fft.irfft(power)[: n // 2]
    below = np.flatnonzero(correlation < (1.0 - np.exp(-1.0)) * correlation[0])
    return int(below[0]) if below.size else 1


def embedded(x: Array, m: int, lag: int) -> Array:
    """The points (n - (m - 1) lag, m) of x (n)."""
    n = len(x) - (m - 1) * lag
    return np.column_stack([x[k * lag : k * lag + n] for k in range(m)])


def neighbours(points: Array, i: Indices, away: int) -> tuple[Indices, Array]:
    """The nearest points of points[i] further than `away` rows, and how near; 0: same or none."""
    from scipy.spatial import cKDTree

    tree = cKDTree(points)
    found, near = np.zeros(len(i), np.int64), np.zeros(len(i))
    left, count = np.arange(len(i)), 4
    while left.size and count <= 4 * (2 * away + 4):
        distance, j = tree.query(points[i[left]], k=min(count, len(points)))
        good = np.abs(j - i[left][:, None]) > away
        first, any_good = good.argmax(axis=1), good.any(axis=1)
        rows = np.flatnonzero(any_good)
        found[left[rows]] = j[rows, first[rows]]
        near[left[rows]] = distance[rows, first[rows]]
        left, count = left[~any_good], 4 * count
    near[near < FEW] = 0.0
    return found, near


def apart(points: Array, i: Indices, j: Indices, flow: bool = False) -> Array:
    """The logarithm of the distance of points[i] and points[j], (n).

    Of a flow what is along its path at j is left out: there two points are apart because rows are,
    which does not grow.
    """
    off = points[i] - points[j]
    if flow:
        path = points[np.minimum(j + 1, len(points) - 1)] - points[np.maximum(j - 1, 0)]
        path /= np.maximum(np.linalg.norm(path, axis=1, keepdims=True), 1e-300)
        off -= np.sum(off * path, axis=1, keepdims=True) * path
    return np.asarray(np.log(np.maximum(np.linalg.norm(off, axis=1), FEW)))


def dimension(x: Array, lag: int, away: int, least: int = 1) -> int:
    """The first m from `least` on with few false neighbours, 0 where there is none up to LARGEST.

    A neighbour is false where x(i + m J) and x(j + m J) are more than FURTHER times as far apart
    as the points, or further than twice the standard deviation [Kennel1992].
    """
    for m in range(least, LARGEST + 1):
        points = embedded(x, m, lag)[: len(x) - m * lag]
        i = np.unique(np.linspace(0, len(points) - 1, SAMPLED).astype(int))
        j, near = neighbours(points, i, away)
        i, j, near = i[near > 0.0], j[near > 0.0], near[near > 0.0]
        if not len(i):
            return m
        gap = np.abs(x[i + m * lag] - x[j + m * lag])
        wrong = (gap > FURTHER * near) | (np.hypot(gap, near) > 2.0 * float(np.std(x)))
        if np.mean(wrong) < FALSE:
            return m
    return 0
