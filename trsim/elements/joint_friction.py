"""Friction in a joint: its own reaction presses the surfaces together, and they rub as it moves.

    s' = g x'                       sliding speed, x the coordinate of the joint
    F  = (N + C / (mu g)) f(s')     along the surface; f: a law of laws/friction.py, of a load of 1
    Q  = g F                        on body j along the coordinate, -Q on body i

C is a constant friction, of a seal or a preload, at full sliding.  The load N follows from the
reaction of the joint's own rows, a force R and a moment M on body j at the joint, with a the axis:

    slide     N = |R_1| + |R_2| + 2 |M . a| / width               g = 1
    hinge     N = |R_1| + |R_2| + |R . a| thrust_radius / radius  g = radius
    thread    N = |R . a| / cos l,   tan l = h / radius           g = radius / cos l  of the angle

    R_1,2 = (R - a a . R)/2 +- (M x a) / length      what its two ends carry across the axis

Without `length` its moment presses nothing, N counts |R - a a . R|.  A thread rubs along its helix:
by a force F sin l along the axis and a torque radius F cos l about it.  What drives, locks and
stops do along the coordinate is no part of the reaction.

Reaction and friction depend on each other.  They are solved for together, to rounding, in every
evaluation of the equations of motion (assemble/rubbing.py).  Where large friction has no solution,
or several [Painleve1895], the run ends with the status `painleve`.
"""

from math import atan, cos, pi, sin, sqrt
from typing import Annotated, ClassVar

from annotated_types import Ge, Gt

from trsim.elements.contract import Channel, Element, Reach, Row, kernel, measured
from trsim.elements.coordinates import named
from trsim.elements.frames import (
    Along,
    act_along,
    arm,
    cross,
    dot,
    minus,
    on_joint,
    plus,
    scaled,
)
from trsim.elements.friction_law import Friction
from trsim.elements.rows import COORDINATES
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.kernels.columns import f8, i8, run
from trsim.kernels.lazy import internal
from trsim.laws.friction import N_PARAMETERS, friction_force

Length = Annotated[float, Gt(0), Unit("m")]


class JointFriction(Spec):
    """Friction in a joint, made by the joint's own reaction.

    joint          joint that rubs, and along which coordinate if it has several
    friction       law modified_coulomb or sticking, with its numbers; a coefficient of 0 leaves
                   `constant` alone
    radius         of the journal of a hinge, at which it rubs; of a thread its mean radius
    thrust_radius  mean radius of the collar that carries the force along the axis of a hinge;
                   without it that force makes no friction
    length         between the two ends that carry moments across the axis; without it these make
                   no friction
    width          between the two flanks of a slide that carry the moment about its axis; the same
    constant       friction that is always there while it slides, of a seal or a preload
    """

    type: ClassVar[str] = "joint_friction"
    joint: str
    friction: Friction
    radius: Length | None = None
    thrust_radius: Length | None = None
    length: Length | None = None
    width: Length | None = None
    constant: Annotated[float, Ge(0), Unit("N", "N*m")] = 0.0


class Own(Along):
    """Of one instance."""

    state: i8  # of z: the deflection of bristles, or -1
    law: i8  # one of CODES
    gear: f8  # sliding speed over the rate of the coordinate
    along: f8  # of a friction force of 1: the force along the axis, and
    about: f8  # the torque about it, m
    across_counts: f8  # of the load: of forces across the axis
    axial_counts: f8
    twist_counts: f8  # of the moment about the axis, 1/m
    tilt_counts: f8  # of moments across it at each end, 1/m
    preload: f8  # N
    friction: run(f8, N_PARAMETERS)


