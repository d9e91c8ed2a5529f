"""Friction in a joint: its reaction presses the surfaces together, and they rub as it moves.

    s' = g x'                       sliding speed, x the coordinate of the joint
    F  = (N + C / (mu g)) f(s')     along the surface; f: a law of laws/friction.py, of a load of 1
    Q  = g F                        on body j along the coordinate, -Q on body i

C is a constant friction from a seal or a preload, at full sliding.  The load N follows from the
reaction of the joint's own rows, a force R and a moment M on body j at the joint, with a the axis:

    slide     N = |R_1| + |R_2| + 2 |M . a| / width               g = 1
    hinge     N = |R_1| + |R_2| + |R . a| thrust_radius / radius  g = radius
    shaft     the same of its locating and its floating bearing   g = radius
    ball      N = |R|                                             g = radius  about every axis
    thread    N = |R . a| / cos l,   tan l = h / radius           g = radius / cos l  of the angle

    R_1,2 = (R - a a . R)/2 +- (M x a) / length      what its two ends carry across the axis

Without `length` the moment adds no load, and N contains |R - a a . R| instead.  A thread rubs along
its helix, with a force F sin l along the axis and a torque radius F cos l about it.  Forces of
drives, locks and stops along the coordinate are not part of the reaction.

If a joint slides along several coordinates at once, like a shaft that turns in a sleeve or a block
on a table, s' and F are vectors with one component for each coordinate; F opposes s', and f is
taken at |s'|.  A sleeve is loaded like a hinge without a collar, a plane by N = |R . a| along its
normal.  A ball turns about three axes of body i; its friction is a moment radius |F| that opposes
its angular velocity omega, with s' = radius omega, as for a ball that is held all around by its
socket.

Reaction and friction depend on each other.  Every evaluation of the equations of motion solves for
both together, to rounding (assemble/rubbing.py).  If large friction has no solution, or several
[Painleve1895], the run ends with the status `painleve`.
"""

from math import sqrt
from typing import Annotated, ClassVar

from annotated_types import Ge, Gt

from trsim.elements.contract import Channel, Element, Reach, Row, Turning, kernel, measured
from trsim.elements.frames import (
    Along,
    act_along,
    arm,
    at_both,
    cross,
    dot,
    minus,
    on_joint,
    plus,
    relative_spin,
    scaled,
)
from trsim.elements.friction_law import Friction
from trsim.elements.sliding import MOST, check, check_sizes, coordinates, counts, gear
from trsim.fields import Spec, Unit
from trsim.kernels.columns import f8, i8, run
from trsim.kernels.lazy import internal
from trsim.laws.friction import CODES, N_PARAMETERS, friction_force, part_of_bristle

Length = Annotated[float, Gt(0), Unit("m")]


