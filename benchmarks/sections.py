"""Poincare sections of the thrust reverser: located, and interpolated from its rows afterwards."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.measure import SCENARIOS
from benchmarks.tables import head, power, row
from trsim.analyse.section import section
from trsim.assemble.assemble import assemble
from trsim.scenario.load import load
from trsim.solve.simulate import simulate
from trsim.store.hdf5 import write
from trsim.store.read import Run, read

SCENARIO = SCENARIOS / "thrust_reverser" / "clearance_ab_0.3mm.yaml"
EVERY = ("0.1 ms", "0.01 ms")


def compared(run: Run, pin: str) -> tuple[int, int, np.ndarray, np.ndarray]:
    """Points located and interpolated, their distances, and what is stated for these (n, 2) m."""
    located = run.poincare[f"{pin}_orbit"]
    names = (f"{pin}.eccentricity_x_rate", f"{pin}.eccentricity_x", f"{pin}.eccentricity_y")
    found = section(run, *names)
    nearest = np.abs(located.time[:, None] - found.time).argmin(axis=0)
    off = [np.abs(getattr(found, axis) - getattr(located, axis)[nearest]) for axis in "xy"]
    stated = [getattr(found, f"{axis}_error") for axis in "xy"]
    return len(located.time), len(found.time), np.array(off), np.array(stated)


def main() -> None:
    """Print the table."""
    head("rows every", "section", "located", "interpolated", "error of x, y m: largest (median)",
         "stated m: largest (median)", "covered")  # fmt: skip
    for every in EVERY:
        scenario = load(SCENARIO, [f"output.every={every}"])
        mechanism = assemble(scenario)
        with TemporaryDirectory() as folder:
            path = Path(folder) / "run.h5"
            write(path, scenario, mechanism, simulate(scenario, mechanism))
            run = read(path)
            for pin in "AB":
                there, count, off, stated = compared(run, pin)
                covered = np.sum(np.all(off <= stated + 1e-15, axis=0))
                row(every, f"{pin}_orbit", there, count, told(off), told(stated),
                    "all" if covered == count else covered)  # fmt: skip


def told(x: np.ndarray) -> str:
    return f"{power(float(x.max()))} ({power(float(np.median(x)), 0)})"


if __name__ == "__main__":
    main()
