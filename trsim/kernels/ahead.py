"""Compiling in two processes, each function by one of them.

The solver and its equations call each other by address, so they are compiled independently: on two
processors a first run takes little more than half the time.  This module, run with names of modules
on its command line (child.py), compiles those of their functions that nobody else is at, and leaves
their machine code in the cache.  It ends with the process that began it.
"""

import fcntl
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from threading import Thread

from trsim import child
from trsim.kernels import kept

_at_work: list[subprocess.Popen] = []  # kept: the other end of their standard input


def begin(*modules: str) -> None:
    """Start compiling modules, where there is a second processor for it."""
    if len(os.sched_getaffinity(0)) < 2:
        return
    command = child.command("trsim.kernels.ahead", *modules)
    quiet = subprocess.DEVNULL
    _at_work.append(
        subprocess.Popen(  # noqa: S603
            command, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet, start_new_session=True
        )
    )


@contextmanager
def turn(lock: Path, key: str, wait: bool = True) -> Iterator[bool]:
    """While one process is at a key the others wait; True: the turn is ours.

    The system takes the lock, a byte of a file, from a process that dies.  Where files cannot be
    locked everybody compiles for himself.
    """
    try:
        kept.make(lock.parent)
        handle = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
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
        fcntl.lockf(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB), 1, place)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:
        return True
    return True


def _end_with_parent() -> None:
    """End when standard input does, in the middle of compiling or not."""
    with suppress(OSError):
        sys.stdin.buffer.read()
    os._exit(0)


def main() -> None:
    """Compile the modules named on the command line."""
    from trsim.kernels.machine import Compiled

    Thread(target=_end_with_parent, daemon=True).start()
    for module in map(import_module, sys.argv[1:]):
        for value in vars(module).values():
            if isinstance(value, Compiled) and value.python.__module__ == module.__name__:
                value.keep()
    os._exit(0)  # the thread holds standard input, which Python would wait for in vain


if __name__ == "__main__":
    main()
