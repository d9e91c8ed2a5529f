"""Relative angle: rotation of one body relative to another about an axis, over any number of turns.

    tan x = (w_i . u_j - u_i . w_j) / (u_i . u_j + w_i . w_j)
    x'    = omega . (a_i + a_j) / (1 + a_i . a_j)          omega: of body j relative to body i
    s     = sign (x - x_drawn) + at_start

The triads u, w, a of both bodies coincide as drawn, with a along the axis.  For bodies that turn
about the axis alone, x is their angle, as on a hinge.  If the axes a_i and a_j are tilted apart, x
is the rotation about them that remains after the shortest rotation from one to the other is removed
(swing and twist).  It is the same seen from either body, and a constant-velocity joint keeps it
constant.  If the axes point in opposite directions, no such angle exists.
"""

from math import atan2
from typing import Annotated, ClassVar, Literal

from trsim.elements.contract import Channel, Element, Reach, Row, Turning, kernel, measured
from trsim.elements.frames import (
    arm,
    cross,
    dot,
    nearest_branch,
    plus,
    relative_spin,
    spin,
)
from trsim.elements.joint import held, perpendicular
from trsim.elements.rows import Axes
from trsim.fields import Spec, Unit, point, vector
from trsim.kernels.columns import f8, i8
from trsim.kernels.lazy import internal


class RelativeAngle(Spec):
    """The angle by which the second body is rotated relative to the first about an axis; no joint
    is needed.

    bodies    the two bodies; the angle grows as the second one turns about the axis relative to the
              first
    axis      direction of the axis, as drawn; it is fixed in both bodies
    at        point of a flexible bar, as drawn; its middle unless given
    sign      -1 reverses the sign
    at_start  value of the sensor as drawn
    """

    type: ClassVar[str] = "relative_angle"
    bodies: tuple[str, str]
    axis: vector("-") = (0.0, 0.0, 1.0)
    at: point("m") | None = None
    sign: Literal[1, -1] = 1
    at_start: Annotated[float, Unit("rad")] = 0.0


class Own(Axes):
    """Of one instance."""

    source: i8  # entry of S with the angle x itself, which is counted over turns
    sign: f8
    at_start: f8


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    u, w, a = perpendicular(spec.axis, spec.drawn_in)
    x = at.turn(name, i, j, a, spec.drawn_in)
    axes = held(i, j, u, w, a, at) | {"p_i": (0.0, 0.0, 0.0), "p_j": (0.0, 0.0, 0.0)}
    places = {"i": i, "j": j, "coordinate": at.sensor(name), "source": x.entry}
    return Row(*Own.packed(spec, **places, **axes, drawn=x.drawn), turns=True, travel="twist")


@internal
def turned(scene, e):
    """Both axes and 1 + a_i . a_j, and the rate of the angle."""
    X, own = scene.X, Own(scene, e)
    a_i, a_j = arm(X, own.i, own.a_i), arm(X, own.j, own.a_j)
    both, share = plus(a_i, a_j), 1.0 + dot(a_i, a_j)
    return a_i, a_j, share, dot(relative_spin(scene.V, own.i, own.j), both) / share


@kernel
def coordinate(t, scene, e):
    X, S, own = scene.X, scene.S, Own(scene, e)
    x, s = own.source, own.coordinate
    _, a_j, _, rate = turned(scene, e)
    u_i, w_i, u_j = arm(X, own.i, own.u_i), arm(X, own.i, own.w_i), arm(X, own.j, own.u_j)
    w_j = cross(a_j, u_j)
    angle = atan2(dot(w_i, u_j) - dot(u_i, w_j), dot(u_i, u_j) + dot(w_i, w_j)) + own.drawn
    S[x, 0] = nearest_branch(angle, S[x, 0])
    S[x, 1] = rate
    S[s, 0] = own.sign * (S[x, 0] - own.drawn) + own.at_start
    S[s, 1] = own.sign * rate


@measured
def measure(t, scene, e, o):
    V, S, out, own = scene.V, scene.S, scene.out, Own(scene, e)
    a_i, a_j, share, rate = turned(scene, e)
    omega = relative_spin(V, own.i, own.j)
    bend = dot(relative_spin(scene.A, own.i, own.j), plus(a_i, a_j))
    bend += dot(omega, plus(cross(spin(V, own.i), a_i), cross(spin(V, own.j), a_j)))
    bend -= rate * dot(a_i, cross(omega, a_j))
    out[o], out[o + 1] = S[own.coordinate, 0], S[own.coordinate, 1]
    out[o + 2] = own.sign * bend / share


def reach(row):
    own = Own.of(row)
    return Reach(about=((own.i, own.a_i),))


def turning(row):
    own = Own.of(row)
    axes = ((own.i, own.u_i), (own.i, own.a_i), (own.j, own.u_j), (own.j, own.a_j))
    return Turning(frames=(own.i, own.j), axes=axes)


ELEMENT = Element(
    key="relative_angle",
    section="sensors",
    spec=RelativeAngle,
    pack=pack,
    reach=reach,
    coordinates=("angle",),
    channels=(
        Channel("", "rad", "angle about the axis"),
        Channel("rate", "rad/s", "its rate"),
        Channel("acceleration", "rad/s^2", "its acceleration"),
    ),
    turning=turning,
    kernels={"coordinate": coordinate, "measure": measure},
    example="""
bodies:
  crank: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [0.1, 0], angular_velocity: [0, 0, 20 rad/s]}
  rod: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [0.4, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  pin: {type: revolute, bodies: [crank, rod], at: [0.2, 0]}
sensors:
  rod_angle: {type: relative_angle, bodies: [ground, rod]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
