"""Compiling ahead, in a second process, what is needed after what is compiled here.

The solver calls the equations and the elements by address, so it does not wait for them: on two
processors a first run takes little more than half the time.  `python -m trsim.elements.ahead
MODULE...` compiles every function of some modules and leaves their machine code in the cache.
"""

import os
import subprocess
import sys
from importlib import import_module

_at_work: dict[str, subprocess.Popen] = {}  # module -> the process that compiles it


def begin(*modules: str) -> None:
    """Start compiling modules, where there is a second processor for it."""
    if len(os.sched_getaffinity(0)) < 2:
        return
    command = [sys.executable, "-m", "trsim.elements.ahead", *modules]
    quiet = subprocess.DEVNULL
    process = subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet)  # noqa: S603
    _at_work.update(dict.fromkeys(modules, process))


def finished(module: str) -> bool:
    """Wait for a module that is being compiled; False where it is not."""
    process = _at_work.pop(module, None)
    if process is None:
        return False
    process.wait()
    return True


def main() -> None:
    """Compile the modules named on the command line."""
    from trsim.elements.machine import Compiled

    for module in map(import_module, sys.argv[1:]):
        for value in vars(module).values():
            if isinstance(value, Compiled) and value.python.__module__ == module.__name__:
                value.address()


if __name__ == "__main__":
    main()
