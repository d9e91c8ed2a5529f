"""Who compiles what: one function by one process, told by locks on bytes of a file."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from trsim import system
from trsim.kernels import kept


@contextmanager
def turn(lock: Path, key: str, wait: bool = True) -> Iterator[bool]:
    """While one process is at a key the others wait; True: the turn is ours.

    The system takes the lock, a byte of a file, from a process that dies.  Where files cannot be
    locked everybody compiles for himself.
    """
    try:
        kept.make(lock.parent)
        handle = system.opened(lock, os.O_RDWR | os.O_CREAT, 0o600)
    except OSError:
        yield True
        return
    try:
        yield _locked(handle, int(key[:15], 16), wait)
    finally:
        os.close(handle)


def _locked(handle: int, place: int, wait: bool) -> bool:
    """Whether one byte of a file is ours, or cannot be anybody's."""
    try:
        system.lock_byte(handle, place, wait)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:
        return True
    return True
