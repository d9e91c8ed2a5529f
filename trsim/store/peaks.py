"""The table of peaks: extremes of forces and motions, exact where the solver kept them.

Extremes of scalars and components, and of the magnitudes of vectors that have no channel of their
own, come from the solver, which finds those of the motion between its steps.  Where a run was
recovered without them they are those of the output rows.
"""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.arrays import Array
from trsim.store import rows
from trsim.store.grow import components
from trsim.store.made import Book

ROWS = 1 << 16


class Peak(NamedTuple):
    """One extreme of one channel."""

    channel: str
    extreme: str  # largest, smallest, magnitude
    value: float
    time: float  # s
    stroke: float  # m or rad: the sensor named `stroke` at that time; nan without one
    unit: str


def bears(channel: str) -> bool:
    """Whether a channel, by its whole name, is a reaction."""
    return channel.rpartition(".")[2].startswith("reaction")


class Magnitudes:
    """Largest magnitudes of vectors so far, kept while rows pass by."""

    def __init__(self, columns: tuple[Any, ...]) -> None:
        self.columns = [c for c in columns if c.size == 3 and c.wanted and bears(c.name)]
        self.row = {c.name: k for k, c in enumerate(self.columns)}
        self.largest = np.zeros((len(self.columns), 2))  # square, time: a root would lose bits

    def update(self, rows: Array) -> None:
        """Take rows; of equal ones the first counts, wherever rows are cut into blocks."""
        for c, largest in zip(self.columns, self.largest, strict=True):
            x, y, z = rows[:, 1 + c.start : 4 + c.start].T
            square = x * x + y * y + z * z
            k = int(np.argmax(square))
            if square[k] > largest[0]:
                largest[:] = square[k], rows[k, 0]

    def of(self, name: str) -> tuple[float, float]:
        """The largest magnitude of a vector, and its time."""
        square, time = self.largest[self.row[name]].tolist()
        return math.sqrt(square), time


def table(
    mechanism: Any, extremes: NDArray[np.float64] | None, magnitudes: Magnitudes
) -> list[Peak]:
    """The peaks of a run, without their strokes; `extremes` is what the solver kept."""
    from trsim.assemble.layout import of_peaks

    names = of_peaks(mechanism.instances)
    peaks, width = [], mechanism.model.n_out
    for column in mechanism.columns:
        if column.name.split(".")[0] not in names or column.for_points:
            continue
        if column.name in magnitudes.row:
            value, time = magnitudes.of(column.name)
            if extremes is not None:
                value, time = extremes[width + magnitudes.row[column.name], :2].tolist()
            peaks.append(Peak(column.name, "magnitude", value, time, np.nan, column.unit))
        if extremes is None or column.size not in (1, 3):
            continue
        of_column = extremes[column.start : column.start + column.size]
        peaks += both_ways(column.name, column.unit, of_column)
    return peaks


def both_ways(channel: str, unit: str, extremes: Array) -> Iterator[Peak]:
    """Largest and smallest of each component; extremes: high, its time, low, its time (n, 4)."""
    names = components(channel, len(extremes))
    for name, (high, high_time, low, low_time) in zip(names, extremes.tolist(), strict=True):
        yield Peak(name, "largest", high, high_time, np.nan, unit)
        yield Peak(name, "smallest", low, low_time, np.nan, unit)


def with_strokes(peaks: list[Peak], book: Book) -> list[Peak]:
    """The peaks with the stroke at their times, by linear interpolation of the rows."""
    if not book.has("stroke"):
        return peaks
    return at_strokes(peaks, book.rows("time"), book.rows("stroke"))


def at_strokes(peaks: list[Peak], time: Any, stroke: Any) -> list[Peak]:
    """The same with the rows themselves: times (n) s and strokes (n), read in parts."""
    wanted = np.array([peak.time for peak in peaks])
    strokes = np.full(len(peaks), np.nan)
    for k in range(0, len(time), ROWS):
        t, s = time[k : k + ROWS + 1], stroke[k : k + ROWS + 1]
        inside = (wanted >= t[0]) & (wanted <= t[-1])
        strokes[inside] = np.interp(wanted[inside], t, s)
    return [peak._replace(stroke=float(s)) for peak, s in zip(peaks, strokes, strict=True)]


def store(book: Book, peaks: list[Peak]) -> None:
    """The group /peaks: one dataset per column of the table."""
    rows.store(book, "peaks", Peak, peaks)
    book.scale("peaks/channel", "channel")
    book.attach([(f"peaks/{name}", ("peaks/channel",)) for name in Peak._fields[1:]])
    book.attribute("peaks/time", "units", "s")
    if book.has("stroke"):
        book.attribute("peaks/stroke", "units", book.said("stroke", "units"))
    book.attribute("peaks", "extremes", "of the motion, between steps too")
