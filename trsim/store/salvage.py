"""The tables of a broken file, cut to what is whole, written into another file."""

from contextlib import suppress
from typing import Any, NamedTuple

import h5py
import numpy as np

from trsim.arrays import Array
from trsim.store import rows, torn
from trsim.store.grow import AXES, scales
from trsim.store.made import Book
from trsim.store.peaks import Peak, both_ways
from trsim.store.peaks import store as store_peaks
from trsim.store.read import reached
from trsim.store.tables import AT_EVENTS, MAY_BE_NAN

ROWS = 1 << 14  # rows handled together
SECTIONS = {"joints", "drives", "forces", "sensors"}
KEPT = ("scenario", "mechanism", "solver", "provenance")  # groups of small things, copied whole
SCALE = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}


class Extremes(NamedTuple):
    """Largest and smallest values of the components of one dataset, and their rows' times."""

    high: Array
    high_time: Array
    low: Array
    low_time: Array


class Salvage:
    """Copies a source into an empty file."""

    def __init__(self, source: h5py.File, file: h5py.File) -> None:
        self.source, self.file, self.book = source, file, Book(file)
        self.extremes: dict[str, Extremes] = {}  # dataset -> its extremes
        self.rows: dict[str, int] = {}  # group -> rows

    def copy(self) -> None:
        """Everything but portraits, impact maps and orbits, which follow from the rest."""
        source, file = self.source, self.file
        file.attrs.update({k: v for k, v in source.attrs.items() if k != "content_sha256"})
        for name in KEPT:
            source.copy(name, file)
        scales(self.book, {size for size, name in AXES.items() if name in source})
        self._table(source, file)
        groups = ["events", *(name for name in AT_EVENTS if name in source)]
        groups += [f"{part}/{name}" for part in ("steps", "poincare") for name in source[part]]
        for group in groups:
            made, told = file.create_group(group), source[group].attrs.items()
            made.attrs.update({k: v for k, v in told if not k.startswith("dispersion")})
            self._table(source[group], made)
        file.require_group("steps")
        file.create_group("summary")
        self._peaks()

    def _table(self, source: h5py.Group, group: h5py.Group) -> None:
        """Copy the datasets with a time scale, as far as they are whole."""
        found = {n: d for n, d in source.items() if isinstance(d, h5py.Dataset)}
        items = {"time": source["time"]}
        items |= {n: d for n, d in found.items() if not n.startswith("component.")}
        copies = {name: _empty(item, group, name) for name, item in items.items()}
        names = {name: copied.name[1:] for name, copied in copies.items()}
        last, n = -np.inf, 0
        while True:
            piece = _piece(items, source.name == "/", n, last)
            count = len(piece["time"])
            for name, values in piece.items() if count else ():
                copies[name].resize(n + count, axis=0)
                copies[name][n:] = values
                if values.dtype.kind == "f":
                    self._extreme(names[name], values, piece["time"])
            n += count
            if count < ROWS:
                break
            last = piece["time"][-1]
        self.rows[group.name] = n
        time = copies.pop("time")
        time.make_scale("time")
        for copied in copies.values():
            copied.dims[0].attach_scale(time)
            if copied.ndim == 2:
                copied.dims[1].attach_scale(self.file[AXES[copied.shape[1]]])

    def _extreme(self, name: str, values: Array, time: Array) -> None:
        table = values.reshape(len(values), -1)
        k, j = table.argmax(0), table.argmin(0)
        each = np.arange(table.shape[1])
        now = Extremes(table[k, each], time[k], table[j, each], time[j])
        old = self.extremes.get(name, now)
        up, down = now.high > old.high, now.low < old.low
        self.extremes[name] = Extremes(
            np.where(up, now.high, old.high), np.where(up, now.high_time, old.high_time),
            np.where(down, now.low, old.low), np.where(down, now.low_time, old.low_time),
        )  # fmt: skip

    # --- what a complete run would have said ------------------------------------------------

    def _peaks(self) -> None:
        """The peaks of the solver if it came so far, otherwise those of the rows."""
        if "value" in self.source["peaks"]:
            self.book.group("peaks")
            store_peaks(self.book, rows.stored(self.source["peaks"], Peak))
            return
        self.book.group("peaks")
        inside = self.file["mechanism"]
        sections = inside["section"].asstr()[:]
        told = {n for n, s in zip(inside["name"].asstr()[:], sections, strict=True)
                if s in SECTIONS}  # fmt: skip
        found: list[Peak] = []
        for name, e in self.extremes.items():
            if "/" not in name and name.split(".")[0] in told and len(e.high) in (1, 3):
                unit = str(self.file[name].attrs.get("units", "-"))
                found += both_ways(name, unit, np.transpose(e))
        store_peaks(self.book, found)
        self.book.attribute("peaks", "extremes", "of the output rows")

    def summary(self) -> dict[str, Any]:
        """The recovered run in a few numbers."""
        events, contacts = self.file["events"], {}
        element, kind = events["element"].asstr()[:], events["kind"].asstr()[:]
        for name in self.file["steps"]:
            onset = (element == name) & (kind == "onset")
            speed = events["speed"][:][onset]
            peak = self.extremes.get(f"steps/{name}/contact_force")
            peak = peak or self.extremes.get(f"steps/{name}/normal_force")
            contacts[name] = {
                "impacts": int(np.count_nonzero(onset)),
                "fastest_impact": float(speed.max(initial=0.0)),
                "peak_force": float(peak.high[0]) if peak else 0.0,
                "peak_time": float(peak.high_time[0]) if peak else 0.0,
                "steps": self.rows[f"/steps/{name}"],
            }
        return {
            "title": str(self.file.attrs["title"]),
            "time": reached(self.file),
            "rows": self.rows["/"],
            "events": self.rows["/events"],
            "contacts": contacts,
        }


