"""P2: flexible pendulum of 8 and 16 elements, 2 s: largest error of tip and middle, m."""

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import ROOT, SCENARIOS, Run
from benchmarks.tables import head, power, row
from benchmarks.work_precision import Problem, at_bounds, of_file, table

DATA = ROOT / "tests" / "data"
SCENARIO = SCENARIOS / "validation" / "flexible_pendulum.yaml"
SIZES = (8, 16)
METHODS = ("radau", "dop853", "auto")
TOLERANCES = (1e-3, 3e-4, 2e-4, 1e-4, 1e-5, 1e-6, 1e-7)
BOUND = 1.2e-5  # m


def reference(n: int) -> NDArray[np.float64]:
    """Tip and middle every 10 ms, (201, 6)."""
    lines = (DATA / f"p2_pendulum_{n}_elements.csv").read_text().splitlines()
    return np.array([[float(x) for x in s.split(",")[1:]] for s in lines if s[0] in "0123456789"])


def error(r: Run, n: int) -> float:
    """Largest difference of a coordinate of tip or middle to the reference of the same mesh, m."""
    first = [1 + r.columns[f"rod.{name}"] for name in ("tip", "middle")]
    found = np.hstack([r.rows[:, k : k + 3] for k in first])
    return float(np.max(np.abs(found - reference(n))))


def main() -> None:
    from benchmarks.peers import compare

    every = []
    for n in SIZES:
        best = []
        for method in METHODS:
            print(f"  {n} elements, {method}")
            source = of_file(SCENARIO, f"bodies.rod.elements={n}", f"solver.method={method}")
            problem = Problem(source, lambda r, n=n: error(r, n))
            found = table(problem, "m", tolerances=TOLERANCES, starts=(None, 0.6, 1.7), repeats=2)
            at_bounds(found, (BOUND,), "m")
            best += found
            every += [(n, method, p) for p in found]
        compare("flexible_pendulum", best, "m", n)
        print()
    head("elements", "method", "tolerance", "error m", "CPU s", "evaluations")
    for n, method, p in every:
        row(n, method, power(p.tolerance, 0), power(p.error), f"{p.cpu:.3f}", p.evaluations)
