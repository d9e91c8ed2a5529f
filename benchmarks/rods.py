"""Thrust reverser: rigid and flexible pull rods of two masses, five runs each: forces and motion.

Clearance of 0.294, 0.297, 0.3, 0.303 and 0.306 mm at one pin: impacts of a run are chaotic, so
means over the five are told, with half of their range.  From 0.3 s on, when the door turns:
largest contact force, fluctuation of the door's rate and acceleration and of the drive force
(analyse/fluctuation.py), spread of the journal's centre, and how far the door's angle is from that
with the rigid rod of 0.5 kg.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from benchmarks.measure import SCENARIOS, Run, run
from benchmarks.tables import head, row

WORDS = {
    "rigid_rod_0.5kg": "rigid 0.5 kg",
    "flexible_rod_mass_matched": "flexible, 0.5 kg",
    "rigid_rod_3.454kg": "rigid 3.454 kg",
    "flexible_rod_paper_damped": "flexible, 3.454 kg, damped",
    "flexible_rod_paper": "flexible, 3.454 kg",
}
PINS = ("A", "B", "Q")
CLEARANCES = (0.294, 0.297, 0.3, 0.303, 0.306)  # mm
FROM, UNTIL = 0.3, 0.98  # s
NARROW = 0.03  # of the mean: half ranges below it are left out


class Quantity(NamedTuple):
    """A column of the table."""

    name: str
    of: Callable[[Run, str, Any], float]  # run, pin, door's angle with the first rod
    form: str


def peak(r: Run, pin: str, _: Any) -> float:
    """Largest contact force, N; it is one of the turn."""
    largest, at = r.outcome.peaks[r.columns[f"{pin}.contact_force"]][:2]
    if at < FROM:
        raise ValueError(f"the largest force, {largest:g} N at {at:g} s, is not one of the turn")
    return float(largest)


def fluctuates(channel: str, component: int = 0) -> Callable[[Run, str, Any], float]:
    def of(r: Run, pin: str, _: Any) -> float:
        from trsim.analyse.fluctuation import fluctuation

        x = r.rows[:, 1 + r.columns[channel] + component]
        return fluctuation(r.rows[:, 0], x, FROM, UNTIL)

    return of


def orbit(r: Run, pin: str, _: Any) -> float:
    """Root mean square distance of the journal's centre from its mean place, um."""
    late = (r.rows[:, 0] >= FROM) & (r.rows[:, 0] <= UNTIL)
    x, y = (r.channel(f"{pin}.eccentricity_{c}")[late] for c in "xy")
    return float(1e6 * np.sqrt(np.var(x) + np.var(y)))


def turned(r: Run, pin: str, angle: Any) -> float:
    """Largest difference of the door's angle, deg."""
    return float(np.degrees(np.max(np.abs(r.channel("door_angle") - angle))))


QUANTITIES = (
    Quantity("peak force N", peak, ".0f"),
    Quantity("door's rate rad/s", fluctuates("door_angle.rate"), ".3f"),
    Quantity("its acceleration rad/s^2", fluctuates("door.angular_acceleration", 2), ".0f"),
    Quantity("drive N", fluctuates("actuator.force"), ".0f"),
    Quantity("orbit um", orbit, ".0f"),
    Quantity("angle deg", turned, ".2f"),
)


def runs(rod: str, pin: str) -> tuple[list[Run], float]:
    """A run for each clearance, and the median of their CPU times, s."""
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import load

    path, found = SCENARIOS / "thrust_reverser" / f"{rod}.yaml", []
    for c in CLEARANCES:
        sets = [f"joints.{pin}.clearance={c} mm", f"joints.{pin}.contact=pin"]
        if pin != "B":
            sets.append("joints.B.clearance=0")
        scenario = load(path, sets)
        found.append(run(scenario, assemble(scenario)))
    return found, float(np.median([r.outcome.statistics["integration_cpu"] for r in found]))


def main() -> None:
    """Print the table."""
    head("0.3 mm at", "rod", *(q.name for q in QUANTITIES), "CPU s")
    for pin in PINS:
        angles: list[Any] = []
        for rod in WORDS:
            several, cpu = runs(rod, pin)
            angles = angles or [r.channel("door_angle") for r in several]
            cells = []
            for q in QUANTITIES:
                values = [q.of(r, pin, a) for r, a in zip(several, angles, strict=True)]
                half = 0.5 * (max(values) - min(values))
                mean = float(np.mean(values))
                told, apart = f"{mean:{q.form}}", f"{half:{q.form}}"
                wide = half > NARROW * mean and float(apart) > 0.0
                cells.append(f"{told} +- {apart}" if wide else told)
            row(pin, WORDS[rod], *cells, f"{cpu:.2f}")


if __name__ == "__main__":
    main()
