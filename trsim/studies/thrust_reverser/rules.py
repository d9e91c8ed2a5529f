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
from typing import Any, NamedTuple, Protocol

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


class Rule(Protocol):
    """A way to decide."""

    def judge(self, values: Array) -> Judged: ...

    @property
    def words(self) -> str: ...


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
    """Of a bound; holds (members): whether it is kept by each, surely: what the interval says."""
    return verdict(surely and bool(holds.all()), surely_not and not holds.any())


class Rising(NamedTuple):
    """Each case is above the one before it, by more than a margin."""

    margin: float = SEEN  # of the smaller one

    @property
    def words(self) -> str:
        return f"each case above the one before it by more than {100.0 * self.margin:g} %"

    def judge(self, values: Array) -> Judged:
        if not (values > 0.0).all():
            return Judged(UNDETERMINED, "not all numbers are positive", 0, values.shape[1])
        steps = np.diff(np.log(values), axis=0)
        least = math.log1p(self.margin)
        return _of_ratios(steps, np.all(steps > least, axis=0), least)


class Falling(NamedTuple):
    """Each case is below the one before it, by more than a margin."""

    margin: float = SEEN  # of the larger one

    @property
    def words(self) -> str:
        return f"each case below the one before it by more than {100.0 * self.margin:g} %"

    def judge(self, values: Array) -> Judged:
        if not (values > 0.0).all():
            return Judged(UNDETERMINED, "not all numbers are positive", 0, values.shape[1])
        steps = np.diff(np.log(values), axis=0)
        most = math.log1p(-self.margin)
        found = _of_ratios(-steps, np.all(steps < most, axis=0), -most)
        return found._replace(told=_ratios(steps))


def _of_ratios(steps: Array, holds: Any, least: float) -> Judged:
    """steps (cases - 1, members): logarithms of ratios, which are to exceed the least one."""
    bounds = [interval(step) for step in steps]
    surely = all(b.low > least for b in bounds)
    surely_not = any(b.high < least for b in bounds)
    told = verdict(surely, surely_not)
    return Judged(told, _ratios(steps), int(holds.sum()), holds.size)


def _ratios(steps: Array) -> str:
    """The ratios of neighbouring cases, with their intervals."""
    parts = []
    for step in steps:
        b = interval(step)
        bounds = f" [{math.exp(b.low):.4g}, {math.exp(b.high):.4g}]" if len(step) > 1 else ""
        parts.append(f"{math.exp(b.mean):.4g}{bounds}")
    return f"ratio{'s' if len(parts) > 1 else ''} {', then '.join(parts)}"


class Ratio(NamedTuple):
    """The ratio of the second case to the first lies between two numbers."""

    low: float
    high: float

    @property
    def words(self) -> str:
        return f"ratio between {self.low:g} and {self.high:g}"

    def judge(self, values: Array) -> Judged:
        if not (values > 0.0).all():
            return Judged(UNDETERMINED, "not all numbers are positive", 0, values.shape[1])
        steps = np.log(values[1:2] / values[:1])
        within = (steps[0] >= math.log(self.low)) & (steps[0] <= math.log(self.high))
        b, (low, high) = interval(steps[0]), (math.log(self.low), math.log(self.high))
        inside, outside = low <= b.low and b.high <= high, b.high < low or b.low > high
        return Judged(verdict(inside, outside), _ratios(steps), int(within.sum()),
                      within.size)  # fmt: skip


class Alike(NamedTuple):
    """The largest case is above the smallest one by no more than a share."""

    share: float

    @property
    def words(self) -> str:
        return f"largest and smallest within {100.0 * self.share:g} %"

    def judge(self, values: Array) -> Judged:
        if not (values > 0.0).all():
            return Judged(UNDETERMINED, "not all numbers are positive", 0, values.shape[1])
        spread = values.max(axis=0) / values.min(axis=0) - 1.0
        holds, b = spread <= self.share, interval(spread)
        told = f"spread {100.0 * b.mean:.3g} %{_bounds(100.0 * spread, ' %')}"
        return Judged(bounded(holds, b.high <= self.share, b.low > self.share), told,
                      int(holds.sum()), holds.size)  # fmt: skip


class Within(NamedTuple):
    """Every case lies between two numbers, in SI."""

    low: float
    high: float
    shown: str  # the two numbers for the reader, with a unit

    @property
    def words(self) -> str:
        return f"all {self.shown}"

    def judge(self, values: Array) -> Judged:
        each = (values >= self.low) & (values <= self.high)
        holds = each.all(axis=0)
        bounds = [interval(case) for case in values]
        surely = values.shape[1] > 1 and all(self.low <= b.low and b.high <= self.high
                                             for b in bounds)  # fmt: skip
        surely_not = any(b.high < self.low or b.low > self.high for b in bounds)
        return Judged(bounded(holds, surely, surely_not), f"all {self.shown}", int(holds.sum()),
                      holds.size)  # fmt: skip


class Exact(NamedTuple):
    """A number that a law gives, without any run, lies between two others."""

    low: float
    high: float
    shown: str

    @property
    def words(self) -> str:
        return self.shown

    def judge(self, values: Array) -> Judged:
        holds = bool((values >= self.low).all() and (values <= self.high).all())
        return Judged(CONFIRMED if holds else CONTRADICTED, self.shown, int(holds), 1)


class Steadier(NamedTuple):
    """The cases of the second half vary less among themselves than those of the first half."""

    words: str = "largest over smallest: less in the second group than in the first"

    def judge(self, values: Array) -> Judged:
        if not (values > 0.0).all():
            return Judged(UNDETERMINED, "not all numbers are positive", 0, values.shape[1])
        half = len(values) // 2
        spread = np.array([np.log(part.max(axis=0) / part.min(axis=0))
                           for part in (values[:half], values[half:])])  # fmt: skip
        less = spread[0] - spread[1]
        holds, b = less > 0.0, interval(less)
        first, second = (math.exp(float(np.mean(s))) for s in spread)
        told = f"largest over smallest {first:.3g} and {second:.3g}"
        return Judged(verdict(b.low > 0.0, b.high < 0.0), told, int(holds.sum()), holds.size)


class Open(NamedTuple):
    """Nothing that could be measured decides it."""

    reason: str

    @property
    def words(self) -> str:
        return "nothing measured decides"

    def judge(self, values: Array) -> Judged:
        return Judged(UNDETERMINED, self.reason, 0, 0)


def _bounds(values: Array, unit: str) -> str:
    if len(values) < 2:
        return ""
    b = interval(values)
    return f" [{b.low:.3g}, {b.high:.3g}]{unit}"
