"""The rows that two runs of one scenario have in common, a stretch at a time."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import h5py
import numpy as np

from trsim.arrays import Array
from trsim.store import torn
from trsim.store.certificate import ROWS, channels, common_rows
from trsim.store.grow import components

MOTION = ("position", "velocity", "angular_velocity", "rate", "eccentricity_x", "eccentricity_y",
          "eccentricity_x_rate", "eccentricity_y_rate")  # fmt: skip
MOVING = ("m", "rad", "m/s", "rad/s")  # units of what no contact makes jump: no force or energy


class Column(NamedTuple):
    """One component of a channel."""

    name: str
    channel: int  # its number
    unit: str


class Pair:
    """The channels that two open files share, and the rows they have in common."""

    def __init__(self, run: h5py.File, twin: h5py.File) -> None:
        self.run, self.twin = run, twin
        mine, other = channels(run), channels(twin)
        self.names = [
            n for n, d in mine.items() if n in other and d.shape[1:] == other[n].shape[1:]
        ]
        self.units = {name: str(mine[name].attrs.get("units", "-")) for name in self.names}
        self.rows = common_rows(run, twin)
        self.columns = [
            Column(component, k, self.units[name])
            for k, name in enumerate(self.names)
            for component in components(name, math.prod(mine[name].shape[1:]))
        ]
        self.channel = np.array([column.channel for column in self.columns], dtype=int)
        self.sensors = sensors(run)

    def pieces(
        self, begin: int, end: int, names: list[str] | None = None
    ) -> Iterator[tuple[int, Array, Array]]:
        """First row, and rows (n, m) of both files, of some channels or of all."""
        names = self.names if names is None else names
        for k in range(begin, end, ROWS) if names else ():
            last = min(k + ROWS, end)
            mine, other = (
                np.column_stack([torn.rows(file[name], k, last) for name in names])
                for file in (self.run, self.twin)
            )
            yield k, mine, other

    def moves(self, name: str) -> bool:
        """Whether a channel is of positions and velocities, which no contact makes jump."""
        moves = name in self.sensors or name.rsplit(".", 1)[-1] in MOTION
        return moves and self.units[name] in MOVING

    def whole(self) -> bool:
        """Whether nothing is left out of either run, but for a last row at an event."""
        return max(len(self.run["time"]), len(self.twin["time"])) <= self.rows + 1

    def per_channel(self, of_columns: Array) -> Array:
        """The largest of the components."""
        found = np.zeros(len(self.names))
        np.maximum.at(found, self.channel, of_columns)
        return found


def sensors(file: h5py.File) -> set[str]:
    names, sections = (file["mechanism"][key].asstr()[:] for key in ("name", "section"))
    return {name for name, section in zip(names, sections, strict=True) if section == "sensors"}


class Totals:
    """Extremes with their rows, sums and last values of columns, kept while rows pass by."""

    def __init__(self, columns: int) -> None:
        self.values = np.tile([[-np.inf], [np.inf]], columns)  # largest, smallest
        self.at = np.zeros((2, columns), dtype=int)
        self.sum, self.square, self.last = np.zeros((3, columns))

    def take(self, first: int, rows: Array) -> None:
        for k, (index, better) in enumerate(
            ((rows.argmax(0), np.greater), (rows.argmin(0), np.less))
        ):
            found = rows[index, np.arange(rows.shape[1])]
            new = better(found, self.values[k])
            self.values[k, new], self.at[k, new] = found[new], first + index[new]
        self.sum += rows.sum(axis=0)
        self.square += np.square(rows).sum(axis=0)
        self.last = rows[-1].copy()