def pack(name, spec, at):
    x = at.coordinate(spec.joint)
    joint = at.packed("joints", x.joint, ("joint",))
    check(spec, x, joint, at)
    at.check_units(x.kind, JointFriction, ("constant",), "forces", name)
    surface = surfaces(spec, x, joint, at)
    mu, (law, numbers) = spec.friction.coefficient, spec.friction.numbers
    if mu == 0.0:  # the constant alone, as of a coefficient of 1
        mu, numbers = 1.0, (1.0, *numbers[1:])
        surface |= dict.fromkeys(("across_counts", "axial_counts", "twist_counts"), 0.0)
    # w settles at +-mu / sigma0: that is its size in the error norm
    sticks = spec.friction.law == "sticking"
    state = at.state(numbers[1] / numbers[3]) if sticks else -1
    preload = spec.constant / (mu * abs(surface["gear"]))
    own = Own.packed(**on_joint(x), **surface, law=law, friction=numbers, state=state,
                     preload=preload)  # fmt: skip
    return Row(*own, states=(state,), turns=x.kind == "angle", rubs=x.joint)


def surfaces(spec, x, joint, at):
    """What rubs: where it acts, and how a reaction presses it."""
    screw = lead(at.scenario.joints[x.joint])
    tilt = 1.0 / spec.length if spec.length else 0.0
    across = 1.0 if presses(joint, x, at)[0] else 0.0
    if screw:
        l = atan(screw / spec.radius)
        gear = spec.radius / cos(l) if x.kind == "angle" else 1.0 / sin(l)
        return {
            "gear": gear, "along": sin(l), "about": spec.radius * cos(l), "across_counts": 0.0,
            "axial_counts": 1.0 / cos(l), "twist_counts": 0.0, "tilt_counts": 0.0,
        }  # fmt: skip
    if x.kind == "angle":
        thrust = spec.thrust_radius / spec.radius if spec.thrust_radius else 0.0
        return {
            "gear": spec.radius, "along": 0.0, "about": spec.radius, "across_counts": across,
            "axial_counts": thrust, "twist_counts": 0.0, "tilt_counts": tilt,
        }  # fmt: skip
    twist = 2.0 / spec.width if spec.width else 0.0
    return {
        "gear": 1.0, "along": 1.0, "about": 0.0, "across_counts": across, "axial_counts": 0.0,
        "twist_counts": twist, "tilt_counts": tilt,
    }  # fmt: skip


def lead(joint):
    """What a joint advances in a radian; 0 unless it is a thread."""
    return getattr(joint, "pitch", 0.0) / (2.0 * pi)


def presses(joint, x, at):
    """Whether the rows of a joint hold forces across the axis of a coordinate, and along it."""
    _, _, which = named(x.name, at.scenario.joints)
    letter, places = COORDINATES[which].axis, [h for h in joint.element.holds if h in "xyzuwa"]
    return any(h != letter for h in places), any(h in ("x", "y", "z", letter) for h in places)


# keys of what rubs, and what it is called
KEYS = {
    "a thread": ("radius",),
    "a hinge": ("radius", "thrust_radius", "length"),
    "a slide": ("length", "width"),
}


def check(spec, x, joint, at):
    """Refuse what rubs in no way, or in one that is told elsewhere, or twice."""
    law = spec.friction.law
    if joint.element.ideal:
        raise ScenarioError(
            f"'{x.joint}' has a clearance: friction there is that of its contact",
            "give its contact law a `friction`, or the joint no clearance",
            ("joint",),
        )
    twin = next((n for (_, n), i in at.instances.items() if i.row.rubs == x.joint), None)
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
    check_sizes(spec, x, joint, at)


def check_sizes(spec, x, joint, at):
    """Refuse sizes that the joint does not have, and those that are missing."""
    thread, turns = lead(at.scenario.joints[x.joint]) != 0.0, x.kind == "angle"
    what = "a thread" if thread else "a hinge" if turns else "a slide"
    for key in dict.fromkeys(key for keys in KEYS.values() for key in keys):
        if key not in KEYS[what] and getattr(spec, key) is not None:
            hint = f"friction of {what} takes {', '.join(f'`{k}`' for k in KEYS[what])}"
            raise ScenarioError(f"{what} has no `{key}`", hint, (key,))
    if "radius" in KEYS[what] and spec.radius is None:
        raise ScenarioError(
            f"friction of {what} needs `radius`", "it acts at that radius", ("radius",)
        )
    across, along = presses(joint, x, at)
    if what == "a hinge" and not across and not (spec.thrust_radius and along):
        raise ScenarioError(
            f"nothing presses '{x.joint}' together across its axis",
            "give `thrust_radius`: the mean radius of the faces that carry the force along it",
            ("thrust_radius",),
        )


