"""What of a joint rubs: along which coordinates it slides, what presses it, and its sizes.

A hinge, a shaft on two bearings, a slide, a sleeve, a plane, a thread or a ball, as the joint and
its coordinates have it.  How they rub is in joint_friction.py.
"""

from math import atan, cos, pi, sin, sqrt
from typing import NamedTuple

from trsim.elements.coordinates import named, of_joint
from trsim.elements.frames import Along, TwoPoints
from trsim.elements.joint import triad
from trsim.elements.rows import COORDINATES
from trsim.errors import ScenarioError

MOST = 3  # coordinates of a joint
UNITS = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
# what rubs -> keys of its sizes
KEYS = {
    "a thread": ("radius",),
    "a hinge": ("radius", "thrust_radius", "length"),
    "a shaft": ("radius", "thrust_radius"),
    "a slide": ("length", "width"),
    "a sleeve": ("radius", "length"),
    "a plane": ("radius",),
    "a ball": ("radius",),
}


class Turn(NamedTuple):
    """How a ball turns about an axis of its first body: no coordinate, but a rate."""

    joint: str
    i: int
    j: int
    s_i: tuple
    s_j: tuple
    axis_i: tuple
    name: str = ""
    kind: str = "angle"
    entry: int = -1
    from_drawing: bool = False


def coordinates(spec, at):
    """The coordinates along which it slides, and the one about or along whose axis it is pressed.

    Of a joint named alone all that it has, but of a thread, which has one freedom; of a plane the
    angle where a `radius` says at what distance that rubs.
    """
    there = of_joint(spec.joint, at.scenario.joints)
    thread = len(there) > 1 and lead(at.scenario.joints[spec.joint]) != 0.0
    if len(there) > 1 and all(COORDINATES[own].kind == "angle" for own in there.values()):
        raise ScenarioError(
            f"each pin of '{spec.joint}' rubs by itself",
            f"name one of them: {', '.join(there)}; and give the other a friction of its own",
            ("joint",),
        )
    if len(there) > MOST:
        raise ScenarioError(
            f"'{spec.joint}' slides in more than {MOST} ways, and no surface does",
            f"name one of them: {', '.join(there)}",
            ("joint",),
        )
    if spec.joint in at.scenario.joints and is_ball(at.elements["joints", spec.joint]):
        own = TwoPoints.of(at.packed("joints", spec.joint, ("joint",)).row)
        axes = [Turn(spec.joint, own.i, own.j, own.p_i, own.p_j, axis) for axis in UNITS]
        return axes, axes[0]._replace(axis_i=(0.0, 0.0, 0.0))  # pressed along any axis alike
    if len(there) < 2 or thread:
        x = at.coordinate(f"{spec.joint}.angle" if thread else spec.joint)
        return [x], x
    found = [at.coordinate(name) for name in there]
    angle = next((x for x in found if x.kind == "angle"), None)
    plane = sum(x.kind == "stroke" for x in found) > 1
    normal = found[0]
    if angle is None:  # of a point on a plane
        _, _, a = triad(at.scenario.joints[spec.joint])
        normal = normal._replace(axis_i=at.axes(normal.i, a), axis=a)
    return [x for x in found if not (plane and x is angle and spec.radius is None)], angle or normal


def is_ball(joint):
    """Whether a joint holds a point and nothing else."""
    return joint.holds == ("x", "y", "z")


def gear(spec, x, at):
    """Sliding speed over the rate of a coordinate; force and torque of a friction of 1."""
    screw = lead(at.scenario.joints[x.joint])
    if screw:
        l = atan(screw / spec.radius)
        rate = spec.radius / cos(l) if x.kind == "angle" else 1.0 / sin(l)
        return rate, sin(l), spec.radius * cos(l)
    return (spec.radius, 0.0, spec.radius) if x.kind == "angle" else (1.0, 1.0, 0.0)


def counts(spec, surface, joint):
    """How a reaction presses what rubs."""
    counted = dict.fromkeys(("across_counts", "axial_counts", "twist_counts", "tilt_counts"), 0.0)
    counted["share"], screw = 0.5, lead(joint)
    if surface == "a thread":
        return counted | {"axial_counts": 1.0 / cos(atan(screw / spec.radius))}
    if surface == "a plane":
        return counted | {"axial_counts": 1.0}
    if surface in ("a hinge", "a shaft"):
        thrust = spec.thrust_radius / spec.radius if spec.thrust_radius else 0.0
        counted["axial_counts"] = thrust
    if surface == "a slide" and spec.width:
        counted["twist_counts"] = 2.0 / spec.width
    if surface == "a shaft":  # its reaction is that at the bearing where `at` is
        counted["share"] = 0.0
        tilt = 1.0 / sqrt(sum(c * c for c in joint.axis))
    else:
        tilt = 1.0 / spec.length if spec.length else 0.0
    return counted | {"across_counts": 1.0, "tilt_counts": tilt}


