"""Magnitudes no material and no body has: mostly a unit that was forgotten.

stiffness    E of 1 MPa (rubber) to 1 TPa (diamond); a stiffness in N/m^1.5 as the E of
             K = 4/3 E/(2 (1 - nu^2)) sqrt(R_i R_j/(R_i - R_j))
friction     coefficients of 0 to 2
mass         lighter than a wire a hundred times as long as thick at 1 kg/m^3, heavier than a
             solid cube at 30 000 kg/m^3; the edge of the cube is the body's extent
             L = max(largest distance of its points, sqrt(12) times the radius of gyration)
"""

from collections.abc import Iterator
from itertools import combinations
from math import dist, hypot, sqrt
from typing import Any

from trsim import elements
from trsim.elements.rows import slides as moves_along
from trsim.errors import ScenarioError

SOFTEST, HARDEST = 1e6, 1e12  # Pa
POISSON = 0.3  # where a law that gives K says nothing
STICKIEST = 2.0  # rubber on rubber is about 1
LIGHTEST, HEAVIEST = 1.0, 3e4  # kg/m^3; osmium is 22 600
WIRE = 100.0  # length over thickness
Places = dict[str, list[tuple[float, ...]]]  # body -> where it is held, as drawn


def moduli(scenario: Any) -> Iterator[str]:
    """Stiffness of what is in contact."""
    for name, law in scenario.contact_laws.items():
        for key in ("youngs_modulus", "journal_youngs_modulus"):
            E = getattr(law, key)
            if E is not None and not SOFTEST <= E <= HARDEST:
                yield (
                    f"contact_laws.{name}.{key}: {E:.3g} Pa; solids have 1 MPa (rubber) to 1 TPa "
                    f"(diamond), steel 2.1e+11 Pa: {prefix(E)}"
                )
    for name, joint, law in contacts(scenario):
        c = joint.clearance
        if not isinstance(law.stiffness, float):
            continue
        E = modulus(law.stiffness * c ** (law.exponent - 1.5), law.bearing_radius, c)
        if not SOFTEST <= E <= HARDEST:
            yield (
                f"joints.{name}: a stiffness of {law.stiffness:.3g} N/m^{law.exponent:g} is that "
                f"of a pin with a Young's modulus of {E:.1e} Pa (radius "
                f"{1e3 * law.bearing_radius:.3g} mm, clearance {1e3 * c:.3g} mm); solids have "
                "1 MPa to 1 TPa: write `stiffness: internal` and the `youngs_modulus`"
            )


def contacts(scenario: Any) -> Iterator[tuple[str, Any, Any]]:
    """Name, spec and law of each joint with clearance; those ill-named are reported elsewhere."""
    for name, joint in scenario.joints.items():
        law = scenario.contact_laws.get(getattr(joint, "contact", None))
        fits = law is not None and law.bearing_radius is not None
        if fits and 0.0 < getattr(joint, "clearance", 0.0) < law.bearing_radius:
            yield name, joint, law


def modulus(K: float, R: float, c: float) -> float:
    """Young's modulus that gives a pin of two equal materials the stiffness K, Pa."""
    return 1.5 * K * (1.0 - POISSON**2) / sqrt(R * (R - c) / c)


def prefix(E: float) -> str:
    """The unit that was meant, if one fits: left out, or written after a number in Pa."""
    for unit, factor in (("GPa", 1e9), ("MPa", 1e6), ("kPa", 1e3)):
        if E < SOFTEST <= E * factor <= HARDEST:
            return f"is `{E:g} {unit}` meant?"
        if 1e9 <= E / factor <= HARDEST < E / 1e3:
            return f"is `{E / factor:.3g} Pa` meant?"
    return "check the unit"


def coefficients(scenario: Any) -> Iterator[str]:
    """Coefficients of friction."""
    for name, law in scenario.contact_laws.items():
        for key in ("coefficient", "static_coefficient"):
            mu = getattr(law.friction, key)
            if mu is not None and mu > STICKIEST:
                yield (
                    f"contact_laws.{name}.friction.{key}: {mu:.3g}; dry metals have 0.1 to 1, "
                    f"rubber up to about {STICKIEST:g}: a pin holds fast above 1 already"
                )


def rigid(scenario: Any) -> Iterator[tuple[str, Any]]:
    """The bodies with an inertia of their own; that of others follows from their section."""
    return ((name, body) for name, body in scenario.bodies.items() if hasattr(body, "inertia"))


def slides(scenario: Any) -> set[str]:
    """The bodies on slides, of which nobody knows whether they turn."""
    return {
        body
        for joint in scenario.joints.values()
        if moves_along(elements.load(joint.type).coordinates)
        for body in joint.bodies
    }


