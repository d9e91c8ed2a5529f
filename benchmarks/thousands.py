"""Thousands of cases of which numbers are kept: the reverser with play, and P1.

Whole commands on all processors.  Efficiency: CPU time over wall time times processors.
"""

import os
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.measure import SCENARIOS
from benchmarks.sweeps import SCENARIO, A, B, timed
from trsim.system import processors

P1 = str(SCENARIOS / "validation" / "slider_crank_friction.yaml")
REVERSER = (
    "--set", f"{A}=lin(0.25 mm, 0.35 mm, 40)", "--set", f"{B}=lin(0.25 mm, 0.35 mm, 25)",
)  # fmt: skip
CRANK = (
    "--set", "solver.end=3 ms", "--set", "joints.pin.clearance=lin(0.3 mm, 0.7 mm, 100)",
    "--set", "contact_laws.steel.restitution=lin(0.8, 0.95, 100)",
)  # fmt: skip


def main() -> None:
    print("| cases | wall time, s | CPU time of a case, ms | efficiency | MB | the same again, s |")
    print("|---|---|---|---|---|---|")
    with TemporaryDirectory() as folder:
        swept("of the reverser, 1 s", SCENARIO, REVERSER, Path(folder) / "reverser")
        swept("of P1 with friction, 3 ms", P1, CRANK, Path(folder) / "crank")


def swept(name: str, scenario: str, varied: Sequence[str], folder: Path) -> None:
    """A sweep, and the same again."""
    command = ("sweep", scenario, *varied, "--keep", "summary", "-o", str(folder))
    before = children()
    wall, told = timed(*command)
    cpu, cases = children() - before, told["cases"]
    if told["counts"] != {"done": cases}:
        raise RuntimeError(f"{name}: {told['counts']}")
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    again, told = timed(*command)
    if told["ran"]:
        raise RuntimeError(f"{name}: {told['ran']} ran again")
    print(f"| {cases:,} {name} | {wall:.0f} | {1e3 * cpu / cases:.0f} | "
          f"{cpu / (processors() * wall):.2f} | {size / 1e6:.0f} | {again:.1f} |",
          flush=True)  # fmt: skip


def children() -> float:
    """CPU time of the processes that have ended, s."""
    times = os.times()
    return times.children_user + times.children_system
