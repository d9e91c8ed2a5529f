"""Displacement sensor: how far a point of one body has moved along an axis of another.

    s = sign a_i . (P_j - P_i) + at_start

P_i and P_j are one point as drawn, fixed in either body, a_i the axis fixed in the first one.
Along the axis of a prismatic joint this is its stroke; it needs no joint, so it tells for example
the stroke of a body on compliant rails.
"""

from typing import Annotated, ClassVar, Literal

from trsim.elements.contract import Channel, Element, Reach, Row, Turning, kernel
from trsim.elements.frames import arm, stroke, stroke_acceleration
from trsim.elements.joint import perpendicular
from trsim.fields import Spec, Unit, point, vector


class Displacement(Spec):
    """The displacement of a point of the second body along an axis of the first.

    bodies    the first one has the axis
    at        the point, as drawn
    axis      direction in which it grows, as drawn; of any length
    sign      -1 counts the other way round
    at_start  what it shows as drawn
    """

    type: ClassVar[str] = "displacement"
    bodies: tuple[str, str]
    at: point("m")
    axis: vector("-")
    sign: Literal[1, -1] = 1
    at_start: Annotated[float, Unit("m")] = 0.0


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    axis = perpendicular(spec.axis)[2]
    places = (*at.local(i, spec.at), *at.local(j, spec.at))
    par = (*places, *at.axes(i, axis), float(spec.sign), spec.at_start)
    return Row((i, j, at.sensor(name)), par, travel="stroke")


@kernel
def coordinate(t, scene, a, b):
    X, V, S, con, par = scene.X, scene.V, scene.S, scene.con, scene.par
    for e in range(a, b):
        s, axis = con[e, 2], arm(X, con[e, 0], par[e, 6], par[e, 7], par[e, 8])
        x, x_dot = stroke(X, V, con, par, e, axis)
        S[s, 0] = par[e, 9] * x + par[e, 10]
        S[s, 1] = par[e, 9] * x_dot


@kernel
def measure(t, scene, a, b):
    X, V, A, S = scene.X, scene.V, scene.A, scene.S
    con, par, col, out = scene.con, scene.par, scene.wanted, scene.out
    for e in range(a, b):
        o = col[e]
        if o < 0:
            continue
        s, axis = con[e, 2], arm(X, con[e, 0], par[e, 6], par[e, 7], par[e, 8])
        out[o], out[o + 1] = S[s, 0], S[s, 1]
        out[o + 2] = par[e, 9] * stroke_acceleration(X, V, A, con, par, e, axis)


def turning(row):
    return Turning(points=((row.con[1], row.par[3:6]),), axes=((row.con[0], row.par[6:9]),))


ELEMENT = Element(
    key="displacement",
    section="sensors",
    spec=Displacement,
    pack=pack,
    reach=lambda row: Reach(shown=((row.con[0], row.par[6:9]),)),
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
