"""A stretch of a run, as it is written behind a word: @0.3..0.98 or @stroke=150mm..490mm.

    begin <= t <= end

Ends are times (s, or with a unit), or values of a channel that passes both of them once: a stroke
is one, whatever the speed it is made at.  An end may be left out.  No window reaches beyond the
run, which ends where it came to and not at its last output row: what the solver located lies behind
that row, too.  A channel is known in the rows alone, and counts as unchanged behind the last one.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.arrays import Array
from trsim.errors import ScenarioError, UsageError, described
from trsim.store.read import Run
from trsim.units import quantity, unit

ROUNDING = 1e-14  # of the largest: k * every and 300 ms are rounded, and an end may be a row
FORM = "A window is @BEGIN..END in seconds, or @CHANNEL=BEGIN..END."


class Window(NamedTuple):
    """A stretch of time."""

    begin: float  # s
    end: float  # s

    def of(self, t: Array) -> NDArray[np.bool_]:
        """Which of the times t (n) lie in it, its ends too."""
        return between(t, self)

    def has(self, t: float) -> bool:
        """Whether one time lies in it."""
        return bool(self.of(np.array([t]))[0])


def between(x: Array, ends: tuple[float, float]) -> NDArray[np.bool_]:
    """Which of some values x (n) lie between two ends; one at an end does, whatever the rounding
    of it or of the end."""
    e = ROUNDING * np.max(np.abs(x), where=np.isfinite(x), initial=0.0)
    return np.asarray((x >= ends[0] - e) & (x <= ends[1] + e))


def parted(word: str) -> tuple[str, str]:
    """A word and the text of its window, which may be empty."""
    name, _, text = word.partition("@")
    return name, text


def window(run: Run, text: str = "", rows: bool = True) -> Window:
    """The window a text describes, in the time of a run; all of the run for an empty one.

    rows: whether something is asked of the output rows in it, so that it has to have one.  Raises
    UsageError where the text makes no sense, or no row, or nothing of the run, lies inside.
    """
    time = run.time
    if not time.size:
        raise UsageError(f"{run.path} has no output rows", "Run the scenario again.")
    whole = Window(float(time[0]), max(float(time[-1]), run.reached))
    if not text:
        return whole
    channel, equals, limits = text.rpartition("=")
    if equals and not channel:
        raise UsageError(f"no window: {described('@' + text)}", FORM)
    x = scalar_channel(run, channel) if equals else time
    si = run.unit(channel) if equals else "s"
    low, high = ends(limits, si, described("@" + text))
    found = Window(max(low, whole.begin), min(high, whole.end))
    if equals:
        found = _passed(run, channel, x, whole, low, high)
    if rows and not found.of(time).any():
        told = f"it has rows from {whole.begin:g} to {time[-1]:g} s"
        raise UsageError(f"{run.path}: no row lies in {described('@' + text)}; {told}", FORM)
    if found.end < found.begin:
        told = f"it goes from {whole.begin:g} to {whole.end:g} s"
        raise UsageError(f"{run.path}: nothing lies in {described('@' + text)}; {told}", FORM)
    return found


def ends(text: str, si: str, told: str, form: str = FORM) -> tuple[float, float]:
    """The ends of BEGIN..END in an SI unit; one that is left out is infinite.

    told: the window in words.  Raises UsageError for what makes no sense.
    """
    begin, dots, end = text.partition("..")
    if not dots:
        raise UsageError(f"no window: {told}", form)
    return _value(begin, -np.inf, si, told, form), _value(end, np.inf, si, told, form)


def _value(text: str, absent: float, si: str, told: str, form: str) -> float:
    """One end in SI units; absent: where it is left out."""
    if not text.strip():
        return absent
    try:
        found = quantity(text)
    except ScenarioError as error:
        raise UsageError(f"window {told}: {error.what}", error.hint) from None
    if found is None:
        raise UsageError(f"window {told}: {described(text)} is no number", form)
    if found[1] and unit(found[1])[1] != unit(si)[1]:
        raise UsageError(f"window {told}: {described(text)} is not in {si}", form)
    return found[0]


def scalar_channel(run: Run, name: str) -> Array:
    """The rows (n) of a channel or of one of its components.

    Raises UsageError where there is no such channel, or it has components.
    """
    found = run.channel(name)
    if found.ndim > 1:
        raise UsageError(
            f"'{name}' has {found.shape[1]} components",
            f"Say '{name}.x', or '|{name}|' for its magnitude.",
        )
    return np.asarray(found)


def rows_in(run: Run, channel: str, within: Window) -> tuple[Array, Array]:
    """Times and values of the rows of a channel that lie in a window."""
    time, x = run.time, scalar_channel(run, channel)
    inside = within.of(time)
    return time[inside], x[inside]


def _passed(run: Run, channel: str, x: Array, whole: Window, low: float, high: float) -> Window:
    """The stretch in which a channel goes from one value to another."""
    time = run.time
    inside = between(x, (low, high))
    edges = np.flatnonzero(np.diff(inside, prepend=False, append=False))
    if edges.size > 2:
        what = f"{run.path}: '{channel}' is between these values {edges.size // 2} times"
        raise UsageError(what, "A window is one stretch: give it in seconds.")
    if not edges.size:
        return Window(np.inf, -np.inf)
    first, last = int(edges[0]), int(edges[1]) - 1
    begin = _crossing(time, x, first, first - 1, (low, high)) if first else whole.begin
    end = _crossing(time, x, last, last + 1, (low, high)) if last + 1 < len(x) else whole.end
    return Window(begin, end)


def _crossing(time: Array, x: Array, a: int, b: int, limits: tuple[float, float]) -> float:
    """Where between row a, in the window, and row b, out of it, the channel passes a limit; at row
    a where that is at the limit but for rounding."""
    for limit in limits:
        if min(x[a], x[b]) <= limit <= max(x[a], x[b]):
            share = (limit - x[a]) / (x[b] - x[a])
            return float(time[a] + share * (time[b] - time[a]))
    return float(time[a])
