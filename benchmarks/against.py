"""CPU time of the integration beside that of another tree of trsim: interleaved pairs.

    python -m benchmarks.against FOLDER [--pairs 31] [CASE ...]

FOLDER holds another tree, or is a revision of git.  One process of each tree assembles the case
once; then both integrate in turn, each first in every other pair.  Where a process happens to lie
in memory changes its speed by some per cent: after some pairs two new ones go on (trees/turns.py).
A pair's ratio is of the CPU times of both; the median over the pairs is given with the bounds of
its 95 % interval, which are order statistics of the ratios (binomial), so that nothing is assumed
of how they are distributed.

Where steps happen to lie changes their number by some per cent, next to singular places and in
chaotic motion by more.  So a case is DRAWS runs, with tolerances from the one named to SPREAD times
that; clearances that are in chaotic motion differ by CHANCE too.  Of all settings of a problem the
geometric mean of their ratios is taken pair by pair.
"""

import argparse
from pathlib import Path
from statistics import geometric_mean, median

from benchmarks.measure import SCENARIOS
from benchmarks.tables import head, row
from benchmarks.trees import HERE, Tree, there
from benchmarks.trees.turns import Task, measured, told

VALIDATION, REVERSER = SCENARIOS / "validation", SCENARIOS / "thrust_reverser"
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


def drawn(source: str, sets: list[str]) -> list[list[str]]:
    """What is set in each run of a case."""
    from trsim.scenario.load import load, loads

    given = loads(source, sets) if "\n" in source else load(Path(source), sets)
    end, tolerance, found = given.solver.end, given.solver.tolerance, []
    for k in range(DRAWS):
        other = [f"solver.tolerance={tolerance * SPREAD ** (k / (DRAWS - 1))!r}"]
        for name, joint in given.joints.items():
            if clearance := getattr(joint, "clearance", None):
                other.append(f"joints.{name}.clearance={clearance * (1 + CHANCE * k)!r}")
        found.append([*sets, *other, f"output.every={end!r}", "output.channels=[]"])
    return found


def compared(tree: Tree, name: str, source: str, sets: list[str], pairs: int) -> list[float]:
    """The ratios of all pairs of one case, whose row of the table is printed."""
    task: Task = ("integrated", {"source": source, "runs": drawn(source, sets)})
    found = measured((tree, HERE), [[task], [task]], pairs)
    first, second = ([cpu for cpu, _ in of_tree[0]] for of_tree in found)
    (_, before), (_, after) = (of_tree[0][-1] for of_tree in found)
    counts = [f"{before[k]:.0f}, {after[k]:.0f}" for k in after]
    ratios = [two / one for one, two in zip(first, second, strict=True)]
    times = (f"{1e3 * median(of_tree) / DRAWS:.2f}" for of_tree in (first, second))
    row(name, *times, *told(ratios), *counts)
    return ratios


def main() -> None:
    read = argparse.ArgumentParser(prog="python -m benchmarks.against", description=__doc__)
    read.add_argument("folder", help="another tree, or a revision of git")
    read.add_argument("case", nargs="*", help="those whose names begin with it; all unless given")
    read.add_argument("--pairs", type=int, default=31)
    a = read.parse_intermixed_args()
    tree = there(a.folder)
    head("case", "ms there", "ms here", "ratio", "95 %", "steps", "rejected", "evaluations")
    problems: dict[str, list[list[float]]] = {}
    for name, (source, sets) in cases().items():
        if not a.case or any(name.startswith(one) for one in a.case):
            ratios = compared(tree, name, source, sets, a.pairs)
            problems.setdefault(name.split()[0], []).append(ratios)
    print()
    head("problem", "settings", "ratio", "95 %")
    for name, settings in problems.items():
        together = [geometric_mean(of_pair) for of_pair in zip(*settings, strict=True)]
        row(name, len(settings), *told(together))


if __name__ == "__main__":
    main()
