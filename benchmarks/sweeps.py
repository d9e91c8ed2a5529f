"""Sweeps: 200 cases of the thrust reverser, the same again, plans of 10 000, status of 1 000.

Wall time in s of whole commands, on all processors; efficiency is the time of one worker over
that of n, times n.
"""

import json
import subprocess
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.measure import ROOT, SCENARIOS, trsim
from benchmarks.tables import head, row
from trsim.system import processors

SCENARIO = str(SCENARIOS / "thrust_reverser" / "clearance_ab_0.3mm.yaml")
A, B = "joints.A.clearance", "joints.B.clearance"
FAST = ("--set", "solver.end=0.31 s", "--set", "output.every=1 ms")


def timed(*arguments: str) -> tuple[float, dict]:
    """Wall time of a command, and what it says."""
    began = time.perf_counter()
    done = subprocess.run(  # noqa: S603
        trsim(*arguments, "--json", "-q"), cwd=ROOT, check=True, capture_output=True
    )
    return time.perf_counter() - began, json.loads(done.stdout)


def counted(told: dict) -> str:
    """How many cases have which status."""
    return ", ".join(f"{count} {status}" for status, count in told["counts"].items())


def grid(n: int, m: int) -> tuple[str, ...]:
    return ("--set", f"{A}=lin(0.1 mm, 0.5 mm, {n})", "--set", f"{B}=lin(0.1 mm, 0.5 mm, {m})")


def main() -> None:
    head("what", "aim", "measured")
    with TemporaryDirectory() as folder:
        timed("run", SCENARIO, *FAST, "-o", str(Path(folder) / "warm.h5"))
        whole = ("sweep", SCENARIO, *grid(20, 10), "-o", str(Path(folder) / "whole"))
        seconds, told = timed(*whole)
        row("200 cases of 1 s, 10 001 rows each", "4 min", f"{seconds:.0f} s, {counted(told)}")
        seconds, told = timed(*whole)
        row("the same again", "2 s", f"{seconds:.2f} s, {told['ran']} run")
        seconds, _ = timed("status", str(Path(folder) / "whole"))
        row("their status", "", f"{seconds:.2f} s")
        part = (*grid(10, 4), *FAST)
        alone = 0.0
        for jobs in sorted({1, processors(), 8}):
            out = ("-o", f"{folder}/{jobs}", "-j", str(jobs))
            seconds, _ = timed("sweep", SCENARIO, *part, *out)
            alone = alone or seconds
            count = min(jobs, processors())
            told = f"efficiency {alone / seconds / count:.2f}"
            row(f"40 short cases, workers: {jobs}", "0.85", f"{seconds:.1f} s, {told}")
        out = ("-o", f"{folder}/plan")
        seconds, told = timed("sweep", SCENARIO, *grid(100, 100), "--explain", "--shard",
                              "1/10000", *FAST, *out)  # fmt: skip
        row("10 000 cases made and checked, one of them run", "5 s without the run",
            f"{seconds:.1f} s")  # fmt: skip
        many(Path(folder) / "many")


def many(folder: Path) -> None:
    """Status and repetition of 1 000 cases, which end at once."""
    short = ("--set", "solver.end=1 ms", "--set", "output.every=1 ms")
    command = ("sweep", SCENARIO, *grid(50, 20), *short, "-o", str(folder))
    seconds, _ = timed(*command)
    row("1 000 cases of 1 ms", "", f"{seconds:.0f} s")
    seconds, told = timed(*command)
    row("the same again", "2 s", f"{seconds:.2f} s, {told['ran']} run")
    seconds, _ = timed("status", str(folder))
    row("their status", "1 s", f"{seconds:.2f} s")
