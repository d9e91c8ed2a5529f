"""The group /certificate: what a second, independent run says of the first one.

It is no part of the content hash, so a run is the same with and without it; it has a hash of its
own, in the same manner.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import h5py
import numpy as np

from trsim.store.content import content_hash
from trsim.store.grow import Array

GROUP = "certificate"
ROWS = 1 << 12  # rows looked at together


class Parted(NamedTuple):
    """A stretch of time in which the two runs are apart."""

    number: int
    begin: float  # s
    end: float  # s, where they are together again; nan where they never are
    rows: int
    share: float  # of its rows that are apart


class Curve(NamedTuple):
    """One channel while the runs are together."""

    channel: str
    difference: float  # largest, of the range; nan where it does not move
    range: float
    motion: bool  # has a part in where the runs part
    unit: str


class Quantity(NamedTuple):
    """One summary quantity of one component of a channel."""

    channel: str
    quantity: str  # largest, smallest, final, mean, rms
    value: float
    twin: float
    difference: float
    certain: bool  # nothing of it lies where the runs are apart
    unit: str


class Level(NamedTuple):
    """A mean over a stretch in which the runs are apart, and half of its interval."""

    window: int  # number of the stretch
    channel: str  # or contact
    quantity: str  # mean, rms, in contact (share of time)
    value: float
    twin: float
    half: float  # nan without an interval
    twin_half: float
    off_half: float  # of the interval of the difference
    verdict: str  # agree, differ; unknown without any interval
    unit: str


class Onsets(NamedTuple):
    """How often a contact closed."""

    contact: str
    impacts: int
    twin: int
    before: int  # the runs part
    twin_before: int


class Onset(NamedTuple):
    """One of the first onsets of a contact; the time of a run that has none is nan."""

    contact: str
    number: int
    time: float  # s
    twin: float  # s


class Certificate(NamedTuple):
    """All of it.  about: see cli/documents/certificate.py."""

    about: dict[str, Any]
    windows: list[Parted]
    curves: list[Curve]
    quantities: list[Quantity]
    levels: list[Level]
    contacts: list[Onsets]
    onsets: list[Onset]


TABLES: dict[str, Any] = {
    "windows": Parted, "curves": Curve, "quantities": Quantity, "levels": Level,
    "contacts": Onsets, "onsets": Onset,
}  # fmt: skip
KINDS: dict[type, Any] = {str: h5py.string_dtype(), float: "f8", int: "i8", bool: "?"}


def store(file: h5py.File, certificate: Certificate) -> None:
    """Add the group to a file whose run is complete."""
    group = file.create_group(GROUP)
    group.attrs.update(certificate.about)
    for name, row in TABLES.items():
        table, rows = group.create_group(name), getattr(certificate, name)
        for key, kind in row.__annotations__.items():
            values = np.array([getattr(one, key) for one in rows], dtype=KINDS[kind])
            table.create_dataset(key, data=values)
    group.attrs["content_sha256"] = content_hash(group)


def of(file: h5py.File) -> Certificate | None:
    """The certificate in a file, None where there is none."""
    if GROUP not in file:
        return None
    group = file[GROUP]
    about = {n: v.item() if isinstance(v, np.generic) else v for n, v in group.attrs.items()}
    del about["content_sha256"]
    return Certificate(about, *(_rows(group[name], row) for name, row in TABLES.items()))


def whole(file: h5py.File) -> bool:
    """Whether the certificate, if there is one, still is what its hash says."""
    return GROUP not in file or content_hash(file[GROUP]) == file[GROUP].attrs["content_sha256"]


def _rows(table: h5py.Group, row: Any) -> list[Any]:
    columns = [table[key] for key in row.__annotations__]
    read = [c.asstr()[:] if c.dtype == object else c[:].tolist() for c in columns]
    return [row(*values) for values in zip(*read, strict=True)]


# --- two files -------------------------------------------------------------------------------


def channels(file: h5py.File) -> dict[str, h5py.Dataset]:
    """The datasets of the output rows."""
    inner = {n: item for n, item in file.items() if isinstance(item, h5py.Dataset) and item.shape}
    return {n: d for n, d in inner.items() if n != "time" and not n.startswith("component.")}


def common_rows(one: h5py.File, two: h5py.File) -> int:
    """How many rows two runs share: as many as have the same times."""
    n = min(len(one["time"]), len(two["time"]))
    for k in range(0, n, ROWS):
        a, b = one["time"][k : min(k + ROWS, n)], two["time"][k : min(k + ROWS, n)]
        other = np.abs(a - b) > 1e-9 * np.maximum(np.abs(a), np.abs(b))
        if other.any():
            return k + int(np.argmax(other))
    return n


def pieces(
    one: h5py.File, two: h5py.File, names: list[str], begin: int, end: int
) -> Iterator[tuple[int, Array, Array]]:
    """First row, and the columns (n, m) of both runs, of stretches of the rows begin..end."""
    for k in range(begin, end, ROWS):
        rows = slice(k, min(k + ROWS, end))
        both = [np.column_stack([file[name][rows] for name in names]) for file in (one, two)]
        yield k, both[0], both[1]
