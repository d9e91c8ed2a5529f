"""Thousands of cases of which numbers are kept: the reverser with play, and P1.

Wall time in s of whole commands on all processors, the CPU time of a case, the efficiency (CPU
time over processors times wall time), and what the folder takes.
"""

import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.measure import SCENARIOS
from benchmarks.sweeps import SCENARIO, A, B, timed
from trsim.system import processors

P1 = str(SCENARIOS / "validation" / "slider_crank_friction.yaml")
P1_CASES = ("joints.pin.clearance", "contact_laws.steel.restitution")


def main() -> None:
    some = float(sys.argv[2]) if len(sys.argv) > 2 else 1.0  # a share of the cases
    reverser = (
        "--set", f"{A}=lin(0.25 mm, 0.35 mm, {round(40 * some)})",
        "--set", f"{B}=lin(0.25 mm, 0.35 mm, 25)",
    )  # fmt: skip
    clearance, restitution = P1_CASES
    crank = (
        "--set", "solver.end=3 ms",
        "--set", f"{clearance}=lin(0.3 mm, 0.7 mm, {round(100 * some)})",
        "--set", f"{restitution}=lin(0.8, 0.95, 100)",
    )  # fmt: skip
    with TemporaryDirectory() as folder:
        swept("reverser, 1 s", SCENARIO, reverser, Path(folder) / "reverser")
        swept("P1 with friction, 3 ms", P1, crank, Path(folder) / "crank")


def swept(name: str, scenario: str, varied: Sequence[str], folder: Path) -> None:
    """One sweep, and the same again."""
    command = ("sweep", scenario, *varied, "--keep", "summary", "-o", str(folder))
    before = children()
    wall, told = timed(*command)
    cpu = children() - before
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    cases, share = told["cases"], cpu / (processors() * wall)
    each = 1e3 * cpu / cases
    print(f"  {cases:,} cases of {name}: {wall:.0f} s, {each:.0f} ms of CPU time each, efficiency "
          f"{share:.2f}, {size / 1e6:.0f} MB, {told['counts']}", flush=True)  # fmt: skip
    began = time.perf_counter()
    _, told = timed(*command)
    print(f"  the same again: {time.perf_counter() - began:.2f} s, {told['ran']} run", flush=True)


def children() -> float:
    """CPU time of the processes that have ended, s."""
    times = os.times()
    return times.children_user + times.children_system
