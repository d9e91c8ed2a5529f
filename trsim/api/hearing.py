"""Who is told what happens while something is done: messages, warnings, how far it is.

From Python messages go to the log `trsim`, and warnings are Python's.  The command line prints both
and shows how far a run is.
"""

import sys
import warnings
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any, Protocol

from trsim.errors import TrsimError, TrsimWarning, one_line


class Meter(Protocol):
    """How far something is."""

    def update(self, done: float, told: str, line: str = "") -> None: ...

    def close(self) -> None: ...


class Cases(Protocol):
    """How far a sweep is."""

    def ended(self, one: Any) -> None: ...

    def close(self) -> None: ...


class Unshown:
    """Nobody looks how far it is."""

    def update(self, done: float, told: str, line: str = "") -> None:
        pass

    def ended(self, one: Any) -> None:
        pass

    def close(self) -> None:
        pass


class Listener:
    """Hears as a program in Python does.

    command  what began the work, as the result file says
    again    what goes on with it once it was broken off
    """

    command = again = ""
    quiet = False  # whether messages are of no use

    def __init__(self) -> None:
        self.warned: set[str] = set()

    def say(self, text: str) -> None:
        """A message, a line."""
        import logging  # not for a command, which prints

        logging.getLogger("trsim").info("%s", one_line(text))

    def warn(self, about: str, text: str) -> None:
        """A warning; one that was said is not said again."""
        message = one_line(f"{about}: {text}")
        if message not in self.warned:
            warnings.warn(message, TrsimWarning, stacklevel=outside())
        self.warned.add(message)

    def lost(self, error: TrsimError) -> None:
        """Something went wrong that does not end the work."""
        warnings.warn(error.show(), TrsimWarning, stacklevel=outside())

    def doing(self, name: str) -> AbstractContextManager[Callable[[str], None]]:
        """What is called with each thing that is begun."""
        return nullcontext(lambda text: None)

    def meter(self, name: str, total: float) -> Meter:
        """What is told how far something is; total: what that comes to."""
        return Unshown()

    def cases(self, name: str, total: int) -> Cases:
        """What is told of each case that ended."""
        return Unshown()


def outside() -> int:
    """How far up whoever called this package is, as `warnings.warn` counts in its caller."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("trsim."):
        level, frame = level + 1, frame.f_back
    return level
