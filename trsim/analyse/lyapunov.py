"""The largest Lyapunov exponent of a series: how fast neighbours part.

    y(k) = mean over i of ln |X(i + k) - X(j + k)|,     X(i) = x(i), x(i + J), ... x(i + (m - 1) J)

X(j) is the nearest neighbour of X(i) that is more than one mean period away in time; y rises with
the exponent as its slope until neighbours are as far apart as any two points [Rosenstein1993].  The
delay J is where the autocorrelation has fallen to 1 - 1/e, the dimension m the first with less than
FALSE of false neighbours [Kennel1992].  The line is fitted where y is straight (scaling.py), over
a mean period at least, and ends before pairs are so far apart that they cannot part any more.

Rows of a flow (a mean period has at least FLOW of them) hit no point twice: neighbours are apart
along the path, by up to half a row, and stay so.  That part of their distance is left out.

The uncertainty is the sum of three: the 95 % interval of the mean of the slopes of all i, from
batch means (interval.py); how far the slopes with m + 1 and m + 2 dimensions are away; half of the
difference between the slopes of the two halves of the region.  On systems with known exponents the
first alone is too small (docs/studies.md has the table).

It is a number of a motion that goes on for ever in the same manner.  One that drifts or dies out,
such as a single stroke, or is too short to come back near itself, has none: the result is nan then
and says why.
"""

from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.embedding import apart, delay, dimension, embedded, neighbours, period
from trsim.analyse.interval import half_width
from trsim.analyse.scaling import Line, line, straightest, weights
from trsim.arrays import Array

MOST = 100_000  # values that are used
REFERENCES = 4000  # points whose neighbours are followed
LEAST_PERIODS = 30
HORIZON = 30  # mean periods a pair is followed, at most a quarter of the series
ROOM = 2.0  # e-folds there must be between neighbours and points that have nothing in common
RISE = 1.0  # e-folds of the fitted line: less is no growth
FLOW = 10  # rows in a mean period
CLEAR = 2.0  # standard deviations of the logarithms the curve stays below what is far apart
DRIFT = 1.0  # standard deviations the means of the thirds may differ by
UNLIKE = 4.0  # ratio the variances of the thirds may have


class Exponent(NamedTuple):
    """A rate of growth and where it comes from; nan with a reason where there is none."""

    value: float  # 1/s
    half: float  # its uncertainty, 1/s
    verdict: str  # grows, none, undetermined
    reason: str  # of none and undetermined
    time: Array  # (n) s since they were neighbours
    curve: Array  # (n) mean of the logarithm of the distance, in standard deviations of x
    fit: Line | None
    dimension: int
    delay: float  # s
    period: float  # s: mean period, within which no neighbours are looked for
    pairs: int


def undetermined(reason: str, **known: Any) -> Exponent:
    """No exponent, and why."""
    empty = Exponent(np.nan, np.nan, "undetermined", reason, np.zeros(0), np.zeros(0), None, 0,
                     np.nan, np.nan, 0)  # fmt: skip
    return empty._replace(**known)


def exponent(t: Array, x: Array) -> Exponent:
    """The largest exponent of x (n) at evenly spaced times t (n) s."""
    if len(x) > MOST:
        t, x = t[:MOST], x[:MOST]
    every = float(t[-1] - t[0]) / max(len(t) - 1, 1)
    size = float(np.std(x))
    if len(x) < 100 or size <= 1e-12 * max(float(np.max(np.abs(x))), 1e-300):
        return undetermined("it does not move" if len(x) >= 100 else f"{len(x)} rows are too few")
    x = (x - x.mean()) / size
    rows = period(x)
    known: Any = {"period": rows * every}
    if why := drifts(x):
        return undetermined(why, **known)
    if len(x) < LEAST_PERIODS * rows:
        why = f"{len(x) / rows:.3g} mean periods are too few, {LEAST_PERIODS} are needed"
        return undetermined(why, **known)
    lag, away = delay(x), int(np.ceil(rows))
    m = dimension(x, lag, away, 2 if away >= FLOW else 1)
    if not m:
        return undetermined("no dimension up to 8 unfolds it: noise, or too few rows", **known)
    found = [measured(x, every, lag, each, away) for each in (m, m + 1, m + 2)]
    first = found[0]._replace(delay=lag * every, **known)
    others = [one.value for one in found[1:] if np.isfinite(one.value)]
    if first.verdict == "none":
        return first
    if first.verdict == "undetermined" or len(others) < 2:
        why = first.reason or "with one dimension more no straight part is left"
        return first._replace(value=np.nan, half=np.nan, verdict="undetermined", reason=why)
    spread = max(abs(value - first.value) for value in others)
    return judged(first._replace(half=first.half + spread))


