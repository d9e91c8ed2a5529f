"""Files beside a result: part, checkpoint, lock.  Only what trsim made is replaced or removed.

Each has a fixed name, so something else may have it: a file of the user's, or a link that leads
to one.  They are made without following links; what has the name already is taken for ours if it is
an ordinary file, known by no second name, that begins as ours do.
"""

import os
import stat
from pathlib import Path

from trsim import system
from trsim.errors import FileError, what_it_is
from trsim.store.target import BEGINNING, Kind

ASIDE = "Move it away, or name another file with -o."


def exists(path: Path, kind: Kind) -> bool:
    """Whether there is a file of ours.  Raises FileError where there is anything else."""
    try:
        handle = system.opened(path, os.O_RDONLY | system.O_NONBLOCK)
    except FileNotFoundError:
        return False
    except OSError as error:
        raise in_the_way(path, "it is a link" if path.is_symlink() else error.strerror) from None
    try:
        check_open(handle, path, kind)
    finally:
        os.close(handle)
    return True


def check_open(handle: int, path: Path, kind: Kind) -> None:
    """Raise FileError unless an open file is one of ours."""
    found = os.fstat(handle)
    if not stat.S_ISREG(found.st_mode):
        raise in_the_way(path, f"it is {what_it_is(found.st_mode)}")
    if found.st_nlink > 1:
        raise in_the_way(path, "it is another name of a file elsewhere")
    if not kind.fits(system.beginning(handle, BEGINNING)):
        raise FileError(f"{path} exists and is not a {kind.name}", ASIDE, file=str(path))


def in_the_way(path: Path, why: str | None) -> FileError:
    return FileError(f"{path} is in the way: {why}", ASIDE, file=str(path))


def remove(path: Path, kind: Kind) -> None:
    """Remove a file of ours, if it is there.  Raises FileError where there is anything else."""
    if exists(path, kind):
        path.unlink(missing_ok=True)


def made(path: Path, kind: Kind) -> int:
    """The handle of a new file, in place of one of ours.  Raises FileError, OSError."""
    remove(path, kind)
    return system.opened(path, os.O_RDWR | os.O_CREAT | os.O_EXCL)
