"""Which bodies there are: rigid ones, and flexible bars as beams or, for a start, as rigid ones."""

from itertools import islice
from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.elements.joint import perpendicular, place_on
from trsim.errors import ModelError, ScenarioError
from trsim.scenario.slender import ends

Array = NDArray[np.float64]

AT_A_NODE = 1e-6  # of its length: a joint so far from a node is at it
MOST_TRIED = 100  # elements
SHORTEST, LONGEST = 1e-9, 1e9  # m, of elements
LIGHTEST, HEAVIEST = 1e-30, 1e30  # kg
THINNEST, THICKEST = 1e-9, 1e3  # sqrt(I/A), of the length of an element
SLOWEST, LIGHT, HIGHEST = 1e-6, 3e8, 1e12  # m/s, 1/s


class Beam(NamedTuple):
    """The nodes of a flexible bar as drawn."""

    first: int  # frame of its first node
    nodes: int
    element: int  # its first one among the elements of all beams
    whole: float  # m, of the bar
    tangent: tuple[float, float, float]
    axes: Array  # (3, 3) of its nodes, the tangent first
    places: Array  # (nodes, 3)
    per_length: float  # kg/m
    stiffness: float  # EA, N
    bending: float  # EI, N*m^2

    @property
    def length(self) -> float:
        """The length of one element, m."""
        return self.whole / (self.nodes - 1)


def members(scenario: Any, stiff: bool = False) -> dict[str, Any]:
    """The bodies by name, flexible ones as the bars that are solved; with `stiff` all rigid."""
    found = {}
    for name, spec in scenario.bodies.items():
        found[name] = spec
        if spec.flexible is None:
            continue
        try:
            bar = spec.bar(*ends(scenario, name))
        except ScenarioError as error:
            raise error.at("bodies", name) from None
        check_solvable(name, bar)
        found[name] = bar.as_rigid() if stiff else bar
    return found


def check_solvable(name: str, bar: Any) -> None:
    """Refuse bars whose numbers no arithmetic of 16 digits carries; they are slips of units.

    With l the length of an element, c = sqrt(E A / rho A) the speed of waves along it and
    r = sqrt(I / A): c / l and c r / l^2 are the fastest frequencies, r / l what bending is to
    stretching.
    """
    area, moment, _ = bar.numbers
    l = bar.length / bar.elements
    if not SHORTEST <= l <= LONGEST:
        raise _unsolvable(name, f"elements of {l:.3g} m", f"{SHORTEST:g} to {LONGEST:g} m")
    mass = bar.per_length * l
    if not LIGHTEST <= mass <= HEAVIEST:
        raise _unsolvable(name, f"elements of {mass:.3g} kg", f"{LIGHTEST:g} to {HEAVIEST:g} kg")
    r = sqrt(moment / area) / l if area > 0.0 else 0.0
    if not THINNEST <= r <= THICKEST:
        what = f"sqrt(I/A) of {r * l:.3g} m in elements of {l:.3g} m"
        raise _unsolvable(name, what, f"{THINNEST:g} to {THICKEST:g} of their length")
    c = sqrt(bar.youngs_modulus / mass) * sqrt(area * l)
    if not SLOWEST <= c <= LIGHT:
        what = f"waves of {c:.3g} m/s along it, sqrt(E A/(mass/length))"
        raise _unsolvable(name, what, f"{SLOWEST:g} m/s to the speed of light")
    fastest = c / l * max(1.0, r)
    if not fastest <= HIGHEST:
        what = f"a frequency of {fastest:.3g} 1/s in elements of {l:.3g} m"
        raise _unsolvable(name, what, f"at most {HIGHEST:g} 1/s")


def _unsolvable(name: str, what: str, limits: str) -> ModelError:
    hint = f"{limits} can be solved; check the units of length, section, modulus and density"
    return ModelError(f"the bar has {what}", hint, ("bodies", name))


