"""Running a scenario in a test: one call, and the channels by name."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pytest

from trsim.assemble.assemble import assemble
from trsim.assemble.mechanism import Mechanism
from trsim.kernels.lazy import PYTHON
from trsim.scenario.load import loads
from trsim.solve.outcome import Outcome
from trsim.solve.simulate import simulate


@dataclass(frozen=True)
class Run:
    """All that a run left behind."""

    scenario: Any
    mechanism: Mechanism
    outcome: Outcome
    rows: np.ndarray  # (n, 1 + n_out) time, channels
    steps: np.ndarray
    events: np.ndarray  # (n, 5) time, kind, row, speed, angle
    points: np.ndarray  # (n, 4) time, section, x, y
    recorded: np.ndarray  # (n, 2 + n_out) time, event, channels
    impulses: np.ndarray  # (n, 11) see solve/march/impulses.py
    jumps: np.ndarray  # (n, 15)

    @property
    def t(self) -> np.ndarray:
        return self.rows[:, 0]

    @cached_property
    def place(self) -> dict[str, tuple[int, int]]:
        return {c.name: (c.start, c.size) for c in self.mechanism.columns}

    def __getitem__(self, name: str) -> np.ndarray:
        """A channel at the output times: (n) or (n, size)."""
        start, size = self.place[name]
        return self.rows[:, 1 + start] if size == 1 else self.rows[:, 1 + start : 1 + start + size]

    def largest(self, name: str) -> tuple[float, float]:
        """Largest value of a channel and its time, from the peaks."""
        return tuple(self.outcome.peaks[self.place[name][0], :2])

    def section(self, name: str) -> np.ndarray:
        """The points of a Poincare section: (n, 3) time, x, y."""
        names = [section.name for section in self.mechanism.sections]
        return self.points[self.points[:, 1] == names.index(name)][:, [0, 2, 3]]

    def at(self, name: str, t: float) -> np.ndarray:
        """A channel at one output time."""
        (k,) = np.flatnonzero(np.abs(self.t - t) < 1e-9)
        return self[name][k]


def scenario(text_or_scenario: Any, *sets: str) -> Any:
    """A scenario from its text; one that is made already is passed on."""
    if isinstance(text_or_scenario, str):
        return loads(text_or_scenario, sets)
    return text_or_scenario


def built(text: str, *sets: str) -> Mechanism:
    """The mechanism of a text."""
    return assemble(scenario(text, *sets))


def run(text: Any, *sets: str, fails: bool | None = False) -> Run:
    """Run to the end; `fails` says whether the run is expected to end early, None that it may.

    Without machine code most runs take minutes: their tests are skipped then.
    """
    if PYTHON:
        pytest.skip("a run of many steps as plain Python")
    return short_run(text, *sets, fails=fails)


def short_run(text: Any, *sets: str, fails: bool | None = False) -> Run:
    """`run`, as plain Python too."""
    read = scenario(text, *sets)
    mechanism = assemble(read)
    march = simulate(read, mechanism)
    blocks: list[tuple[np.ndarray, ...]] = []
    while True:
        try:
            block = next(march)
        except StopIteration as stop:
            outcome = stop.value
            break
        tables = (block.rows, block.steps, block.events, block.points, block.recorded, *block.jump)
        blocks.append(tuple(table.copy() for table in tables))
    assert fails is None or (outcome.status == "failed") == fails, outcome.reason
    return Run(read, mechanism, outcome, *(np.vstack(part) for part in zip(*blocks, strict=True)))


def energy_error(r: Run) -> float:
    """Largest residual of the energy book over the largest energy exchanged."""
    return r.outcome.statistics["energy_residual_relative"]
