"""The writer of result files: X.h5.part while the run goes on, X.h5 when it is complete.

All groups, names and attributes of the running file are made before it is opened for one writer
and any number of readers (SWMR); from then on it can be read at any moment, also after the writer
was killed, see torn.py.  What is known only at the end is added after reopening it in normal mode.
"""

import contextlib
import os
import time
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import h5py

from trsim.errors import FileError, TrsimError
from trsim.solve.blocks import Blocks
from trsim.statuses import Status
from trsim.store import blank, describe, own, peaks, points, tables
from trsim.store import checkpoint as checkpoints
from trsim.store.checkpoint import Checkpoint
from trsim.store.content import told_hash
from trsim.store.disk import check_room, let_go, synced
from trsim.store.grow import Field, Growing, scales
from trsim.store.lock import alone
from trsim.store.made import Book
from trsim.store.read import Run, read
from trsim.store.resume import refill
from trsim.store.target import CHECKPOINT, PART, replaceable

__all__ = ["Run", "read", "write"]

FLUSHED = 0.5  # s of wall time between two flushes
INTERRUPTED: Status = "interrupted"
Closing = Callable[[h5py.File], dict[str, Any]]
HASTE = 1.0  # s: a checkpoint that takes longer is not begun after an interrupt


class Around(NamedTuple):
    """What belongs to a file besides the results of its run."""

    command: str = ""  # line that began the run
    every: float = 0.0  # s of wall time between two checkpoints, 0 for none
    kept: Checkpoint | None = None  # where the run goes on
    # adds to a complete file what its hash does not cover, and returns more for the summary
    closing: Closing | None = None
    again: str = ""  # line that goes on with the run


NOTHING_MORE = Around()


@alone
def write(
    path: str | os.PathLike, scenario: Any, mechanism: Any, blocks: Generator[Any, None, Any],
    around: Around = NOTHING_MORE,
) -> dict[str, Any]:  # fmt: skip
    """Write what `blocks` yields to a result file; returns its summary.

    A solver that fails leaves a complete file with status `failed`, an interrupt a closed .part
    file with status `interrupted`, a run that never starts no file at all.
    """
    run = Running(Path(path), scenario, mechanism, around)
    clock, outcome, broken = describe.Clock.now(), None, None
    run.go_on(around.kept)
    try:
        outcome = run.take_all(blocks)
        status, reason = outcome.status, outcome.reason
    except FileError:
        run.abandon()
        raise
    except BaseException as error:
        if run.file is None:
            raise
        status, reason = _ending(error)
        run.save_last(status)
        broken = error
    try:
        provenance = describe.provenance(around.command, clock, outcome, run.resumed)
        summary = run.finish(status, reason, outcome, provenance)
    except FileError:
        run.abandon()
        raise
    if isinstance(broken, KeyboardInterrupt):
        raise KeyboardInterrupt(run.left(run.kept)) from None
    if broken is not None and not isinstance(broken, TrsimError):
        raise broken
    return summary


def _ending(error: BaseException) -> tuple[Status, str]:
    """Status and reason of a run that an exception ended."""
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED, "interrupted from outside"
    told = f"error in trsim: {type(error).__name__}: {error}"
    return "failed", error.what if isinstance(error, TrsimError) else told


