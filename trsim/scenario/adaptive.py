"""What in a `sweep:` says which of its cases are run at all: `until` and `refine`.

    until: {peak:B.contact_force: 2 %}    of monte_carlo: the mean over cases is as sure as this
    until: {peak:B.contact_force: 0.05}   of sobol: its indices are
    refine: {every: 8, by: {peak:B.contact_force: 5 %}}    of a grid: every 8th value first, and
                                          those between where neighbours differ;
              {every: {joints.A.clearance: 8}}    of one key alone, all values of the others

The cases of the sweep are what they are without these (sweeps/adaptive.py chooses among them).
"""

import math
from collections.abc import Iterable, Mapping
from itertools import pairwise
from typing import Any, NamedTuple

from trsim.errors import ScenarioError, described, known
from trsim.units import quantity

SHARE = "%"
UNTIL = ("monte_carlo", "sobol")  # methods whose first cases are such a sample themselves
EVERY, BY = "every", "by"
MOST = 100_000


class Width(NamedTuple):
    """How near numbers have to be."""

    value: float  # SI; of a share 0.02
    unit: str  # as written: "%" of the number itself; "" of a plain number
    text: str  # as written

    def of(self, number: float) -> float:
        """The same as a number."""
        return self.value * abs(number) if self.unit == SHARE else self.value


Widths = tuple[tuple[str, Width], ...]  # word of a number (analyse/outputs.py), width


class Refine(NamedTuple):
    """A grid of which not every case is run."""

    every: tuple[tuple[str, int], ...]  # key, which of its values are run first; of others all
    by: Widths  # besides the status


def until(data: Any, method: str) -> Widths:
    """What `until` says.  Raises ScenarioError."""
    if method not in UNTIL:
        what = f"`until` is for {' and '.join(UNTIL)}, not for {method}"
        hint = "The first cases of these are a sample themselves; write `refine` for a grid."
        raise ScenarioError(what, hint)
    found = _widths(data)
    if not found:
        hint = "Write for example `until: {peak:B.contact_force: 2 %}`."
        raise ScenarioError("says of no number how sure it is to be", hint)
    for word, one in found if method == "sobol" else ():
        if one.unit not in ("", SHARE) or not one.value < 1.0:
            hint = "Write for example 0.05."
            raise ScenarioError("an index is a share of a variance, less than 1", hint, (word,))
    if method == "sobol":  # 5 % is 0.05, not 5 % of an index
        found = tuple((word, one._replace(unit="")) for word, one in found)
    return found


def refine(data: Any, method: str, axes: Mapping[str, tuple[Any, ...]]) -> Refine:
    """What `refine` says; axes: keys that vary by themselves, with their values.

    Raises ScenarioError.
    """
    if method != "grid":
        raise ScenarioError(f"`refine` is for a grid, not for {method}")
    if not isinstance(data, dict):
        hint = "Write for example `refine: {every: 8, by: {peak:B.contact_force: 5 %}}`."
        raise ScenarioError(f"must be a mapping, got {described(data)}", hint)
    for key in data:
        if key not in (EVERY, BY):
            raise ScenarioError(f"unknown key {described(key)}", known(key, (EVERY, BY)), (key,))
    try:
        by = _widths(data.get(BY, {}))
    except ScenarioError as error:
        raise error.at(BY) from None
    fitting = [key for key, values in axes.items() if in_order(values)]
    if not fitting:
        what = "no key has values between which others lie"
        raise ScenarioError(what, "Give one at least three numbers in order: lin(a, b, n).")
    try:
        return Refine(_every(data.get(EVERY), fitting), by)
    except ScenarioError as error:
        raise error.at(EVERY) from None


def _every(value: Any, fitting: list[str]) -> tuple[tuple[str, int], ...]:
    """Which values of a key are run first; a number is for all keys whose values are in order."""
    if value is None:
        raise ScenarioError("field required", "`every: 8` runs each 8th value first.")
    wanted = value if isinstance(value, dict) and value else dict.fromkeys(fitting, value)
    for key, n in wanted.items():
        path = (key,) if wanted is value else ()
        if key not in fitting:
            what = f"{described(key)} has no values between which others lie"
            raise ScenarioError(what, known(key, fitting), path)
        if not isinstance(n, int) or isinstance(n, bool) or not 2 <= n <= MOST:
            raise ScenarioError(f"must be a whole number from 2 to {MOST}", path=path)
    return tuple(wanted.items())


def in_order(values: Iterable[Any]) -> bool:
    """Whether values are three numbers or more that only grow, or only fall."""
    numbers = [_number(value) for value in values]
    if any(math.isnan(one) for one in numbers) or len(numbers) < 3:
        return False
    steps = [b - a for a, b in pairwise(numbers)]
    return all(step > 0.0 for step in steps) or all(step < 0.0 for step in steps)


def _number(value: Any) -> float:
    """A value in SI; nan of what is no number."""
    if isinstance(value, str):
        try:
            found = quantity(value)
        except ScenarioError:  # of units; told when the cases are checked
            return math.nan
        return found[0] if found else math.nan
    return float(value) if isinstance(value, int | float) and value is not True else math.nan


def _widths(data: Any) -> Widths:
    if not isinstance(data, dict) or not all(isinstance(word, str) for word in data):
        hint = "Write for example `{peak:B.contact_force: 2 %}`."
        raise ScenarioError(f"must be a mapping of numbers of a run, got {described(data)}", hint)
    return tuple((word, _width(word, value)) for word, value in data.items())


def _width(word: str, value: Any) -> Width:
    wrong = ScenarioError(
        f"must be a share or a number with its unit, got {described(value)}",
        "Write `2 %` for a share of the number itself, or for example `20 N`.", (word,),
    )  # fmt: skip
    if isinstance(value, str):
        try:
            found = quantity(value)
        except ScenarioError as error:
            raise error.at(word) from None
        if found is None:
            raise wrong
        width = Width(*found, value.strip())
    elif isinstance(value, int | float) and not isinstance(value, bool):
        width = Width(float(value), "", f"{value:g}")
    else:
        raise wrong
    if not 0.0 < width.value < math.inf:
        what = f"must be larger than 0, got {width.text}"
        raise ScenarioError(what, "Write how far off it may be, for example `2 %`.", (word,))
    return width
