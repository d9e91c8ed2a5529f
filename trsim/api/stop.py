"""Signals that end what is being done: told to `Stop`, and heeded where that is safe."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED: dict[int, int] = {signal.SIGINT: 130, signal.SIGTERM: 143}  # -> exit code


class Stop:
    """What a signal asked for.  Compiled code must not be broken off by an exception of ours: while
    `patient`, whoever can stop safely looks here."""

    number: int | None = None
    patient = False
    heard = False  # whether somebody listens already


@contextmanager
def listening() -> Iterator[None]:
    """Signals are told to Stop; afterwards everything is as it was."""
    if Stop.heard:
        yield
        return
    Stop.number, Stop.patient = None, False
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, _stop) for number in INTERRUPTED}
    Stop.heard = True
    try:
        yield
    finally:
        Stop.heard = False
        for number, handler in before.items():
            signal.signal(number, handler)


def _stop(number: int, _: Any) -> None:
    for each in INTERRUPTED:  # the second one ends the process at once
        signal.signal(each, signal.SIG_DFL)
    Stop.number = number
    if not Stop.patient:
        raise KeyboardInterrupt


def look() -> None:
    """End a measurement when a signal asked for it."""
    if Stop.number:
        raise KeyboardInterrupt
