"""Envelopes: largest and smallest of each quantity over the cases of a sweep, and what acted then.

A quantity is a channel, a component, or a vector, which stands for its magnitude.  Its extremes are
those of the motion (extremes.py).  Only they are kept: what else acted is known from the output
rows, and of contacts from their accepted steps, and is interpolated linearly between these.  So is
the quantity itself: how far that is from its extreme tells how far the others can be trusted.  An
abscissa with a rate (`angle` and `angle.rate`) is interpolated by the cubic through both.
"""

import fnmatch
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.cases import answers
from trsim.analyse.extremes import LARGEST, MAGNITUDE, SMALLEST, extreme, in_touch, vector_of
from trsim.analyse.window import scalar_channel, window
from trsim.arrays import Array
from trsim.errors import UsageError, known
from trsim.store.grow import components
from trsim.store.read import Run

FORCES, UNITS = "forces", ("N", "N*m")
AXES = ("x", "y", "z")
SAME = 1e-9  # of an extreme: rounding
TRUSTED = 0.05  # of an extreme: what its rows may miss of it


class Met(NamedTuple):
    """An extreme of a quantity in one run.

    of      motion, steps or rows: where it is known from
    at      the abscissa then; none where the run has none
    rows    the quantity then, as rows and steps say
    acting  by name: components of the same vector, and what else was named
    """

    value: float
    time: float  # s
    of: str
    at: float
    rows: float
    acting: dict[str, float]

    @property
    def trusted(self) -> bool:
        """Whether the rows know of the extreme, so that what they say of others counts."""
        return abs(self.rows - self.value) <= TRUSTED * abs(self.value)


class Quantity(NamedTuple):
    """A quantity over all cases."""

    name: str
    extreme: str  # largest, smallest, magnitude
    unit: str
    cases: dict[str, Met]  # by their names, in the order of the study
    why: dict[str, str]  # of cases that ended well: what is in the way

    @property
    def worst(self) -> str:
        """The case that counts; of those that are the same but for rounding the first."""
        sign = -1.0 if self.extreme == SMALLEST else 1.0
        found = {name: sign * met.value for name, met in self.cases.items()}
        most = max(found.values())
        return next(name for name, x in found.items() if x >= most - SAME * abs(most))

    @property
    def zero(self) -> bool:
        """Whether nothing of it is there in any case."""
        return not any(met.value for met in self.cases.values())


def envelope(study: Any, wanted: Iterable[str], at: str, others: Iterable[str]) -> list[Quantity]:
    """The extremes of the quantities that fit a pattern; `forces` are all forces and moments.

    at: the abscissa, or nothing; others: channels whose values are told as well.  Raises UsageError
    where a pattern fits nothing in any case, or no case ended well.
    """
    patterns, told = list(wanted), (at, *others)
    found = answers(study, {"": lambda run: _of_run(run, patterns, told)})[""].found
    units: dict[tuple[str, str], str] = {}
    for of in found.values():
        for key, (unit, _) in of.items():
            units.setdefault(key, unit)
    for pattern in patterns:
        if pattern == FORCES and not units:
            raise UsageError("no case has a force or a moment", "Name others: --envelope PATTERN.")
        if pattern != FORCES and not any(_fits(name, [pattern]) for name, _ in units):
            there = (case for case in study.cases if case.name in found)
            names = dict.fromkeys(name for case in there for name in _named(case))
            raise UsageError(f"no quantity of any case fits '{pattern}'", known(pattern, names))
    return [_over(key, unit, found) for key, unit in units.items()]


def lost(study: Any, channels: Iterable[str]) -> list[str]:
    """Which cases have not what is told beside the extremes."""
    out = []
    for channel in channels:
        found = answers(study, {channel: lambda run, c=channel: scalar_channel(run, c)[:0]})
        out += [f"{name}: {text}" for name, text in found[channel].why.items()]
    return out


def _over(key: tuple[str, str], unit: str, found: Mapping[str, Any]) -> Quantity:
    """One quantity of all cases that have it."""
    name, word = key
    cases, why = {}, {}
    for case, of in found.items():
        if key not in of:
            why[case] = f"no {name}"
        elif of[key][0] != unit:
            why[case] = f"{name} is in {of[key][0]}, not in {unit} as that of other cases"
        elif not np.isfinite(of[key][1].value):
            why[case] = f"{name} has no number"
        else:
            cases[case] = of[key][1]
    return Quantity(name, word, unit, cases, why)


