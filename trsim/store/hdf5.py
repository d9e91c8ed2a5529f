"""The writer of result files: X.h5.part while the run goes on, X.h5 when it is complete.

All groups, names and attributes of the running file are made before it is opened for one writer
and any number of readers (SWMR); from then on it can be read at any moment, also after the writer
was killed.  What is known only at the end is added after reopening it in normal mode.
"""

import contextlib
import os
import time
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any

import h5py

from trsim.errors import FileError, TrsimError
from trsim.statuses import Status
from trsim.store import describe, peaks, points
from trsim.store.content import content_hash
from trsim.store.grow import Field, Growing, scales
from trsim.store.read import Run, read

__all__ = ["Run", "read", "write"]

LIBVER = ("v110", "v110")  # the first with SWMR: every HDF5 since 1.10 reads it
FLUSHED = 0.5  # s of wall time between two flushes
CACHE = 128 << 10  # bytes of chunks kept per dataset
BEGINNING = 1 << 18  # bytes, more than what a file holds before its first row
EXPECTED = 256  # rows of the tables whose length nobody knows
KINDS = ("", "onset", "separation")  # of events, by number


def write(
    path: str | os.PathLike,
    scenario: Any,
    mechanism: Any,
    blocks: Generator[Any, None, Any],
    command: str = "",
) -> dict[str, Any]:
    """Write what `blocks` yields to a result file; returns its summary.

    A solver that fails leaves a complete file with status `failed`.  An interrupt leaves a closed
    .part file with status `interrupted`.  A run that never starts leaves no file at all.
    """
    run = Running(Path(path), scenario, mechanism, points.plan(scenario, mechanism))
    clock = describe.Clock.now()
    outcome, broken = None, None
    status: Status
    try:
        outcome = run.take_all(blocks)
        status, reason = outcome.status, outcome.reason
    except FileError:
        run.abandon()
        raise
    except BaseException as error:
        if run.file is None:
            raise
        status, reason = "failed", f"error in trsim: {type(error).__name__}: {error}"
        if isinstance(error, KeyboardInterrupt):
            status, reason = "interrupted", "interrupted from outside"
        elif isinstance(error, TrsimError):
            reason = error.what
        broken = error
    try:
        summary = run.finish(status, reason, outcome, describe.provenance(command, clock, outcome))
    except FileError:
        run.abandon()
        raise
    if broken is not None and not isinstance(broken, TrsimError):
        raise broken
    return summary


