"""The group /certificate: what a second, independent run says of the first one.

It is no part of the content hash, so a run is the same with and without it; it has a hash of its
own, in the same manner.
"""

from typing import Any, Literal, NamedTuple

import h5py
import numpy as np

from trsim.store import rows, torn
from trsim.store.content import content_hash
from trsim.store.made import Book
from trsim.store.points import plain

GROUP = "certificate"
ROWS = 1 << 12  # rows looked at together


class Parted(NamedTuple):
    """A stretch of time in which the two runs are apart.

    number  from 1
    begin   s
    end     s, where they are together again; none where they never are
    rows    output rows in it
    share   of these rows, that are apart
    """

    number: int
    begin: float
    end: float
    rows: int
    share: float


class Curve(NamedTuple):
    """One channel while the two runs are together.

    channel     name
    difference  largest, over the range; none where the channel does not move
    range       largest less smallest value, of all components the largest, SI
    motion      whether it has a part in where the two are apart
    unit        SI
    """

    channel: str
    difference: float
    range: float
    motion: bool
    unit: str


class Quantity(NamedTuple):
    """One summary quantity of one component of a channel.

    channel     with its component
    quantity    which one; extremes are of output rows and, where kept, of accepted steps
    value       of the run
    twin        of the twin
    difference  value less that of the twin
    certain     whether nothing of it lies where the two are apart
    unit        SI
    """

    channel: str
    quantity: Literal["largest", "smallest", "final", "mean", "rms"]
    value: float
    twin: float
    difference: float
    certain: bool
    unit: str


class Level(NamedTuple):
    """A mean over a stretch in which the two are apart, with 95 % intervals from batch means.

    window     number of the stretch
    channel    with its component; of `in contact` the joint or stop
    quantity   which one; `in contact` is the share of time
    value      of the run
    twin       of the twin
    half       of the interval of the run; none without one
    twin_half  of the interval of the twin; none without one
    off_half   of the interval of their difference; none without one
    verdict    agree where an interval covers the difference, or that is below 1 % of both
    unit       SI
    """

    window: int
    channel: str
    quantity: Literal["mean", "rms", "in contact"]
    value: float
    twin: float
    half: float
    twin_half: float
    off_half: float
    verdict: Literal["agree", "differ", "unknown"]
    unit: str


class Onsets(NamedTuple):
    """How often a contact closed.

    contact      joint or stop
    impacts      of the run
    twin         of the twin
    before       of the run, before the two part
    twin_before  of the twin, before the two part
    """

    contact: str
    impacts: int
    twin: int
    before: int
    twin_before: int


class Onset(NamedTuple):
    """One of the first onsets of a contact.

    contact  joint or stop
    number   from 1
    time     of the run, s; none where it has none
    twin     of the twin, s; none where it has none
    """

    contact: str
    number: int
    time: float
    twin: float


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


def store(file: h5py.File, certificate: Certificate) -> None:
    """Add the group to a file whose run is complete."""
    book = Book(file)
    book.attributes(book.group(GROUP), certificate.about)
    for name, row in TABLES.items():
        rows.store(book, book.group(f"{GROUP}/{name}"), row, getattr(certificate, name))
    book.attribute(GROUP, "content_sha256", content_hash(file[GROUP]))


def of(file: h5py.File) -> Certificate | None:
    """The certificate in a file, None where there is none."""
    if GROUP not in file:
        return None
    group = file[GROUP]
    about = plain(group.attrs)
    del about["content_sha256"]
    return Certificate(about, *(rows.stored(group[name], row) for name, row in TABLES.items()))


def whole(file: h5py.File) -> bool:
    """Whether the certificate, if there is one, still is what its hash says."""
    return GROUP not in file or content_hash(file[GROUP]) == file[GROUP].attrs["content_sha256"]


# --- two files -------------------------------------------------------------------------------


def channels(file: h5py.File) -> dict[str, h5py.Dataset]:
    """The datasets of the output rows."""
    inner = {n: item for n, item in file.items() if isinstance(item, h5py.Dataset) and item.shape}
    return {n: d for n, d in inner.items() if n != "time" and not n.startswith("component.")}


def common_rows(one: h5py.File, two: h5py.File) -> int:
    """How many rows two runs share: as many as have the same times."""
    n = min(len(one["time"]), len(two["time"]))
    for k in range(0, n, ROWS):
        a, b = (torn.rows(file["time"], k, min(k + ROWS, n)) for file in (one, two))
        other = np.abs(a - b) > 1e-9 * np.maximum(np.abs(a), np.abs(b))
        if other.any():
            return k + int(np.argmax(other))
    return n