class JointFriction(Spec):
    """Friction in a joint, caused by the reaction of the joint.

    joint          joint in which friction acts. If it has several coordinates, friction acts on all
                   of them together, or on the one that is named
    friction       law modified_coulomb or sticking, with its parameters; with a coefficient of 0
                   only `constant` acts
    radius         radius at which the surfaces rub: of the journal of a hinge, of a ball, or the
                   mean radius of a thread
    thrust_radius  mean radius of the collar that carries the force along the axis of a hinge;
                   without it that force causes no friction
    length         distance between the two ends that carry moments across the axis; without it
                   these moments cause no friction
    width          distance between the two flanks of a slide that carry the moment about its axis;
                   without it this moment causes no friction
    constant       friction from a seal or a preload, which always acts while the joint slides; a
                   torque if the joint turns
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
    """Of one instance; its axis is that of the load."""

    number: i8  # of coordinates along which it slides
    entries: run(i8, MOST)  # of these in S
    states: run(i8, MOST)  # of z: the deflections of bristles, or -1
    law: i8  # one of CODES
    gears: run(f8, MOST)  # sliding speed over the rate of a coordinate
    along: run(f8, MOST)  # of a friction force of 1: the force along the axis of a coordinate, and
    about: run(f8, MOST)  # the torque about it, m
    axes: run(f8, 3 * MOST)  # in the axes of frame i
    across_counts: f8  # of the load: of forces across the axis
    axial_counts: f8
    twist_counts: f8  # of the moment about the axis, 1/m
    tilt_counts: f8  # of moments across it at each end, 1/m
    share: f8  # that its first end has of forces across the axis, without a moment
    reacts: f8  # 1 where a load makes friction, 0 where the constant is all there is
    preload: f8  # N
    friction: run(f8, N_PARAMETERS)


STICKING = CODES["sticking"]
PRESSED = (
    Channel(
        "normal_force",
        "N",
        "normal force with which the reaction presses the surfaces together",
        least=0.0,
    ),
    Channel(
        "sliding_speed",
        "m/s",
        "sliding speed of the second body relative to the first, where they rub",
    ),
)
SEVERAL = (
    Channel("force", "N", "friction along the surfaces, negative: against the sliding"),
    *PRESSED,
)
BALL = (*SEVERAL, Channel("moment", "N*m", "friction on the second body, world axes", 3))


def pack(name, spec, at):
    parts, axis = coordinates(spec, at)
    joint = at.packed("joints", axis.joint, ("joint",))
    check(spec, axis, joint, at)
    surface = check_sizes(spec, parts, joint, at)
    ball, alone = surface == "a ball", len(parts) == 1
    kind = axis.kind if alone or ball else "stroke"
    at.check_units(kind, JointFriction, ("constant",), "forces", name)
    gears, along, about = zip(*(gear(spec, x, at) for x in parts), strict=True)
    mu, (law, numbers) = spec.friction.coefficient, spec.friction.numbers
    counted = counts(spec, surface, at.scenario.joints[axis.joint])
    counted["reacts"] = float(mu > 0.0)
    if mu == 0.0:  # the constant alone, as of a coefficient of 1
        mu, numbers = 1.0, (1.0, *numbers[1:])
    # w settles at +-mu / sigma0: that is its size in the error norm
    sticks = law == STICKING
    states = [at.state(numbers[1] / numbers[3]) if sticks else -1 for _ in parts]
    own = Own.packed(
        **on_joint(axis), **counted, law=law, friction=numbers, number=len(parts),
        entries=filled((x.entry for x in parts), -1), states=filled(states, -1),
        gears=filled(gears), along=filled(along), about=filled(about),
        axes=filled((c for x in parts for c in x.axis_i), 0.0, 3 * MOST),
        preload=spec.constant / (mu * (abs(gears[0]) if alone or ball else 1.0)),
    )  # fmt: skip
    if sticks:
        grips = (numbers[3], numbers[4], numbers[3] / numbers[1])
    else:
        grips = (0.0, numbers[0] / (numbers[2] - numbers[1]), 0.0)
    return Row(*own, states=tuple(states), turns=kind == "angle", rubs=axis.joint, grips=grips,
               channels=None if alone else BALL if ball else SEVERAL)  # fmt: skip


def filled(values, rest=0.0, number=MOST):
    """So many numbers."""
    values = [*values]
    return (*values, *[rest] * (number - len(values)))


@internal
def ends(own, a, R, M):
    """What each end carries across the axis."""
    across = minus(R, scaled(dot(R, a), a))
    tilt = scaled(own.tilt_counts, cross(M, a))
    first = plus(scaled(own.share, across), tilt)
    return first, minus(across, first)


@internal
def direction(c, v):
    """c v / |v|; zero where there is none."""
    size = sqrt(dot(v, v))
    return scaled(c / size, v) if size > 0.0 else (0.0, 0.0, 0.0)


@internal
def signed(c, x):
    """c sign x."""
    return c if x > 0.0 else (-c if x < 0.0 else 0.0)


@internal
def slides(scene, e, c):
    """The sliding speed along the c-th coordinate, and the deflection of its bristles."""
    own = Own(scene, e)
    state = own.states[c]
    w = scene.z[state] if state >= 0 else 0.0
    if own.entries[c] < 0:
        return own.gears[c] * dot(axis(scene, e, c), relative_spin(scene.V, own.i, own.j)), w
    return own.gears[c] * scene.S[own.entries[c], 1], w


@internal
def axis(scene, e, c):
    """The axis of the c-th coordinate, world axes."""
    own = Own(scene, e)
    n = (own.axes[3 * c], own.axes[3 * c + 1], own.axes[3 * c + 2])
    return arm(scene.X, own.i, n)


@internal
def part(scene, e, c, speed):
    """Friction of a load of 1 along the c-th coordinate, where it slides at a speed in all; the
    rate of its bristles."""
    own = Own(scene, e)
    v, w = slides(scene, e, c)
    f = own.friction
    if own.law == STICKING:
        return part_of_bristle(1.0, v, speed, w, f)
    whole, _ = friction_force(own.law, 1.0, speed, 0.0, f)
    return (whole * v / speed if speed > 0.0 else 0.0), 0.0


@internal
def sliding(scene, e):
    """Friction of a load of 1 along all coordinates, negative where there are several; the unit
    vector it is along, and the sliding speed along that."""
    own = Own(scene, e)
    v, w = slides(scene, e, 0)
    if own.number == 1:
        f, _ = friction_force(own.law, 1.0, v, w, own.friction)
        return f, (1.0, 0.0, 0.0), v
    u, _ = slides(scene, e, 1)
    t, _ = slides(scene, e, own.number - 1)
    t *= float(own.number - 2)
    speed = sqrt(v * v + u * u + t * t)
    f, _ = part(scene, e, 0, speed)
    g, _ = part(scene, e, 1, speed)
    h, _ = part(scene, e, own.number - 1, speed)
    h *= float(own.number - 2)
    size = sqrt(f * f + g * g + h * h)
    if size == 0.0:
        return 0.0, (0.0, 0.0, 0.0), 0.0
    d = (-f / size, -g / size, -h / size)
    return -size, d, d[0] * v + d[1] * u + d[2] * t


@internal
def reaction(scene, e):
    """The axis of the load, force and moment of the joint's reaction; world axes."""
    own, p = Own(scene, e), scene.pressed
    R, M = (p[e, 0], p[e, 1], p[e, 2]), (p[e, 3], p[e, 4], p[e, 5])
    return arm(scene.X, own.i, own.axis), R, M


