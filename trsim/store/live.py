"""A run whose results stay in memory: its blocks are taken, and read like a result file.

For cases of which only numbers are kept (sweeps/summary.py).  What it tells is to the bit what the
file of the same run tells; there is no file, no checkpoint, and nothing to recover.
"""

from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trsim.arrays import Array
from trsim.errors import TrsimError, UsageError
from trsim.solve.blocks import Blocks
from trsim.store import describe, peaks, points, tables
from trsim.store.grow import Field
from trsim.store.points import Points
from trsim.store.read import Events, Run

LEAST = 64  # lines that there is room for
MOST = 1 << 22  # numbers of rows that room is made for beforehand


class Gathered:
    """Lines of blocks, as they come, one column behind the other in memory."""

    def __init__(self, width: int, expected: int = 0) -> None:
        """expected: how many there will be, where that is known."""
        self.lines = np.empty((expected, width), order="F")
        self.n = 0

    def append(self, lines: Array) -> None:
        """Take lines (n, width), which are the solver's again afterwards."""
        n = self.n + len(lines)
        if n > len(self.lines):
            kept = self.whole()
            self.lines = np.empty((max(n, 2 * len(kept), LEAST), lines.shape[1]), order="F")
            self.lines[: self.n] = kept
        self.lines[self.n : n] = lines
        self.n = n

    def whole(self) -> Array:
        """All of them."""
        return self.lines[: self.n]


def columns_of(lines: Array, start: int, size: int) -> Array:
    """One column, or several side by side."""
    return lines[:, start] if size == 1 else lines[:, start : start + size]


@dataclass(frozen=True, kw_only=True)
class Live(Run):
    """A run in memory, complete."""

    columns: dict[str, Array]  # of time and the channels
    of_steps: dict[str, dict[str, Array]]  # contact -> channel -> values
    of_events: Events
    of_sections: dict[str, Points]
    of_peaks: tuple[peaks.Peak, ...]
    told: dict[str, Any]  # the summary
    solver: dict[str, Any]  # attributes of the solver
    of_units: dict[str, dict[str, str]]  # contact -> channel -> unit
    resolved: dict[str, Any]  # the scenario

    @property
    def reached(self) -> float:
        return float(self.told["time"])

    def _rows(self, stored: str) -> Array:
        return self.columns[stored]

    def steps(self, joint: str) -> dict[str, Array]:
        self.check_contact(joint)
        return self.of_steps[joint]

    def contact_unit(self, joint: str, *channels: str) -> str:
        units = self.of_units[joint]
        return next((units[c] for c in channels if c in units), "-")

    @property
    def events(self) -> Events:
        return self.of_events

    @property
    def peaks(self) -> tuple[peaks.Peak, ...]:
        return self.of_peaks

    @property
    def poincare(self) -> dict[str, Points]:
        return self.of_sections

    @property
    def summary(self) -> dict[str, Any]:
        return self.told

    @property
    def scenario(self) -> dict[str, Any]:
        return self.resolved

    def group(self, name: str) -> dict[str, Any]:
        if name != "solver":
            raise UsageError(f"{self.path}: nothing is kept of its {name}")
        return self.solver


