"""Point velocity: a component of the velocity of a point, or its speed.

    s = a . v         s' = a . v' + (omega_f x a) . v          a fixed in the body `frame`
    s = |v|           s' = v . v' / |v|,  |v'| where v = 0

v is the velocity of the point in the world.  Along a rotating axis the sensor shows the component
of v along that axis, not the rate of the position seen from `frame`; for that use `rate` of a
`point`.
"""

from math import sqrt
from typing import ClassVar

from trsim.elements.contract import Channel, Element, Row, kernel, measured
from trsim.elements.frames import Along, arm, centripetal, cross, dot, plus, spin, velocity
from trsim.elements.joint import of_key
from trsim.elements.shown import on_pendulum, reach, turning
from trsim.fields import Spec, point, vector
from trsim.kernels.lazy import internal


class PointVelocity(Spec):
    """A component of the velocity of a point of a body, or its speed.

    body   the body in which the point is fixed
    at     the point, as drawn
    axis   direction of the component, as drawn; without it the sensor shows the speed
    frame  `world`, or the name of a body or point: the axis turns with that body
    """

    type: ClassVar[str] = "point_velocity"
    body: str
    at: point("m")
    axis: vector("-") | None = None
    frame: str = "world"


def pack(name, spec, at):
    i = at.frame(spec.frame, spec.at)
    j = at.body(spec.body, "body", near=spec.at)
    axis = (0.0, 0.0, 0.0) if spec.axis is None else at.axes(i, of_key(spec, "axis"))
    places = {"p_i": (0.0, 0.0, 0.0), "p_j": at.looked_at(j, spec.at)}
    return Row(*Along.packed(i=i, j=j, coordinate=at.sensor(name), **places, axis=axis))


@internal
def motion(scene, e):
    """The axis, zero for the speed, the velocity and what is shown of it."""
    own = Along(scene, e)
    axis = arm(scene.X, own.i, own.axis)
    v = velocity(scene.V, own.j, arm(scene.X, own.j, own.p_j))
    shown = dot(axis, v) if dot(axis, axis) > 0.0 else sqrt(dot(v, v))
    return axis, v, shown


@kernel
def coordinate(t, scene, e):
    s = Along(scene, e).coordinate
    _, _, scene.S[s, 0] = motion(scene, e)
    scene.S[s, 1] = 0.0  # known only with the accelerations: nobody may ask


@measured
def measure(t, scene, e, o):
    V, out, own = scene.V, scene.out, Along(scene, e)
    axis, v, shown = motion(scene, e)
    p = arm(scene.X, own.j, own.p_j)
    a = plus(velocity(scene.A, own.j, p), centripetal(V, own.j, p))
    if dot(axis, axis) > 0.0:
        rate = dot(axis, a) + dot(cross(spin(V, own.i), axis), v)
    elif shown > 0.0:
        rate = dot(v, a) / shown
    else:
        rate = sqrt(dot(a, a))
    out[o], out[o + 1] = shown, rate


ELEMENT = Element(
    key="point_velocity",
    section="sensors",
    spec=PointVelocity,
    pack=pack,
    reach=reach,
    coordinates=("speed",),
    channels=(
        Channel("", "m/s", "component of the velocity, or the speed"),
        Channel("rate", "m/s^2", "its rate"),
    ),
    turning=turning,
    kernels={"coordinate": coordinate, "measure": measure},
    example=on_pendulum("tip_speed: {type: point_velocity, body: rod, at: [0.4, 0]}"),
)