@internal
def ends(own, a, R, M):
    """What each end carries across the axis."""
    half = scaled(0.5, minus(R, scaled(dot(R, a), a)))
    tilt = scaled(own.tilt_counts, cross(M, a))
    return plus(half, tilt), minus(half, tilt)


@internal
def direction(c, v):
    """c v / |v|, and c |v|; zero where there is none."""
    size = sqrt(dot(v, v))
    return (scaled(c / size, v) if size > 0.0 else (0.0, 0.0, 0.0)), c * size


@internal
def signed(c, x):
    """c sign x."""
    return c if x > 0.0 else (-c if x < 0.0 else 0.0)


@kernel
def load(t, scene, e):
    own, p, out = Own(scene, e), scene.pressed, scene.loads
    a = arm(scene.X, own.i, own.axis)
    R, M = (p[e, 0], p[e, 1], p[e, 2]), (p[e, 3], p[e, 4], p[e, 5])
    first, second = ends(own, a, R, M)
    n_1, N_1 = direction(own.across_counts, first)
    n_2, N_2 = direction(own.across_counts, second)
    axial, twist = dot(R, a), dot(M, a)
    N = N_1 + N_2 + own.axial_counts * abs(axial) + own.twist_counts * abs(twist)
    slip = own.gear * scene.S[own.coordinate, 1]
    w = scene.z[own.state] if own.state >= 0 else 0.0
    f, w_dot = friction_force(own.law, 1.0, slip, w, own.friction)
    if own.state >= 0:
        scene.zd[own.state] = w_dot
    # ends: n . dR/2 across the axis, and n . (dM x a) c = (a x n) . dM c
    by_R = plus(scaled(0.5, plus(n_1, n_2)), scaled(signed(own.axial_counts, axial), a))
    by_M = plus(
        scaled(own.tilt_counts, cross(a, minus(n_1, n_2))),
        scaled(signed(own.twist_counts, twist), a),
    )
    out[e, 0], out[e, 1], out[e, 2], out[e, 3] = N, own.preload, f, slip
    for c in range(3):
        out[e, 4 + c], out[e, 7 + c] = by_R[c], by_M[c]


@kernel
def rub(t, scene, e):
    own, F = Own(scene, e), scene.rubbed[e]
    a = arm(scene.X, own.i, own.axis)
    if own.about != 0.0:
        act_along(scene, e, scaled(F * own.about, a), 1)
    if own.along != 0.0:
        act_along(scene, e, scaled(F * own.along, a), 0)


@measured
def measure(t, scene, e, o):
    own, out = Own(scene, e), scene.out
    out[o], out[o + 1] = own.gear * scene.rubbed[e], scene.loads[e, 0]
    out[o + 2] = own.gear * scene.S[own.coordinate, 1]


ELEMENT = Element(
    key="joint_friction",
    section="forces",
    spec=JointFriction,
    pack=pack,
    reach=lambda row: Reach(),  # acts along a coordinate, whose joint says where that leads
    channels=(
        Channel("force", "drive", "friction on the second body, along the coordinate"),
        Channel("normal_force", "N", "how the reaction presses what rubs together", least=0.0),
        Channel("sliding_speed", "m/s", "of the second body against the first, where it rubs"),
    ),
    loads={"force": "force"},
    kernels={"load": load, "rub": rub, "measure": measure},
    example="""
bodies:
  wheel: {mass: 2 kg, inertia: 0.01 kg*m^2, angular_velocity: [0, 0, 20]}
joints:
  bearing: {type: revolute, bodies: [ground, wheel], at: [0, 0]}
forces:
  journal: {type: joint_friction, joint: bearing, radius: 10 mm,
            friction: {law: modified_coulomb, coefficient: 0.1, v0: 0, v1: 1 mm/s}}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