class Taking:
    """Takes the blocks of a run; `live` is what they are of."""

    def __init__(self, path: Path, scenario: Any, mechanism: Any) -> None:
        self.path, self.scenario, self.mechanism = path, scenario, mechanism
        self.planned = points.plan(scenario, mechanism)
        width = 1 + max((c.start + c.size for c in mechanism.columns), default=0)
        self.rows = Gathered(width, min(describe.expected(scenario), MOST // width))
        self.touches = tables.Touches(mechanism)
        self.contacts = {e: Gathered(width) for e, width in self.touches.width.items()}
        self.events, self.points = Gathered(tables.EVENT_COLUMNS), Gathered(4)
        self.impacts = describe.Impacts(len(mechanism.instances))
        self.time = 0.0

    def all(self, blocks: Generator[Any, None, Any]) -> tuple[Live, dict[str, Any]]:
        """Take all blocks; the run, and its summary.  One that fails is a run, too."""
        run = Blocks(blocks)
        status, reason = "failed", ""
        try:
            for block in run:
                self.take(block)
            status, reason = run.outcome.status, run.outcome.reason
        except TrsimError as error:
            if not self.rows.n:
                raise
            reason = error.what
        return self.live(status, reason, run.outcome)

    def take(self, block: Any) -> None:
        self.rows.append(block.rows)
        self.touches.take(block.steps, self.contacts, self.impacts)
        self.events.append(block.events)
        self.impacts.update(block.events)
        self.points.append(block.points)
        self.time = block.time

    def live(self, status: Any, reason: str, outcome: Any) -> tuple[Live, dict[str, Any]]:
        """The run, and its summary."""
        mechanism, rows = self.mechanism, self.rows.whole()
        wanted = [c for c in mechanism.columns if c.wanted or c.name in self.planned.columns]
        columns = {"time": rows[:, 0]}
        columns |= {c.name: columns_of(rows, 1 + c.start, c.size) for c in wanted}
        extremes = None if outcome is None else outcome.peaks
        magnitudes = peaks.Magnitudes(mechanism.columns)
        if extremes is None and len(rows):
            magnitudes.update(rows)
        found = peaks.table(mechanism, extremes, magnitudes)
        if "stroke" in columns:
            found = peaks.at_strokes(found, columns["time"], columns["stroke"])
        told = describe.summary(self, self.scenario.title, status, reason, outcome, found)
        shown = {e: mechanism.instances[e] for e in self.contacts}
        live = Live(
            path=self.path,
            attributes={"title": self.scenario.title, "status": status, "reason": reason},
            units={c.name: c.unit for c in wanted},
            sizes={c.name: c.size for c in wanted},
            parts=describe.parts(self.scenario, mechanism),
            contacts=tuple(instance.name for instance in shown.values()),
            rows=len(rows),
            columns=columns,
            of_steps={i.name: self.steps(e, i) for e, i in shown.items()},
            of_events=self.happened(),
            of_sections=self.sections(),
            of_peaks=tuple(found),
            told={name: told[name] for name in ("time", "rows", "events", "contacts")},
            solver=describe.of_solver(self.scenario, told["statistics"]),
            resolved=self.scenario.resolved,
            of_units={i.name: {c.name: c.unit for c in i.channels} for i in shown.values()},
        )
        return live, told

    def steps(self, e: int, instance: Any) -> dict[str, Array]:
        """`time` and the channels of a contact at its accepted steps in touch."""
        lines, fields = self.contacts[e].whole(), tables.step_fields(instance)
        found = {f.name: columns_of(lines, f.start, f.size) for f in fields}
        return {"time": lines[:, 0], **found}

    def happened(self) -> Events:
        """The table of events, as a file has it."""
        lines = self.events.whole()
        fields = {f.name: f for f in tables.event_fields(self.mechanism)}

        def words(field: Field) -> Any:
            return np.array(field.words)[lines[:, field.start].astype(int)]

        none: dict[str, Any] = {"did": np.array([], "S1").astype(str), "work": np.array([])}
        there = {
            name: words(field) if field.words else lines[:, field.start]
            for name, field in fields.items() if name in Events._fields
        }  # fmt: skip
        return Events(**{"time": lines[:, 0], **none, **there})

    def sections(self) -> dict[str, Points]:
        lines, found = self.points.whole(), {}
        for k, section in enumerate(self.planned.sections):
            mine = lines[lines[:, points.SECTION] == k]
            time, x, y = (mine[:, column] for column in (points.TIME, points.X, points.Y))
            defined, units = points.defined(section), (section.x_unit, section.y_unit)
            found[section.name] = Points(defined, time, x, y, *units)
        return found
