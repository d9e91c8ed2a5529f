"""What two runs of one scenario, made independently, say of each other.

A run is compared with its twin, made by another method at a tighter tolerance: the difference is
the error of the run, unless both are wrong in the same way.  Where they are apart (apart.py) a
curve is one of many possible ones; what can still be told then are means and RMS, and how sure
they are (levels.py).  The rows of both files are read three times, a stretch at a time.
"""

from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from trsim.analyse.apart import APART, Window, still, windows
from trsim.analyse.levels import ERRORS, Inside, levels, shares
from trsim.analyse.onsets import first_onsets, numbers
from trsim.analyse.pair import Column, Pair, Totals
from trsim.arrays import Array
from trsim.store.certificate import Certificate, Curve, Parted, Quantity
from trsim.store.read import reached

BOOK = "energy.work."  # channels that add up what happened: what parted once stays so
EXTREMES = ("largest", "smallest")


def certificate(run: h5py.File, twin: h5py.File) -> Certificate:
    """Compare the rows, peaks and events of two complete files."""
    pair = Pair(run, twin)
    both = Totals(len(pair.columns)), Totals(len(pair.columns))
    for k, *rows in pair.pieces(0, pair.rows):
        for totals, values in zip(both, rows, strict=True):
            totals.take(k, values)
    ranges, moving = compared(pair, both[0])
    apart, which = departures(pair, ranges, moving)
    found = windows(apart)
    largest, inside = differences(pair, found)
    curves = [
        Curve(name, float(largest[k] / ranges[k]) if ranges[k] > 0.0 else np.nan,
              float(ranges[k]), bool(moving[k]), pair.units[name])
        for k, name in enumerate(pair.names)
    ]  # fmt: skip
    until = float(run["time"][pair.rows - 1]) if pair.rows else 0.0
    parted = [stretch(pair, number, each, apart) for number, each in enumerate(found, 1)]
    quantities = summary(pair, both, parted) if pair.rows else []
    first = parted[0].begin if parted else np.nan
    about = {
        **of_twin(twin), "compared_until": until, "rows": pair.rows, "motion": int(moving.sum()),
        "apart": first, "apart_channel": which, **worst([c for c in curves if c.motion]),
        **worst_quantity(pair, quantities, ranges),
    }  # fmt: skip
    told = [row for k, one in enumerate(inside) for row in levels(pair, k + 1, one, both)]
    located = min(reached(run), reached(twin))  # contacts go on behind the last row
    told += [row for one in parted for row in shares(run, twin, one, located)]
    return Certificate(about, parted, curves, quantities, told, numbers(run, twin, first),
                       first_onsets(run, twin, located))  # fmt: skip


def stretch(pair: Pair, number: int, found: Window, apart: NDArray[np.bool_]) -> Parted:
    """A window in times: it ends where the runs are together again, nan where they never are."""
    time = pair.run["time"]
    end = float(time[found.end]) if found.end < pair.rows else np.nan
    share = float(apart[found.begin : found.end].mean())
    return Parted(number, float(time[found.begin]), end, found.end - found.begin, share)


def of_twin(twin: h5py.File) -> dict[str, Any]:
    """How the twin was made, and how it ended."""
    solver = twin["solver"].attrs
    return {
        "method": str(solver["method"]),
        "tolerance": float(solver["tolerance"]),
        "status": str(twin.attrs["status"]),
        "reason": str(twin.attrs["reason"]),
        "time": float(twin["summary"].attrs["time"]),
        "steps": int(solver.get("steps", 0)),
        "evaluations": int(solver.get("evaluations", 0)),
    }


def worst(curves: list[Curve]) -> dict[str, Any]:
    """The largest difference of motion while the runs are together."""
    largest = max(curves, key=lambda curve: curve.difference, default=None)
    return {
        "difference": largest.difference if largest else np.nan,
        "difference_channel": largest.channel if largest else "",
    }


def worst_quantity(pair: Pair, quantities: list[Quantity], ranges: Array) -> dict[str, Any]:
    """The largest difference of a summary quantity, of the range of its channel."""
    sizes = {c.name: float(ranges[c.channel]) for c in pair.columns if ranges[c.channel] > 0.0}
    found = [
        (abs(q.difference) / sizes[q.channel], f"{q.channel}, {q.quantity}")
        for q in quantities
        if q.certain and q.channel in sizes and q.channel not in ERRORS
    ]
    largest, name = max(found, default=(np.nan, ""))
    return {"quantity_difference": largest, "quantity": name}


# --- where they are apart --------------------------------------------------------------------


