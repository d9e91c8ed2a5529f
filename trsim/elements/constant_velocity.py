"""Constant-velocity joint: two points coincide, and bending the joint twists neither shaft.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0
    Phi_4    = (w_i . u_j - u_i . w_j)/2 = 0

a_i and a_j point along the shafts, from the first through the joint to the second.  The triad u, w,
a of body j is that of body i after the shortest rotation from a_i to a_j.  The quaternion of this
rotation has no component along a_i; Phi_4 is twice the product of that component and the scalar one
[Nikravesh1988].  In any motion

    (omega_j - omega_i) . (a_i + a_j)/2 = 0

so two shafts in fixed bearings turn at equal speeds at every bend below 180 degrees.  At 180
degrees the relative rotation of the shafts is undetermined: both factors of Phi_4 vanish, and the
motion could continue with the wrong one.  In space a run fails 0.02 rad before that bend.  reaction
acts on body j at the point, reaction_moment in the direction of a_i + a_j.
"""

from math import atan2, cos, degrees, pi, sqrt
from typing import ClassVar

from trsim.elements.contract import FIRST_ROW, Channel, Limit, Reach, Row, kernel, measured
from trsim.elements.frames import (
    arm,
    cross,
    dot,
    minus,
    plus,
    points,
    relative_spin,
    scaled,
    spin,
    turn_lines,
)
from trsim.elements.joint import Joint, held, joint, of_key, perpendicular
from trsim.elements.rows import POINT, Axes, JointRow
from trsim.errors import ScenarioError
from trsim.fields import vector
from trsim.frame import across
from trsim.kernels.columns import V3
from trsim.kernels.lazy import internal

NEXT_TO_HALF = 0.2  # rad: a bend so near to half a turn is told
LARGEST = pi - 0.02  # rad: a larger bend ends the run
TWIST = FIRST_ROW + 3  # column of con with the row of the twist


class ConstantVelocity(Joint):
    """A joint between two shafts that turn at equal speeds at any bend.

    axis         direction of the first shaft, towards the second one, as drawn; of any length
    second_axis  direction of the second shaft, away from the first one, as drawn; straight on
                 unless given
    """

    type: ClassVar[str] = "constant_velocity"
    axis: vector("-")
    second_axis: vector("-") | None = None


class Own(Axes):
    """Of one instance."""

    w_j: V3  # w in the axes of body j


def shafts(spec):
    """Unit vectors along both shafts, world axes as drawn."""
    a = of_key(spec, "axis")
    return a, a if spec.second_axis is None else of_key(spec, "second_axis")


def bent(v, a, b):
    """A vector turned by the shortest turn from a to b, unit vectors not opposite to each other."""
    n = across(a, b)
    once = across(n, v)
    twice = across(n, once)
    c = 1.0 + sum(p * q for p, q in zip(a, b, strict=True))
    return tuple(p + q + r / c for p, q, r in zip(v, once, twice, strict=True))


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    _, b = shafts(spec)
    u, w, a = perpendicular(spec.axis)
    cosine = sum(p * q for p, q in zip(a, b, strict=True))
    if cosine <= 0.0:
        raise ScenarioError(
            f"`second_axis` points back: the cosine to `axis` is {cosine:.3g}",
            "let both point the way from the first body to the second; shafts at a right angle or "
            "more need two joints",
            ("second_axis",),
        )
    axes = held(i, j, u, w, a, at) | {
        "u_j": at.axes(j, bent(u, a, b)), "w_j": at.axes(j, bent(w, a, b)), "a_j": at.axes(j, b),
    }  # fmt: skip
    own = Own.packed(**points(at, i, j, spec.at, spec.at), **axes, drawn=0.0)
    return Row(*own, limits=(Limit("folded", LARGEST, "rad", "failed", FOLDED),))


FOLDED = "is bent by half a turn, where nothing tells how its shafts are turned against each other"


@internal
def twist(scene, e, k):
    """The twist of the shafts against each other as row k."""
    X, V, own = scene.X, scene.V, Own(scene, e)
    i, j = own.i, own.j
    u_i, w_i = arm(X, i, own.u_i), arm(X, i, own.w_i)
    u_j, w_j = arm(X, j, own.u_j), arm(X, j, own.w_j)
    o_i, o_j = spin(V, i), spin(V, j)
    n = scaled(0.5, minus(cross(u_i, w_j), cross(w_i, u_j)))
    of_u = plus(cross(cross(o_i, u_i), w_j), cross(u_i, cross(o_j, w_j)))
    of_w = plus(cross(cross(o_i, w_i), u_j), cross(w_i, cross(o_j, u_j)))
    n_dot = scaled(0.5, minus(of_u, of_w))
    scene.phi[k] = 0.5 * (dot(w_i, u_j) - dot(u_i, w_j))
    scene.phi_t[k] = 0.0
    scene.gamma[k] = -dot(n_dot, relative_spin(V, i, j))
    turn_lines(scene, k, n)


@kernel
def gap(t, scene, e):
    """How far the cosine of the bend is beyond that of the largest; in a plane any bend will do."""
    X, V, g, own = scene.X, scene.V, scene.gap, Own(scene, e)
    if scene.con[e, TWIST] < 0:
        g[e, 0], g[e, 1] = -1.0, 0.0
        return
    a_i, a_j = arm(X, own.i, own.a_i), arm(X, own.j, own.a_j)
    g[e, 0] = cos(LARGEST) - dot(a_i, a_j)
    g[e, 1] = -dot(cross(relative_spin(V, own.i, own.j), a_j), a_i)


@measured
def measure(t, scene, e, o):
    X, own = scene.X, Own(scene, e)
    a_i, a_j = arm(X, own.i, own.a_i), arm(X, own.j, own.a_j)
    n = cross(a_i, a_j)
    scene.out[o] = atan2(sqrt(dot(n, n)), dot(a_i, a_j))


def doubts(name, spec, largest):
    """A bend at which it comes to hold nothing but the point."""
    bend, when = largest(f"{name}.bend")
    if bend > pi - NEXT_TO_HALF:
        yield (
            f"joints.{name}: bent by {degrees(bend):.4g} deg at {when:.4g} s; at half a turn it "
            "does not tell how its shafts are turned against each other, and reactions grow "
            "without bound: keep the bend below by a stop, or take a `universal`"
        )


ELEMENT = joint(
    key="constant_velocity",
    spec=ConstantVelocity,
    rows=(*POINT, JointRow("turn", "c", fill=twist)),
    pack=pack,
    sways=True,
    bends=shafts,
    channels=(Channel("bend", "rad", "angle between the shafts", least=0.0),),
    kernels={"gaps": gap, "measure": measure},
    doubts=doubts,
    reach=lambda _: Reach(tilts=True),
    dear=True,
    example="""
planar: false
bodies:
  driver: {mass: 1 kg, inertia: [0.02, 0.01, 0.01], at: [-0.2, 0, 0], angular_velocity: [20, 0, 0]}
  driven: {mass: 1 kg, inertia: [0.04, 0.04, 0.04], at: [0.16, 0.12, 0]}
joints:
  one: {type: revolute, bodies: [ground, driver], at: [-0.3, 0, 0], axis: [1, 0, 0]}
  two: {type: revolute, bodies: [ground, driven], at: [0.24, 0.18, 0], axis: [4, 3, 0]}
  between: {type: constant_velocity, bodies: [driver, driven], at: [0, 0, 0], axis: [1, 0, 0],
            second_axis: [4, 3, 0]}
solver: {end: 0.5 s}
""",
)
