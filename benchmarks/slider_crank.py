"""P1: slider-crank with a clearance pin, 3 ms: error of the slider's velocity against CPU time."""

import numpy as np

from benchmarks.measure import ROOT, SCENARIOS, median, run

DATA = ROOT / "tests" / "data"
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)


def main() -> None:
    from trsim.assemble.assemble import assemble
    from trsim.spec.load import load

    for variant in ("frictionless", "friction"):
        path = SCENARIOS / "validation" / f"slider_crank_{variant}.yaml"
        reference = np.genfromtxt(
            DATA / f"p1_{variant}.csv", delimiter=",", names=True, skip_header=3
        )
        print(f"  {variant}\n  tolerance   max |dv| / 30 m/s   CPU ms   evaluations   events")
        errors = []
        for tolerance in TOLERANCES:
            scenario = load(path, [f"solver.tolerance={tolerance}", "solver.end=3 ms"])
            mechanism = assemble(scenario)
            result = run(scenario, mechanism)
            velocity = np.interp(
                reference["t"], result.rows[:, 0], result.channel("slider.velocity")
            )
            errors.append(np.max(np.abs(velocity - reference["slider_v"])) / 30.0)
            quiet = load(path, [f"solver.tolerance={tolerance}", "solver.end=3 ms",
                                "output.every=3 ms"])  # fmt: skip
            lean = assemble(quiet)
            cpu = median(lambda q=quiet, m=lean: run(q, m).outcome.statistics["integration_cpu"])
            numbers = result.outcome.statistics
            print(f"  {tolerance:9.0e}   {errors[-1]:17.1e}   {1e3 * cpu:6.2f}   "
                  f"{numbers['evaluations']:11d}   {numbers['events']:6d}")  # fmt: skip
        slope = np.polyfit(np.log(TOLERANCES), np.log(errors), 1)[0]
        print(f"  slope of error against tolerance: {slope:.2f}\n")