def drifts(x: Array) -> str:
    """Why a series is no motion that goes on in the same manner, or nothing; x (n) of variance 1.

    Compared are its thirds.
    """
    thirds = np.array_split(x, 3)
    means, variances = [p.mean() for p in thirds], [max(p.var(), 1e-300) for p in thirds]
    if max(means) - min(means) > DRIFT:
        return "it is a transient: its mean moves by more than a standard deviation"
    if max(variances) > UNLIKE * min(variances):
        return "it is a transient: its variance changes by more than a factor of 4"
    return ""


def measured(x: Array, every: float, lag: int, m: int, away: int) -> Exponent:
    """The exponent with m dimensions; every: s between rows, away: rows of a mean period."""
    points = embedded(x, m, lag)
    horizon = min(HORIZON * away, len(points) // 4)
    i = np.unique(np.linspace(0, len(points) - 1 - horizon, REFERENCES).astype(int))
    j, near = neighbours(points[: len(points) - horizon], i, away)
    i, j = i[near > 0.0], j[near > 0.0]
    if len(i) < 100:
        empty = undetermined("it repeats itself to rounding", dimension=m)
        return empty._replace(value=0.0, half=0.0, verdict="none")
    steps = np.unique(np.linspace(0, horizon, 400).astype(int))
    flow = away >= FLOW
    logs = np.array([apart(points, i + k, j + k, flow) for k in steps])  # (steps, pairs)
    y, t = logs.mean(axis=1), steps * every
    far = float(np.mean(apart(points, i, np.roll(i, len(i) // 2), flow)))
    known: Any = {"time": t, "curve": y, "dimension": m, "pairs": len(i)}
    if far - y[0] < ROOM:
        return undetermined("no neighbours are near enough: too few rows for it", **known)
    # from where some pairs are as far apart as they can be the mean bends
    bent = np.flatnonzero(y + CLEAR * logs.std(axis=1) > far)
    end = int(bent[0]) if bent.size else len(y)
    fit = straightest(t[:end], y[:end], away * every)
    if fit is None or risen(fit, t) < RISE:
        if float(y.max() - y[0]) > ROOM:
            return undetermined("the growth has no straight part", **known)
        fit = line(t, y, 0, len(y))
    slopes = weights(t[fit.begin : fit.end]) @ logs[fit.begin : fit.end]
    half = half_width(slopes) + bend(t, y, fit)
    empty = undetermined("", **known)
    return empty._replace(value=fit.slope, half=half, verdict="grows", fit=fit)


def bend(t: Array, y: Array, fit: Line) -> float:
    """Half of the difference between the slopes of the two halves of a region."""
    middle = (fit.begin + fit.end) // 2
    first, second = line(t, y, fit.begin, middle + 1), line(t, y, middle, fit.end)
    return 0.5 * abs(second.slope - first.slope)


def judged(found: Exponent) -> Exponent:
    """Growth is told where the interval of the rate is above zero and the curve rises."""
    if found.fit is None or not np.isfinite(found.half):
        why = found.reason or "the slopes have no interval: the series is too short"
        return found._replace(value=np.nan, verdict="undetermined", reason=why)
    rise = float(found.curve.max() - found.curve[0])
    if found.value <= found.half and rise < RISE:
        near, length = np.exp(found.curve[0]), found.time[-1]
        why = f"neighbours at {near:.2g} standard deviations stay neighbours for {length:.3g} s"
        return found._replace(verdict="none", reason=why)
    if found.value <= found.half or risen(found.fit, found.time) < RISE:
        why = "neighbours part by less than a factor of e: another channel may show more"
        if found.value <= found.half:
            why = "the interval of the rate holds zero"
        return found._replace(value=np.nan, verdict="undetermined", reason=why)
    return found


def risen(fit: Line, t: Array) -> float:
    """By how much a line rises over its region."""
    return fit.slope * float(t[fit.end - 1] - t[fit.begin])
