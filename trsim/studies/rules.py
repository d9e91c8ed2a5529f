"""What turns an ensemble of numbers into confirmed, contradicted or undetermined.

values (series, members): a number per case and member; members of one index differ from the stated
case alike.  An ordering of cases is

    confirmed       where the 95 % intervals of the mean ratios of neighbours lie on its side
    contradicted    where one of them lies on the other side
    undetermined    otherwise

A bound is confirmed where it and the interval hold in every member, contradicted where in none.
In how many members a claim holds is what the chance of a single run would be.
"""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CONFIRMED, CONTRADICTED, UNDETERMINED = "confirmed", "contradicted", "undetermined"
LEVEL = 0.95
SEEN = 0.01  # a smaller difference is none that the curves of a study could show


class Judged(NamedTuple):
    """A verdict, the quantity that decided it, and in how many members the claim holds."""

    verdict: str
    told: str
    holds: int
    of: int


class Rule(NamedTuple):
    """A way to decide, in words, and what decides so."""

    words: str
    judge: Callable[[Array], Judged]


class Interval(NamedTuple):
    """A mean, and the bounds of its interval; infinite bounds of a single value."""

    mean: float
    low: float
    high: float


def interval(values: Array) -> Interval:
    """The mean of independent values (n) with its interval, by Student's distribution."""
    from scipy.special import stdtrit

    n, mean = len(values), float(np.mean(values))
    if n < 2:
        return Interval(mean, -math.inf, math.inf)
    half = float(stdtrit(n - 1, 0.5 + 0.5 * LEVEL) * np.std(values, ddof=1) / np.sqrt(n))
    return Interval(mean, mean - half, mean + half)


def verdict(surely: bool, surely_not: bool) -> str:
    if surely:
        return CONFIRMED
    return CONTRADICTED if surely_not else UNDETERMINED


def bounded(holds: Any, surely: bool, surely_not: bool) -> str:
    """The verdict on a bound; holds: whether members keep it, surely: what the interval says."""
    return verdict(surely and bool(holds.all()), surely_not and not holds.any())


def counted(told: str, of: str, holds: Any) -> Judged:
    """A verdict `told`, what decided it, and holds (members)."""
    return Judged(told, of, int(holds.sum()), holds.size)


def of_positive(words: str, judge: Callable[[Array], Judged]) -> Rule:
    """A rule on ratios, which are judged of positive numbers alone."""

    def judged(values: Array) -> Judged:
        if not (values > 0.0).all():
            return Judged(UNDETERMINED, "not all numbers are positive", 0, values.shape[1])
        return judge(values)

    return Rule(words, judged)


def way(side: int) -> str:
    return "above" if side > 0 else "below"


def trend(side: int, margin: float = SEEN) -> Rule:
    """Each case is above (side 1) or below (-1) the one before it, by more than a share of that."""

    def judge(values: Array) -> Judged:
        steps = np.diff(np.log(values), axis=0)
        far, least = side * steps, side * math.log1p(side * margin)
        bounds = [interval(step) for step in far]
        surely, surely_not = all(b.low > least for b in bounds), any(b.high < least for b in bounds)
        return counted(verdict(surely, surely_not), _ratios(steps), np.all(far > least, axis=0))

    words = f"each case {way(side)} the one before it by more than {100.0 * margin:g} %"
    return of_positive(words, judge)


rising, falling = partial(trend, 1), partial(trend, -1)


def _ratios(steps: Array) -> str:
    """The ratios of neighbouring cases, with their intervals."""
    parts = []
    for step in steps:
        b = interval(step)
        bounds = f" [{math.exp(b.low):.4g}, {math.exp(b.high):.4g}]" if len(step) > 1 else ""
        parts.append(f"{math.exp(b.mean):.4g}{bounds}")
    return f"ratio{'s' if len(parts) > 1 else ''} {', then '.join(parts)}"


