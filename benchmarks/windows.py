"""P4: N four-bar windows, 10 s: largest energy error every 10 ms (J), and B0's at the end (m)."""

import json
from functools import partial

import numpy as np

from benchmarks.measure import ROOT, Run
from benchmarks.problems import windows
from benchmarks.tables import head, power, row
from benchmarks.work_precision import Point, Problem, at_bounds, cheapest, of_text, table

DATA = ROOT / "tests" / "data"
SIZES = (2, 10, 40)
TOLERANCES = tuple(10.0**-k for k in range(4, 11))
BOUND = 1e-3  # J


def energy_error(r: Run) -> float:
    total = r.channel("energy.kinetic") + r.channel("energy.stored.gravity")
    return float(np.max(np.abs(total - total[0])))


def place_error(r: Run, n: int) -> float:
    """Distance of B0 from where it should be at 10 s, m."""
    theta = json.loads((DATA / "p4_windows.json").read_text())[str(n)]["theta"][-1]
    return 2.0 * abs(np.sin(0.5 * (r.channel("theta")[-1] - theta)))


def main() -> None:
    from benchmarks.peers import compare

    at_bound: dict[int, Point | None] = {}
    every = []
    for n in SIZES:
        print(f"  N = {n}")
        few = {"starts": (None, 1.25), "repeats": 2} if n == 40 else {}
        problem = Problem(of_text(windows(n)), energy_error, (), partial(place_error, n=n))
        found = table(problem, "J", "B0 m", tolerances=TOLERANCES, **few)
        every.append(found)
        at_bounds(found, (BOUND,), "J")
        at_bound[n] = cheapest(found, BOUND)
        compare("windows", found, "J", n)
        print()
    small, large = at_bound[10], at_bound[40]
    if small and large:
        print(f"  N = 40 over N = 10 at {BOUND:g} J: {large.cpu / small.cpu:.1f} times the cost, "
              f"{large.each / small.each:.1f} times per evaluation")  # fmt: skip
    head("tolerance", *(told for n in SIZES for told in (f"N = {n}: energy J", "B0 m")))
    for several in zip(*every, strict=True):
        cells = ((power(p.error), power(p.other)) for p in several)
        row(power(several[0].tolerance, 0), *(cell for two in cells for cell in two))