class Running:
    """A part file and its growing tables; the file is made when the first rows arrive."""

    def __init__(self, final: Path, scenario: Any, mechanism: Any, planned: points.Plan) -> None:
        self.final, self.part = final, final.with_name(final.name + ".part")
        self.scenario, self.mechanism, self.planned = scenario, mechanism, planned
        self.file: h5py.File | None = None
        self.magnitudes = peaks.Magnitudes(mechanism.columns)
        self.impacts = describe.Impacts()
        self.time, self.kept, self.flushed = 0.0, 0.0, 0.0  # s simulated, in the file; s of wall
        with self.told():
            final.parent.mkdir(parents=True, exist_ok=True)
            if not os.access(final.parent, os.W_OK) or final.is_dir():
                raise OSError("not a file in a folder that can be written to")

    @contextlib.contextmanager
    def told(self) -> Iterator[None]:
        """Errors of the file system in our words."""
        try:
            yield
        except (OSError, RuntimeError) as error:
            reason = describe.cause(error)
            if self.file is None:
                raise FileError(f"{self.final}: {reason}") from None
            size = self.part.stat().st_size if self.part.exists() else 0
            what = f"{self.part}: cannot be written beyond {size} bytes: {reason}"
            raise FileError(what, f"It holds the run until t = {self.kept:g} s.") from None

    def take_all(self, blocks: Generator[Any, None, Any]) -> Any:
        """Store all blocks; the outcome."""
        while True:
            try:
                block = next(blocks)
            except StopIteration as stop:
                with self.told():
                    self.open()
                return stop.value
            with self.told():
                self.open()
                self.take(block)

    # --- while the run goes on ---------------------------------------------------------------

    def open(self) -> None:
        """Make the file with everything that has a name, then let readers in."""
        if self.file is not None:
            return
        _room(self.part)
        file = h5py.File(self.part, "w", libver=LIBVER, rdcc_nbytes=CACHE)
        try:
            self.declare(file)
            file.swmr_mode = True
        except BaseException:  # there is no row in it yet
            _let_go(file)
            self.part.unlink(missing_ok=True)
            raise
        self.file = file

    def declare(self, file: h5py.File) -> None:
        """Groups, names and attributes."""
        columns = [c for c in self.mechanism.columns if c.wanted or c.name in self.planned.columns]
        describe.begin(file, self.scenario, self.mechanism)
        scales(file, {c.size for c in self.mechanism.columns})
        time_field = Field("time", "s", "simulated time", 0)
        fields = [Field(c.name, c.unit, c.meaning, 1 + c.start, c.size) for c in columns]
        width = 1 + max((c.start + c.size for c in self.mechanism.columns), default=0)
        solver, output = self.scenario.solver, self.scenario.output
        expected = int(min((solver.end or 0.0) / output.every if output.every else 1000, 1e9)) + 1
        self.rows = Growing(file, [time_field, *fields], width, expected)
        describe.flag(file, self.mechanism)
        self.contacts = {
            e: _steps(file, instance, time_field)
            for e, instance in enumerate(self.mechanism.instances)
            if instance.row.contact is not None
        }
        self.force = {e: _force_column(self.mechanism.instances[e]) for e in self.contacts}
        self.events = _events(file, self.mechanism, time_field)
        points.declare(file, self.planned)

    def take(self, block: Any) -> None:
        """Store one block of results."""
        self.rows.append(block.rows)
        if len(block.rows):
            self.magnitudes.update(block.rows)
        if len(block.steps):
            of = block.steps[:, 1]
            for e, table in self.contacts.items():
                lines = block.steps[of == e][:, : table.waiting.shape[1]]
                table.append(lines)
                self.impacts.press(e, lines, self.force[e])
        self.events.append(block.events)
        self.impacts.update(block.events)
        self.time = block.time
        if time.monotonic() - self.flushed > FLUSHED:
            self.flush()

    def flush(self) -> None:
        assert self.file is not None  # noqa: S101
        for table in (self.rows, self.events, *self.contacts.values()):
            table.flush()
        self.file.flush()
        self.kept, self.flushed = self.time, time.monotonic()

    # --- at the end --------------------------------------------------------------------------

    def finish(self, status: Status, reason: str, outcome: Any, provenance: dict) -> dict[str, Any]:
        """Add what is known only now, and give the file its name; the summary."""
        with self.told():
            assert self.file is not None  # noqa: S101
            self.flush()
            self.file.close()
            with h5py.File(self.part, "r+", libver=LIBVER) as file:
                self.file = file
                complete = status != "interrupted"  # otherwise there are only two seconds
                if complete:
                    points.complete(file, self.planned)
                extremes = None if outcome is None else outcome.peaks
                found = peaks.table(self.mechanism, extremes, self.magnitudes)
                if complete:
                    found = peaks.with_strokes(found, file)
                peaks.store(file, found)
                summary = describe.summary(self, file, status, reason, outcome, found)
                describe.end(file, summary, self.scenario, outcome, provenance)
                if complete:
                    summary["content_sha256"] = content_hash(file)
                    file.attrs["content_sha256"] = summary["content_sha256"]
            _synced(self.part)
            if complete:
                os.replace(self.part, self.final)
                _synced(self.final.parent)
        summary["file"] = str(self.final if complete else self.part)
        return summary

    def abandon(self) -> None:
        """Let go of a file that cannot be written: readers find what was flushed.

        HDF5 would go on trying to write what it holds, and fail again when it is unloaded; all it
        still has to say goes to nowhere instead.
        """
        if self.file is not None:
            _let_go(self.file)


def _room(part: Path) -> None:
    """See that a file can be begun: HDF5 ends the process where its first bytes fail."""
    trial = part.with_name(part.name + ".room")  # readers may already look for the part file
    try:
        with trial.open("wb") as file:
            file.write(bytes(BEGINNING))
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        what = f"{part}: the first {BEGINNING} bytes cannot be written: {error.strerror}"
        raise FileError(what) from None
    finally:
        trial.unlink(missing_ok=True)


def _let_go(file: h5py.File) -> None:
    if not file.id.valid:
        return
    with contextlib.suppress(OSError, RuntimeError):
        nowhere = os.open(os.devnull, os.O_RDWR)
        os.dup2(nowhere, file.id.get_vfd_handle())
        os.close(nowhere)
        file.close()


def _steps(file: h5py.File, instance: Any, time_field: Field) -> Growing:
    """The table of one contact: its channels at every accepted step in touch."""
    fields, start = [time_field], 2
    for c in instance.element.channels:
        fields.append(Field(c.name, c.unit, c.meaning, start, c.size))
        start += c.size
    return Growing(file["steps"].create_group(instance.name), fields, start, EXPECTED)


def _force_column(instance: Any) -> int:
    """The column of a line of steps that holds the contact force."""
    start = {}
    column = 2
    for c in instance.element.channels:
        start[c.name], column = column, column + c.size
    return start.get("contact_force", start.get("normal_force", 1))


def _events(file: h5py.File, mechanism: Any, time_field: Field) -> Growing:
    names = tuple(instance.name or "-" for instance in mechanism.instances)
    fields = [
        time_field,
        Field("kind", "", "what happened", 1, words=KINDS),
        Field("element", "", "where", 2, words=names or ("-",)),
        Field("speed", "m/s", "rate of penetration", 3),
        Field("angle", "rad", "of the contact point around the bearing", 4),
    ]
    return Growing(file["events"], fields, 5, EXPECTED)


def _synced(path: Path) -> None:
    """Have the system bring a file or a folder to the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