def ratio(low: float, high: float) -> Rule:
    """The ratio of the second case to the first lies between two numbers."""

    def judge(values: Array) -> Judged:
        steps, least, most = np.log(values[1:2] / values[:1]), math.log(low), math.log(high)
        within, b = (steps[0] >= least) & (steps[0] <= most), interval(steps[0])
        inside, outside = least <= b.low and b.high <= most, b.high < least or b.low > most
        return counted(verdict(inside, outside), _ratios(steps), within)

    return of_positive(f"ratio between {low:g} and {high:g}", judge)


def alike(share: float) -> Rule:
    """The largest case is above the smallest one by no more than a share."""

    def judge(values: Array) -> Judged:
        spread = values.max(axis=0) / values.min(axis=0) - 1.0
        holds, b = spread <= share, interval(spread)
        told = f"spread {100.0 * b.mean:.3g} %{_bounds(100.0 * spread, ' %')}"
        return counted(bounded(holds, b.high <= share, b.low > share), told, holds)

    return of_positive(f"largest and smallest within {100.0 * share:g} %", judge)


def within(low: float, high: float, shown: str) -> Rule:
    """Every case lies between two numbers, in SI; shown: these for the reader, with a unit."""

    def judge(values: Array) -> Judged:
        each = (values >= low) & (values <= high)
        holds = each.all(axis=0)
        bounds = [interval(case) for case in values]
        surely = values.shape[1] > 1 and all(low <= b.low and b.high <= high for b in bounds)
        surely_not = any(b.high < low or b.low > high for b in bounds)
        return counted(bounded(holds, surely, surely_not), f"all {shown}", holds)

    return Rule(f"all {shown}", judge)


def exact(low: float, high: float, shown: str) -> Rule:
    """A number that a law gives, without any run, lies between two others."""

    def judge(values: Array) -> Judged:
        holds = bool((values >= low).all() and (values <= high).all())
        return Judged(CONFIRMED if holds else CONTRADICTED, shown, int(holds), 1)

    return Rule(shown, judge)


def steadier() -> Rule:
    """The cases of the second half vary less among themselves than those of the first half."""

    def judge(values: Array) -> Judged:
        half = len(values) // 2
        spread = np.array([np.log(part.max(axis=0) / part.min(axis=0))
                           for part in (values[:half], values[half:])])  # fmt: skip
        less = spread[0] - spread[1]
        holds, b = less > 0.0, interval(less)
        first, second = (math.exp(float(np.mean(s))) for s in spread)
        told = f"largest over smallest {first:.3g} and {second:.3g}"
        return counted(verdict(b.low > 0.0, b.high < 0.0), told, holds)

    return of_positive("largest over smallest: less in the second group than in the first", judge)


def sizes(of: Interval) -> tuple[float, float]:
    """The smallest and the largest magnitude in an interval."""
    low, high = sorted((abs(of.low), abs(of.high)))
    return (0.0 if of.low < 0.0 < of.high else low), high


def departing() -> Rule:
    """The second two of four cases are farther apart, as a ratio, than the first two."""

    def judge(values: Array) -> Judged:
        steps = np.log(values[1::2] / values[::2])
        first, second = (sizes(interval(step)) for step in steps)
        surely, surely_not = second[0] > first[1] + SEEN, second[1] < first[0] + SEEN
        holds = np.abs(steps[1]) > np.abs(steps[0]) + SEEN
        return counted(verdict(surely, surely_not), _ratios(steps).replace("then", "and"), holds)

    return of_positive("the second pair farther apart than the first, as mean ratios", judge)


def undecided(reason: str) -> Rule:
    """Nothing that could be measured decides it."""
    return Rule("nothing measured decides", lambda _: Judged(UNDETERMINED, reason, 0, 0))


def _bounds(values: Array, unit: str) -> str:
    if len(values) < 2:
        return ""
    b = interval(values)
    return f" [{b.low:.3g}, {b.high:.3g}]{unit}"
