"""Thrust reverser in space: a run and the twelve asynchronous ones as commands; error of its peaks.

CPU and wall seconds of whole processes, start-up and result files included; then the largest error
of the three peaks, and of the three forces at 1000 times over the largest of them, against a run
at a tolerance of 1e-11, equal speeds and actuator 2 slower; CPU of the integration alone, median
of three.
"""

from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import SCENARIOS, run, trsim
from benchmarks.startup import REPEATS, took
from benchmarks.tables import head, power, row
from trsim.system import processors

FOLDER = SCENARIOS / "thrust_reverser"
TOLERANCES = ("1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9")
REFERENCE = "1e-11"
FORCES = tuple(f"actuator_{k}.force" for k in (1, 2, 3))
CASES = {"equal speeds": (), "actuator 2 at 418 mm/s": ("parameters.speed_2=418 mm/s",)}
ROUNDS = 3


def commands() -> None:
    """Print what a user waits for."""
    head("whole commands", "wall s", "CPU s", "of it integration")
    with TemporaryDirectory() as folder:
        out = str(Path(folder) / "run.h5")
        command = trsim("run", str(FOLDER / "spatial_synchronous.yaml"), "-q", "--json", "-o", out)
        took(command)
        once = [took(command) for _ in range(REPEATS)]
        wall, cpu, integration = (median(column) for column in zip(*once, strict=True))
        row(f"the synchronous run, median of {REPEATS}", f"{wall:.2f}", f"{cpu:.2f}",
            f"{integration:.2f}")  # fmt: skip
        for k in range(ROUNDS):
            sweep = ("sweep", str(FOLDER / "spatial_asynchronous.yaml"), "-q", "-o")
            whole = took(trsim(*sweep, str(Path(folder) / f"sweep_{k}")))
            label = f"the twelve asynchronous runs, {processors()} processors"
            row(label, f"{whole.wall:.1f}", f"{whole.cpu:.1f}", "")


class Measured(NamedTuple):
    """Peaks and forces of the actuators, N; CPU of the integration, s; numbers of the run."""

    peaks: NDArray[np.float64]
    forces: NDArray[np.float64]  # (n, 3)
    cpu: float
    numbers: dict[str, float]


def measured(sets: tuple[str, ...], tolerance: str) -> Measured:
    """Of a case at a tolerance."""
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    sets = (*sets, f"solver.tolerance={tolerance}")
    scenario = load(FOLDER / "spatial_synchronous.yaml", sets)
    mechanism = assemble(scenario)
    runs = [run(scenario, mechanism) for _ in range(ROUNDS)]
    peaks = np.array([runs[0].peak(name) for name in FORCES])
    forces = np.stack([runs[0].channel(name) for name in FORCES], axis=1)
    cpu = median(r.outcome.statistics["integration_cpu"] for r in runs)
    return Measured(peaks, forces, cpu, runs[0].outcome.statistics)


def precision() -> None:
    """Print errors over tolerances."""
    print()
    head("", "tolerance", "CPU s", "steps", "evaluations", "peaks", "forces", "energy residual")
    for label, sets in CASES.items():
        exact = measured(sets, REFERENCE)
        for tolerance in TOLERANCES:
            found = measured(sets, tolerance)
            peaks = np.abs(found.peaks / exact.peaks - 1.0).max()
            forces = np.abs(found.forces - exact.forces).max() / np.abs(exact.forces).max()
            numbers = found.numbers
            row(
                label,
                tolerance,
                f"{found.cpu:.2f}",
                numbers["steps"],
                numbers["evaluations"],
                power(peaks),
                power(forces),
                power(numbers["energy_residual_relative"], 0),
            )
            label = ""  # once is enough


def main() -> None:
    commands()
    precision()


if __name__ == "__main__":
    main()
