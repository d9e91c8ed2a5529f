"""Bifurcation diagram: the points of a Poincare section of every case over a swept value.

The motion of a case has period n where its section comes back to itself after n points,

    |p(k + n) - p(k)| <= TOLERANCE * size        for all k,
    size = max(range of all points of the study, NARROW * range of the channel over the run)

for x and y apart.  The least n is its number of distinct points; a case that has none up to a third
of its points is scattered: chaotic, quasi-periodic, or still on its way.

The second size is for studies whose points are all the same: their range is rounding, or what is
left of a decay.  An axis that varies by less than TOLERANCE * NARROW of what its channel does comes
back after every point, so it has no say; where neither axis varies by more the period is 1.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.apart import STILL
from trsim.analyse.cases import answers, numeric, varied
from trsim.analyse.outputs import scalar
from trsim.analyse.window import parted, window
from trsim.arrays import Array
from trsim.errors import UsageError, known
from trsim.store.read import Run

TOLERANCE = 0.01
NARROW = 1e-4  # points closer than TOLERANCE of this, of the range of the channel, are one point
FEWEST = 6  # points: of fewer nothing is told


class Section(NamedTuple):
    """The section of one case."""

    case: str
    over: float | str  # value of the swept key
    series: tuple[tuple[str, float | str], ...]  # the other keys and their values
    x: Array
    y: Array
    period: int  # 0: scattered; -1: too few points


class Diagram(NamedTuple):
    """All cases that have the section, in the order of the study."""

    section: str
    axis: str  # x or y
    channel: str  # drawn
    unit: str
    over: str  # swept key
    units: Mapping[str, str]  # of the keys
    written: Mapping[str, str]  # key -> unit as the scenario has it
    cases: tuple[Section, ...]
    places: Mapping[str, float | str]  # case -> value of the swept key, also without points
    why: Mapping[str, str]  # case that ended well -> why it has no such section


def diagram(study: Any, word: str, over: str | None = None) -> Diagram:
    """The diagram of SECTION[:AXIS][@WINDOW] over a key of a study, the first one unless named.

    Cases that do not vary the key are left out.  Raises UsageError where the study has no such key
    or no run such a section.
    """
    key = swept(study, over)
    named, text = parted(word)
    name, _, axis = named.partition(":")
    axis = axis or "x"
    if axis not in ("x", "y"):
        raise UsageError(f"a section has no axis '{axis}'", known(axis, ("x", "y")))
    every = answers(study, {word: lambda run: _points(run, name, text)})[word]
    mine = [case for case in study.cases if case.name in every.found and key in case.values]
    if not mine:
        what = f"no case that varies {key} has section '{name}'"
        raise UsageError(what, "Say another key with --over.")
    about = next(iter(every.found.values()))
    whole = {a: spread([getattr(every.found[c.name], a) for c in mine]) for a in ("x", "y")}
    cases = []
    for case in mine:
        run, points = case.run(), every.found[case.name]
        sizes = [max(size, narrow(run, str(about.definition[a]))) for a, size in whole.items()]
        others = tuple((k, case.values[k]) for k in study.keys if k != key and k in case.values)
        repeats = period(points.x, points.y, *sizes)
        cases.append(Section(case.name, case.values[key], others, points.x, points.y, repeats))
    unit = about.x_unit if axis == "x" else about.y_unit
    places = {case.name: case.values[key] for case in study.cases if key in case.values}
    return Diagram(name, axis, str(about.definition[axis]), unit, key, study.units,
                   study.written, tuple(cases), places, every.why)  # fmt: skip


def _points(run: Run, name: str, text: str) -> Any:
    """The points of a section that lie in a window."""
    sections = run.poincare
    if name not in sections:
        hint = known(name, sections) if sections else "Declare one under `poincare`."
        raise UsageError(f"{run.path}: no section '{name}'", hint)
    points = sections[name]
    inside = window(run, text, rows=False).of(points.time)
    return points._replace(time=points.time[inside], x=points.x[inside], y=points.y[inside])


def swept(study: Any, over: str | None) -> str:
    """The key of a study to draw over: the one named, or the first that is a number."""
    if over is None:
        numbers = [key for key in study.keys if numeric(varied(study, key))]
        keys = numbers or list(study.keys)
        if not keys:
            raise UsageError("the study sweeps nothing", "Give the scenario a `sweep:`.")
        return str(keys[0])
    check_swept(study, over)
    return over


def check_swept(study: Any, over: str | None) -> None:
    """Check that a study varies a key that is named; raises UsageError."""
    if over is not None and over not in study.keys:
        raise UsageError(f"the study does not sweep '{over}'", known(over, study.keys))


def spread(parts: list[Array]) -> float:
    """The range of all values; 0 without any."""
    every = np.concatenate(parts)
    return float(np.ptp(every)) if every.size else 0.0


def narrow(run: Run, channel: str) -> float:
    """What points are held against at least, from the motion of their channel over a run.

    Besides NARROW of its range it is so much that rounding is no motion (STILL of its largest
    value); 0 for a channel that was not stored.
    """
    kept = [np.array([peak.value for peak in run.peaks if peak.channel == channel])]
    if run.stores(channel):
        kept.append(np.array([scalar(run, f"{word}:{channel}")[0] for word in ("peak", "least")]))
    largest = max((float(np.max(np.abs(part), initial=0.0)) for part in kept), default=0.0)
    return max(NARROW * spread(kept), STILL / TOLERANCE * largest)


def period(x: Array, y: Array, x_range: float, y_range: float) -> int:
    """After how many points a section (n) comes back to itself; 0 scattered, -1 too few points."""
    if len(x) < FEWEST:
        return -1
    for n in range(1, len(x) // 3 + 1):
        if all(
            np.max(np.abs(v[n:] - v[:-n])) <= TOLERANCE * size
            for v, size in ((x, x_range), (y, y_range))
        ):
            return n
    return 0


def period_in_words(period: int) -> str:
    """A period in words."""
    return {-1: "too few points", 0: "scattered"}.get(period, f"period {period}")
