"""Wheels, racks, worms and belts of a mechanism: where their pitch circles are and touch.

Of two wheels on one carrier, with the rates w_1 and w_2 against it about their axes a_1 and a_2,
the pitch line is where both go equally fast,

    w_1 a_1 x (p - c_1) = w_2 a_2 x (p - c_2)

of parallel axes a line along them, of axes that meet the direction w_1 a_1 - w_2 a_2.  So every
gear has its pitch circles, whether by teeth, radii or a ratio.
"""

from typing import Any, NamedTuple

import numpy as np

from trsim import elements
from trsim.elements.coordinates import split
from trsim.elements.joint import perpendicular
from trsim.report.animation.drawing import (
    Array,
    Belt,
    Drawing,
    Mesh,
    Rack,
    Transmissions,
    Wheel,
    Worm,
)
from trsim.report.animation.solids import circle, frame
from trsim.report.animation.teeth import toothed

PARALLEL = 1e-6  # sine of an angle, or a part of a distance, that is none
SAME = 1e-3  # of a radius: wheels of one joint that are one
WHEELS, RACK, HELIX, BAND = "wheels", "rack", "helix", "band"  # pictures
STEEP = 0.1  # cosine of half of a cone, below which its wheel's place tells no size
LONG = 1.5  # of the radius of its wheel: length of a worm
SHARE = 0.75  # of the distance of a worm's axis to that of its wheel: radius of the wheel


class Hinge(NamedTuple):
    """What of a joint a transmission knows; `way` is 1 where the carrier is its first body."""

    name: str
    body: str
    carrier: str
    at: Array
    axis: Array
    way: float


class Found:
    """The wheels so far, and what they touch."""

    def __init__(self) -> None:
        self.wheels: list[Wheel] = []
        self.meshes: list[Mesh] = []
        self.racks: list[Rack] = []
        self.worms: list[Worm] = []
        self.belts: list[Belt] = []
        self.skipped: list[str] = []
        self.counts: dict[int, int] = {}  # wheel -> teeth

    def wheel(self, hinge: Hinge, radius: float, at: Array, hollow: bool = False,
              apex: Array | None = None) -> int:  # fmt: skip
        """The number of a wheel on a hinge; one that is there already is not made again."""
        for k, one in enumerate(self.wheels):
            same = (one.joint, one.body, one.hollow) == (hinge.name, hinge.body, hollow)
            if (
                same
                and (one.apex is None) == (apex is None)
                and (abs(one.radius - radius) < SAME * radius)
            ):
                return k
        self.wheels.append(Wheel(hinge.name, hinge.body, hinge.carrier, at, hinge.axis, radius,
                                 hollow, apex))  # fmt: skip
        return len(self.wheels) - 1

    def level(self, one: Hinge, other: Hinge) -> Array:
        """A place on the first axis in the plane of wheels that are there, or of the first one."""
        for hinge in (one, other):
            for wheel in self.wheels:
                if wheel.joint == hinge.name and wheel.apex is None:
                    return one.at + ((wheel.at - one.at) @ one.axis) * one.axis
        return one.at


def transmissions(drawn: Drawing) -> tuple[Transmissions, tuple[str, ...]]:
    """All that there are between bodies that are drawn, and in words those that are not."""
    kinds = {WHEELS: gear, RACK: rack, HELIX: worm, BAND: belt}
    found = Found()
    for name, spec in {**drawn.scenario.joints, **drawn.scenario.forces}.items():
        kind = kinds.get(elements.load(spec.type).picture)
        pair = hinges(drawn, spec) if kind else None
        if kind and pair:
            why = kind(found, name, spec, *pair)
            found.skipped += [f"{name}: {why}"] if why else []
    wheels = toothed(found.wheels, found.meshes, found.belts, found.counts)
    made = Transmissions(tuple(wheels), tuple(found.meshes), tuple(found.racks),
                         tuple(found.worms), tuple(found.belts))  # fmt: skip
    return made, tuple(found.skipped)


