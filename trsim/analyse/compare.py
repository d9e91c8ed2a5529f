"""Runs beside each other: differences over time or over a channel such as the stroke.

    d(s) = x(s) - x_0(s)         s: the rows of the first run, the others interpolated linearly

over the stretch that both runs have.  Two runs of one scenario, or of two that differ in nothing
but the solver or by less than ALIKE of a number, ought to be the same: where they come apart
(apart.py, any position or velocity) it is chance that parts them, and from there single values mean
nothing.  Largest difference and rms are then those before, and mean and rms of both runs stand for
the rest.
"""

from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.apart import APART, windows
from trsim.analyse.growth import motions
from trsim.analyse.window import scalar_channel
from trsim.arrays import Array
from trsim.errors import ScenarioError, UsageError
from trsim.store.read import Run
from trsim.units import quantity

ALIKE = 1e-5  # relative
# sections that have no influence on the motion
FREE = {
    *("title", "limits", "solver", "output", "report"),
    *("phase_portraits", "poincare", "sweep", "cases"),
}


class Curve(NamedTuple):
    """A channel of a run over the common abscissa."""

    s: Array
    x: Array


class Difference(NamedTuple):
    """One channel of one run less that of the first."""

    channel: str
    unit: str
    largest: float  # signed, before they are apart
    at: float  # abscissa of that
    rms: float
    of_range: float  # |largest| of the range of the first run
    apart: float  # abscissa from where they are apart by chance; nan
    means: tuple[float, float]  # of the first and of this one, after that or of all of it
    levels: tuple[float, float]  # rms of both
    rest: Curve  # the difference


def curve(run: Run, channel: str, against: str = "") -> Curve:
    """A channel over time, or over another one that only grows or only falls.

    Raises UsageError where that one turns back by more than rounding.
    """
    x = scalar_channel(run, channel)
    if not against:
        return Curve(run.time, x)
    s = scalar_channel(run, against)
    if s.size and s[-1] < s[0]:
        s, x = s[::-1], x[::-1]
    back = np.diff(s) <= 0.0
    if s.size > 1 and np.any(np.diff(s) < -1e-9 * np.ptp(s)):
        what = f"{run.path}: '{against}' turns back, so nothing is a function of it"
        hint = f"Compare over time; `--portrait {against}:{channel}` draws one over the other."
        raise UsageError(what, hint)
    kept = np.append(True, ~back)
    return Curve(s[kept], x[kept])


def channels(runs: list[Run]) -> list[str]:
    """What is compared by default: sensors and their rates, forces of drives and of contacts."""
    first = runs[0]
    found = [
        f"{name}{suffix}"
        for name, part in first.parts.items()
        for suffix in {"sensors": ("", ".rate"), "drives": (".force",)}.get(part.section, ())
    ]
    found += [f"{name}.{k}" for name in first.contacts for k in ("contact_force", "normal_force")]
    return [name for name in found if all(name in run.units for run in runs)]


def difference(
    channel: str, si: str, first: Curve, other: Curve, apart: float = np.nan
) -> Difference:  # fmt: skip
    """Another curve less the first, over what both have; apart: where chance parts them.

    Raises UsageError where they have less than two rows in common.
    """
    low, high = max(first.s[0], other.s[0]), min(first.s[-1], other.s[-1])
    inside = (first.s >= low) & (first.s <= high)
    s, x = first.s[inside], first.x[inside]
    if high <= low:
        raise UsageError(f"{channel}: the curves have no stretch in common", "")
    if s.size < 2:
        what = f"{channel}: the first curve has fewer than two rows in the stretch they share"
        raise UsageError(what, "Give it more rows, or compare the other way round.")
    y = np.interp(s, other.s, other.x)
    off, size = y - x, float(np.ptp(x))
    last = int(np.searchsorted(s, apart)) if apart <= s[-1] else s.size
    before = off[: max(last, 1)]
    k = int(np.argmax(np.abs(before)))
    rest = slice(last if last < s.size else 0, None)
    return Difference(
        channel,
        si,
        float(before[k]),
        float(s[k]),
        float(np.sqrt(np.mean(before**2))),
        abs(float(before[k])) / size if size > 0.0 else np.nan,
        float(s[last]) if last < s.size else np.nan,
        (float(np.mean(x[rest])), float(np.mean(y[rest]))),
        (float(np.sqrt(np.mean(x[rest] ** 2))), float(np.sqrt(np.mean(y[rest] ** 2)))),
        Curve(s, off),
    )


# --- two runs that ought to be the same ------------------------------------------------------


def parting(run: Run, other: Run, against: str = "") -> float:
    """From where two runs of one scenario are apart (s, or the value of a channel); nan.

    Of runs of different scenarios it is nan: there every difference means something.
    """
    if not alike(run.scenario, other.scenario):
        return np.nan
    time, off = motions(run, other)
    found = windows(np.max(np.abs(off), axis=1) > APART)
    if not found:
        return np.nan
    at = float(time[found[0].begin])
    return float(np.interp(at, run.time, scalar_channel(run, against))) if against else at


def alike(one: Any, two: Any, path: tuple[str, ...] = ()) -> bool:
    """Whether two scenarios describe one motion: numbers are the same to ALIKE."""
    if isinstance(one, dict) and isinstance(two, dict):
        keys = {*one, *two} - (FREE if not path else set())
        return all(alike(one.get(k), two.get(k), (*path, k)) for k in keys)
    if isinstance(one, list) and isinstance(two, list):
        return len(one) == len(two) and all(map(alike, one, two, [(*path, "")] * len(one)))
    a, b = (_plain(value) for value in (one, two))
    if a is None or b is None:
        return bool(one == two)
    return abs(a - b) <= ALIKE * max(abs(a), abs(b))


def _plain(value: Any) -> float | None:
    """A number, or one with a unit, in SI; None of anything else."""
    if isinstance(value, str):
        try:
            found = quantity(value)
        except ScenarioError:
            return None
        return found[0] if found else None
    return float(value) if isinstance(value, int | float) else None
