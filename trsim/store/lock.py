"""One writer for a result file: X.h5.lock beside it holds the number of the process.

The system gives the lock (flock) back when a process ends, however it ends: a file that was left
behind locks nothing.  Where files cannot be locked at all, nothing is.
"""

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import wraps
from pathlib import Path
from typing import Concatenate, ParamSpec, TypeVar

from trsim import system
from trsim.errors import FileError
from trsim.store.own import check_open, in_the_way
from trsim.store.target import LOCK, file_errors, make

ENDING = ".lock"
ATTEMPTS, PAUSE = 3, 0.03  # s
P = ParamSpec("P")
T = TypeVar("T")


def alone(
    function: Callable[Concatenate[str | os.PathLike, P], T],
) -> Callable[Concatenate[str | os.PathLike, P], T]:
    """`function(path, ...)` as the only one, of all processes, that writes this result file."""

    @wraps(function)
    def locked(path: str | os.PathLike, *rest: P.args, **named: P.kwargs) -> T:
        with writing(Path(path)):
            return function(path, *rest, **named)

    return locked


@contextmanager
def writing(final: Path) -> Iterator[None]:
    """Hold the lock of a result file.  Raises FileError where another process does."""
    path = _beside(final)
    with file_errors(final):
        make(final.parent)
        handle = _held(path, final)
    try:
        with suppress(OSError):  # a full disk: the number is only for messages
            os.truncate(handle, 0)
            os.write(handle, b"%d\n" % os.getpid())
        yield
    finally:
        with suppress(OSError):
            path.unlink()
        os.close(handle)
        if not system.LOCKS:  # where nobody can have it; an open file may not be removed there
            path.unlink(missing_ok=True)


def refuse_if_written(final: Path) -> None:
    """Raise FileError if a process is writing a result file."""
    try:
        handle = system.opened(_beside(final), os.O_RDONLY | system.O_NONBLOCK)
    except OSError:
        return
    try:
        _lock(handle, final, shared=True)
    finally:
        os.close(handle)


def _held(path: Path, final: Path) -> int:
    """A locked handle of the file that has the name: its last owner may just have removed it."""
    while True:
        if path.is_symlink() or path.is_dir():
            raise in_the_way(path, "it is a link" if path.is_symlink() else "it is a folder")
        handle = system.opened(path, os.O_RDWR | os.O_CREAT)
        try:
            check_open(handle, path, LOCK)
            _lock(handle, final)
            if os.path.samestat(os.fstat(handle), os.stat(path)):
                return handle
        except FileNotFoundError:
            pass
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)


def _lock(handle: int, final: Path, shared: bool = False) -> None:
    """Take a lock; who looks whether there is one holds it for a moment, hence the attempts."""
    for _ in range(ATTEMPTS):
        try:
            system.lock(handle, shared)
            return
        except BlockingIOError:
            time.sleep(PAUSE)
        except OSError:
            return
    number = system.beginning(handle, 20).decode(errors="replace").strip()
    who = f"process {number}" if number.isdigit() else "another process"
    hint = "Wait for it, or name another file with -o."
    raise FileError(f"{final} is being written by {who}", hint, file=str(final))


def _beside(final: Path) -> Path:
    return final.with_name(final.name + ENDING)
