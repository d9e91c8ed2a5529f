"""The cells: five mechanisms, levels of five parameters, five methods."""

import random
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from benchmarks.measure import SCENARIOS
from trsim.scenario.load import load

REVERSER = SCENARIOS / "thrust_reverser" / "mechanism.yaml"
CRANK = SCENARIOS / "validation" / "slider_crank_friction.yaml"
SYSTEMS = {  # name -> pins with clearance; rods of 0.3 to 0.5 kg have it at both of their ends
    "reverser B": ("B",),
    "reverser A+B": ("A", "B"),
    "large rod A+P": ("A", "P"),
    "transfer rod P+Q": ("P", "Q"),
    "slider-crank": ("pin",),
}
CLEARANCES = (1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 5e-3)  # m
RESTITUTIONS = (0.0, 0.2, 0.5, 0.9, 1.0)
FRICTIONS = (0.0, 0.01, 0.1, 0.3, 1.0)
SPEEDS = (0.01, 0.1, 0.5, 2.0, 10.0)  # m/s, of the drive or the crank pin
STIFFNESSES = (1e-3, 1.0, 1e3)  # of Hertz' internal contact
METHODS = ("auto", "dop853", "radau", "generalized_alpha", "rk4")
TOLERANCES = (1e-4, 1e-5, 1e-6)
STEPS = (1e-5, 2e-6, 1e-6)  # s, of rk4
CASES = 20  # of each system
CRANK_RADIUS, ROWS = 0.05, 4000  # m; output rows of a run
TOUCH, WINDOW = 0.15, 0.05  # m: stroke at which the lug touches, and from how far before
MODULUS, RADIUS, POISSON = 207e9, 0.01, 0.29  # of the pins: Pa, m


@dataclass(frozen=True)
class Case:
    """A mechanism in one state of wear, and how fast it is driven."""

    system: str
    clearance: float
    restitution: float
    friction: float
    speed: float
    stiffness: float
    settings: tuple[tuple[str, float], ...] = field(default=(), compare=False)  # method, tolerance

    @property
    def name(self) -> str:
        return (
            f"{self.system} c={self.clearance:g} e={self.restitution:g} mu={self.friction:g} "
            f"v={self.speed:g} K={self.stiffness:g}"
        )

    def scenario(self) -> Any:
        """The scenario, ready to be assembled."""
        pins = SYSTEMS[self.system]
        law, file = ("steel", CRANK) if self.system == "slider-crank" else ("pin", REVERSER)
        changes: dict[str, Any] = {
            f"contact_laws.{law}.youngs_modulus": MODULUS * self.stiffness,
            f"contact_laws.{law}.restitution": self.restitution,
            f"contact_laws.{law}.friction.coefficient": self.friction,
        }
        for pin in pins:
            changes[f"joints.{pin}.clearance"] = self.clearance
            changes[f"joints.{pin}.contact"] = law
        if file is CRANK:
            turn = self.speed / CRANK_RADIUS  # rad/s
            end = 1.5 / turn
            changes["drives.motor.velocity"] = turn
            changes[f"contact_laws.{law}.slowest_impact"] = 0.01 * min(1.0, self.speed)
        else:
            # 0.25 to 0.45 s of the stroke at 0.5 m/s; at other speeds the same stretch, or 0.2 s
            end = min(0.2, 2.0 * WINDOW / self.speed)
            before = min(WINDOW / 2.0, 0.25 * end * self.speed)
            changes["parameters.speed"] = self.speed
            changes["initial.guide"] = TOUCH - before
            changes["initial.equilibrium"] = "[B]" if "B" in pins else "[]"
        changes["solver.end"] = end
        changes["output.every"] = end / ROWS
        return load(file, [f"{key}={value}" for key, value in changes.items()])


def cases(count: int = CASES) -> Iterator[Case]:
    """`count` cases of each system: every level of every parameter equally often, seeded."""
    for system in SYSTEMS:
        dice = random.Random(system)  # noqa: S311
        columns = [
            spread(levels, count, dice)
            for levels in (CLEARANCES, RESTITUTIONS, FRICTIONS, SPEEDS, STIFFNESSES)
        ]
        for values in zip(*columns, strict=True):
            settings = tuple(
                (method, dice.choice(STEPS if method == "rk4" else TOLERANCES))
                for method in METHODS
            )
            yield Case(system, *values, settings)


def spread(levels: tuple[float, ...], count: int, dice: random.Random) -> list[float]:
    """`count` values in random order, each level as often as the others."""
    column = [levels[k % len(levels)] for k in range(count)]
    dice.shuffle(column)
    return column
