"""Rules for motions without chance: one run of each case, (series, 1), decides by itself.

Ideal joints leave no impacts that multiply a difference, so nothing is gained by an ensemble: a
tighter tolerance (1e-8) changes the peaks of the spatial mechanism by less than 1e-6 of themselves.
"""

from functools import partial
from typing import NamedTuple

import numpy as np

from trsim.studies.thrust_reverser.rules import CONFIRMED, CONTRADICTED, SEEN, Array, Judged, Rule

NEWTONS = 10.0  # N: a smaller difference of forces of kilonewtons is none


def judged(holds: bool, told: str) -> Judged:
    return Judged(CONFIRMED if holds else CONTRADICTED, told, int(holds), 1)


class Greatest(NamedTuple):
    """A rule on the greatest of each group of `of` series."""

    rule: Rule
    of: int

    @property
    def words(self) -> str:
        return f"greatest of {self.of} each: {self.rule.words}"

    def judge(self, values: Array) -> Judged:
        return self.rule.judge(values.reshape(-1, self.of, values.shape[1]).max(axis=1))


class Steps(NamedTuple):
    """Each case is above (side 1) or below (-1) the one before it, by more than a margin."""

    side: int
    margin: float = NEWTONS  # in SI
    unit: str = "N"

    @property
    def words(self) -> str:
        way = "above" if self.side > 0 else "below"
        return f"each case {way} the one before it by more than {self.margin:g} {self.unit}"

    def judge(self, values: Array) -> Judged:
        steps = np.diff(values[:, 0])
        told = ", then ".join(f"{step:+.3g}" for step in steps).replace("-", "\u2212")
        return judged(bool((self.side * steps > self.margin).all()), f"{told} {self.unit}")


class Beyond(NamedTuple):
    """The last case is above (side 1) or below (-1) all others, by more than a share."""

    side: int
    margin: float = SEEN

    @property
    def words(self) -> str:
        way = "above" if self.side > 0 else "below"
        return f"the last {way} all others by more than {100.0 * self.margin:g} %"

    def judge(self, values: Array) -> Judged:
        side, last = self.side, float(values[-1, 0])
        others = side * float((side * values[:-1]).max())
        holds = side * last > side * (1.0 + side * self.margin) * others
        return judged(holds, f"ratio {last / others:.4g}")


Above, Below = partial(Beyond, 1), partial(Beyond, -1)


class Near(NamedTuple):
    """The largest case is above the smallest one by no more than a share."""

    share: float

    @property
    def words(self) -> str:
        return f"largest and smallest within {100.0 * self.share:g} %"

    def judge(self, values: Array) -> Judged:
        spread = float(values.max() / values.min()) - 1.0
        return judged(0.0 <= spread <= self.share, f"spread {100.0 * spread:.3g} %")


class Apart(NamedTuple):
    """The first and the last of three cases are nearer to each other than to the second."""

    words: str = "first and third nearer to each other than either to the second"

    def judge(self, values: Array) -> Judged:
        one, two, three = values[:, 0]
        between, away = abs(one - three), min(abs(one - two), abs(three - two))
        return judged(bool(between < away), f"{between:.4g} N apart, {away:.4g} N from the second")


class Opposite(NamedTuple):
    """From the first case to the second it goes the other way than from the third to the fourth."""

    words: str = "the two differences have other signs"

    def judge(self, values: Array) -> Judged:
        first, second = np.diff(values[:, 0])[::2]
        told = f"{first:+.4g} N and {second:+.4g} N".replace("-", "\u2212")
        return judged(bool(first * second < 0.0), told)
