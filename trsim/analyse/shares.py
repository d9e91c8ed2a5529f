"""How a joint with clearance spends its time: free flight, impacts, following.

Contact begins and ends at the located events of the run, so shares of time do not depend on the
output rows.  A contact in which the penetration rises and falls once between its onset and its
separation is an impact; one in which it has several maxima, or that the window begins or ends in
before its maximum was passed twice, is following: the journal stays on the bearing and is pressed
on again.  The three modes are those of [Flores2008].

    flight + impact + following = 1         contact = impact + following
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.analyse.onsets import changed
from trsim.analyse.window import Window
from trsim.arrays import Array
from trsim.store.read import Run

DEPTHS = ("penetration", "compression")  # what a contact calls how deep it is; that of a seal
RIPPLE = 0.01  # of the deepest penetration of a contact: less is no maximum of its own


class Shares(NamedTuple):
    """Shares of a window of time, and the impacts in it."""

    joint: str
    begin: float  # s
    end: float  # s
    flight: float  # of the time, 0 to 1
    contact: float
    impact: float  # contact of one maximum
    following: float  # the rest of contact
    onsets: int
    impacts: int  # contacts of one maximum that begin in the window
    mean_between: float  # s from one onset to the next; nan of fewer than two
    median_between: float  # s


def shares(run: Run, joint: str, within: Window) -> Shares:
    """The modes of one contact of a run in a window.

    Raises UsageError where the run has no such contact.
    """
    steps = run.steps(joint)
    events = run.events
    mine = events.element == joint
    times, kind = events.time[mine], events.kind[mine]
    struck = times[kind == "onset"]
    times, closes = changed(times, kind, run.time[: len(steps["time"]) > 0])
    begins, ends = intervals(times, closes, within)
    depth = next(steps[name] for name in DEPTHS if name in steps)
    once = single(steps["time"], depth, begins, ends)
    length = within.end - within.begin
    clipped = np.minimum(ends, within.end) - np.maximum(begins, within.begin)
    struck = struck[within.of(struck)]
    between = np.diff(struck)
    contact = float(clipped.sum() / length) if length > 0.0 else np.nan
    impact = float(clipped[once].sum() / length) if length > 0.0 else np.nan
    return Shares(
        joint,
        *within,
        1.0 - contact,
        contact,
        impact,
        contact - impact,
        len(struck),
        int(np.count_nonzero(once & within.of(begins))),
        float(between.mean()) if between.size else np.nan,
        float(np.median(between)) if between.size else np.nan,
    )


def intervals(times: Array, closes: NDArray[np.bool_], within: Window) -> tuple[Array, Array]:
    """Begins and ends (s) of the contacts that reach into a window.

    times (n) s: of changes, closes (n): whether a contact begins.  What opens first was closed
    before, and what closes last stays so: these reach to -inf and inf.
    """
    if not times.size:
        return np.zeros(0), np.zeros(0)
    begins, ends = times[closes], times[~closes]
    if not closes[0]:
        begins = np.concatenate([[-np.inf], begins])
    if closes[-1]:
        ends = np.concatenate([ends, [np.inf]])
    inside = (ends > within.begin) & (begins < within.end)
    return begins[inside], ends[inside]


def single(time: Array, depth: Array, begins: Array, ends: Array) -> NDArray[np.bool_]:
    """Which contacts are over and had one maximum; time (n) s, depth (n) m at accepted steps."""
    first = np.searchsorted(time, begins, "left")
    last = np.searchsorted(time, ends, "right")
    over = np.isfinite(begins) & np.isfinite(ends)
    return np.array(
        [whole and maxima(depth[a:b]) <= 1 for whole, a, b in zip(over, first, last, strict=True)],
        bool,
    )


def maxima(depth: Array) -> int:
    """How many times a penetration (n) m rises and falls by more than a ripple."""
    if not depth.size:
        return 0
    least = RIPPLE * float(depth.max())
    count, rising, turn = 0, True, 0.0
    for value in depth.tolist():
        if rising:
            if value > turn:
                turn = value
            elif value < turn - least:
                count, rising, turn = count + 1, False, value
        elif value < turn:
            turn = value
        elif value > turn + least:
            rising, turn = True, value
    return count + rising
