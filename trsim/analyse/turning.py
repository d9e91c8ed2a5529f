"""A run beside a table, over an abscissa that may turn back.

    d = x(s) - x_0(s)         s: the rows of the table; the run is interpolated linearly

An abscissa such as the angle of a door goes forth and back: its rows are parted into branches, each
of which only rises or only falls, and a branch of the run is compared with that of the table.  What
goes back by less than BACK of the range is no branch; such rows are left out.  Where the run stands
still, or two rows have one time, its curve is upright: x(s) is then an interval, and d the distance
to it.  A table knows nothing between its rows, so nothing is compared there.

    as many branches in both, in the same directions    one by one, in their order
    one branch in the table                             each of the run with that one
    else, with a column `time` in the table             along time
    else                                                refused
"""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.reference import Given
from trsim.analyse.window import between
from trsim.arrays import Array
from trsim.errors import UsageError

BACK = 1e-3  # of the range: less is no turn
SAME = 1e-9  # of the range: rounding


class Branch(NamedTuple):
    """Rows between two turns: begin <= row < end."""

    begin: int
    end: int
    way: int  # 1 rising, -1 falling

    def rows(self, column: Any) -> Any:
        return column[self.begin : self.end]


class Off(NamedTuple):
    """What a channel of a run is more than a table.

    how      branch by branch or along time, in words
    largest  signed, in the unit of the channel
    at       abscissa of that
    value    of the run there
    time     of the run there, s; none where a branch stands still
    rms      of all rows compared
    of_range  |largest| of the range of the table
    rows     of the table that were compared, of those in the window
    asked    those in the window
    """

    how: str
    largest: float
    at: float
    value: float
    rms: float
    of_range: float
    rows: int
    asked: int


def branches(s: Array) -> list[Branch]:
    """The branches of an abscissa (n); none where it stands still."""
    far, least = float(np.ptp(s)), BACK * float(np.ptp(s))
    if not far > 0.0:
        return []
    turns, way, high, low = [0], 0, 0, 0
    for k in range(len(s)):
        high, low = (k if s[k] > s[high] else high), (k if s[k] < s[low] else low)
        if way == 0 and s[high] - s[low] >= least:
            way = 1 if high > low else -1
        if way > 0 and s[high] - s[k] >= least:
            turns.append(high)
            way, low = -1, k
            high = k
        elif way < 0 and s[k] - s[low] >= least:
            turns.append(low)
            way, high = 1, k
            low = k
        elif way > 0:
            low = high
        elif way < 0:
            high = low
    return [
        Branch(a, _standing(s, b, SAME * far), 1 if s[b] > s[a] else -1)
        for a, b in pairwise([*turns, len(s) - 1])
    ]


def _standing(s: Array, k: int, same: float) -> int:
    """Behind the last row of those from k on that stand where it does."""
    moved = np.flatnonzero(np.abs(s[k:] - s[k]) > same)
    return k + int(moved[0]) if moved.size else len(s)


def differences(
    of: str,
    run: tuple[Array, Array, Array],
    table: Given,
    channel: str,
    within: tuple[float, float],
) -> list[Off]:
    """A run (time, abscissa, values) less a table, over the rows of that inside a window.

    of: the abscissa by its name.  Raises UsageError where the two cannot be compared.
    """
    time, s, x = (column[np.isfinite(run[1])] for column in run)
    inside = between(table.x, within)
    if not inside.any():
        what = f"{table.name} has no row in the window of {of}"
        raise UsageError(what, f"It goes from {table.x.min():g} to {table.x.max():g} (SI).")
    own = [b for b in branches(s) if _reaches(b, s, within)]
    its = [b for b in branches(table.x) if _reaches(b, table.x, within)]
    if not own or not its:
        who = table.name if own else "the run"
        raise UsageError(f"{of} stands still in {who}: nothing is a function of it", "")
    y = table.y[channel]
    same = [b.way for b in own] == [b.way for b in its]
    if not same and len(its) > 1:
        if table.time is None:
            raise _unlike(of, own, its, table.name)
        how = f"along time: {of} has {_count(own)} in the run and {_count(its)} in the table"
        found = off((time, x), (table.time[inside], y[inside], table.x[inside]), y)
        return [_compared(found, how, channel, table.name)]
    out = []
    for k, one in enumerate(own):
        other = its[k] if same else its[0]
        kept = other.rows(inside)
        at, asked = (column[kept] for column in (other.rows(table.x), other.rows(y)))
        found = off((one.rows(s), one.rows(x)), (at, asked, at), y, one.way)
        out.append(_compared(found, _told(k, own, its), channel, table.name))
    return out


