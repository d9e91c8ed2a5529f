"""P1: slider-crank with a clearance pin, 3 ms: largest error of the slider's velocity / 30 m/s."""

from statistics import median

import numpy as np

from benchmarks.measure import ROOT, Run
from benchmarks.problems import VALIDATION
from benchmarks.tables import head, power, row
from benchmarks.work_precision import Point, Problem, at_bounds, cheapest, of_file, slope, table

DATA = ROOT / "tests" / "data"
TOLERANCES = tuple(10.0**-k for k in range(2, 11))
FRICTION = {"frictionless": 0.0, "friction": 0.01}
BOUNDS = (3e-4, 1e-5, 1e-7)
FIRST_STEPS = (0.6e-6, 0.8e-6, 1e-6, 1.25e-6, 1.7e-6)  # s, of the program by hand
CHANNEL, SPEED = "slider.velocity", 30.0  # m/s, what errors are divided by
END, ROWS = "solver.end=3 ms", ("output.every=4e-6", f'output.channels=["{CHANNEL}"]')


def reference(variant: str) -> np.ndarray:
    """Times, s, and velocity of the slider, m/s, by a separate program."""
    return np.genfromtxt(DATA / f"p1_{variant}.csv", delimiter=",", names=True, skip_header=3)


def by_hand(known: np.ndarray, coefficient: float) -> list[Point]:
    """The hand-written program's points, medians over first steps."""
    from benchmarks.minimal import run

    none, found = np.zeros(0), []
    for tolerance in TOLERANCES:
        errors, cpu, steps = [], [], 0
        for first in FIRST_STEPS:
            r = run(tolerance, coefficient, known["t"], first)
            errors.append(np.max(np.abs(r.velocity - known["slider_v"])) / SPEED)
            cpu += [run(tolerance, coefficient, none, first).cpu for _ in range(5)]
            steps = r.steps
        found.append(Point(tolerance, median(errors), max(errors), median(cpu), steps,
                           12 * steps, 0.0))  # fmt: skip
    return found


def main() -> None:
    from benchmarks.peers import compare

    both = []
    for variant, coefficient in FRICTION.items():
        known = reference(variant)

        def error(r: Run, right: np.ndarray = known) -> float:
            velocity = np.interp(right["t"], r.rows[:, 0], r.channel(CHANNEL))
            return float(np.max(np.abs(velocity - right["slider_v"]))) / SPEED

        print(f"  {variant}")
        path = VALIDATION / f"slider_crank_{variant}.yaml"
        found = table(Problem(of_file(path, END), error, ROWS), "-")
        both.append(found)
        at_bounds(found, BOUNDS, "")
        hand = by_hand(known, coefficient)
        print("  by hand, two degrees of freedom (benchmarks/minimal.py)")
        for p in hand:
            print(f"  {p.tolerance:9.0e}   {p.error:11.1e}   {p.worst:7.1e} {1e3 * p.cpu:8.3f} "
                  f"{p.steps:7d}")  # fmt: skip
        print(f"  slope {slope(hand, 1e-9, 1e-3):.2f} over 1e-09..1e-03")
        for bound in BOUNDS:
            ours, theirs = cheapest(found, bound), cheapest(hand, bound)
            if ours and theirs:
                print(f"  error <= {bound:.0e}: {ours.cpu / theirs.cpu:.1f} times by hand")
        if variant == "frictionless":
            compare("slider_crank", found, "")
        print()
    head("tolerance", "frictionless: error", "evaluations", "friction: error", "evaluations")
    for pair in zip(*both, strict=True):
        cells = ((power(p.error), p.evaluations) for p in pair)
        row(power(pair[0].tolerance, 0), *(cell for two in cells for cell in two))