class Running:
    """A part file and its growing tables; the file is made when the first rows arrive."""

    def __init__(
        self, final: Path, scenario: Any, mechanism: Any, around: Around = NOTHING_MORE
    ) -> None:
        self.final, self.part = final, final.with_name(final.name + ".part")
        self.fresh = final.with_name(final.name + ".part.new")  # of a resumed run
        self.checkpoint = checkpoints.beside(final)
        self.scenario, self.mechanism = scenario, mechanism
        self.planned = points.plan(scenario, mechanism)
        self.file: h5py.File | None = None
        self.magnitudes = peaks.Magnitudes(mechanism.columns)
        self.impacts = describe.Impacts(len(mechanism.instances))
        self.touches = tables.Touches(mechanism)
        self.extremes = {"magnitudes": self.magnitudes.largest, "impacts": self.impacts.of}
        self.around, self.saved, self.took = around, time.monotonic(), 0.0  # s of wall time
        self.state: dict[str, Any] | None = None  # of the solver after the last block taken
        self.resumed: list[str] = []  # when
        self.time, self.kept, self.flushed = 0.0, 0.0, 0.0  # s simulated, in the file; s of wall
        with self.file_errors():
            final.parent.mkdir(parents=True, exist_ok=True)
            if not os.access(final.parent, os.W_OK) or final.is_dir():
                raise OSError("not a file in a folder that can be written to")
            replaceable(self.part, PART)
            own.exists(self.part, PART)
            own.exists(self.fresh, PART)
            own.exists(self.checkpoint, CHECKPOINT)

    @contextlib.contextmanager
    def file_errors(self) -> Iterator[None]:
        """Errors of the file system in our words."""
        try:
            yield
        except (OSError, RuntimeError) as error:
            reason = describe.cause(error)
            if self.file is None:  # where a run is gone on with, what it left is untouched
                hint = self.left(self.kept) if self.kept else ""
                raise FileError(f"{self.final}: {reason}", hint, file=str(self.final)) from None
            size = self.part.stat().st_size if self.part.exists() else 0
            what = f"{self.part}: cannot be written beyond {size} bytes: {reason}"
            raise FileError(what, self.left(self.kept), file=str(self.part)) from None
        except FileError as error:  # of a checkpoint
            if self.file is None or error.hint:
                raise
            raise FileError(error.what, self.left(self.kept), file=error.file) from None

    def take_all(self, blocks: Generator[Any, None, Any]) -> Any:
        """Store all blocks; the outcome."""
        run = Blocks(blocks)
        for block in run:
            with self.file_errors():
                self.open()
                self.take(block)
        with self.file_errors():
            self.open()
        return run.outcome

    # --- while the run goes on ---------------------------------------------------------------

    def open(self) -> None:
        """Make the file, unless it is there."""
        if self.file is None:
            checkpoints.forget(self.checkpoint)  # of rows about to be written over
            own.remove(self.fresh, PART)
            self.file = self.begun(self.part)

    def begun(self, path: Path, kept: Checkpoint | None = None) -> h5py.File:
        """A file with all that has a name, and the rows of a checkpoint; readers may come."""
        check_room(path)
        self.book = Book()
        self.declare(self.book)
        file = blank.begun(path, self.book)
        try:
            describe.given(self.book, self.scenario, self.mechanism)
            if kept is not None:
                refill(self.part, self.tables, kept)
            file.swmr_mode = True
        except BaseException:  # there is no row in it that is not elsewhere
            let_go(file)
            path.unlink(missing_ok=True)
            raise
        return file

    def go_on(self, kept: Checkpoint | None) -> None:
        """Be where a run was at a checkpoint, with a fresh part file in place of the old one."""
        if kept is None:
            return
        checkpoints.check_like(self.checkpoint, kept.extremes, self.extremes, rows=False)
        self.time = self.kept = kept.time
        with self.file_errors():
            file = self.begun(self.fresh, kept)
            file.flush()
            synced(self.fresh)
            os.replace(self.fresh, self.part)
            synced(self.part.parent)
        self.file = file
        for name, array in self.extremes.items():
            array[:] = kept.extremes[name]
        self.resumed = [*kept.resumed, f"t = {kept.time:g} s on {describe.stamp(time.time())}"]

    def declare(self, book: Book) -> None:
        """Groups, names and attributes."""
        columns = [c for c in self.mechanism.columns if c.wanted or c.name in self.planned.columns]
        describe.begin(book)
        turned = any(event.turned for event in self.mechanism.stages.switches.events)
        scales(book, {c.size for c in self.mechanism.columns} | ({3} if turned else set()))
        time_field = Field("time", "s", "simulated time", 0)
        fields = [Field(c.name, c.unit, c.meaning, 1 + c.start, c.size) for c in columns]
        width = 1 + max((c.start + c.size for c in self.mechanism.columns), default=0)
        rows = width, describe.expected(self.scenario)
        self.rows = Growing(book, "", [time_field, *fields], rows)
        describe.flag(book, self.mechanism)
        self.contacts = {
            e: tables.steps(book, instance, time_field)
            for e, instance in tables.touching(self.mechanism).items()
        }
        self.events = tables.events(book, self.mechanism, time_field)
        self.recorded = tables.recorded(book, self.mechanism, [time_field, *fields])
        self.jumps = tables.jumps(book, self.mechanism, time_field)
        self.tables = [self.rows, self.events, *self.contacts.values(), *(self.jumps or ())]
        self.sections = points.declare(book, self.planned)
        self.tables += [*filter(None, [self.recorded]), *self.sections]

    def take(self, block: Any) -> None:
        """Store one block of results."""
        self.state = None  # until all of the block is taken
        self.rows.append(block.rows)
        if len(block.rows):
            self.magnitudes.update(block.rows)
        self.touches.take(block.steps, self.contacts, self.impacts)
        self.events.append(block.events)
        for k, of_section in enumerate(self.sections):
            of_section.append(block.points[block.points[:, points.SECTION] == k])
        self.impacts.update(block.events)
        if self.recorded:
            self.recorded.append(block.recorded)
        for table, lines in zip(self.jumps or (), block.jump, strict=False):
            table.append(lines)
        self.time, self.state = block.time, block.state
        now = time.monotonic()
        if self.around.every and self.state is not None and now - self.saved > self.around.every:
            self.save()
        elif now - self.flushed > FLUSHED:
            self.flush()

    def flush(self) -> None:
        assert self.file is not None  # noqa: S101
        for table in self.tables:
            table.flush()
        self.file.flush()
        self.kept, self.flushed = self.time, time.monotonic()

    def save(self) -> None:
        """Write a checkpoint of what was taken so far, once all of that is on the disk."""
        assert self.state is not None  # noqa: S101
        began = time.monotonic()
        self.flush()
        synced(self.part)
        rows = {table.name: table.n for table in self.tables}
        tail = {name: rows for table in self.tables for name, rows in table.tail().items()}
        keys = checkpoints.keys(self.scenario)
        kept = Checkpoint(self.time, keys, rows, self.resumed, self.state, self.extremes, tail)
        checkpoints.store(self.checkpoint, kept)
        self.saved = time.monotonic()
        self.took = self.saved - began

    def save_last(self, status: str) -> None:
        """A checkpoint before an interrupt ends the run, if there is time for it."""
        every, state = self.around.every, self.state
        if status == INTERRUPTED and every and state is not None and self.took < HASTE:
            with contextlib.suppress(FileError), self.file_errors():
                self.save()

    # --- at the end --------------------------------------------------------------------------

    def finish(self, status: Status, reason: str, outcome: Any, provenance: dict) -> dict[str, Any]:
        """Add what is known only now, and give the file its name; the summary."""
        with self.file_errors():
            assert self.file is not None  # noqa: S101
            self.flush()
            for table in self.tables:
                table.tell()
            self.file.close()
            with h5py.File(self.part, "r+", libver=blank.LIBVER) as file:
                self.file, book = file, self.book
                book.go_on(file)
                complete = status != INTERRUPTED  # otherwise there are only two seconds
                extremes = None if outcome is None else outcome.peaks
                found = peaks.table(self.mechanism, extremes, self.magnitudes)
                if complete:
                    points.complete(book, self.planned)
                    found = peaks.with_strokes(found, book)
                peaks.store(book, found)
                title = self.scenario.title
                summary = describe.summary(self, title, status, reason, outcome, found)
                describe.end(book, summary, self.scenario, outcome, provenance)
                if complete:
                    summary["content_sha256"] = told_hash(book)
                    book.attribute("", "content_sha256", summary["content_sha256"])
                if complete and self.around.closing is not None:
                    summary |= self.around.closing(file)
            synced(self.part)
            if complete:
                os.replace(self.part, self.final)
                synced(self.final.parent)
                checkpoints.forget(self.checkpoint)
        summary["file"] = str(self.final if complete else self.part)
        return summary

    def left(self, time: float) -> str:
        """What is there of a run that was broken off."""
        return checkpoints.left(self.part, self.checkpoint, time, self.around.again)

    def abandon(self) -> None:
        """Let go of a file that cannot be written."""
        if self.file is not None:
            let_go(self.file)
