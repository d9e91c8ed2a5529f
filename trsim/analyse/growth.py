"""How fast two runs that began almost alike part: the largest exponent of their stretch of time.

    d(t) = sqrt(mean over channels ((x - x') / (max x - min x))^2),     ln d = lambda t + const

The runs are of one scenario with a number changed by very little, or with another tolerance.  The
line is fitted from where the difference has turned into the direction that grows (SETTLING of the
way) to where d is PARTED.  It has to leave no more than STRAIGHT of its rise (rms).  The
uncertainty is a 95 % interval that lets neighbouring values depend on each other: what the line
leaves counts by sums over PIECES of the region,

    half = t(PIECES - 2) sqrt(PIECES / (PIECES - 2) sum over pieces (sum of w r)^2)

r being what it leaves and w what each value counts in the slope.

Impacts make d jump, and a run has an end: this is a number of the stretch, for a motion that goes
on in the same manner an estimate of its largest Lyapunov exponent [Benettin1976].
"""

from typing import Any

import numpy as np

from trsim.analyse.apart import resting
from trsim.analyse.lyapunov import Exponent, undetermined
from trsim.analyse.pair import Pair
from trsim.analyse.scaling import line, weights
from trsim.analyse.window import Window
from trsim.arrays import Array
from trsim.errors import UsageError
from trsim.store import torn
from trsim.store.read import Run, opened

PARTED = 0.05  # of the ranges: what is further apart grows no more
RISE = 3.0  # e-folds of the fitted line: less is no growth
STRAIGHT = 0.15
PIECES = 8
STUDENT = 2.4469  # two-sided 95 % quantile, 6 degrees of freedom
SETTLING = 0.1


def growth(t: Array, d: Array) -> Exponent:
    """The rate at which a distance d (n) grows over t (n) s."""
    if len(d) < 100:
        return undetermined(f"{len(d)} rows in common are too few")
    if not d.any():
        return undetermined("the two runs are the same to the last bit")
    y = np.log(np.maximum(d, 1e-300))
    known: Any = {"time": t - t[0], "curve": y, "pairs": 1}
    far = np.flatnonzero(d > PARTED)
    first, end = int(np.flatnonzero(d > 0.0)[0]), int(far[0]) if far.size else len(d)
    if not far.size and float(np.max(y) - np.median(y[first : first + len(y) // 4])) < RISE:
        why = f"they stay together to {d.max():.1e} of the ranges"
        return undetermined(why, **known)._replace(value=0.0, verdict="none")
    begin = first + round(SETTLING * (end - first))
    if end - begin < 4 * PIECES:
        return undetermined("they part within too few rows: write rows more often", **known)
    fit = line(t - t[0], y, begin, end)
    rise = fit.slope * float(t[end - 1] - t[begin])
    if rise < RISE or fit.left > STRAIGHT * rise:
        return undetermined("the distance does not grow along a straight line", **known)
    s = t[begin:end] - t[0]
    share = weights(s) * (y[begin:end] - fit.offset - fit.slope * s)
    sums = np.array([part.sum() for part in np.array_split(share, PIECES)])
    half = STUDENT * float(np.sqrt(PIECES / (PIECES - 2) * np.sum(sums**2)))
    found = undetermined("", **known)._replace(value=fit.slope, half=half, fit=fit)
    if fit.slope <= half:
        return found._replace(value=np.nan, reason="the interval of the rate holds zero")
    return found._replace(verdict="grows")


def motions(run: Run, other: Run, within: Window | None = None) -> tuple[Array, Array]:
    """Common times (n) s, and the differences (n, m) of all motions over their ranges.

    Raises UsageError where two runs have no rows or no motions in common.
    """
    with opened(run.path) as mine, opened(other.path) as theirs:
        pair = Pair(mine, theirs)
        names = [name for name in pair.names if pair.moves(name)]
        time = torn.rows(mine["time"], 0, pair.rows)
        inside = within.of(time) if within else np.ones(len(time), bool)
        if not names or not inside.any():
            what = f"{run.path} and {other.path} have no rows of motion in common"
            raise UsageError(what, "Compare two runs of one scenario with the same output times.")
        both = (mine, theirs)
        values = {n: [torn.rows(f[n], 0, pair.rows)[inside] for f in both] for n in names}
    ranges, rests = resting({n: a for n, (a, _) in values.items()}, pair.units)
    off = [(a - b).reshape(len(a), -1) / ranges[n] for n, (a, b) in values.items()
           if n not in rests]  # fmt: skip
    return time[inside], np.hstack(off) if off else np.zeros((int(inside.sum()), 1))


def distance(run: Run, other: Run, within: Window | None = None) -> tuple[Array, Array]:
    """Common times (n) s, and the distance (n) of two runs; raises UsageError."""
    time, off = motions(run, other, within)
    return time, np.sqrt(np.mean(off**2, axis=1))


def of_runs(run: Run, other: Run, within: Window | None = None) -> Exponent:
    """The rate at which two runs part in a window; raises UsageError."""
    return growth(*distance(run, other, within))