def hinges(drawn: Drawing, spec: Any) -> tuple[Hinge, Hinge] | None:
    """The two joints of a transmission; None where a body of theirs is not drawn."""
    scenario, names = drawn.scenario, []
    for reference in spec.joints:
        names.append(split(reference, scenario.joints)[0])
    one, other = (scenario.joints[name] for name in names)
    bodies = {*one.bodies, *other.bodies}
    if not all(drawn.has(body) and body not in drawn.bars for body in bodies):
        return None
    (carrier,) = {*one.bodies} & {*other.bodies}
    found = []
    for name, joint in zip(names, (one, other), strict=True):
        i, j = joint.bodies
        at = joint.at if joint.at is not None else drawn.bodies.get(j, np.zeros(3))
        axis = perpendicular(getattr(joint, "axis", (0.0, 0.0, 1.0)), joint.drawn_in)[2]
        way, body = (1.0, j) if i == carrier else (-1.0, i)
        found.append(Hinge(name, body, carrier, np.array(at), np.array(axis), way))
    return found[0], found[1]


# --- gears -----------------------------------------------------------------------------------


def gear(found: Found, name: str, spec: Any, x: Hinge, y: Hinge) -> str:
    """Two wheels that touch; or why they are not drawn."""
    if np.linalg.norm(np.cross(x.axis, y.axis)) <= PARALLEL:
        return spur(found, name, spec, x, y)
    return bevel(found, name, spec, x, y)


def ratio(spec: Any, x: Hinge, y: Hinge, alike: float) -> float:
    """w_1/w_2 about their axes; alike: 1 or -1, of axes about which external wheels turn so."""
    if getattr(spec, "ratio", None) is not None:
        return float(spec.ratio * x.way * y.way)
    first, second = getattr(spec, "teeth", None) or spec.radii
    return float(second / first * (-alike if spec.internal else alike))


def spur(found: Found, name: str, spec: Any, x: Hinge, y: Hinge) -> str:
    """On parallel axes."""
    same = float(np.sign(x.axis @ y.axis))
    rate = ratio(spec, x, y, -same) * same  # about the first axis
    there = found.level(x, y)
    d = y.at - there
    d = d - (d @ x.axis) * x.axis
    distance = float(np.linalg.norm(d))
    if distance <= PARALLEL * np.linalg.norm(y.at - x.at) or abs(1.0 - rate) < PARALLEL:
        return "no pitch circles: its wheels turn about one axis, or equally fast"
    share = 1.0 / (1.0 - rate)
    radii = abs(share) * distance, abs(1.0 - share) * distance
    first = found.wheel(x, radii[0], there, rate > 0.0 and radii[0] > radii[1])
    second = found.wheel(y, radii[1], there + d, rate > 0.0 and radii[1] > radii[0])
    found.meshes.append(Mesh(name, x.carrier, first, second, there + share * d))
    count(found, spec, (first, second))
    return ""


def bevel(found: Found, name: str, spec: Any, x: Hinge, y: Hinge) -> str:
    """On axes that meet."""
    normal = np.cross(x.axis, y.axis)
    d = y.at - x.at
    if abs(d @ normal) > PARALLEL * np.linalg.norm(d) * np.linalg.norm(normal):
        return "its axes neither are parallel nor meet"
    apex = x.at + (np.cross(d, y.axis) @ normal) / (normal @ normal) * x.axis
    heights = np.array([(one.at - apex) @ one.axis for one in (x, y)])
    if np.abs(heights).min() <= PARALLEL * np.abs(heights).max():
        return "a wheel of it is drawn where its axes meet"
    ways = np.sign(heights)
    rate = ratio(spec, x, y, -float(ways[0] * ways[1]))
    along = rate * x.axis - y.axis
    along = along / np.linalg.norm(along)
    cosines = np.array([along @ x.axis, along @ y.axis]) * ways
    if cosines.sum() < 0.0:
        along, cosines = -along, -cosines
    lengths = [abs(h) / c for h, c in zip(heights, cosines, strict=True) if c > STEEP]
    if not lengths:
        return "it has no pitch cones"
    length = float(np.mean(lengths))
    numbers = []
    for one, way, cosine in zip((x, y), ways, cosines, strict=True):
        at = apex + length * cosine * way * one.axis
        radius = length * float(np.sqrt(max(1.0 - cosine**2, 0.0)))
        numbers.append(found.wheel(one, radius, at, apex=apex))
    found.meshes.append(Mesh(name, x.carrier, numbers[0], numbers[1], apex + length * along))
    count(found, spec, numbers)
    return ""


