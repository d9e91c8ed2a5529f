"""Sensor: a joint coordinate with a name, a sign and an origin of its own.

    s = sign (x - x_drawn) + at_start          s' = sign x'

Loads, expressions and plots use sensors; x is the angle or stroke of the joint.
"""

from typing import Annotated, ClassVar, Literal

from trsim.elements.contract import Channel, Element, Row, kernel
from trsim.elements.frames import arm, stroke_acceleration, turn_acceleration
from trsim.fields import Spec, Unit


class Sensor(Spec):
    """The coordinate of a joint: an angle (rad) or a stroke (m).

    joint     joint whose coordinate it is
    sign      -1 counts the other way round
    at_start  what it shows as drawn
    """

    type: ClassVar[str] = "sensor"
    joint: str
    sign: Literal[1, -1] = 1
    at_start: Annotated[float, Unit("rad", "m")] = 0.0


def pack(name, spec, at):
    source = at.coordinate(spec.joint)
    at.check_unit(source.kind, "rad", "m", "sensors", name, "at_start")
    return Row(
        (source.i, source.j, at.sensor(name), source.entry, int(source.kind == "angle")),
        (
            *source.s_i,
            *source.s_j,
            *source.axis_i,
            float(spec.sign),
            source.drawn,
            spec.at_start,
        ),
        turns=source.kind == "angle",
        travel=source.kind,
    )


@kernel
def coordinate(t, scene, a, b):
    S, con, par = scene.S, scene.con, scene.par
    for e in range(a, b):
        s, x = con[e, 2], con[e, 3]
        S[s, 0] = par[e, 9] * (S[x, 0] - par[e, 10]) + par[e, 11]
        S[s, 1] = par[e, 9] * S[x, 1]


@kernel
def measure(t, scene, a, b):
    X, V, A, S = scene.X, scene.V, scene.A, scene.S
    con, par, col, out = scene.con, scene.par, scene.wanted, scene.out
    for e in range(a, b):
        if col[e] < 0:
            continue
        s, o = con[e, 2], col[e]
        out[o] = S[s, 0]
        out[o + 1] = S[s, 1]
        i, j = con[e, 0], con[e, 1]
        axis = arm(X, i, par[e, 6], par[e, 7], par[e, 8])
        if con[e, 4] == 1:
            out[o + 2] = par[e, 9] * turn_acceleration(V, A, i, j, axis)
        else:
            out[o + 2] = par[e, 9] * stroke_acceleration(X, V, A, con, par, e, axis)


ELEMENT = Element(
    key="sensor",
    section="sensors",
    spec=Sensor,
    pack=pack,
    channels=(
        Channel("", "coordinate", "coordinate of the joint"),
        Channel("rate", "coordinate/s", "its rate"),
        Channel("acceleration", "coordinate/s^2", "its acceleration"),
    ),
    kernels={"coordinate": coordinate, "measure": measure},
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
sensors:
  elevation: {joint: hinge, at_start: 90 deg}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