def beams(bodies: dict[str, Any], first: int) -> dict[str, Beam]:
    """The beams among the bodies; frame `first` is the first of their nodes."""
    found: dict[str, Beam] = {}
    element = 0
    for name, bar in bodies.items():
        if bar.flexible is None:
            continue
        nodes = bar.elements + 1
        part = np.linspace(0.0, 1.0, nodes)[:, None]
        places = (1.0 - part) * np.array(bar.start) + part * np.array(bar.end)
        t = bar.tangent
        found[name] = Beam(
            first,
            nodes,
            element,
            bar.length,
            (t[0], t[1], t[2]),
            axes(t),
            places,
            bar.per_length,
            bar.youngs_modulus * bar.numbers[0],
            bar.youngs_modulus * bar.numbers[1],
        )
        first, element = first + nodes, element + bar.elements
    return found


def axes(t: Array) -> Array:
    """Axes of a node with the tangent t, columns; in the plane turned about z."""
    if t[2] == 0.0:
        return np.array([[t[0], -t[1], 0.0], [t[1], t[0], 0.0], [0.0, 0.0, 1.0]])
    across = np.array(perpendicular(tuple(t))[0])
    return np.stack([t, across, np.cross(t, across)], axis=1)


def off_the_nodes(scenario: Any, name: str, beam: Beam, place: Array) -> tuple[str, str]:
    """What is wrong with a place that is at no node, and what to do about it."""
    away = np.linalg.norm(beam.places - place, axis=1)
    nearest = shown(beam.places[int(np.argmin(away))])
    along, off = on_line(beam, place)
    if off > AT_A_NODE or not -AT_A_NODE <= along <= 1.0 + AT_A_NODE:
        return (
            f"is not on the line of '{name}', from {shown(beam.places[0])} to "
            f"{shown(beam.places[-1])}",
            f"a flexible bar is joined and loaded at its nodes, the nearest is at {nearest}; fix a "
            "rigid body to the bar to reach further",
        )
    fits = counts([on_line(beam, np.array(p))[0] for p in [*held(scenario, name), place]])
    hint = (
        f"the nearest is at {nearest}; `elements: {fits[0]}` puts nodes at all joints and loads of "
        f"'{name}'" + (f", and so do {' and '.join(map(str, fits[1:]))}" if fits[1:] else "")
        if fits
        else f"the nearest is at {nearest}, and no number of elements up to {MOST_TRIED} puts "
        f"nodes at all joints and loads of '{name}': move one of them"
    )
    return f"is {away.min():.3g} m away from the nearest node of '{name}'", hint


def held(scenario: Any, name: str) -> list[tuple[float, ...]]:
    """Where joints and forces need a node of a body."""
    found = [place_on(j, name) for j in scenario.joints.values() if name in j.bodies]
    for force in scenario.forces.values():
        point = getattr(force, "point", None)
        pairs = [
            (getattr(force, "body", None), getattr(force, "at", None)),
            *zip(getattr(force, "bodies", ()), getattr(force, "points", ()), strict=False),
            (getattr(point, "body", None), getattr(point, "at", None)),
        ]
        found += [at for body, at in pairs if body == name]
    return [at for at in found if at is not None]


def on_line(beam: Beam, place: Array) -> tuple[float, float]:
    """How far along a bar a place is and how far off its line, both in lengths of the bar."""
    r = (place - beam.places[0]) / beam.whole
    along = float(r @ np.array(beam.tangent))
    return along, float(np.linalg.norm(r - along * np.array(beam.tangent)))


def counts(places: list[float]) -> list[int]:
    """The first numbers of elements with nodes at all places (0..1 along the bar)."""
    fit = (
        n
        for n in range(1, MOST_TRIED + 1)
        if all(abs(s - round(s * n) / n) <= AT_A_NODE for s in places)
    )
    return list(islice(fit, 3))


def shown(place: Array) -> str:
    return f"[{place[0]:.6g}, {place[1]:.6g}, {place[2]:.6g}]"