def compared(pair: Pair, totals: Totals) -> tuple[Array, NDArray[np.bool_]]:
    """Range of each channel, and which of them say whether the runs are apart."""
    if not pair.rows:
        return np.zeros(len(pair.names)), np.zeros(len(pair.names), bool)
    ranges = pair.per_channel(totals.values[0] - totals.values[1])
    sizes = pair.per_channel(np.abs(totals.values).max(axis=0))
    by_name = [dict(zip(pair.names, x.tolist(), strict=True)) for x in (ranges, sizes)]
    rests = still(by_name[0], by_name[1], pair.units)
    moving = np.array([pair.moves(n) and n not in rests for n in pair.names], bool)
    return np.where([n in rests for n in pair.names], 0.0, ranges), moving


def departures(
    pair: Pair, ranges: Array, moving: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], str]:
    """Whether each row is apart, and the channel that is so first."""
    apart, which = np.zeros(pair.rows, bool), ""
    used = moving[pair.channel]
    if not used.any():
        return apart, which
    bound = APART * ranges[pair.channel][used]
    read = [name for name, says in zip(pair.names, moving, strict=True) if says]
    names = [column.name for column, use in zip(pair.columns, used, strict=True) if use]
    for k, mine, other in pair.pieces(0, pair.rows, read):
        off = np.abs(mine - other) / bound
        apart[k : k + len(off)] = (off > 1.0).any(axis=1)
        if not which and (off > 1.0).any():
            which = names[int(off[np.argmax((off > 1.0).any(axis=1))].argmax())]
    return apart, which


def differences(pair: Pair, found: list[Window]) -> tuple[Array, list[Inside]]:
    """Largest difference of each channel while together, and what the windows hold."""
    largest = np.zeros(len(pair.columns))
    begins, ends = [0, *(w.end for w in found)], [*(w.begin for w in found), pair.rows]
    for low, high in zip(begins, ends, strict=True):
        for _, mine, other in pair.pieces(low, high):
            np.maximum(largest, np.abs(mine - other).max(axis=0), out=largest)
    inside = []
    for begin, end in found:
        kept = Inside(end - begin, len(pair.columns))
        for _, mine, other in pair.pieces(begin, end):
            kept.take(mine, other)
        inside.append(kept)
    return pair.per_channel(largest), inside


# --- in a few numbers ------------------------------------------------------------------------


def summary(pair: Pair, both: tuple[Totals, Totals], parted: list[Parted]) -> list[Quantity]:
    """Extremes, last value, mean and RMS of every component.

    Extremes are those of the rows, and of the accepted steps where both runs kept them and nothing
    of either is left out.
    """
    time, n = pair.run["time"], pair.rows
    exact = [peaks(file) if pair.whole() else {} for file in (pair.run, pair.twin)]
    rows = []
    ever = [one._replace(end=np.nan) for one in parted[:1]]
    for k, column in enumerate(pair.columns):
        gone = ever if column.name.startswith(BOOK) else parted
        for j, quantity in enumerate(EXTREMES):
            key = (column.name, quantity)
            ours = [(float(t.values[j, k]), float(time[t.at[j, k]])) for t in both]
            if all(key in known for known in exact):
                both_ways = zip(ours, (known[key] for known in exact), strict=True)
                ours = [(max, min)[j](two) for two in both_ways]
            certain = not any(within(when, gone) for _, when in ours)
            rows.append(quantified(column, quantity, ours[0][0], ours[1][0], certain))
        mine, other = both
        last, never = not within(float(time[n - 1]), gone), not parted
        for quantity, a, b, certain in (
            ("final", mine.last[k], other.last[k], last),
            ("mean", mine.sum[k] / n, other.sum[k] / n, never),
            ("rms", np.sqrt(mine.square[k] / n), np.sqrt(other.square[k] / n), never),
        ):
            rows.append(quantified(column, quantity, float(a), float(b), certain))
    return rows


def within(time: float, parted: list[Parted]) -> bool:
    """Whether the runs are apart at a time (s)."""
    return any(one.begin <= time and not time >= one.end for one in parted)


def quantified(column: Column, quantity: Any, value: float, twin: float, certain: bool) -> Quantity:
    return Quantity(column.name, quantity, value, twin, value - twin, certain, column.unit)


def peaks(file: h5py.File) -> dict[tuple[str, str], tuple[float, float]]:
    """Extremes that the solver kept, with their times (s)."""
    group = file["peaks"]
    if "channel" not in group:
        return {}
    names, extremes = (group[key].asstr()[:] for key in ("channel", "extreme"))
    numbers = zip(group["value"][:].tolist(), group["time"][:].tolist(), strict=True)
    return dict(zip(zip(names, extremes, strict=True), numbers, strict=True))