# --- one run ---------------------------------------------------------------------------------


def _named(case: Any) -> list[str]:
    run = case.run()
    return [name for channel in run.names for name in _parts(run, channel)]


def _parts(run: Run, channel: str) -> list[str]:
    """A channel, and its components if it has any."""
    size = run.sizes[channel]
    return [channel] if size == 1 else [channel, *components(channel, size)]


def _fits(name: str, patterns: list[str]) -> bool:
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def quantities(run: Run, patterns: list[str]) -> list[tuple[str, str]]:
    """The quantities of a run, each with which extreme of it counts."""
    kept = {(peak.channel, peak.extreme): peak.unit for peak in run.peaks}
    found = [key for key, unit in kept.items() if unit in UNITS and FORCES in patterns]
    for channel in run.names:
        for name in _parts(run, channel):
            if not _fits(name, patterns):
                continue
            if run.sizes.get(name, 1) == 1:
                found += [(name, LARGEST), (name, SMALLEST)]
            elif (name, MAGNITUDE) in kept:
                found.append((name, MAGNITUDE))
    return list(dict.fromkeys(found))


def _of_run(run: Run, patterns: list[str], told: tuple[str, ...]) -> dict[Any, Any]:
    """Quantity and extreme -> unit and what was met."""
    whole, known_rows = window(run), Rows(run)
    found = {}
    for name, word in quantities(run, patterns):
        one = extreme(run, SMALLEST if word == SMALLEST else LARGEST, name, whole, part=False)
        own = f"|{name}|" if word == MAGNITUDE else name
        acting = {axis: known_rows.at(part, one.time) for axis, part in _beside(run, name)}
        acting |= {other: known_rows.at(other, one.time) for other in told[1:]}
        place = known_rows.place(told[0], one.time) if told[0] else np.nan
        met = Met(one.value, one.time, one.of, place, known_rows.at(own, one.time), acting)
        found[name, word] = run.unit(name), met
    return found


def _beside(run: Run, name: str) -> list[tuple[str, str]]:
    """The components of the vector that a quantity is, or is one of."""
    vector = vector_of(run, name) or vector_of(run, name.rpartition(".")[0])
    return [(axis, f"{vector}.{axis}") for axis in AXES] if vector else []


class Rows:
    """What the rows of a run, and the steps of its contacts, say between them."""

    def __init__(self, run: Run) -> None:
        self.run, self.time = run, run.time
        self.kept: dict[str, tuple[Array, Array] | None] = {}

    def at(self, channel: str, time: float) -> float:
        """A channel at a time; nan where the run does not have it."""
        if channel not in self.kept:
            self.kept[channel] = self._read(channel)
        found = self.kept[channel]
        return np.nan if found is None else float(np.interp(time, *found))

    def _read(self, channel: str) -> tuple[Array, Array] | None:
        try:
            x = scalar_channel(self.run, channel)
        except UsageError:
            return None
        time, steps = in_touch(self.run, channel)
        both = np.concatenate([self.time, time])
        order = np.argsort(both, kind="stable")
        return both[order], np.concatenate([x, steps])[order]

    def place(self, channel: str, time: float) -> float:
        """The abscissa at a time, by its rate too where it has one."""
        rate = f"{channel}.rate"
        if not self.run.stores(rate) or not self.time[0] <= time <= self.time[-1]:
            return self.at(channel, time)
        k = int(np.clip(np.searchsorted(self.time, time) - 1, 0, max(len(self.time) - 2, 0)))
        x, v = scalar_channel(self.run, channel), scalar_channel(self.run, rate)
        h = float(self.time[min(k + 1, len(self.time) - 1)] - self.time[k])
        if not h > 0.0:
            return self.at(channel, time)
        u = (time - float(self.time[k])) / h
        w = 1.0 - u
        ends = w * w * (1.0 + 2.0 * u) * x[k] + u * u * (3.0 - 2.0 * u) * x[k + 1]
        return float(ends + h * u * w * (w * v[k] - u * v[k + 1]))
