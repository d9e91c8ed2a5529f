"""`trsim check` in this process: how it ends, and the time and memory it took."""

import contextlib
import gc
import io
import json
import signal
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from trsim.cli.check import command

HANGS = 20.0  # s of CPU
LARGEST = 200e6  # bytes a check may add to what the process held before


class Hang(BaseException):
    """No `except Exception` of the code under test stops it."""


@contextlib.contextmanager
def watchdog() -> Iterator[None]:
    """Ends what uses the processor for longer than HANGS."""

    def bite(*_: Any) -> None:
        raise Hang(f"still busy after {HANGS} s")

    before = signal.signal(signal.SIGPROF, bite)
    signal.setitimer(signal.ITIMER_PROF, HANGS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


@contextlib.contextmanager
def collections() -> Iterator[list[float]]:
    """CPU times, s, whose sum is what collections of the whole heap took: ends, and starts below 0.

    The heap of a process of tests holds what all its tests and their dice keep, up to 1.7 million
    objects: one collection took 4.7 s. That of `trsim check` alone holds what it made itself.
    """
    times: list[float] = []

    def seen(phase: str, info: dict[str, int]) -> None:
        if info["generation"] == 2:
            times.append(-time.process_time() if phase == "start" else time.process_time())

    gc.callbacks.append(seen)
    try:
        yield times
    finally:
        gc.callbacks.remove(seen)


def written(path: Path, data: bytes) -> Path:
    """A file made anew: one that is cut and filled again has to wait for the disk."""
    path.unlink(missing_ok=True)
    path.write_bytes(data)
    return path


def held(what: str) -> float:
    """VmRSS (now) or VmHWM (the most since `forget`) of this process, bytes."""
    with open("/proc/self/status", "rb") as file:
        text = file.read()
    return 1024.0 * int(text[text.index(b"\n%s:" % what.encode()) :].split(None, 2)[1])


def forget() -> None:
    """Let VmHWM begin anew."""
    with open("/proc/self/clear_refs", "wb", buffering=0) as file:
        file.write(b"5")


class Checks:
    """`trsim check` of many files, with what became of them."""

    def __init__(self) -> None:
        self.counts: Counter[int] = Counter()  # by exit code
        self.slowest = self.largest = 0.0

    def warm(self, path: Path) -> None:
        """What is compiled or imported, is so before the clock runs."""
        assert Checks().check(path) == 0

    def check(self, path: Path) -> int:
        """The exit code: 0, 3 or 4, with a message for each error; anything else is refused."""
        out, err = io.StringIO(), io.StringIO()
        forget()
        before, start = held("VmRSS"), time.process_time()
        streams = contextlib.redirect_stdout(out), contextlib.redirect_stderr(err)
        with watchdog(), collections() as others, streams[0], streams[1]:
            code = command.callback(scenarios=(str(path),), sets=(), as_json=True, quiet=True)
        self.slowest = max(self.slowest, time.process_time() - start - sum(others))
        self.largest = max(self.largest, held("VmHWM") - before)
        self.counts[code] += 1
        errors = json.loads(out.getvalue())["errors"]
        assert code in (0, 3, 4), (code, err.getvalue())
        assert bool(errors) == (code != 0)
        assert all(error["what"] and error["exit_code"] in (3, 4) for error in errors), errors
        assert "Traceback" not in err.getvalue()
        return code

    def told(self) -> str:
        counts = ", ".join(f"exit {code}: {n}" for code, n in sorted(self.counts.items()))
        return (
            f"{sum(self.counts.values())} checked ({counts}), the slowest {self.slowest:.2f} s of"
            f" CPU, the largest {self.largest / 1e6:.0f} MB"
        )
