"""What the system is asked for around HDF5: room to begin, data on the disk, ways out."""

import contextlib
import os
from pathlib import Path
from tempfile import TemporaryFile

import h5py

from trsim import system
from trsim.errors import FileError

MORE = 1 << 22  # bytes, more than HDF5 writes at once
BEGINNING = 1 << 18  # bytes, more than what a file holds before its first row


def check_room(part: Path) -> None:
    """Check that a file can be begun: HDF5 ends the process where its first bytes fail."""
    try:
        with TemporaryFile(dir=part.parent) as file:  # without a name
            file.write(bytes(BEGINNING))
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        what = f"{part}: the first {BEGINNING} bytes cannot be written: {error.strerror}"
        raise FileError(what, file=str(part)) from None


def check_can_grow(path: Path) -> None:
    """Check that a file can grow; raises OSError."""
    with path.open("ab") as file:
        system.lengthen(file.fileno(), file.tell(), MORE)


def let_go(file: h5py.File) -> None:
    """Close a file that cannot be written.

    HDF5 would go on trying to write what it holds, and fail again when it is unloaded; all it
    still has to say goes to nowhere instead.  Readers find what was flushed.
    """
    if not file.id.valid:
        return
    with contextlib.suppress(OSError, RuntimeError):
        nowhere = os.open(os.devnull, os.O_RDWR)
        os.dup2(nowhere, file.id.get_vfd_handle())
        os.close(nowhere)
        file.close()


def synced(path: Path) -> None:
    """Have the system bring a file, or where it can a folder, to the disk."""
    if not system.OPENS_FOLDERS and path.is_dir():
        return
    flags = os.O_RDONLY if system.OPENS_FOLDERS else os.O_RDWR
    handle = os.open(path, flags | system.O_BINARY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
