"""Numbers that read well but are probably not meant: warnings, each with its figures.

Nothing here stops a run.  A warning says what, how much, and what to do about it; the limits are
wide, so that a scenario somebody thought about is silent.
"""

from collections.abc import Iterator
from functools import partial
from math import ceil, dist, hypot, inf, pi, sqrt
from typing import Any

from trsim.laws.contact import (
    damping_factor,
    delivered_restitution,
    hertz_contact_time,
    hertz_peak,
)
from trsim.scenario import plausible
from trsim.scenario.commas import commas
from trsim.scenario.methods import METHODS
from trsim.scenario.slender import slender
from trsim.scenario.strangers import strangers

LARGE, SMALL = 3.0, 0.01  # radius of gyration over the reach of the joints
SHAPED = 30.0  # instead of LARGE where it follows from a shape: only another unit makes it that
ROUNDED = 1e-3  # inertias are typed with three or four digits
CONFORMAL, LOOSE = 1e-3, 0.2  # clearance over radius
OFF = 0.1  # restitution delivered against restitution written
STEPS = 20.0  # of rk4 in the time of one contact
STABLE = 2.785  # rk4: step times the rate of a decay
TURNS = 3.0  # at the start: more than anybody winds a joint up by
NARROW = 1e-5  # m/s over which friction turns round


def lint(scenario: Any) -> tuple[str, ...]:
    """What looks wrong in a validated scenario: "section.name: what; what to do"."""
    points = plausible.points(scenario)
    checks = (
        *(_inertias, partial(_sizes, points), partial(plausible.densities, points)),
        *(plausible.moduli, plausible.coefficients),
        *(_conformity, _restitutions, _speeds, _stops, _fixed_step, _ignored_step, _ground, _rows),
        *(_many_turns, slender, strangers, commas, _unused),
    )
    found = (message for check in checks for message in check(scenario))
    return tuple(dict.fromkeys(_as_written(scenario, message) for message in found))


def _as_written(scenario: Any, message: str) -> str:
    """The message with the place of what it is about in the templates, once for all instances."""
    where, colon, what = message.partition(": ")
    return ".".join(map(str, scenario.written(tuple(where.split("."))))) + colon + what


def _unused(scenario: Any) -> Iterator[str]:
    """Templates that stand nowhere."""
    used = {instance.template for instance in scenario.instances.values()}
    for name in scenario.templates:
        if name not in used:
            yield f"templates.{name}: no instance uses it; put it in place under `instances`"


# --- bodies ----------------------------------------------------------------------------------


def _inertias(scenario: Any) -> Iterator[str]:
    """Principal inertias no body can have."""
    for name, body in plausible.rigid(scenario):
        if isinstance(body.inertia, float):
            continue
        low, middle, high = _principal(body)
        where = f"bodies.{name}.inertia"
        if low < -ROUNDED * high:
            yield (
                f"{where}: a principal inertia is {low:.3g} kg*m^2, below zero; check the products"
            )
        elif high > (low + middle) * (1.0 + ROUNDED):
            yield (
                f"{where}: principal inertias {low:.3g}, {middle:.3g}, {high:.3g} kg*m^2: no body "
                f"has one above the sum of the others ({high / (low + middle):.3g} times here); "
                "check order and units"
                if low + middle > 0.0
                else f"{where}: only one inertia above zero ({high:.3g} kg*m^2); give all three"
            )


def _principal(body: Any) -> list[float]:
    """Principal inertias, the smallest first."""
    import numpy as np

    return np.linalg.eigvalsh(np.reshape(body.tensor[0], (3, 3))).tolist()  # type: ignore[no-any-return]


def _sizes(points: plausible.Places, scenario: Any) -> Iterator[str]:
    """Radius of gyration against the reach of the points where others hold the body."""
    everywhere = [p for of_body in points.values() for p in of_body]
    everywhere += [body.at for _, body in plausible.rigid(scenario)]
    size = max((dist(p, everywhere[0]) for p in everywhere), default=0.0)
    slides = plausible.slides(scenario)
    for name, body in plausible.rigid(scenario):
        largest = max(_principal(body))
        if name in slides or largest <= 0.0:  # does not turn; a point
            continue
        where = f"bodies.{name}"
        if body.mass == 0.0:
            yield f"{where}: inertia {largest:.3g} kg*m^2 without mass; give its mass"
            continue
        radius = sqrt(largest / body.mass)
        reach = max((dist(p, body.at) for p in points.get(name, ())), default=0.0)
        text = f"{where}: radius of gyration sqrt(inertia/mass) = {radius:.3g} m, but "
        ask = "; check mass, inertia (kg*m^2, about the centre of mass) and `at`"
        shaped = body.shape is not None and not body.says("inertia")
        large = SHAPED if shaped else LARGE
        if reach > 0.0 and radius > large * reach:
            yield f"{text}its points lie within {reach:.3g} m of its centre{ask}"
        elif reach > 0.0 and radius < SMALL * reach:
            yield f"{text}its points lie up to {reach:.3g} m from its centre{ask}"
        elif reach == 0.0 and 0.0 < large * size < radius:
            yield f"{text}the whole mechanism is {size:.3g} m large{ask}"


