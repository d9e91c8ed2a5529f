"""Compiling in two processes, each function by one of them.

The solver and its equations call each other by address, so they are compiled independently: on two
processors a first run takes little more than half the time.  This module, run with names of modules
on its command line (child.py), compiles those of their functions that nobody else is at, and leaves
their machine code in the cache.  It ends with the process that began it.
"""

import os
import subprocess
import sys
from contextlib import suppress
from importlib import import_module
from threading import Thread

from trsim import child, system
from trsim.kernels.lazy import PYTHON
from trsim.kernels.machine import Compiled

_at_work: list[subprocess.Popen] = []  # kept: the other end of their standard input


def begin(*modules: str) -> None:
    """Start compiling modules, where there is a second processor for it."""
    if PYTHON or system.processors() < 2:
        return
    command = child.command("trsim.kernels.ahead", *modules)
    quiet = subprocess.DEVNULL
    _at_work.append(
        subprocess.Popen(  # noqa: S603
            command, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet, start_new_session=True
        )
    )


def _end_with_parent() -> None:
    """End when standard input does, in the middle of compiling or not."""
    with suppress(OSError):
        sys.stdin.buffer.read()
    os._exit(0)


def main() -> None:
    """Compile the modules named on the command line."""
    Thread(target=_end_with_parent, daemon=True).start()
    for module in map(import_module, sys.argv[1:]):
        for value in vars(module).values():
            if isinstance(value, Compiled) and value.python.__module__ == module.__name__:
                value.keep()
    os._exit(0)  # the thread holds standard input, which Python would wait for in vain


if __name__ == "__main__":
    main()