def densities(held: Places, scenario: Any) -> Iterator[str]:
    """Mass of each body against its extent; a body held at one point has none to speak of.

    held: `points`.
    """
    sliding = slides(scenario)
    for name, body in rigid(scenario):
        places = [*held.get(name, ()), body.at]
        reach = max((dist(p, q) for p, q in combinations(places, 2)), default=0.0)
        if reach**3 == 0.0 or body.mass == 0.0:  # the cube of 1e-108 m is none
            continue
        inertia = body.inertia if isinstance(body.inertia, float) else max(body.inertia[:3])
        L = max(reach, 0.0 if name in sliding else sqrt(12.0 * max(inertia, 0.0) / body.mass))
        cube, wire = body.mass / L**3, body.mass * WIRE**2 / reach**3
        text = f"bodies.{name}: {body.mass:.3g} kg"
        ask = "; steel has 7850: check the mass (kg) and the points (m)"
        if cube > HEAVIEST:
            yield (
                f"{text} within {L:.3g} m would be {cube:.1e} kg/m^3 even as a solid cube of that "
                f"edge{ask}"
            )
        elif wire < LIGHTEST:
            yield (
                f"{text} over {reach:.3g} m would be {wire:.1e} kg/m^3 even as a wire of a "
                f"hundredth of that in thickness{ask}"
            )


def outline(shape: Any) -> list[tuple[float, ...]]:
    """Places far out on a curve or a profile; none of what has no such line, or of one that
    assembly refuses."""
    try:
        return list(getattr(shape, "outline", ()))
    except ScenarioError:
        return []


def rim(at: Any, radius: float | None, axis: Any = None) -> Iterator[tuple[float, ...]]:
    """Four places around a centre, at a radius across an axis; z unless given."""
    if not radius:
        return
    x, y, z = axis or (0.0, 0.0, 1.0)
    length, flat = hypot(x, y, z), hypot(x, y)
    one = (y / flat, -x / flat, 0.0) if flat > 0.0 else (1.0, 0.0, 0.0)
    other = (y * one[2] - z * one[1], z * one[0] - x * one[2], x * one[1] - y * one[0])
    for way, size in ((one, radius), (other, radius / length if length > 0.0 else radius)):
        for side in (size, -size):
            yield tuple(c + side * w for c, w in zip(at, way, strict=True))


def wheels(scenario: Any, joint: Any) -> Iterator[tuple[str, Any, float]]:
    """Body, hinge and radius of each wheel of a transmission whose radii are given."""
    radii = getattr(joint, "radii", None) or (getattr(joint, "radius", None),)
    hinges = [scenario.joints.get(name) for name in getattr(joint, "joints", ())]
    bodies = [getattr(hinge, "bodies", ()) for hinge in hinges]
    for k, (hinge, radius) in enumerate(zip(hinges, radii, strict=False)):
        others = {body for m, held in enumerate(bodies) if m != k for body in held}
        own = [body for body in bodies[k] if body not in others]  # the carrier is not a wheel
        if radius and getattr(hinge, "at", None) is not None and len(own) == 1:
            yield own[0], hinge, radius


def points(scenario: Any) -> Places:
    """Where joints and forces hold each body, as drawn."""
    found: Places = {}

    def add(body: str | None, at: Any) -> None:
        if body is not None and at is not None:
            found.setdefault(body, []).append(at)

    for joint in scenario.joints.values():
        if elements.load(joint.type).meets:
            for body in joint.bodies:
                add(body, getattr(joint, "at", None))
        else:
            for body, at in zip(
                getattr(joint, "bodies", ()), getattr(joint, "points", ()), strict=False
            ):
                add(body, at)
        for place in getattr(joint, "through", ()):
            add(place.body, place.at)
            for at in rim(place.at, place.radius):
                add(place.body, at)
        if len(getattr(joint, "bodies", ())) == 2 and getattr(joint, "at", None) is not None:
            for at in rim(joint.at, getattr(joint, "radius", None)):  # a roller
                add(joint.bodies[1], at)
        for at in outline(getattr(joint, "curve", None)):
            add(joint.bodies[0], at)
    for train in (*scenario.joints.values(), *scenario.forces.values()):
        for body, hinge, radius in wheels(scenario, train):
            for at in rim(hinge.at, radius, getattr(hinge, "axis", None)):
                add(body, at)
    for force in scenario.forces.values():
        add(getattr(force, "body", None), getattr(force, "at", None))
        places = getattr(force, "points", None) or (getattr(force, "at", None),) * 2
        for body, at in zip(getattr(force, "bodies", ()), places, strict=False):
            add(body, at)
        for end in map(lambda key: getattr(force, key, None), ("point", "wall", "ball", "surface")):
            add(getattr(end, "body", None), getattr(end, "at", None))
            for at in outline(end):
                add(getattr(end, "body", None), at)
    found.pop("ground", None)
    return found
