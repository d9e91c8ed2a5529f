"""Other engines on the same problems, where they are installed: `pip install trsim[bench]`.

Each engine is one module: it builds its model from the same scenario as trsim and times its
integration alone (process time, no files, no sensors); errors are those of separate runs.
"""

from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from statistics import median
from typing import NamedTuple

from benchmarks.work_precision import Point, cheapest

ENGINES = ("exudyn", "mujoco", "drake")
REPEATS = 3


class Measured(NamedTuple):
    """One setting of an engine on one problem."""

    setting: str
    cpu: float  # s
    error: float
    steps: int


def cpu_of(once: Callable[[], float]) -> float:
    """Median of CPU times, s, after one that is not counted."""
    once()
    return median(once() for _ in range(REPEATS))


def compare(problem: str, ours: Sequence[Point], unit: str, n: int = 0) -> None:
    """Print what every engine reaches, and trsim's CPU time at the same error."""
    for engine in ENGINES:
        try:
            module = import_module(f"benchmarks.peers.{engine}")
        except ModuleNotFoundError as missing:
            if (missing.name or "").startswith("benchmarks"):
                raise
            print(f"  {engine}: skipped: not installed")
            continue
        if problem not in module.PROBLEMS:
            print(f"  {engine}: {module.WITHOUT}")
            continue
        runs: Iterator[Measured] = module.PROBLEMS[problem](n)
        for m in runs:
            each = f"{1e6 * m.cpu / m.steps:8.1f} us per step"
            print(f"  {engine:6s} {m.setting:36s} error {m.error:.1e} {unit:3s} CPU "
                  f"{1e3 * m.cpu:8.1f} ms {each}; {said(m, ours)}", flush=True)  # fmt: skip


def said(m: Measured, ours: Sequence[Point]) -> str:
    """The ratio of CPU times at the engine's error."""
    best = cheapest(ours, m.error)
    if best is None:
        return "trsim: not reached"
    return f"trsim {1e3 * best.cpu:.2f} ms: 1/{m.cpu / best.cpu:.3g}"
