"""What can be told of two runs while they are apart: means, RMS and shares of contact.

Each has an interval from its own batch means (interval.py).  A stroke drifts, and a drift has
none; but both runs drift alike, so their difference x - x' has one where neither of them has.  Two
means agree where either interval covers their difference, or where that is small beside them.
"""

from typing import Any

import h5py
import numpy as np

from trsim.analyse.apart import APART, still
from trsim.analyse.interval import MOST, Batches, half_widths
from trsim.analyse.onsets import changes, closed
from trsim.analyse.pair import Pair, Totals
from trsim.arrays import Array
from trsim.store.certificate import Level, Parted

ERRORS = ("energy.residual", "energy.work.projection")  # of the solver: no motion has them


class Inside:
    """Values and squares of all columns in one window: of the run, the twin, and the difference."""

    def __init__(self, rows: int, columns: int) -> None:
        self.run, self.twin, self.off = (Batches(rows, 2 * columns) for _ in range(3))

    def take(self, mine: Array, other: Array) -> None:
        """The next rows (n, columns) of both runs."""
        both = [np.hstack([values, np.square(values)]) for values in (mine, other)]
        self.run.take(both[0])
        self.twin.take(both[1])
        self.off.take(both[0] - both[1])


def levels(pair: Pair, window: int, inside: Inside, both: tuple[Totals, Totals]) -> list[Level]:
    """Mean and RMS of what moves, in one window."""
    n, found = len(pair.columns), []
    left_out = {*resting(pair, both), *ERRORS}
    value = [inside.run.mean, inside.twin.mean]
    half = [inside.run.half, inside.twin.half, inside.off.half]
    for k, column in enumerate(pair.columns):
        if column.name in left_out:
            continue
        numbers = [float(x[k]) for x in (*value, *half)]
        found.append(level(window, column.name, "mean", numbers, column.unit))
        squares = [float(x[n + k]) for x in (*value, *half)]
        roots = [np.sqrt(max(x, 0.0)) for x in squares[:2]]
        # of a root, to first order
        slopes = [0.5 / x if x > 0.0 else 0.0 for x in (*roots, max(roots))]
        halves = [slope * h for slope, h in zip(slopes, squares[2:], strict=True)]
        found.append(level(window, column.name, "rms", [*roots, *halves], column.unit))
    return found


def resting(pair: Pair, both: tuple[Totals, Totals]) -> set[str]:
    """Components that change by no more than rounding in both runs."""
    names = [column.name for column in pair.columns]
    units = {column.name: column.unit for column in pair.columns}
    values = np.array([totals.values for totals in both])
    ranges = (values[:, 0] - values[:, 1]).max(axis=0).tolist()
    sizes = np.abs(values).max(axis=(0, 1)).tolist()
    return still(dict(zip(names, ranges, strict=True)), dict(zip(names, sizes, strict=True)), units)


def level(window: int, name: str, quantity: Any, numbers: list[float], unit: str) -> Level:
    """numbers: of run and twin, half their intervals, half that of the difference."""
    told = [float(number) for number in numbers]
    return Level._make([window, name, quantity, *told, verdict(*told), unit])


def verdict(mine: float, other: float, half: float, other_half: float, off_half: float) -> Any:
    """Whether two means agree or differ; unknown where there is no interval at all."""
    off, widths = abs(mine - other), [np.hypot(half, other_half), off_half]
    if off <= APART * min(abs(mine), abs(other)) or any(off <= width for width in widths):
        return "agree"
    return "unknown" if np.isnan(widths).all() else "differ"


def shares(run: h5py.File, twin: h5py.File, parted: Parted, until: float) -> list[Level]:
    """The share of time in contact in one window; until: s, the end of what is compared."""
    end = until if np.isnan(parted.end) else parted.end
    if end <= parted.begin:
        return []
    edges, found = np.linspace(parted.begin, end, MOST + 1), []
    for name in run["steps"]:
        mine, other = (closed(*changes(file, name), edges) for file in (run, twin))
        each = np.column_stack([mine, other, mine - other])
        numbers = [*each.mean(axis=0)[:2].tolist(), *half_widths(each).tolist()]
        found.append(level(parted.number, name, "in contact", numbers, "-"))
    return found
