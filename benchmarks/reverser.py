"""Thrust reverser, 1 s: CPU time against the error of peak forces and statistics.

Peaks are the largest contact forces and the extremes of the drive force; loads are mean and root
mean square of each normal force and its share of time in contact; then the fluctuation of the drive
force and of the door's rate; loads and fluctuations from 0.3 s on.  CPU is that of runs that write
no rows.

A case that forgets its start is compared as an ensemble: clearances of its members are up to WIDTH
apart, and what is compared is the mean over them, with twice the standard error of the differences
of members with the same clearances.  Other first steps alone do not do: too little is forgotten
until the impacts near 0.301 s, which the largest forces belong to, so runs of one tolerance have
much the same ones, and runs of another tolerance others.
"""

from collections.abc import Sequence
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from benchmarks.measure import SCENARIOS, Run, run
from benchmarks.tables import head, power, row

FROM, UNTIL = 0.3, 0.98  # s
LONGEST = "solver.max_step=0.5 ms"  # with rows and without: the same steps
NO_ROWS = ("output.every=1", "output.channels=[]")
PINS = "ABPQ"
WIDTH = 1e-3  # of the clearances, to either side


class Case(NamedTuple):
    """A scenario and how it is compared."""

    name: str
    tolerances: tuple[float, ...]
    reference: float  # tolerance
    members: int  # 1: as one run


CASES = (
    Case("clearance_b_0.3mm", (1e-3, 1e-4, 1e-5, 1e-6), 1e-9, 1),
    Case("clearance_ab_0.3mm", (1e-3, 1e-4, 1e-5), 1e-7, 24),
    Case("clearance_ap_0.1mm", (1e-3, 1e-4, 1e-5), 1e-6, 24),
    Case("clearance_abpq_0.1mm", (1e-2, 1e-3, 1e-4), 1e-5, 24),
)


def peaks(r: Run) -> dict[str, float]:
    """Largest contact forces and extremes of the drive force, N."""
    names = [f"{pin}.contact_force" for pin in PINS]
    found = {name: r.peak(name) for name in names if name in r.columns}
    drive = r.outcome.peaks[r.columns["actuator.force"]]
    return {**found, "drive max": float(drive[0]), "drive min": float(drive[2])}


def loads(r: Run) -> dict[str, float]:
    """Mean (N), rms (N) and share of contact of each pin."""
    late, found = window(r), {}
    for pin in PINS:
        if f"{pin}.normal_force" in r.columns:
            force = r.channel(f"{pin}.normal_force")[late]
            found[f"{pin} mean"] = float(np.mean(force))
            found[f"{pin} rms"] = float(np.sqrt(np.mean(force**2)))
            found[f"{pin} in contact"] = float(np.mean(force > 0.0))
    return found


def fluctuations(r: Run) -> dict[str, float]:
    """Of the drive force, N, and of the door's rate, rad/s."""
    from trsim.analyse.fluctuation import fluctuation

    names = {"drive": "actuator.force", "door": "door_angle.rate"}
    t = r.rows[:, 0]
    return {word: fluctuation(t, r.channel(name), FROM, UNTIL) for word, name in names.items()}


def window(r: Run) -> Any:
    return (r.rows[:, 0] >= FROM) & (r.rows[:, 0] <= UNTIL)


KINDS = (peaks, loads, fluctuations)


class Found(NamedTuple):
    """Runs at one tolerance: of each kind the quantities by name, a value for each member."""

    kinds: tuple[dict[str, list[float]], ...]
    cpu: float  # s
    evaluations: int


def ensemble(name: str, tolerance: float, members: int) -> Found:
    """Runs of a scenario that differ a little in their clearances; one run is as it is written."""
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    path = SCENARIOS / "thrust_reverser" / f"{name}.yaml"
    given = load(path).joints
    clearances = {pin: given[pin].clearance for pin in PINS if hasattr(given[pin], "clearance")}
    kinds: tuple[dict[str, list[float]], ...] = tuple({} for _ in KINDS)
    cpu, counts = [], []
    for k in range(members):
        factor = 1.0 + WIDTH * (2.0 * k / (members - 1) - 1.0 if members > 1 else 0.0)
        sets = [f"solver.tolerance={tolerance!r}", LONGEST]
        sets += [f"joints.{pin}.clearance={factor * c!r}" for pin, c in clearances.items()]
        full, lean = (load(path, [*sets, *more]) for more in ([], NO_ROWS))
        r = run(full, assemble(full))
        for into, kind in zip(kinds, KINDS, strict=True):
            for quantity, value in kind(r).items():
                into.setdefault(quantity, []).append(value)
        of_lean = assemble(lean)
        for _ in range(3 if members == 1 else 1):
            numbers = run(lean, of_lean).outcome.statistics
            cpu.append(numbers["integration_cpu"])
        counts.append(numbers["evaluations"])
    return Found(kinds, median(cpu), int(median(counts)))


def worst(found: dict[str, list[float]], true: dict[str, list[float]]) -> tuple[str, float, float]:
    """The quantity furthest from the reference: its name, how far, and twice the standard error."""
    largest = ("", 0.0, 0.0)
    for name, values in found.items():
        centre = np.mean(true[name])
        off = np.subtract(values, true[name])
        away = abs(np.mean(off) / centre)
        if away >= largest[1]:
            largest = (name, float(away), 2.0 * error(off) / abs(centre))
    return largest


def error(values: Any) -> float:
    """Standard error of a mean; 0 of a single run."""
    return float(np.std(values, ddof=1) / np.sqrt(len(values))) if len(values) > 1 else 0.0


def told(of: tuple[str, float, float]) -> str:
    name, away, doubt = of
    said = f"{100 * away:.2g}" + (f" +- {100 * doubt:.2g}" if doubt else "")
    return f"{said} ({name})"


def main(cases: Sequence[Case] = CASES) -> None:
    """Print the table."""
    head("scenario", "tolerance", "CPU s", "evaluations", "peaks off by %", "loads %",
         "fluctuations %")  # fmt: skip
    for case in cases:
        true = ensemble(case.name, case.reference, case.members)
        for tolerance in case.tolerances:
            found = ensemble(case.name, tolerance, case.members)
            off = [told(worst(*pair)) for pair in zip(found.kinds, true.kinds, strict=True)]
            row(case.name, power(tolerance, 0), f"{found.cpu:.3f}", found.evaluations, *off)
        many = f"{case.members} runs" if case.members > 1 else "one run"
        row(f"{case.name}, reference", power(case.reference, 0), f"{true.cpu:.3f}",
            true.evaluations, many, "", "")  # fmt: skip
