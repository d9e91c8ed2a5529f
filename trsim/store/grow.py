"""Tables that grow while a run goes on: datasets of one length and one time scale."""

from typing import Any, NamedTuple

import h5py
import numpy as np
from h5py import h5d, h5s

from trsim.arrays import Array
from trsim.store import made
from trsim.store.made import Book, Layout

LONGEST = 4096  # rows that wait in memory, and rows of a chunk
ROOM = 4 << 20  # bytes of rows that wait in memory
AXES = {3: "component.xyz", 9: "component.rotation"}  # scale of the second dimension, by size
LABELS = {
    "component.xyz": ["x", "y", "z"],
    "component.rotation": ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
}


class Field(NamedTuple):
    """One dataset of a table, and the columns of the rows it takes."""

    name: str
    unit: str
    meaning: str
    start: int
    size: int = 1
    words: tuple[str, ...] = ()  # the column holds indices of these


class Growing:
    """Datasets that grow together.  Field 0 is the time scale of the others."""

    def __init__(self, book: Book, path: str, fields: list[Field], rows: tuple[int, int]) -> None:
        """In a group; rows: columns of the rows that come, and how many there may be."""
        self.book, self.fields, self.name = book, fields, f"/{path}"
        width, expected = rows
        self.chunk = chunk = min(LONGEST, max(64, 1 << (max(expected, 1) - 1).bit_length()))
        self.paths = paths = [f"{path}/{f.name}" if path else f.name for f in fields]
        for of in zip(paths, fields, strict=True):
            _dataset(book, *of, chunk)
        book.scale(paths[0], fields[0].name)
        axes = [(paths[0], AXES[f.size]) if f.size > 1 else (paths[0],) for f in fields]
        book.attach(list(zip(paths, axes, strict=True))[1:])
        self.room = chunk * max(1, min(LONGEST // chunk, ROOM // (8 * width * chunk)))
        self.waiting = np.empty((self.room, width))
        self.n_waiting = 0
        self.n = 0  # rows in the file
        self.held = 0  # of these, that are still the first in `waiting`; all or none

    @property
    def datasets(self) -> list[h5py.Dataset]:
        """The datasets as h5py knows them."""
        return [h5py.Dataset(self.book.item(path)) for path in self.paths]

    def append(self, rows: Array) -> None:
        """Take rows; what does not fit in memory goes to the file."""
        while len(rows):
            # whole chunks are written fastest, also after a flush at any other moment
            room = self.room - self.n % self.room
            taken = min(len(rows), room - self.n_waiting)
            self.waiting[self.n_waiting : self.n_waiting + taken] = rows[:taken]
            self.n_waiting += taken
            rows = rows[taken:]
            if self.n_waiting == room:
                self.flush()

    def flush(self) -> None:
        """Write what waits.  Broken off at any point, it can simply be called again."""
        if not self.n_waiting:
            return
        rows, n = self.waiting[: self.n_waiting], self.n + self.n_waiting
        self.held = 0 if self.n else n
        for field, path in zip(self.fields, self.paths, strict=True):
            extended(self.book.item(path), self.n, np.ascontiguousarray(_values(field, rows)))
        self.n, self.n_waiting = n, 0

    def tell(self) -> None:
        """Tell the book of the rows, where all of them are still in memory."""
        if self.held == self.n:
            for path, field in zip(self.paths, self.fields, strict=True):
                self.book.tell(path, _values(field, self.waiting[: self.n]))

    def full(self, n: int) -> int:
        """How many of n rows are in chunks that are full: those are never written again."""
        return n - n % self.chunk

    def tail(self) -> dict[str, Any]:
        """The rows in the file after them, by the names of the datasets."""
        rows = {d.name: d[self.full(self.n) : self.n] for d in self.datasets}
        # HDF5 says of texts how they are coded, and numpy would say that it does not keep that
        return {name: values.view(values.dtype.str) for name, values in rows.items()}


def components(channel: str, size: int) -> list[str]:
    """The names of the columns of a channel: its own, .x .y .z, or .xx .xy ... of a rotation."""
    if size == 1:
        return [channel]
    return [f"{channel}.{label}" for label in LABELS.get(AXES.get(size, ""), range(size))]


def scales(book: Book, sizes: set[int]) -> None:
    """The scales of components, for the sizes of channels that are there."""
    for size in sorted(sizes & set(AXES)):
        path = book.values(AXES[size], LABELS[AXES[size]])
        book.attribute(path, "long_name", "component")
        book.scale(path, path)


def _dataset(book: Book, path: str, field: Field, chunk: int) -> None:
    """An empty dataset that grows."""
    shape = () if field.size == 1 else (field.size,)
    dtype = f"S{max(map(len, field.words))}" if field.words else "f8"
    unwritten = 0.0 if field.words else np.nan  # a row that was never written says so
    book.dataset(path, dtype, Layout((0, *shape), (chunk, *shape), unwritten, dated=True))
    told = {"units": field.unit, "long_name": field.meaning}
    book.attributes(path, {name: text for name, text in told.items() if text})


def extended(item: h5d.DatasetID, n: int, values: Any) -> None:
    """Put rows behind the first n of a dataset."""
    item.set_extent((n + len(values), *values.shape[1:]))
    memory, place = h5s.ALL, h5s.ALL
    if n:
        memory, place = h5s.create_simple(values.shape), item.get_space()
        place.select_hyperslab((n, *[0] * (values.ndim - 1)), values.shape)
    item.write(memory, place, values, made.memory(values.dtype))


def _values(field: Field, rows: Array) -> Any:
    if field.words:
        return np.array(field.words, "S")[rows[:, field.start].astype(int)]
    if field.size == 1:
        return rows[:, field.start]
    return rows[:, field.start : field.start + field.size]
