"""P5: open chains of n rods, 0.2 s: error of the tip (m); cost per rod and right-hand side."""

import json
import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np

from benchmarks.measure import ROOT, Run, run
from benchmarks.problems import LENGTH, bending_chain, chain
from benchmarks.tables import head, row
from benchmarks.work_precision import Problem, at_bounds, of_text, table, varied
from trsim.assemble.equations import evaluate
from trsim.elements.contract import SCENE, compiled
from trsim.kernels.signatures import A1, i8, void

DATA = ROOT / "tests" / "data"
SIZES = (10, 40, 160)
TOLERANCES = tuple(10.0**-k for k in range(4, 11))
BOUND = 1e-8  # m
ROUNDS = 9


def tip(r: Run, n: int) -> np.ndarray:
    """End of the last rod at the end of the run (3,) m."""
    row = r.rows[-1, 1:]
    place, turn = (r.columns[f"rod{n - 1}.{name}"] for name in ("position", "rotation"))
    return row[place : place + 3] + 0.5 * LENGTH * row[turn : turn + 9 : 3]


@compiled(void(SCENE, A1, A1, i8))
def often(s, y, yd, times):
    """The equations of motion, again and again."""
    for _ in range(times):
        evaluate(s, 0.0, y, yd)


def alone(mechanism: Any) -> float:
    """CPU time of the equations of motion by themselves, us per evaluation."""
    from trsim.elements.scene import scene

    work, y = scene(mechanism.model), mechanism.y0.copy()
    yd, times = np.zeros_like(y), 10_000 // mechanism.model.n
    start = time.process_time()
    often(work, y, yd, times)
    return 1e6 * (time.process_time() - start) / times


def costs(text: Callable[[int], str]) -> list[str]:
    """The CPU time of assembling, and per right-hand side, all that a step does included: printed,
    and as cells of a table.

    The lengths are run in turn, so that a busy minute of the machine meets all of them.
    """
    from trsim.assemble.assemble import assemble

    lean = {n: of_text(text(n))(["output.every=0.2", "output.channels=[]"]) for n in SIZES}
    models, built, each, bare = {}, {}, {n: [] for n in SIZES}, {n: [] for n in SIZES}
    for n in SIZES:
        start = time.process_time()
        models[n] = assemble(lean[n])
        built[n] = time.process_time() - start
    for _ in range(1 + ROUNDS):
        for n in SIZES:
            numbers = run(varied(lean[n], BOUND), models[n]).outcome.statistics
            each[n].append(1e6 * numbers["integration_cpu"] / numbers["evaluations"])
            bare[n].append(alone(models[n]))
    cells = []
    for n in SIZES:
        took = [cost / n for cost in each[n][1:]]
        cells.append(f"{min(took):.2f} ({median(took):.2f})")
        print(f"  n = {n:3d}: assembled in {built[n]:.2f} s; us per rod and right-hand side "
              f"{median(took):.2f}, least {min(took):.2f}; equations alone "
              f"{min(bare[n][1:]) / n:.2f}")  # fmt: skip
    ratio = median(large / small for small, large in zip(each[40][1:], each[160][1:], strict=True))
    print(f"  n = 160 over n = 40: {ratio:.2f} times the cost per right-hand side\n")
    return [*cells, f"{ratio:.2f} times"]


def main() -> None:
    from benchmarks.peers import compare

    known = json.loads((DATA / "p5_chains.json").read_text())
    measured = {}
    for kind, text in (("straight", chain), ("bending", bending_chain)):
        for n in SIZES:
            reference = np.array(known[kind][str(n)])
            print(f"  {kind}, n = {n}")
            ends = f'output.channels=["rod{n - 1}.position", "rod{n - 1}.rotation"]'
            problem = Problem(
                of_text(text(n)),
                lambda r, n=n, at=reference: float(np.linalg.norm(tip(r, n) - at)),
                ("output.every=0.2", ends),
            )
            few = {"starts": (None, 1.25), "repeats": 1} if n == 160 else {}
            found = table(problem, "m", tolerances=TOLERANCES, **few)
            at_bounds(found, (BOUND,), "m")
            compare("chain" if kind == "straight" else "bending_chain", found, "m", n)
            print()
        print(f"  {kind}, tolerance {BOUND:.0e}")
        measured[kind] = costs(text)
    head("", *(f"n = {n}" for n in SIZES), "n = 160 over n = 40")
    for kind, cells in measured.items():
        row(f"{kind}, us per rod", *cells)
