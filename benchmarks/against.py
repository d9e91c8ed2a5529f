"""CPU time of the integration beside that of another tree of trsim: interleaved pairs.

    python -m benchmarks.against FOLDER [--pairs 31] [CASE ...]

FOLDER holds another tree with its own .venv.  One process of each tree assembles the case once;
then both integrate in turn, each first in every other pair.  Where a process happens to lie in
memory changes its speed by some per cent: every TOGETHER pairs two new ones go on.  A pair's ratio
is of the CPU times of both; the median over the pairs is given with the bounds of its 95 %
interval, which are order statistics of the ratios (binomial), so that nothing is assumed of how
they are distributed.

Where steps happen to lie changes their number by some per cent, next to singular places and in
chaotic motion by more.  So a case is DRAWS runs, with tolerances from the one named to SPREAD times
that; clearances that are in chaotic motion differ by CHANCE too.  Of all settings of a problem the
geometric mean of their ratios is taken pair by pair.
"""

import argparse
import json
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from math import comb
from pathlib import Path
from statistics import geometric_mean, median
from typing import Any

ROOT = Path(__file__).parent.parent
VALIDATION, REVERSER = ROOT / "scenarios/validation", ROOT / "scenarios/thrust_reverser"
TOGETHER = 2  # pairs of one process of each tree
LEAST = 0.03  # s of CPU of one measurement: shorter runs are repeated
DRAWS, SPREAD, CHANCE = 8, 1.3, 1e-5


def cases() -> dict[str, tuple[str, list[str]]]:
    """Name -> text or file of a scenario, and what is set in it."""
    from benchmarks.problems import bending_chain, chain, windows

    end, found = ["solver.end=3 ms"], {}
    for variant in ("frictionless", "friction"):
        for tolerance in ("1e-3", "1e-4", "1e-6", "1e-8"):
            found[f"P1 {variant} {tolerance}"] = (
                str(VALIDATION / f"slider_crank_{variant}.yaml"),
                [*end, f"solver.tolerance={tolerance}"],
            )
    for tolerance in ("1e-6", "1e-9"):
        found[f"P3 {tolerance}"] = (
            str(VALIDATION / "andrews.yaml"),
            [f"solver.tolerance={tolerance}"],
        )
    for n, tolerance in ((2, "1e-6"), (10, "1e-6"), (40, "1e-6"), (2, "1e-8")):
        found[f"P4 N={n} {tolerance}"] = (windows(n), [f"solver.tolerance={tolerance}"])
    found["P5 n=40 1e-8"] = (chain(40), [])
    found["P5 n=40 bending 1e-8"] = (bending_chain(40), [])
    for name in ("ideal", "clearance_b_0.3mm", "clearance_ab_0.3mm", "clearance_abpq_0.1mm"):
        found[f"reverser {name}"] = (str(REVERSER / f"{name}.yaml"), ["solver.end=0.5 s"])
    return found


WORKER = r"""
import json, sys
from pathlib import Path
try:
    from trsim.scenario.load import load, loads
except ModuleNotFoundError:  # as it was called in trees before November 2026
    from trsim.spec.load import load, loads
from trsim.assemble.assemble import assemble
from trsim.analyse.trajectory import marched
source, sets, draws, spread, chance = json.loads(sys.stdin.readline())
read = (lambda s: loads(source, s)) if "\n" in source else (lambda s: load(Path(source), s))
given = read(sets)
end, tolerance, ready = given.solver.end, given.solver.tolerance, []
for k in range(draws):
    other = [f"solver.tolerance={tolerance * spread ** (k / (draws - 1))!r}"]
    for name, joint in given.joints.items():
        if getattr(joint, "clearance", None):
            other.append(f"joints.{name}.clearance={joint.clearance * (1 + chance * k)!r}")
    scenario = read([*sets, *other, f"output.every={end!r}", "output.channels=[]"])
    ready.append((scenario, assemble(scenario)))
for line in sys.stdin:
    total, counts = 0.0, dict.fromkeys(("steps", "rejected_steps", "evaluations"), 0)
    for _ in range(int(line)):
        for scenario, mechanism in ready:
            numbers = marched(scenario, mechanism)[1].statistics
            total += numbers["integration_cpu"] / draws
            for k in counts:
                counts[k] += numbers[k] / draws / int(line)
    print(json.dumps([total, counts]), flush=True)
"""


