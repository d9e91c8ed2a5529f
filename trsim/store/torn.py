"""Rows of a table whose last chunk is torn: its writer was killed while it wrote it once more.

A chunk that is not full is written again at every flush, where it is, with more rows and another
checksum behind them.  A kill may end the system's call after any page, and a reader may come
between two pages: HDF5 then finds a wrong checksum and gives no row of the chunk.

    before    rows 0 .. m   fill values ..........   checksum of this
    torn      rows 0 .. m   new rows, perhaps half of one, fill values   checksum of `before`

The first m rows are the same bytes in both, and the checksum proves them: with the right m, and
fill values in place of what follows, it is right.  These are the rows of the last flush, of which
there are some: room for rows is made by a flush before.

Only a file that is still written to, or was when its writer ended, has such chunks; elsewhere a
wrong checksum is damage.
"""

from typing import Any

import h5py
import numpy as np
from h5py import h5s, h5z
from numpy.typing import NDArray

from trsim.store import made

BASE = 65535  # of fletcher32, whose two sums have 16 bits each
CHECKSUM = 4  # bytes
ATTEMPTS = 5  # a writer that is alive is done with a chunk before it is read again


def rows(dataset: h5py.Dataset, begin: int, end: int) -> Any:
    """Rows of a table that grew; those that were lost to a torn chunk are fill values.

    Raises OSError where a chunk is not as any flush left it.
    """
    try:
        item, shape = dataset.id, dataset.shape
        if begin or not shape or not 0 < shape[0] <= end or not item.get_type().equal(made.NUMBERS):
            return dataset[begin:end]
        whole = np.empty(shape)  # as most are read; h5py's way takes longer than HDF5 does
        item.read(h5s.ALL, h5s.ALL, whole, made.NUMBERS)
        return whole
    except OSError:
        writing = dataset.file.attrs.get("status") == "running"
        if not (writing and dataset.chunks and dataset.fletcher32):
            raise
    size, end = dataset.chunks[0], min(end, len(dataset))
    found = np.empty((end - begin, *dataset.shape[1:]), dataset.dtype)
    for k in range(begin - begin % size, end, size):
        a, b = max(k, begin), min(k + size, end)
        found[a - begin : b - begin] = _chunk(dataset, k)[a - k : b - k]
    return found


def _chunk(dataset: h5py.Dataset, begin: int) -> Any:
    """The chunk from a row on.  Raises OSError where it is damaged."""
    refused = OSError()
    for _ in range(ATTEMPTS):
        try:
            return dataset[begin : begin + dataset.chunks[0]]
        except OSError as error:
            refused, mended = error, _mended(dataset, begin)
            if mended is not None:
                return mended
    raise refused


def _mended(dataset: h5py.Dataset, begin: int) -> NDArray[Any] | None:
    """A torn chunk as the flush before left it; None where its checksum proves nothing."""
    plan = dataset.id.get_create_plist()
    if plan.get_nfilters() != 1 or plan.get_filter(0)[0] != h5z.FILTER_FLETCHER32:
        return None
    _, stored = dataset.id.read_direct_chunk((begin, *(0,) * (dataset.ndim - 1)))
    fill = np.full(dataset.chunks, dataset.fillvalue, dataset.dtype)
    if len(stored) != fill.nbytes + CHECKSUM:
        return None
    values = np.frombuffer(stored[:-CHECKSUM], dataset.dtype).reshape(fill.shape)
    width = fill.nbytes // len(fill)  # bytes of a row
    there, filled = _sums(values)[:, ::width], _sums(fill)[:, ::width]
    sums = there + filled[:, -1:] - filled  # (2, m): of m rows and fill values
    told = int.from_bytes(stored[-CHECKSUM:], "little")
    of = np.array([[told & 0xFFFF], [told >> 16]])
    right = np.flatnonzero(((sums - of) % BASE == 0).all(axis=0))
    if not len(right) or right[-1] == 0:  # nothing before proves nothing
        return None
    return np.concatenate([values[: right[-1]], fill[right[-1] :]])


def _sums(values: NDArray[Any]) -> NDArray[np.int64]:
    """Both sums of fletcher32, of all beginnings of some bytes, (2, 1 + bytes)."""
    data = np.frombuffer(values.tobytes(), np.uint8).astype(np.int64)
    place = np.arange(len(data))
    words = (len(data) + 1) // 2
    first = data * np.where(place % 2, 1, 256)  # words of two bytes, the high one first
    found = np.zeros((2, 1 + len(data)), np.int64)
    np.cumsum([first, first * (words - place // 2)], axis=1, out=found[:, 1:])
    return found