def _empty(item: h5py.Dataset, group: h5py.Group, name: str) -> h5py.Dataset:
    """A dataset like `item`, without rows."""
    made = group.create_dataset(
        name, (0, *item.shape[1:]), maxshape=(None, *item.shape[1:]), chunks=item.chunks,
        dtype=item.dtype, fletcher32=True,
    )  # fmt: skip
    made.attrs.update({k: v for k, v in item.attrs.items() if k not in SCALE})
    return made


def _piece(
    items: dict[str, h5py.Dataset], alone: bool, begin: int, last: float
) -> dict[str, Any]:  # fmt: skip
    """The next rows that are whole in all datasets, at most ROWS.

    alone: no two rows are at one time.
    """
    end = min(begin + ROWS, *map(len, items.values()), begin + ROWS)
    piece: dict[str, Any] = {}
    for name, item in items.items():
        piece[name] = values = _readable(item, begin, end)
        end = begin + len(values)
    n = max(end - begin, 0)
    time = piece["time"][:n]
    later = np.diff(time, prepend=last)
    # of output rows no two are at one time; several events may happen at once, and be recorded, and
    # a step that ends at a corner may be shorter than the time resolves
    n = _first(~(later > 0.0) if alone else ~(later >= 0.0), n)
    for name, values in piece.items():
        if name in MAY_BE_NAN:
            continue
        rows = values[:n].reshape(n, int(np.prod(values.shape[1:])))
        # a row that was never written; a text is empty then, see tables.KINDS
        unwritten = np.isnan(rows) if values.dtype.kind == "f" else rows == b""
        n = _first(unwritten.any(axis=1), n)
    return {name: values[:n] for name, values in piece.items()}


def _readable(item: h5py.Dataset, begin: int, end: int) -> Any:
    """Rows up to the first chunk that cannot be read."""
    with suppress(OSError):
        return torn.rows(item, begin, max(begin, end))
    good, step = begin, item.chunks[0]
    with suppress(OSError):
        for k in range(begin, end, step):
            torn.rows(item, k, min(k + step, end))
            good = min(k + step, end)
    return torn.rows(item, begin, good)


def _first(bad: Any, n: int) -> int:
    """The index of the first true value, n without one."""
    return int(np.argmax(bad)) if bad.any() else n
