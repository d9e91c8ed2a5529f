"""A01: simple pendulum, 10 s: largest energy error sampled every 10 ms (J)."""

import numpy as np

from benchmarks.measure import Run
from benchmarks.problems import VALIDATION
from benchmarks.work_precision import Problem, at_bounds, of_file, table


def error(r: Run) -> float:
    total = r.channel("energy.kinetic") + r.channel("energy.stored.gravity")
    return float(np.max(np.abs(total - total[0])))


def main() -> None:
    problem = Problem(of_file(VALIDATION / "pendulum_a01.yaml"), error)
    found = table(problem, "J", tolerances=[10.0**-k for k in range(2, 10)])
    at_bounds(found, (5e-5,), "J")
    print("  the bar is massless: the ball has 1e-9 kg m^2 about its centre, since 0 is refused")