@contextmanager
def worker(tree: Path, source: str, sets: list[str]) -> Iterator[Any]:
    """A call that integrates a number of times in another process: CPU s, the run's counts."""
    process = subprocess.Popen(  # noqa: S603
        [str(tree / ".venv/bin/python"), "-c", WORKER],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=tree,
    )  # fmt: skip
    ask, answer = process.stdin, process.stdout
    assert ask is not None and answer is not None
    ask.write(json.dumps([source, sets, DRAWS, SPREAD, CHANCE]) + "\n")

    def run(times: int) -> tuple[float, dict[str, float]]:
        ask.write(f"{times}\n")
        ask.flush()
        cpu, numbers = json.loads(answer.readline())
        return cpu, numbers

    try:
        yield run
    finally:
        ask.close()
        process.wait()


def interval(ratios: list[float]) -> tuple[float, float]:
    """Bounds of the median at 95 %: the k-th smallest and largest.

    k is the largest with P(Binomial(n, 1/2) < k) <= 2.5 %.
    """
    n, k, below = len(ratios), 0, 0.0
    while below + comb(n, k) / 2**n <= 0.025:
        below += comb(n, k) / 2**n
        k += 1
    ordered = sorted(ratios)
    return ordered[max(k - 1, 0)], ordered[min(n - k, n - 1)]


def measured(there: Any, here: Any, times: int, swap: bool) -> tuple[Any, Any]:
    """CPU and counts of a pair, the first of both in turn."""
    if swap:
        two = here(times)
        return there(times), two
    one = there(times)
    return one, here(times)


def compared(folder: Path, name: str, source: str, sets: list[str], pairs: int) -> list[float]:
    """The ratios of all pairs of one case, whose row of the table is printed."""
    first: list[float] = []
    second: list[float] = []
    while len(first) < pairs:
        with worker(folder, source, sets) as there, worker(ROOT, source, sets) as here:
            there(1), here(1)
            times = max(1, round(LEAST / DRAWS / min(there(1)[0], here(1)[0])))
            for pair in range(len(first), min(len(first) + TOGETHER, pairs)):
                (one, before), (two, after) = measured(there, here, times, pair % 2 == 0)
                first.append(one / times)
                second.append(two / times)
    took = f"{1e3 * median(first):.2f} | {1e3 * median(second):.2f}"
    counts = " | ".join(f"{before[k]:.0f}, {after[k]:.0f}" for k in after)
    ratios = [two / one for one, two in zip(first, second, strict=True)]
    print(f"| {name} | {took} | {told(ratios)} | {counts} |", flush=True)
    return ratios


def told(ratios: list[float]) -> str:
    """Their median and its interval, as two columns."""
    low, high = interval(ratios)
    return f"{median(ratios):.3f} | {low:.3f}..{high:.3f}"


def main() -> None:
    read = argparse.ArgumentParser(prog="python -m benchmarks.against", description=__doc__)
    read.add_argument("folder", type=Path)
    read.add_argument("case", nargs="*", help="those whose names begin with it; all unless given")
    read.add_argument("--pairs", type=int, default=31)
    a = read.parse_intermixed_args()
    print("| case | ms there | ms here | ratio | 95 % | steps | rejected | evaluations |")
    print("|---|---|---|---|---|---|---|---|")
    problems: dict[str, list[list[float]]] = {}
    for name, (source, sets) in cases().items():
        if not a.case or any(name.startswith(one) for one in a.case):
            ratios = compared(a.folder, name, source, sets, a.pairs)
            problems.setdefault(name.split()[0], []).append(ratios)
    print("\n| problem | settings | ratio | 95 % |\n|---|---|---|---|")
    for name, settings in problems.items():
        together = [geometric_mean(of_pair) for of_pair in zip(*settings, strict=True)]
        print(f"| {name} | {len(settings)} | {told(together)} |")


if __name__ == "__main__":
    main()