# --- contact laws ----------------------------------------------------------------------------


def _conformity(scenario: Any) -> Iterator[str]:
    """Curvature of the stiffness, and the clearance, against the radius."""
    for name, joint, law in plausible.contacts(scenario):
        c, R = joint.clearance, law.bearing_radius
        where = f"joints.{name}"
        if law.stiffness == "paper":
            factor = sqrt((2.0 * R - c) / c)
            yield (
                f"{where}: stiffness `paper` puts R_i + R_j where a pin in a hole has R_i - R_j: "
                f"{factor:.3g} times too soft at {1e3 * c:.3g} mm clearance; write `stiffness: "
                "internal` unless a published run is to be repeated"
            )
        if c / R > LOOSE:
            yield (
                f"{where}: the clearance, {1e3 * c:.3g} mm, is {c / R:.0%} of the bearing radius; "
                "usual is 0.1 to 5 %: check the units (it is radial)"
            )
        elif c / R < CONFORMAL and law.stiffness in ("internal", "paper"):
            yield (
                f"{where}: clearance over radius is {c / R:.1e}: the contact wraps around the pin, "
                "which Hertz does not know; write `stiffness: cylinder` and the `width`"
            )


def _restitutions(scenario: Any) -> Iterator[str]:
    """What a law really delivers for the restitution written."""
    for name, law in scenario.contact_laws.items():
        e = law.restitution
        if (
            law.impact
            or law.normal in ("identified", "impact")
            or (e == 0.0 and law.normal == "flores")
        ):
            continue
        real = delivered_restitution(damping_factor(law.normal, e))
        if abs(real - e) > OFF or (law.normal == "lankarani_nikravesh" and e < 0.7):
            yield (
                f"contact_laws.{name}: {law.normal} delivers a restitution of {real:.3f} where "
                f"{e:g} is written; write `normal: identified` to get what is written"
            )


def _speeds(scenario: Any) -> Iterator[str]:
    """Friction that turns round within next to no speed."""
    for name, law in scenario.contact_laws.items():
        friction = law.friction
        if friction.law != "modified_coulomb" or not friction.coefficient:
            continue
        width = friction.v1 - friction.v0
        if width < NARROW:
            yield (
                f"contact_laws.{name}.friction: friction grows from 0 to its full size within "
                f"{width:.1e} m/s, which forces tiny steps; take v1 about 1e-3 of the sliding "
                "speed, or `law: sticking`"
            )


# --- stiffness against the step --------------------------------------------------------------


def _reduced(scenario: Any, bodies: Any, hinge: Any = None) -> float:
    """m_i m_j / (m_i + m_j) of two bodies; of a hinge their inertias about its axis as drawn.

    These are I + m d^2 with I about z and the distance d of the centre of mass from the axis.
    """
    inverse = 0.0
    for name in bodies:
        body = scenario.bodies.get(name)
        if body is None:
            continue  # the ground
        rigid = body.as_rigid()
        mass, inertia = rigid.mass, rigid.tensor[0][8]
        if hinge is not None:
            about = inertia + mass * _away(rigid.at, hinge) ** 2
        inverse += 1.0 / (mass if hinge is None else about) if (inertia and mass) else inf
    return 1.0 / inverse if inverse else inf


def _away(place: Any, hinge: Any) -> float:
    """How far a place is from the axis of a hinge, m; 0 of a joint that has no axis."""
    size = hypot(*getattr(hinge, "axis", (0.0,)))
    if size == 0.0:
        return 0.0
    r = [a - b for a, b in zip(place, hinge.at, strict=True)]
    along = sum(a * b for a, b in zip(r, hinge.axis, strict=True)) / size
    return hypot(*(a - along * b / size for a, b in zip(r, hinge.axis, strict=True)))


def _all_stops(scenario: Any) -> Iterator[tuple[str, Any, float]]:
    for name, stop in scenario.forces.items():
        if hasattr(stop, "pressed"):
            mass = _reduced(scenario, *stop.pressed(scenario.joints))
            if 0.0 < mass < inf:
                yield name, stop, mass


