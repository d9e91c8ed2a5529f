"""Mass, centre and inertia of every body, and where they come from."""

from collections.abc import Iterator
from typing import Any, NamedTuple


class Weight(NamedTuple):
    """What a body weighs.

    body     its name
    mass     kg
    centre   centre of mass as drawn, m, world axes
    inertia  Ixx, Iyy, Izz, Ixy, Ixz, Iyz in body axes, kg*m^2; or one, about z
    origin   where mass, centre and inertia come from
    """

    body: str
    mass: float
    centre: tuple[float, ...]
    inertia: tuple[float, ...]
    origin: str


def weights(scenario: Any) -> Iterator[Weight]:
    """Of all bodies, in their order."""
    taken = {total.remainder: (name, total) for name, total in scenario.totals.items()}
    for name, body in scenario.bodies.items():
        rigid = body.as_rigid()
        inertia = rigid.inertia if isinstance(rigid.inertia, tuple) else (rigid.inertia,)
        origin = body.origin
        if name in taken:
            total, of = taken[name]
            keys = ["mass", *(key for key in ("at", "inertia") if getattr(of, key) is not None)]
            what = {"mass": "mass", "at": "centre", "inertia": "inertia"}
            origin = f"{', '.join(what[key] for key in keys)} left of total '{total}'; {origin}"
        yield Weight(name, rigid.mass, tuple(rigid.at), tuple(inertia), origin)