def lead(joint):
    """What a joint advances in a radian; 0 unless it is a thread."""
    return getattr(joint, "pitch", 0.0) / (2.0 * pi)


def presses(joint, x, at):
    """Whether the rows of a joint hold forces across the axis of a coordinate, and along it."""
    _, _, which = named(x.name, at.scenario.joints)
    letter, places = COORDINATES[which].axis, [h for h in joint.element.holds if h in "xyzuwa"]
    return any(h != letter for h in places), any(h in ("x", "y", "z", letter) for h in places)


def check(spec, x, joint, at):
    """Refuse what rubs in no way, or in one that is told elsewhere, or twice."""
    law = spec.friction.law
    if joint.element.ideal:
        raise ScenarioError(
            f"'{x.joint}' has a clearance: friction there is that of its contact",
            "give its contact law a `friction`, or the joint no clearance",
            ("joint",),
        )
    twin = next((n for n in at.scenario.forces if rubs_too(n, x, at)), None)
    if twin:
        raise ScenarioError(
            f"'{twin}' is friction in '{x.joint}' already, and what slides slides one way",
            "keep one of the two",
            ("joint",),
        )
    if law not in ("modified_coulomb", "sticking"):
        raise ScenarioError(
            f"friction law {law} is none of a joint",
            "take `modified_coulomb`, which is smooth at rest, or `sticking`, which holds",
            ("friction", "law"),
        )
    if spec.friction.coefficient == 0.0 and spec.constant == 0.0:
        raise ScenarioError(
            "without a coefficient and a constant nothing rubs",
            "give a `coefficient`, a `constant` or both",
            ("friction",),
        )


def rubs_too(name, x, at):
    """Whether a friction that is packed already is one of the same surfaces: those of a joint, or
    of each pin of a cross."""
    other = at.instances.get(("forces", name))
    if other is None or other.row.rubs != x.joint:
        return False
    return not x.from_drawing or Along.of(other.row).coordinate == x.entry


def check_sizes(spec, parts, joint, at):
    """What rubs, in words.  Refuses sizes that it does not have, and those that are missing."""
    x, angle = parts[0], any(part.kind == "angle" for part in parts)
    what = "a hinge" if x.kind == "angle" else "a slide"
    if joint.element.bearings:
        what = "a shaft"
    elif lead(at.scenario.joints[x.joint]) != 0.0:
        what = "a thread"
    elif len(parts) > 1 and x.entry < 0:
        what = "a ball"
    elif len(parts) > 1:
        what = "a plane" if sum(part.kind == "stroke" for part in parts) > 1 else "a sleeve"
    for key in dict.fromkeys(key for keys in KEYS.values() for key in keys):
        if key not in KEYS[what] and getattr(spec, key) is not None:
            hint = f"friction of {what} takes {', '.join(f'`{k}`' for k in KEYS[what])}"
            raise ScenarioError(f"{what} has no `{key}`", hint, (key,))
    if angle and spec.radius is None:
        raise ScenarioError(
            f"friction of {what} needs `radius`", "it acts at that radius", ("radius",)
        )
    places = [held for held in joint.element.holds if held in "xyzuwa"]
    if not places and what in ("a hinge", "a slide") and spec.friction.coefficient > 0.0:
        if spec.length is None:
            raise ScenarioError(
                f"'{x.joint}' passes on moments only, and nothing says what these press",
                "give `length`: the distance of the two ends that carry them",
                ("length",),
            )
    elif places and what in ("a hinge", "a shaft"):
        check_pressed(spec, joint, x, at)
    return what


def check_pressed(spec, joint, x, at):
    """Refuse a hinge that is pressed by what makes no friction as it is told."""
    across, along = presses(joint, x, at)
    if not across and not (spec.thrust_radius and along):
        raise ScenarioError(
            f"nothing presses '{x.joint}' together across its axis",
            "give `thrust_radius`: the mean radius of the faces that carry the force along it",
            ("thrust_radius",),
        )
