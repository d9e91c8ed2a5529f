"""Point sensor: where a point is along a direction.

    s = a . (P - O)        a and O fixed in the body `frame`, P in `body`

The rate and the acceleration are those that an observer on `frame` sees along a.
"""

from typing import ClassVar

from trsim.elements.contract import Channel, Element, Row, Turning, kernel, measured
from trsim.elements.frames import Along, arm, stroke, stroke_acceleration
from trsim.elements.joint import perpendicular
from trsim.elements.shown import on_pendulum, reach
from trsim.fields import Spec, point, vector


class Point(Spec):
    """A component of the position of a point of a body.

    body    the body in which the point is fixed
    at      the point, as drawn
    axis    direction of the component, as drawn; of any length
    frame   `world`, or the name of a body or point: axis and origin are fixed in that body
    origin  point from which the position is measured, as drawn
    """

    type: ClassVar[str] = "point"
    body: str
    at: point("m")
    axis: vector("-")
    frame: str = "world"
    origin: point("m") = (0.0, 0.0, 0.0)


def pack(name, spec, at):
    i = at.frame(spec.frame, spec.origin)
    j = at.body(spec.body, "body", near=spec.at)
    axis = perpendicular(spec.axis)[2]
    places = {"p_i": at.looked_at(i, spec.origin), "p_j": at.looked_at(j, spec.at)}
    own = Along.packed(i=i, j=j, coordinate=at.sensor(name), **places, axis=at.axes(i, axis))
    return Row(*own, travel="stroke")


@kernel
def coordinate(t, scene, e):
    own = Along(scene, e)
    s = own.coordinate
    scene.S[s, 0], scene.S[s, 1] = stroke(scene, e, arm(scene.X, own.i, own.axis))


@measured
def measure(t, scene, e, o):
    S, out, own = scene.S, scene.out, Along(scene, e)
    s, axis = own.coordinate, arm(scene.X, own.i, own.axis)
    out[o], out[o + 1] = S[s, 0], S[s, 1]
    out[o + 2] = stroke_acceleration(scene, e, axis)


def turning(row):
    own = Along.of(row)
    return Turning(points=((own.j, own.p_j), (own.i, own.p_i)), axes=((own.i, own.axis),))


ELEMENT = Element(
    key="point",
    section="sensors",
    spec=Point,
    pack=pack,
    reach=reach,
    coordinates=("stroke",),
    channels=(
        Channel("", "m", "component of the position along the axis"),
        Channel("rate", "m/s", "its rate"),
        Channel("acceleration", "m/s^2", "its acceleration"),
    ),
    turning=turning,
    kernels={"coordinate": coordinate, "measure": measure},
    example=on_pendulum("height: {type: point, body: rod, at: [0.4, 0], axis: [0, 1, 0]}"),
)
