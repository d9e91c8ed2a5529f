"""How far a run is: a bar on a terminal, otherwise a line every ten seconds."""

import sys
import threading
import time
from pathlib import Path
from typing import Any

from trsim.api.hearing import Listener
from trsim.errors import one_line

PATIENCE = 1.0  # s: a shorter run shows nothing
WHILE = 2.0  # s: what takes longer is told
LINE = 10.0  # s between two lines where there is no terminal
DRAWN = 0.2  # s between two looks at the bar


class Doing:
    """What a command is doing, told once it has taken a while."""

    def __init__(self, hears: Listener, name: str) -> None:
        self.hears, self.name, self.text, self.late = hears, name, "at work", False
        self.timer = threading.Timer(WHILE, self._tell)
        self.timer.daemon = True

    def __enter__(self) -> "Doing":
        self.timer.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.timer.cancel()

    def __call__(self, text: str) -> None:
        """Begin something else."""
        self.text = text
        if self.late:
            self._tell()

    def _tell(self) -> None:
        self.late = True
        self.hears.say(f"{self.name}: {self.text} ...")


def left(elapsed: float, share: float, first: float) -> str:
    """The time left at the pace since a first share was done; a resumed run begins with more."""
    if share <= first:
        return "?"
    seconds = elapsed * (1.0 - share) / (share - first)
    return f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"


def bar() -> Any:
    """A bar of rich, started."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = [TextColumn("{task.description}", markup=False), BarColumn(bar_width=24)]
    columns += [TextColumn("{task.percentage:>3.0f}%")]
    columns += [TextColumn("{task.fields[told]}", markup=False)]
    columns += [TextColumn("{task.fields[left]} left")]
    started = Progress(*columns, console=Console(stderr=True), transient=True)
    started.start()
    return started


class Meter:
    """How far something is: a bar on a terminal, otherwise a line every ten seconds.

    total: what `done` comes to; first: the share that is done at the start, None where the first
    update tells it.
    """

    def __init__(
        self, hears: Listener, name: str, total: float, first: float | None = None
    ) -> None:  # fmt: skip
        self.hears, self.name, self.total, self.first = hears, name, total, first
        self.drawn = sys.stderr.isatty() and not hears.quiet
        self.began = self.last = time.monotonic()
        self.bar: Any = None

    def update(self, done: float, told: str, line: str = "") -> None:
        """told: what a bar says beside the share; line: what a line says, where that is more."""
        now, share = time.monotonic(), done / self.total
        if self.first is None:
            self.began, self.last, self.first = now, now, share
        if now - self.last < (LINE if not self.drawn else DRAWN if self.bar else PATIENCE):
            return
        self.last = now
        to_go = left(now - self.began, share, self.first)
        if not self.drawn:
            self.hears.say(f"{self.name}: {line or told}, {to_go} left")
            return
        if self.bar is None:
            self.bar = bar()
            about = one_line(Path(self.name).stem)
            self.task = self.bar.add_task(about, total=self.total, told="", left="")
        self.bar.update(self.task, completed=done, told=told, left=to_go)

    def close(self) -> None:
        if self.bar is not None:
            self.bar.stop()


class Cases(Meter):
    """How far a sweep is."""

    def __init__(self, hears: Listener, name: str, total: int) -> None:
        super().__init__(hears, name, total, 0.0)
        self.done = self.failed = 0

    def ended(self, one: Any) -> None:
        """One more case ended."""
        self.done += 1
        self.failed += one.failed
        bad = f", {self.failed} failed" if self.failed else ""
        if self.done < self.total:
            self.update(self.done, f"{self.done} of {self.total} cases{bad}")
