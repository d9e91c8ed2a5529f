"""Rules for motions without chance: one run of each case, (series, 1), decides by itself.

Ideal joints leave no impacts that multiply a difference, so nothing is gained by an ensemble: a
tighter tolerance (1e-8) changes the peaks of the spatial mechanism by less than 1e-6 of themselves.
"""

from functools import partial

import numpy as np

from trsim.studies.rules import (
    CONFIRMED,
    CONTRADICTED,
    SEEN,
    Array,
    Judged,
    Rule,
    way,
)

NEWTONS = 10.0  # N: a smaller difference of forces of kilonewtons is none
NO_BOUND = 1e9  # a bound that is none


def judged(holds: bool, told: str) -> Judged:
    return Judged(CONFIRMED if holds else CONTRADICTED, told, int(holds), 1)


def greatest(rule: Rule, of: int) -> Rule:
    """A rule on the greatest of each group of `of` series."""
    return Rule(
        f"greatest of {of} each: {rule.words}",
        lambda values: rule.judge(values.reshape(-1, of, values.shape[1]).max(axis=1)),
    )


def steps(side: int, margin: float = NEWTONS, unit: str = "N") -> Rule:
    """Each case is above (side 1) or below (-1) the one before it, by more than a margin in SI."""

    def judge(values: Array) -> Judged:
        found = np.diff(values[:, 0])
        told = ", then ".join(f"{step:+.3g}" for step in found).replace("-", "\u2212")
        return judged(bool((side * found > margin).all()), f"{told} {unit}")

    return Rule(f"each case {way(side)} the one before it by more than {margin:g} {unit}", judge)


def grows(share: float) -> Rule:
    """Each case is above the one before it by more than a share."""

    def judge(values: Array) -> Judged:
        found = values[1:, 0] / values[:-1, 0] - 1.0
        told = ", then ".join(f"{100.0 * step:+.3g}" for step in found).replace("-", "\u2212")
        return judged(bool((found > share).all()), f"{told} %")

    return Rule(f"each case above the one before it by more than {100.0 * share:g} %", judge)


def beyond(side: int) -> Rule:
    """The last case is above (side 1) or below (-1) all others, by more than what is seen."""

    def judge(values: Array) -> Judged:
        last, others = float(values[-1, 0]), side * float((side * values[:-1]).max())
        holds = side * last > side * (1.0 + side * SEEN) * others
        return judged(holds, f"ratio {last / others:.4g}")

    return Rule(f"the last {way(side)} all others by more than {100.0 * SEEN:g} %", judge)


above, below = partial(beyond, 1), partial(beyond, -1)


def near(share: float) -> Rule:
    """The largest case is above the smallest one by no more than a share."""

    def judge(values: Array) -> Judged:
        spread = float(values.max() / values.min()) - 1.0
        return judged(0.0 <= spread <= share, f"spread {100.0 * spread:.3g} %")

    return Rule(f"largest and smallest within {100.0 * share:g} %", judge)


def unlike(share: float) -> Rule:
    """The largest case is above the smallest one by more than a share."""
    other = near(share)

    def judge(values: Array) -> Judged:
        found = other.judge(values)
        return judged(found.verdict == CONTRADICTED, found.told)

    return Rule(f"largest and smallest more than {100.0 * share:g} % apart", judge)


def multiple(least: float) -> Rule:
    """The second case is at least so many times the first."""

    def judge(values: Array) -> Judged:
        found = float(values[1, 0] / values[0, 0])
        return judged(found >= least, f"ratio {found:.4g}")

    return Rule(f"the second at least {least:g} times the first", judge)


def apart() -> Rule:
    """The first and the last of three cases are nearer to each other than to the second."""

    def judge(values: Array) -> Judged:
        one, two, three = values[:, 0]
        between, away = abs(one - three), min(abs(one - two), abs(three - two))
        return judged(bool(between < away), f"{between:.4g} N apart, {away:.4g} N from the second")

    return Rule("first and third nearer to each other than either to the second", judge)


def opposite() -> Rule:
    """From the first case to the second it goes the other way than from the third to the fourth."""

    def judge(values: Array) -> Judged:
        first, second = np.diff(values[:, 0])[::2]
        told = f"{first:+.4g} N and {second:+.4g} N".replace("-", "\u2212")
        return judged(bool(first * second < 0.0), told)

    return Rule("the two differences have other signs", judge)


def bounded(low: float, high: float, shown: str) -> Rule:
    """Every case lies between two numbers, in SI; shown: these for the reader, with a unit."""

    def judge(values: Array) -> Judged:
        inside = (values >= low) & (values <= high)
        if inside.all() or not inside.any():
            return judged(bool(inside.all()), f"all {shown}")
        return Judged(CONTRADICTED, f"{int(inside.sum())} of {inside.size} {shown}", 0, 1)

    return Rule(f"all {shown}", judge)


def apart_by(low: float, high: float, factor: float, unit: str) -> Rule:
    """The size of the second case less that of the first lies between two numbers, in SI.

    factor, unit: for the reader.
    """

    def judge(values: Array) -> Judged:
        first, second = np.abs(values[:, 0])
        step = float(second - first)
        told = f"{factor * step:+.3g} {unit}".replace("-", "\u2212")
        return judged(bool(low <= step <= high), told)

    most = f" and {factor * high:.3g}" if high < NO_BOUND else ""
    between = f"between {factor * low:.3g}{most}" if most else f"above {factor * low:.3g}"
    return Rule(f"second less first {between} {unit}".replace("-", "\u2212"), judge)


def part_of(share: float) -> Rule:
    """The size of the first case is at most a share of that of the second."""

    def judge(values: Array) -> Judged:
        first, second = np.abs(values[:, 0])
        told = f"{100.0 * first / second:.3g} % of the second"
        return judged(bool(first <= share * second), told)

    return Rule(f"the first at most {100.0 * share:g} % of the second", judge)


def differ(margin: float, unit: str) -> Rule:
    """Two cases differ by more than a margin in SI, either way."""

    def judge(values: Array) -> Judged:
        step = float(values[1, 0] - values[0, 0])
        told = f"{step:+.3g} {unit}".replace("-", "\u2212")
        return judged(abs(step) > margin, told)

    return Rule(f"both differ by more than {margin:g} {unit}", judge)


def other_signs() -> Rule:
    """One of two cases is positive, the other one negative."""

    def judge(values: Array) -> Judged:
        first, second = values[:, 0]
        told = f"{first:+.4g} and {second:+.4g}".replace("-", "\u2212")
        return judged(bool(first * second < 0.0), told)

    return Rule("one positive, one negative", judge)