def _reaches(branch: Branch, s: Array, within: tuple[float, float]) -> bool:
    return bool(np.any(between(s, within)[branch.begin : branch.end]))


def _count(of: list[Branch]) -> str:
    return f"{len(of)} branch{'es' * (len(of) > 1)}"


def _told(k: int, own: list[Branch], its: list[Branch]) -> str:
    """Which branch, in words."""
    if len(own) == 1:
        return "over all of it"
    told = f"branch {k + 1} of {len(own)}, {'rising' if own[k].way > 0 else 'falling'}"
    return told if len(its) == len(own) else f"{told}, beside the only one of the table"


def _unlike(of: str, own: list[Branch], its: list[Branch], name: str) -> UsageError:
    """Why two curves cannot be compared."""
    what = f"{of} has {_count(own)} in the run and {_count(its)} in {name}"
    if len(own) == len(its):
        what += ", in other directions"
    return UsageError(
        f"{what}: no branch of one belongs to one of the other",
        "Give the table a column `time [s]`, or choose a stretch: --window of the abscissa, or "
        "@BEGIN..END of the time.",
    )


def _compared(found: Off | None, how: str, channel: str, name: str) -> Off:
    if found is None:
        what = f"{channel} and {name} have no stretch in common ({how})"
        raise UsageError(what, "Is the unit of each column that of its numbers?")
    return found._replace(how=how)


def off(
    curve: tuple[Array, Array], rows: tuple[Array, Array, Array], whole: Array, way: int = 1
) -> Off | None:
    """A curve x(s) less rows y at some places; None where there are none in common.

    curve  s and x; s goes one way but for rows that are left out
    rows   places, y, and the abscissa of theirs that is told
    whole  the values whose range counts
    """
    (s, x), (at, y, shown) = curve, rows
    u, v = way * s, way * at
    far = max(float(np.ptp(s)), 1e-300)
    low, high = upright(u, x, SAME * far)
    value = nearest(low, high, v, y, SAME * far)
    left = value - y
    there = np.flatnonzero(np.isfinite(left))
    if not there.size:
        return None
    k = int(there[np.argmax(np.abs(left[there]))])
    size = float(np.ptp(whole))
    return Off(
        "",
        float(left[k]),
        float(shown[k]),
        float(value[k]),
        float(np.sqrt(np.mean(left[there] ** 2))),
        abs(float(left[k])) / size if size > 0.0 else np.nan,
        int(there.size),
        len(y),
    )


class Side(NamedTuple):
    """One side of a curve that may be upright: places, and its value on the way in and out."""

    u: Array
    x: Array  # extreme at the place
    end: Array  # first, or last, of the rows at the place


def upright(u: Array, x: Array, same: float) -> tuple[Side, Side]:
    """Places that rise, with the least and first, and the largest and last value at each."""
    ahead = np.maximum.accumulate(u)
    kept = u >= ahead - same
    u, x = ahead[kept], x[kept]
    begins = np.flatnonzero(np.append(True, np.diff(u) > same))
    ends = np.append(begins[1:], len(u)) - 1
    low = Side(u[begins], np.minimum.reduceat(x, begins), x[begins])
    return low, Side(u[begins], np.maximum.reduceat(x, begins), x[ends])


def nearest(low: Side, high: Side, v: Array, y: Array, same: float) -> Array:
    """The values at places v: of an upright part the one that is nearest to y, nan outside."""
    u = low.u
    k = np.clip(np.searchsorted(u, v, side="right") - 1, 0, max(len(u) - 2, 0))
    out = np.full(len(v), np.nan)
    if len(u) > 1:
        share = (v - u[k]) / (u[k + 1] - u[k])
        between = (v >= u[0]) & (v <= u[-1])
        out = np.where(between, high.end[k] + share * (low.end[k + 1] - high.end[k]), np.nan)
    place = np.clip(np.searchsorted(u, v), 0, len(u) - 1)
    for j in (place, np.maximum(place - 1, 0)):
        met = np.abs(v - u[j]) <= same
        out = np.where(met, np.clip(y, low.x[j], high.x[j]), out)
    return out
