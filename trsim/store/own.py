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
        handle = os.open(path, os.O_RDONLY | system.O_NOFOLLOW | system.O_NONBLOCK)
    except FileNotFoundError:
        return False
    except OSError as error:
        why = "it is a link" if path.is_symlink() else error.strerror
        raise FileError(f"{path} is in the way: {why}", ASIDE, file=str(path)) from None
    try:
        check_open(handle, path)
        start = system.beginning(handle, BEGINNING)
    finally:
        os.close(handle)
    if not kind.fits(start):
        raise FileError(f"{path} exists and is not a {kind.name}", ASIDE, file=str(path))
    return True


def check_open(handle: int, path: Path) -> None:
    """Raise FileError unless an open file is an ordinary one, known by no second name."""
    found = os.fstat(handle)
    if not stat.S_ISREG(found.st_mode):
        why = f"it is {what_it_is(found.st_mode)}"
        raise FileError(f"{path} is in the way: {why}", ASIDE, file=str(path))
    if found.st_nlink > 1:
        what = f"{path} is in the way: it is another name of a file elsewhere"
        raise FileError(what, ASIDE, file=str(path))


def remove(path: Path, kind: Kind) -> None:
    """Remove a file of ours, if it is there.  Raises FileError where there is anything else."""
    if exists(path, kind):
        path.unlink(missing_ok=True)


def made(path: Path, kind: Kind) -> int:
    """The handle of a new file, in place of one of ours.  Raises FileError, OSError."""
    remove(path, kind)
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | system.O_NOFOLLOW, 0o666)