@internal
def pressing(scene, e):
    """The load that the reaction makes."""
    own = Own(scene, e)
    a, R, M = reaction(scene, e)
    first, second = ends(own, a, R, M)
    across = own.across_counts * (sqrt(dot(first, first)) + sqrt(dot(second, second)))
    return across + own.axial_counts * abs(dot(R, a)) + own.twist_counts * abs(dot(M, a))


@kernel
def load(t, scene, e):
    own, out = Own(scene, e), scene.loads
    a, R, M = reaction(scene, e)
    first, second = ends(own, a, R, M)
    n_1, n_2 = direction(own.across_counts, first), direction(own.across_counts, second)
    axial, twist = dot(R, a), dot(M, a)
    N = pressing(scene, e)
    f, _, slip = sliding(scene, e)
    bend(scene, e)
    # ends: n . dR of each share across the axis, and n . (dM x a) c = (a x n) . dM c
    n = plus(scaled(own.share, n_1), scaled(1.0 - own.share, n_2))
    by_R = plus(n, scaled(signed(own.axial_counts, axial), a))
    by_M = plus(
        scaled(own.tilt_counts, cross(a, minus(n_1, n_2))),
        scaled(signed(own.twist_counts, twist), a),
    )
    out[e, 0], out[e, 1], out[e, 2], out[e, 3] = own.reacts * N, own.preload, f, slip
    for c in range(3):
        out[e, 4 + c], out[e, 7 + c] = own.reacts * by_R[c], own.reacts * by_M[c]


@internal
def bend(scene, e):
    """The rates of its bristles."""
    own, speed = Own(scene, e), 0.0
    if own.law != STICKING:
        return
    for c in range(own.number):
        v, _ = slides(scene, e, c)
        speed = v if own.number == 1 else sqrt(speed * speed + v * v)
    for c in range(own.number):
        _, scene.zd[own.states[c]] = part(scene, e, c, abs(speed))


@kernel
def rub(t, scene, e):
    own = Own(scene, e)
    _, d, _ = sliding(scene, e)
    for c in range(own.number):
        F = scene.rubbed[e] * (d[0] if c == 0 else (d[1] if c == 1 else d[2]))
        a = axis(scene, e, c)
        if own.about[c] != 0.0:
            act_along(scene, e, scaled(F * own.about[c], a), 1)
        if own.along[c] != 0.0:
            act_along(scene, e, scaled(F * own.along[c], a), 0)


@measured
def measure(t, scene, e, o):
    own, out = Own(scene, e), scene.out
    _, d, slip = sliding(scene, e)
    out[o] = own.gears[0] * scene.rubbed[e] if own.number == 1 else scene.rubbed[e]
    out[o + 1], out[o + 2] = pressing(scene, e), slip
    if own.entries[0] < 0:
        M = scene.rubbed[e] * own.about[0]
        x, y, z = axis(scene, e, 0), axis(scene, e, 1), axis(scene, e, 2)
        for c in range(3):
            out[o + 3 + c] = M * (d[0] * x[c] + d[1] * y[c] + d[2] * z[c])


def turning(row):
    """What turns about every axis does so about that of a flexible bar too."""
    own = Own.of(row)
    return Turning((own.i, own.j), held=(own.i, own.j) if own.entries[0] < 0 else ())


ELEMENT = Element(
    key="joint_friction",
    section="forces",
    spec=JointFriction,
    pack=pack,
    acts_at=at_both,
    turning=turning,
    reach=lambda row: Reach(),  # acts along a coordinate, whose joint says where that leads
    channels=(
        Channel("force", "drive", "friction on the second body, along the coordinate"),
        *PRESSED,
    ),
    loads={"force": "force"},
    slides=(Own.columns["law"].at, Own.columns["friction"].at),
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
