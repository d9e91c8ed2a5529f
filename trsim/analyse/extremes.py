"""Extremes of a channel of a run, and when they are met.

Of the whole run they are those of the motion, between rows and steps too, where a run keeps them:
of joints, drives, forces and sensors.  Of a stretch they are those of the rows in it, of the
accepted steps of a contact, and of the extremes of the whole run that lie in it.  The extreme of a
vector is that of its magnitude.
"""

from typing import NamedTuple

from trsim.analyse.window import Window, rows_in
from trsim.arrays import Array
from trsim.errors import UsageError
from trsim.store.points import between_bars, split
from trsim.store.read import Run

LARGEST, SMALLEST, MAGNITUDE = "largest", "smallest", "magnitude"  # as in the table of peaks
MOTION, STEPS, ROWS = "motion", "steps", "rows"  # where an extreme is known from, best first


class Extreme(NamedTuple):
    """An extreme, when it is first met, and where it is known from."""

    value: float
    time: float  # s
    of: str


def extreme(run: Run, word: str, channel: str, within: Window, part: bool) -> Extreme:
    """The largest or smallest value of a channel in a window; part: that is not all of the run.

    Raises UsageError for the magnitude of a vector that a run keeps no extreme of.
    """
    vector, inside = vector_of(run, channel), between_bars(channel)
    if inside is not None and not vector:
        return _of_size(run, word, inside, within, part)
    kept, sign = vector or channel, -1.0 if word == SMALLEST else 1.0
    if vector:
        kept_as, channel = _of_magnitude(run, word, vector), f"|{vector}|"
    else:
        kept_as = word
    found = [
        Extreme(p.value, p.time, MOTION)
        for p in run.peaks
        if (p.channel, p.extreme) == (kept, kept_as) and (not part or within.has(p.time))
    ]
    tables = ((STEPS, in_touch(run, channel)), (ROWS, rows_in(run, channel, within)))
    for of, (time, x) in tables:
        found += _best(of, time, x, sign, within)
    return max(found, key=lambda one: sign * one.value, default=Extreme(float("nan"), 0.0, ROWS))


def _best(of: str, time: Array, x: Array, sign: float, within: Window) -> list[Extreme]:
    """The extreme of some values in a window, if there are any."""
    inside = x == x
    if not (time.size and within.begin <= time[0] and time[-1] <= within.end):
        inside &= within.of(time)
    if not inside.any():
        return []
    time, x = time[inside], x[inside]
    k = int((sign * x).argmax())
    return [Extreme(float(x[k]), float(time[k]), of)]


def vector_of(run: Run, channel: str) -> str:
    """The vector of three that V or |V| names; empty of all else."""
    name = between_bars(channel) or channel
    return name if run.sizes.get(name) == 3 else ""


def _of_magnitude(run: Run, word: str, vector: str) -> str:
    """What the extreme of a vector is in the table of peaks.  Raises where none is kept."""
    kept = any((p.channel, p.extreme) == (vector, MAGNITUDE) for p in run.peaks)
    if word == LARGEST and kept:
        return MAGNITUDE
    raise UsageError(
        f"{run.path}: the {word} magnitude of '{vector}' is not kept in a run",
        f"Ask for a component, '{vector}.x'; `trsim export` writes the rows.",
    )


def _of_size(run: Run, word: str, channel: str, within: Window, part: bool) -> Extreme:
    """The extreme of the size of a number, from those of the number."""
    high = extreme(run, LARGEST, channel, within, part)
    low = extreme(run, SMALLEST, channel, within, part)
    far, near = (high, low) if abs(high.value) >= abs(low.value) else (low, high)
    if word == LARGEST:
        return far._replace(value=abs(far.value))
    if low.value <= 0.0 <= high.value:
        return near._replace(value=0.0)
    return near._replace(value=abs(near.value))


def in_touch(run: Run, channel: str) -> tuple[Array, Array]:
    """Times and values of a channel of a contact, or of a component, at its accepted steps."""
    none = run.time[:0], run.time[:0]
    joint = max((n for n in run.contacts if channel.startswith(f"{n}.")), key=len, default="")
    if not joint:
        return none
    steps = run.steps(joint)
    sizes = {name: column.shape[1] if column.ndim == 2 else 1 for name, column in steps.items()}
    name, component = split(channel.removeprefix(f"{joint}."), sizes)
    if name not in steps or (component is None and sizes[name] > 1):
        return none
    found = steps[name]
    return steps["time"], found if component is None else found[:, component]
