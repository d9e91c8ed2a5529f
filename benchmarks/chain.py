"""P5: open chains of n rods, 0.2 s: error of the tip (m); cost per rod and right-hand side."""

import json

import numpy as np

from benchmarks.measure import ROOT, Run
from benchmarks.problems import LENGTH, bending_chain, chain
from benchmarks.work_precision import Point, Problem, at_bounds, cheapest, of_text, table

DATA = ROOT / "tests" / "data"
SIZES = (10, 40, 160)
TOLERANCES = tuple(10.0**-k for k in range(4, 11))
BOUND = 1e-8  # m


def tip(r: Run, n: int) -> np.ndarray:
    """End of the last rod at the end of the run (3,) m."""
    row = r.rows[-1, 1:]
    place, turn = (r.columns[f"rod{n - 1}.{name}"] for name in ("position", "rotation"))
    return row[place : place + 3] + 0.5 * LENGTH * row[turn : turn + 9 : 3]


def main() -> None:
    from benchmarks.peers import compare

    known = json.loads((DATA / "p5_chains.json").read_text())
    for kind, text in (("straight", chain), ("bending", bending_chain)):
        at_bound: dict[int, Point | None] = {}
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
            best = at_bound[n] = cheapest(found, BOUND)
            if best:
                print(f"  {1e6 * best.each / n:.2f} us per rod and right-hand side")
            if kind == "straight":
                compare("chain", found, "m", n)
            print()
        small, large = at_bound[40], at_bound[160]
        if small and large:
            print(f"  {kind}, n = 160 over n = 40: {large.each / small.each:.1f} "
                  "times the cost per evaluation\n")  # fmt: skip
