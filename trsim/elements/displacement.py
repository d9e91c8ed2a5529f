"""Displacement sensor: how far a point of one body has moved along an axis of another.

    s = sign a_i . (P_j - P_i) + at_start

P_i and P_j are the same point as drawn, fixed in the first and in the second body; the axis a_i is
fixed in the first one.  Along the axis of a prismatic joint this is its stroke.  No joint is
needed, so the sensor also measures, for example, the stroke of a body on compliant rails.
"""

from typing import Annotated, ClassVar, Literal

from trsim.elements.contract import Channel, Element, Row, kernel, measured
from trsim.elements.frames import Along, arm, points, stroke, stroke_acceleration
from trsim.elements.joint import perpendicular
from trsim.elements.shown import reach, turning
from trsim.fields import Spec, Unit, point, vector
from trsim.kernels.columns import f8


class Displacement(Spec):
    """The displacement of a point of the second body along an axis of the first.

    bodies    the first one has the axis
    at        the point, as drawn
    axis      direction in which it grows, as drawn; of any length
    sign      -1 reverses the sign
    at_start  value of the sensor as drawn
    """

    type: ClassVar[str] = "displacement"
    bodies: tuple[str, str]
    at: point("m")
    axis: vector("-")
    sign: Literal[1, -1] = 1
    at_start: Annotated[float, Unit("m")] = 0.0


class Own(Along):
    """Of one instance."""

    sign: f8
    at_start: f8


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    axis = perpendicular(spec.axis)[2]
    places = points(at, i, j, spec.at, spec.at, at.sensor(name))
    return Row(*Own.packed(spec, **places, axis=at.axes(i, axis)), travel="stroke")


@kernel
def coordinate(t, scene, e):
    own = Own(scene, e)
    s = own.coordinate
    x, x_dot = stroke(scene, e, arm(scene.X, own.i, own.axis))
    scene.S[s, 0] = own.sign * x + own.at_start
    scene.S[s, 1] = own.sign * x_dot


@measured
def measure(t, scene, e, o):
    S, out = scene.S, scene.out
    own = Own(scene, e)
    s, axis = own.coordinate, arm(scene.X, own.i, own.axis)
    out[o], out[o + 1] = S[s, 0], S[s, 1]
    out[o + 2] = own.sign * stroke_acceleration(scene, e, axis)


ELEMENT = Element(
    key="displacement",
    section="sensors",
    spec=Displacement,
    pack=pack,
    reach=reach,
    coordinates=("stroke",),
    channels=(
        Channel("", "m", "displacement along the axis"),
        Channel("rate", "m/s", "its rate"),
        Channel("acceleration", "m/s^2", "its acceleration"),
    ),
    turning=turning,
    kernels={"coordinate": coordinate, "measure": measure},
    example="""
planar: false
bodies:
  slider: {mass: 2 kg, inertia: [0.01, 0.01, 0.01], velocity: [0.5 m/s, 0, 0]}
forces:
  rail: {type: bushing, bodies: [ground, slider], at: [0, 0, 0], stiffness: [0, 1e5, 1e5],
         rotational_stiffness: [100, 100, 100]}
sensors:
  stroke: {type: displacement, bodies: [ground, slider], at: [0, 0, 0], axis: [1, 0, 0]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
