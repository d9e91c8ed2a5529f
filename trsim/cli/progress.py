"""How far a run is: a bar on a terminal, otherwise a line every ten seconds."""

import sys
import threading
import time
from collections.abc import Generator
from pathlib import Path
from typing import Any

from trsim.cli.frame import Answer, Stop
from trsim.errors import FileError, one_line
from trsim.scenario.methods import GGL, INDEX_1, METHODS
from trsim.solve.blocks import Blocks

PATIENCE = 1.0  # s: a shorter run shows nothing
WHILE = 2.0  # s: what takes longer is told
LINE = 10.0  # s between two lines where there is no terminal
DRAWN = 0.2  # s between two looks at the bar


def compiling(answer: Answer, method: str = "") -> None:
    """Say so where nothing was compiled on this machine yet.

    method: of a run; its solver is then compiled meanwhile, in a second process.
    """
    from trsim.assemble.equations import derivative

    needed, later = derivative, []
    if method and METHODS[method].rests:
        from trsim.solve.path.balance import system as needed
    elif method:
        # what every run needs, the dearest first; the first process is at the rest meanwhile
        files = METHODS[method].files.get(INDEX_1, ("scipy_ivp",))
        march = ("land", "peaks", "complete", "dense_output", "loop")
        later = [*(f"methods.{name}" for name in reversed(files)), *(f"march.{n}" for n in march)]
        from trsim.solve.march.complete import complete as needed
    warn_of_shared_code(answer)
    if needed.known:
        return
    warn_of_code_not_kept(answer)
    answer.say("compiling (once per installation, about half a minute)")
    if later:
        from trsim.kernels import ahead

        ahead.begin(*(f"trsim.solve.{name}" for name in later))


def compiling_sparse(answer: Answer, scenario: Any, mechanism: Any) -> None:
    """Say so where many bodies need a solver that was not compiled yet."""
    from trsim.solve.simulate import files

    used = files(scenario, mechanism)
    if used != METHODS[scenario.solver.method].files.get(GGL):
        return
    from trsim.solve.methods import radau_ggl

    if radau_ggl.step.known:
        return
    answer.say("compiling Radau for many bodies (once per installation, about 15 s)")
    if len(used) > 1:  # meanwhile the explicit method makes steps
        from trsim.kernels import ahead

        ahead.begin("trsim.solve.methods.radau_ggl")


def warn_of_shared_code(answer: Answer) -> None:
    """Say so where machine code would come from a folder that others may write in."""
    from trsim.kernels.kept import refused

    why = refused()
    if why:
        answer.warn(
            "machine code", f"nothing is loaded from the cache: {why}; this command compiles in a "
            "folder of its own.  Let the cache folder be yours alone (mode 700), or name another "
            "one by XDG_CACHE_HOME"
        )  # fmt: skip


def warn_of_code_not_kept(answer: Answer) -> None:
    """Say so where what is compiled cannot be kept for the next run."""
    from trsim.kernels.kept import folder, make
    from trsim.store.target import check_writable, file_errors

    try:
        with file_errors(folder()):
            make(folder())
        check_writable(folder())
    except FileError as error:
        answer.say(
            f"warning: machine code cannot be kept, so every run compiles anew: {error.what}; "
            "the variable XDG_CACHE_HOME names another folder for it"
        )


class Doing:
    """What a command is doing, told once it has taken a while."""

    def __init__(self, answer: Answer, name: str) -> None:
        self.answer, self.name, self.text, self.late = answer, name, "at work", False
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
        self.answer.say(f"{self.name}: {self.text} ...")


def watched(
    blocks: Generator[Any, None, Any], answer: Answer, name: str, end: float
) -> Generator[Any, None, Any]:
    """The blocks and the outcome of a run, with progress shown in passing.

    Also the place where a run stops when a signal asked for it.
    """
    show = Meter(answer, name, end)
    try:
        run = Blocks(blocks)
        for block in run:
            Stop.patient = True
            percent = f"{100 * block.time / end:.0f} %, "
            show.update(block.time, summary(block), percent + summary(block))
            yield block
            if Stop.number:
                raise KeyboardInterrupt
        return run.outcome
    finally:
        show.close()


def left(elapsed: float, share: float, first: float) -> str:
    """The time left at the pace since a first share was done; a resumed run begins with more."""
    if share <= first:
        return "?"
    seconds = elapsed * (1.0 - share) / (share - first)
    return f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"


def summary(block: Any) -> str:
    """How far a run is."""
    return f"t = {block.time:.4g} s, step {block.step:.1e} s, {block.n_events} contact events"


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
        self, answer: Answer, name: str, total: float, first: float | None = None
    ) -> None:  # fmt: skip
        self.answer, self.name, self.total, self.first = answer, name, total, first
        self.drawn = sys.stderr.isatty() and not answer.quiet
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
            self.answer.say(f"{self.name}: {line or told}, {to_go} left")
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

    def __init__(self, answer: Answer, name: str, total: int) -> None:
        super().__init__(answer, name, total, 0.0)
        self.done = self.failed = 0

    def ended(self, one: Any) -> None:
        """One more case ended."""
        self.done += 1
        self.failed += one.failed
        bad = f", {self.failed} failed" if self.failed else ""
        if self.done < self.total:
            self.update(self.done, f"{self.done} of {self.total} cases{bad}")