def _stops(scenario: Any) -> Iterator[str]:
    """Damping of a stop above critical."""
    for name, stop, mass in _all_stops(scenario):
        critical = 2.0 * sqrt(stop.stiffness * mass)
        if stop.damping > critical:
            yield (
                f"forces.{name}: damping {stop.damping:.3g} is {stop.damping / critical:.3g} times "
                f"critical (2 sqrt(k m) = {critical:.3g} with the two bodies alone): the blow is "
                "the damper's, not the spring's; lower the damping or raise the stiffness"
            )


def _ignored_step(scenario: Any) -> Iterator[str]:
    """A step for a method that chooses its own."""
    solver = scenario.solver
    if solver.step is not None and METHODS[solver.method].adaptive:
        yield (
            f"solver.step: {solver.step:g} s has no influence: {solver.method} chooses its steps "
            "by `tolerance`; `max_step` bounds them, `method: rk4` takes a fixed one"
        )


def _fixed_step(scenario: Any) -> Iterator[str]:
    """rk4 against the time of a contact and the decay of its friction."""
    h = scenario.solver.step
    if METHODS[scenario.solver.method].adaptive or h is None:
        return
    for name, stop, mass in _all_stops(scenario):
        yield from _unresolved(f"forces.{name}", h, pi * sqrt(mass / stop.stiffness))
    for name, joint, law in plausible.contacts(scenario):
        mass, v = _reduced(scenario, joint.bodies), law.slowest_impact
        if not 0.0 < mass < inf:
            continue
        _, exponent, _, _, K = law.normal_numbers(joint.clearance)
        yield from _unresolved(f"joints.{name}", h, hertz_contact_time(mass, K, exponent, v))
        friction = law.friction
        if friction.law == "modified_coulomb" and friction.coefficient:
            force = hertz_peak(mass, K, exponent, v)[1]
            slope = friction.coefficient * force / (friction.v1 - friction.v0)
            if h * slope / mass > STABLE:
                yield (
                    f"joints.{name}: friction rises by {slope:.3g} N*s/m even at the slowest "
                    f"impact ({force:.3g} N), settles in {mass / slope:.1e} s; rk4 with a step of "
                    f"{h:.1e} s is unstable above {STABLE * mass / slope:.1e} s: take that, a "
                    "larger v1, or `method: auto`"
                )


def _unresolved(where: str, h: float, period: float) -> Iterator[str]:
    if h > period / STEPS:
        yield (
            f"{where}: a contact lasts {period:.1e} s at most, {period / h:.3g} steps of rk4; take "
            f"a step of {period / STEPS:.1e} s or less, or `method: auto`"
        )


# --- the whole -------------------------------------------------------------------------------


def _ground(scenario: Any) -> Iterator[str]:
    """Joints, and none of them to the ground."""
    forces = scenario.forces.values()
    pairs = [x.bodies for x in (*scenario.joints.values(), *forces) if getattr(x, "bodies", None)]
    stops = [(f.point.body, f.wall.body) for f in forces if getattr(f, "wall", None) is not None]
    if scenario.joints and "ground" not in {body for pair in (*pairs, *stops) for body in pair}:
        yield (
            "joints: nothing is joined to `ground`, so the mechanism drifts as a whole; name "
            "`ground` as one of the `bodies` of a joint if that is not meant"
        )


def _many_turns(scenario: Any) -> Iterator[str]:
    """Angles at the start that read like degrees."""
    for name, value in scenario.initial.values.items():
        if abs(value) > TURNS * 2.0 * pi and _is_angle(scenario, name):
            yield (
                f"initial.{name}: {value:.6g} rad are {value / (2.0 * pi):.3g} turns; a number "
                f"without a unit is in rad: write `{value:.6g} deg` if degrees are meant"
            )


def _is_angle(scenario: Any, name: str) -> bool:
    """Whether a coordinate of a joint, as `initial` names it, is an angle."""
    from trsim.elements.coordinates import of_joint, split

    return of_joint(split(name, scenario.joints)[0], scenario.joints).get(name) == "angle"


def _rows(scenario: Any) -> Iterator[str]:
    """Rows that end before the run does."""
    end, every = scenario.solver.end, scenario.output.every
    if not end or not every:
        return
    last = every * int(end / every * (1.0 + ROUNDED * 1e-6))
    if last < end * (1.0 - ROUNDED * 1e-6):
        yield (
            f"output.every: rows are {every:g} s apart, the last is at {last:g} s, the run ends at "
            f"{end:g} s; a part of `end` has a row there (`every: {end / ceil(end / every):.6g}`)"
        )
