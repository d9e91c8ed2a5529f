"""Files without rows, as they are when a run begins.

Runs with the same channels, contacts and events begin with the same file, but for what is
simulated.  Where a process writes many, as a sweep does, the bytes of one are those of the others:
to make its objects anew takes half of the time of a short run's file.
"""

import os
from pathlib import Path

import h5py

from trsim.store import own
from trsim.store.disk import let_go
from trsim.store.made import Book
from trsim.store.target import PART

LIBVER = ("v110", "v110")  # the first with SWMR: every HDF5 since 1.10 reads it
CACHE = 128 << 10  # bytes of chunks kept per dataset
MOST = 16  # files that are kept
LARGEST = 1 << 20  # bytes of one
kept: dict[
    bytes, bytes
] = {}  # digest of a book -> bytes, none of what was made once; last used last


def begun(path: Path, book: Book) -> h5py.File:
    """A new file with what waits in a book."""
    handle = own.made(path, PART)  # HDF5 would follow a link
    file = None
    try:
        digest = book.digest()
        known, whole = digest in kept, kept.pop(digest, b"")
        with os.fdopen(handle, "wb") as empty:
            empty.write(whole)
        if whole:
            file = _opened(path, "r+")
            book.go_on(file)
        else:
            file = _opened(path, "w")
            book.put(file)
            if known:  # there will be more of them
                file.close()
                whole = path.read_bytes()
                file = _opened(path, "r+")
                book.go_on(file)
    except BaseException:
        if file is not None:
            let_go(file)
        path.unlink(missing_ok=True)
        raise
    kept[digest] = whole if len(whole) <= LARGEST else b""
    while len(kept) > MOST:
        kept.pop(next(iter(kept)), None)
    return file


def _opened(path: Path, mode: str) -> h5py.File:
    return h5py.File(path, mode, libver=LIBVER, rdcc_nbytes=CACHE)