def count(found: Found, spec: Any, numbers: Any) -> None:
    """Note the numbers of teeth, where they are known."""
    teeth = getattr(spec, "teeth", None)
    for k, number in zip(numbers, teeth or (), strict=False):
        found.counts.setdefault(k, round(number))


# --- racks, worms, belts -----------------------------------------------------------------------


def rack(found: Found, name: str, spec: Any, x: Hinge, y: Hinge) -> str:
    """A wheel and a bar; of a ratio its place tells on which side the bar is, if it can."""
    out = np.cross(y.axis, x.axis)
    size = np.linalg.norm(out)
    if size <= PARALLEL:
        return "its wheel turns about the axis of the rack"
    out = out / size
    there = found.level(x, x)
    aside = float((y.at - there) @ out)
    if spec.radius is not None:
        radius = spec.radius
        out = out if aside > 0.0 else -out
    else:
        # the pitch point goes as the rack does: w a x (radius out) = s' b
        radius = abs(float(spec.ratio))
        way = np.sign(np.cross(x.axis, out) @ y.axis * spec.ratio * x.way * y.way)
        out = out * (way or 1.0)
    wheel = found.wheel(x, radius, there)
    at = there + radius * out
    found.racks.append(Rack(name, y.name, y.body, y.carrier, wheel, at, y.axis, out))
    found.meshes.append(Mesh(name, y.carrier, wheel, -1, at))
    return ""


def worm(found: Found, name: str, spec: Any, x: Hinge, y: Hinge) -> str:
    """A thread beside a wheel; its size is not known."""
    normal = np.cross(x.axis, y.axis)
    size = float(np.linalg.norm(normal))
    apart = float((y.at - x.at) @ normal) / size if size > PARALLEL else 0.0
    if abs(apart) <= PARALLEL * np.linalg.norm(y.at - x.at):
        return "its axes are parallel, or meet"
    out = np.sign(apart) * normal / size  # from the worm to the wheel
    starts, teeth = spec.teeth or (1.0, max(round(abs(spec.ratio)), 1))
    right = spec.hand != "left"
    if spec.ratio is not None:  # w_1 = h |ratio| w_2, h as in the drawing of a right hand
        right = bool(spec.ratio * x.way * y.way * apart > 0.0)
    # the feet of the common perpendicular of both axes
    d = y.at - x.at
    foot = x.at + (np.cross(d, y.axis) @ normal) / size**2 * x.axis
    wheel = found.wheel(y, SHARE * abs(apart), foot + abs(apart) * out)
    found.counts.setdefault(wheel, round(teeth))
    radius = found.wheels[wheel].radius
    lead = starts * 2.0 * np.pi * radius / teeth * (1.0 if right else -1.0)
    found.worms.append(Worm(name, x.body, x.carrier, wheel, foot, x.axis,
                            abs(apart) - radius, float(lead)))  # fmt: skip
    return ""


def belt(found: Found, name: str, spec: Any, x: Hinge, y: Hinge) -> str:
    """Two pulleys and the belt."""
    there = found.level(x, y)
    d = y.at - there
    first = found.wheel(x, spec.radii[0], there)
    second = found.wheel(y, spec.radii[1], there + d - (d @ x.axis) * x.axis)
    found.belts.append(Belt(name, x.carrier, first, second, spec.crossed))
    return ""


def rim(wheel: Wheel) -> Array:
    """Points around a wheel, as drawn, (8, 3)."""
    return wheel.at + circle(1.15 * wheel.radius, 8) @ frame(wheel.axis)[:2]
