"""What Python's own audit sees: files opened, code run, sockets, processes."""

import multiprocessing
import os
import sys
from collections.abc import Callable
from typing import Any

NETWORK = ("socket.", "urllib.", "http.", "ftplib.", "smtplib.")
PROCESSES = ("subprocess.", "os.system", "os.exec", "os.fork", "os.posix_spawn", "os.spawn", "pty.")


class Watch:
    """The events that begin with one of these words, as they come."""

    def __init__(self, events: tuple[str, ...]) -> None:
        self.events = events
        self.seen: list[str] = []
        self.on = False
        sys.addaudithook(self._hook)

    def _hook(self, event: str, arguments: tuple) -> None:
        if self.on and event.startswith(self.events):
            self.seen.append(f"{event} {arguments!r}")

    def __enter__(self) -> list[str]:
        self.on = True
        return self.seen

    def __exit__(self, *_: object) -> None:
        self.on = False


def apart(task: Callable[[], Any]) -> Any:
    """What a task that watches returns.

    It is done in a copy of this process, where there can be one: a hook is never taken away again,
    and is asked at every call of machine code (a thirtieth of the suite's time).
    """
    if not hasattr(os, "fork"):
        return task()
    fork: Any = multiprocessing.get_context("fork")
    here, there = fork.Pipe(duplex=False)
    copy = fork.Process(target=_done, args=(task, there))
    copy.start()
    there.close()
    good, result = here.recv()
    copy.join()
    assert good, result
    return result


def _done(task: Callable[[], Any], there: Any) -> None:
    try:
        told = True, task()
    except BaseException as error:
        told = False, f"{type(error).__name__}: {error}"
    there.send(told)
