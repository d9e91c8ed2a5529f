"""Tables that grow while a run goes on: datasets of one length and one time scale."""

from typing import Any, NamedTuple

import h5py
import numpy as np
from h5py import h5a, h5d, h5p, h5s, h5t

from trsim.arrays import Array

LONGEST = 4096  # rows that wait in memory, and rows of a chunk
ROOM = 4 << 20  # bytes of rows that wait in memory
TEXT, SCALAR = h5py.string_dtype(), h5s.create(h5s.SCALAR)
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

    def __init__(self, group: h5py.Group, fields: list[Field], width: int, expected: int) -> None:
        """width: columns of the rows; expected: how many rows there may be."""
        self.fields, self.name = fields, group.name
        self.chunk = chunk = min(LONGEST, max(64, 1 << (max(expected, 1) - 1).bit_length()))
        self.datasets = [_dataset(group, field, chunk) for field in fields]
        time = self.datasets[0]
        time.make_scale(fields[0].name)
        for field, dataset in zip(fields[1:], self.datasets[1:], strict=True):
            dataset.dims[0].attach_scale(time)
            if field.size > 1:
                dataset.dims[1].attach_scale(group.file[AXES[field.size]])
        self.room = chunk * max(1, min(LONGEST // chunk, ROOM // (8 * width * chunk)))
        self.waiting = np.empty((self.room, width))
        self.n_waiting = 0
        self.n = 0  # rows in the file

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
        for field, dataset in zip(self.fields, self.datasets, strict=True):
            extended(dataset, self.n, np.ascontiguousarray(_values(field, rows)))
        self.n, self.n_waiting = n, 0

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


def scales(file: h5py.File, sizes: set[int]) -> None:
    """The scales of components, for the sizes of channels that are there."""
    for size in sorted(sizes & set(AXES)):
        name = AXES[size]
        file[name] = np.array(LABELS[name], dtype=h5py.string_dtype())
        file[name].attrs["long_name"] = "component"
        file[name].make_scale(name)


def _dataset(group: h5py.Group, field: Field, chunk: int) -> h5py.Dataset:
    """An empty dataset that grows.  A run may have hundreds, which h5py's own way makes slow."""
    shape = () if field.size == 1 else (field.size,)
    kind = np.dtype(f"S{max(map(len, field.words))}" if field.words else "f8")
    plan = h5p.create(h5p.DATASET_CREATE)
    plan.set_chunk((chunk, *shape))
    plan.set_fletcher32()
    if not field.words:
        plan.set_fill_value(np.array(np.nan))  # a row that was never written says so
    space = h5s.create_simple((0, *shape), (h5s.UNLIMITED, *shape))
    made = h5d.create(group.id, field.name.encode(), h5t.py_create(kind, logical=True), space, plan)
    for name, text in ((b"units", field.unit), (b"long_name", field.meaning)):
        if text:
            attribute = h5a.create(made, name, h5t.py_create(TEXT, logical=True), SCALAR)
            attribute.write(np.array(text, TEXT))
    return h5py.Dataset(made)


def extended(dataset: h5py.Dataset, n: int, values: Any) -> None:
    """Put rows behind the first n of a dataset."""
    dataset.id.set_extent((n + len(values), *values.shape[1:]))
    space = dataset.id.get_space()
    space.select_hyperslab((n, *[0] * (values.ndim - 1)), values.shape)
    dataset.id.write(h5s.create_simple(values.shape), space, values)


def _values(field: Field, rows: Array) -> Any:
    if field.words:
        return np.array(field.words, "S")[rows[:, field.start].astype(int)]
    if field.size == 1:
        return rows[:, field.start]
    return rows[:, field.start : field.start + field.size]
