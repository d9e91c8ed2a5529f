"""What the measurements share: a run in this process, medians, a process from outside."""

import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).parent.parent
SCENARIOS = ROOT / "scenarios"


class Run(NamedTuple):
    """A run in memory."""

    rows: NDArray[np.float64]
    columns: dict[str, int]
    outcome: Any

    def channel(self, name: str) -> NDArray[np.float64]:
        return self.rows[:, 1 + self.columns[name]]

    def peak(self, name: str) -> float:
        return float(self.outcome.peaks[self.columns[name], 0])


def run(scenario: Any, mechanism: Any) -> Run:
    """March a scenario to its end."""
    from trsim.analyse.trajectory import marched

    rows, outcome = marched(scenario, mechanism)
    return Run(rows, {c.name: c.start for c in mechanism.columns}, outcome)


def median(measure: Callable[[], float], repeats: int = 5) -> float:
    """Median of repeated measurements, the first one not counted."""
    measure()
    return statistics.median(measure() for _ in range(repeats))


def wall(command: Sequence[str], repeats: int = 5) -> float:
    """Wall seconds of a whole process, median."""

    def once() -> float:
        start = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True, cwd=ROOT)  # noqa: S603
        return time.perf_counter() - start

    return median(once, repeats)


def trsim(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "trsim", *arguments]
