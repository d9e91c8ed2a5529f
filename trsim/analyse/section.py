"""Poincare sections of a stored run that its scenario did not declare: from the output rows.

A crossing is the root of the cubic through the four rows around a change of sign; x and y are those
of their cubics there.  Declared sections are located by the solver (solve/march/sections.py): these
are not, and say by how much they may be wrong.  The error of a point is the largest difference
between its cubic and

    the polynomials through the five and six nearest rows       what one order more or two would say
    the cubics through every other row                          what half as many rows would say

and where a contact opened or closed between the rows in use, so that more rows need not help,
    the straight line through the two rows around it.

All of these can agree by chance where a journal trembles on its contact faster than the rows
follow.  So the error is never less than COVERED times the scatter of the rows near the point: the
median distance of a row from the polynomial through the three before and the three behind it.

A channel that rests at zero crosses it by rounding: `faint` counts the swings between crossings
that go less far than the run resolves, as its own sections do (solve/diagnose/swings.py).

Two crossings between two rows are not seen at all, and a contact shorter than their distance may
leave no trace in the rows: `unresolved` counts the touches that no row saw.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array, Indices
from trsim.errors import UsageError

DIRECTIONS = ("up", "down", "both")
FEWEST = 8  # rows
# places of rows from the one before the crossing on, the cubic of all comparisons first
CUBIC = (-1, 0, 1, 2)
OTHERS = ((-2, -1, 0, 1, 2), (-1, 0, 1, 2, 3), (-2, -1, 0, 1, 2, 3), (-2, 0, 2, 4), (-3, -1, 1, 3))
LINE = (0, 1)
STEPS, AHEAD = 4, 1e-3  # of Newton's method; of a row
AROUND = (-3, -2, -1, 1, 2, 3)  # rows that say what the one between them should be
NEARBY = tuple(range(-5, 7))  # rows whose scatter counts
# a cubic halfway between scattered rows is off by 0.8 of their scatter, the motion there by 1: 1.3
# in all, of which twice covers 95 %; half as much again as the median of twelve rows scatters too
COVERED = 4.0
MEDIAN = 0.6745  # of the absolute values of a normal distribution with scatter 1


class Interpolated(NamedTuple):
    """Points of a section and the errors they may have, in the units of the channels."""

    definition: dict[str, Any]
    time: Array  # s
    x: Array
    y: Array
    time_error: Array
    x_error: Array
    y_error: Array
    unresolved: int  # touches of contacts that no row saw
    faint: int = 0  # swings of `when` between crossings that go less far than the run resolves

    @property
    def worst(self) -> tuple[float, float, float]:
        """The largest errors of time, x and y."""
        errors = (self.time_error, self.x_error, self.y_error)
        time, x, y = (float(np.max(error, initial=0.0)) for error in errors)
        return time, x, y


def section(run: Any, when: str, x: str, y: str, crosses: str = "up") -> Interpolated:
    """Channels x and y of a run where `when` crosses zero.

    Raises UsageError for channels the run does not have, or too few rows.
    """
    if crosses not in DIRECTIONS:
        raise UsageError(f"crosses must be one of {', '.join(DIRECTIONS)}, got '{crosses}'")
    if when == "time":
        what = "time does not cross zero again and again"
        raise UsageError(what, "Name a channel that does; declare `every` for equal intervals.")
    w, across, upwards = channels = [run.channel(name) for name in (when, x, y)]
    for name, values in zip((when, x, y), channels, strict=True):
        if values.ndim > 1:
            hint = f"Did you mean '{name}.x'?"
            raise UsageError(f"'{name}' has {values.shape[1]} components", hint)
    if run.rows < FEWEST:
        raise UsageError(f"{run.path}: {run.rows} rows are too few for a section")
    events = run.events
    contact = np.isin(events.kind, ("onset", "separation", "user"))
    found = crossings(run.time, w, across, upwards, crosses, events.time[contact])
    definition = {"when": when, "crosses": crosses, "x": x, "y": y}
    unresolved = sum(passed_over(run.time, opened) for opened in touches(events, run.contacts))
    return Interpolated(definition, *found, unresolved, faint(run, when, w))


def asked(text: str) -> dict[str, str]:
    """The arguments of `section` in `when=B.x,crosses=up,plot=B.x:B.y`.  Raises UsageError."""
    example = "Write for example when=stroke.rate,crosses=up,plot=stroke:door_angle."
    given: dict[str, str] = {}
    for part in text.split(","):
        key, _, value = part.partition("=")
        if key not in ("when", "crosses", "plot"):
            raise UsageError(f"--section knows no '{key}'", example)
        if key in given:
            raise UsageError(f"--section has {key}= twice", example)
        given[key] = value
    for key in ("when", "plot"):
        if not given.get(key):
            raise UsageError(f"--section lacks {key}=", example)
    x, colon, y = given["plot"].partition(":")
    if not (x and colon and y) or ":" in y:
        raise UsageError(f"plot= is two channels, got '{given['plot']}'", example)
    return {"when": given["when"], "crosses": given.get("crosses", "up"), "x": x, "y": y}


def faint(run: Any, when: str, values: Array) -> int:
    """How many swings between two changes of sign go less far than the run resolves."""
    from trsim.solve.diagnose.swings import largest, resolved

    unit = run.unit(when)
    alike = (run.channel(name) for name in run.names if run.unit(name) == unit)
    tolerance = float(run.group("solver").get("tolerance", 0.0))  # none in an unfinished file
    least = resolved(tolerance, largest(alike), unit)
    ends = np.flatnonzero((values[1:] < 0.0) != (values[:-1] < 0.0)) + 1
    if len(ends) < 2:
        return 0
    far = np.maximum.reduceat(np.abs(values), ends)[:-1]
    return int(np.count_nonzero(far < least))


def touches(events: Any, contacts: tuple[str, ...]) -> Iterator[tuple[Array, Array]]:
    """Times of onsets and of separations of each contact."""
    for name in contacts:
        mine = events.element == name
        opens = events.time[mine & (events.kind == "onset")]
        yield opens, events.time[mine & (events.kind == "separation")]


def passed_over(time: Array, opened: tuple[Array, Array]) -> int:
    """How many touches begin and end between two neighbouring rows."""
    onset, separation = opened
    following = np.searchsorted(separation, onset)
    there = following < len(separation)
    rows = np.searchsorted(time, [onset[there], separation[following[there]]])
    return int(np.count_nonzero(rows[0] == rows[1]))


def crossings(
    time: Array, when: Array, x: Array, y: Array, crosses: str, events: Array
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """Times, x and y of the crossings, and their errors; `events` are times of kinks.

    A run that starts on zero, to rounding, does not cross it there.
    """
    from trsim.solve.march.sections import AT_START  # with it numba

    if abs(when[0]) <= AT_START * abs(when[1]):
        when = np.append(0.0, when[1:])
    up, down = (when[:-1] < 0.0) & (when[1:] >= 0.0), (when[:-1] > 0.0) & (when[1:] <= 0.0)
    k: Indices = np.flatnonzero({"up": up, "down": down}.get(crosses, up | down))
    best, root = along(time, (when, x, y), k, CUBIC)
    error = np.zeros_like(best)
    for places in OTHERS:
        other, _ = along(time, (when, x, y), k, places, root)
        error = np.maximum(error, np.abs(other - best))
    begin, end = np.clip(k + min(CUBIC), 0, None), np.clip(k + max(CUBIC), None, len(time) - 1)
    kinked = np.searchsorted(events, time[begin]) < np.searchsorted(events, time[end], "right")
    line = np.abs(along(time, (when, x, y), k, LINE)[0] - best)
    error = np.where(kinked, np.maximum(error, line), error)
    error = np.maximum(error, trembling(time, (when, x, y), k, root))
    return best[0], best[1], best[2], error[0], error[1], error[2]


def along(
    time: Array, channels: tuple[Array, ...], k: Indices, places: tuple[int, ...],
    near: Array | None = None,
) -> tuple[Array, Array]:  # fmt: skip
    """Time, x and y (3, n) of each crossing by the polynomials through rows k + places; the roots.

    A root is looked for between rows k and k + 1, or `near` a place, both in units of their span.
    """
    rows, span, lever = levers(time, k, places)
    when, *shown = channels
    at = between(lever, when[rows]) if near is None else moved(lever, when[rows], near)
    weight = weights(lever, at)
    found = [time[k] + at * span, *(np.sum(weight * c[rows], axis=1) for c in shown)]
    return np.array(found), at


def levers(time: Array, k: Indices, places: tuple[int, ...]) -> tuple[Indices, Array, Array]:
    """Rows k + places, the span (s) from row k to the next, and where the rows are, in spans."""
    first = np.clip(k, -min(places), len(time) - 1 - max(places))  # near the ends of the run
    rows, span = first[:, None] + np.array(places), time[k + 1] - time[k]
    return rows, span, (time[rows] - time[k][:, None]) / span[:, None]


def trembling(time: Array, channels: tuple[Array, ...], k: Indices, root: Array) -> Array:
    """What the scatter of the rows makes of time, x and y (3, n), at roots of the cubics."""
    rows, span, lever = levers(time, k, CUBIC)
    slope = (weights(lever, root + AHEAD) - weights(lever, root - AHEAD)) / (2.0 * AHEAD)
    slopes = [np.abs(np.sum(slope * c[rows], axis=1)) for c in channels]
    mine = np.clip(k[:, None] + np.array(NEARBY), max(AROUND), len(time) - 1 - max(AROUND))
    of_when, *noise = [
        COVERED * np.median(s[mine - max(AROUND)], axis=1) for s in scatter(time, channels)
    ]
    off = np.minimum(of_when, 3.0 * slopes[0])  # no further than roots are looked for
    off = np.divide(off, slopes[0], out=np.zeros_like(root), where=slopes[0] > 0.0)
    shown = [n + s * off for n, s in zip(noise, slopes[1:], strict=True)]
    return np.array([span * off, *shown])


def scatter(time: Array, channels: tuple[Array, ...]) -> list[Array]:
    """How far each row with three on both sides is from what those say of it.

    In units of the standard deviation of rows that are independent.
    """
    middle = np.arange(max(AROUND), len(time) - max(AROUND))
    rows = middle[:, None] + np.array(AROUND)
    lever = (time[rows] - time[middle][:, None]) / (time[middle + 1] - time[middle])[:, None]
    weight = weights(lever, np.zeros(len(middle)))
    size = MEDIAN * np.sqrt(1.0 + np.sum(weight**2, axis=1))
    return [np.abs(c[middle] - np.sum(weight * c[rows], axis=1)) / size for c in channels]


def between(u: Array, w: Array) -> Array:
    """The roots between 0 and 1 of the polynomials through (u, w), by bisection."""
    low, high = np.zeros(len(u)), np.ones(len(u))
    sign = np.sign(value(u, w, high))
    for _ in range(52):
        middle = 0.5 * (low + high)
        right = np.sign(value(u, w, middle)) == sign
        low, high = np.where(right, low, middle), np.where(right, middle, high)
    return 0.5 * (low + high)


def moved(u: Array, w: Array, at: Array) -> Array:
    """The roots near `at`, by Newton's method; not further than a row from 0 and 1."""
    for _ in range(STEPS):
        slope = (value(u, w, at + AHEAD) - value(u, w, at - AHEAD)) / (2.0 * AHEAD)
        step = np.divide(value(u, w, at), slope, out=np.ones_like(at), where=slope != 0.0)
        at = np.clip(at - step, -1.0, 2.0)
    return at


def value(u: Array, w: Array, at: Array) -> Array:
    """Values of the polynomials through (u, w)."""
    total: Array = np.sum(weights(u, at) * w, axis=1)
    return total


def weights(u: Array, at: Array) -> Array:
    """Weights of the values at u in that of the polynomial through them, a row for each place."""
    weight = np.ones_like(u)
    for i in range(u.shape[1]):
        for j in range(u.shape[1]):
            if i != j:
                weight[:, i] *= (at - u[:, j]) / (u[:, i] - u[:, j])
    return weight
