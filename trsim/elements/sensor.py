"""Sensor: a joint coordinate with a name, a sign and an origin of its own.

    s = sign (x - x_drawn) + at_start          s' = sign x'

Loads, expressions and plots use sensors.  x is the angle or stroke of the joint, its position on a
curve, or its bend (bend.py); a bend is measured from straight unless `at_start` is given.
"""

from typing import Annotated, ClassVar, Literal

from trsim.elements.bend import Bent, bend, bend_acceleration
from trsim.elements.bend import turning as turning_bend
from trsim.elements.contract import (
    Channel,
    Element,
    Row,
    Turning,
    ends,
    kernel,
    measured,
    moving,
)
from trsim.elements.coordinates import ANY
from trsim.elements.frames import (
    arm,
    on_joint,
    stroke_acceleration,
    turn_acceleration,
)
from trsim.elements.on_curve import NO_CURVE, AlongCurve, along_curve, stays_on, tangent
from trsim.elements.rows import ARC
from trsim.elements.shown import on_pendulum
from trsim.fields import Spec, Unit
from trsim.kernels.columns import f8, i8


class Sensor(Spec):
    """The coordinate of a joint: an angle (rad) or a stroke (m).

    joint     joint whose coordinate is measured; NAME.bend is the angle between the shafts of a
              constant_velocity or a universal joint, or between the axes of a spherical one
    sign      -1 reverses the sign
    at_start  value of the sensor as drawn; a bend has its true value unless this is given
    """

    type: ClassVar[str] = "sensor"
    joint: str
    sign: Literal[1, -1] = 1
    at_start: Annotated[float, Unit("rad", "m")] = 0.0


ON_CURVE, BESIDE_CURVE, ON_BEND = 2, 3, 4


class Own(AlongCurve):
    """Of one instance."""

    source: i8  # coordinate of the joint in S
    turns: i8  # 1: it is an angle; ON_CURVE, BESIDE_CURVE, ON_BEND
    sign: f8
    drawn: f8
    at_start: f8


def pack(name, spec, at):
    bent = at.bend(spec.joint)
    if bent is not None:
        return of_bend(bent, name, spec, at)
    source = at.coordinate(spec.joint, ANY)
    at.check_unit(source.kind, "rad", "m", "sensors", name, "at_start")
    turns = source.kind == "angle"
    kind, curve = int(turns), NO_CURVE
    if source.kind == ARC:
        kind = ON_CURVE if stays_on(source) else BESIDE_CURVE
        curve = along_curve(source) if source.curve else NO_CURVE
    shown = on_joint(source) | {"coordinate": at.sensor(name)}
    own = Own.packed(spec, **shown, source=source.entry, turns=kind, drawn=source.drawn, **curve)
    # beside a curve an acceleration takes the third derivative of the curve
    shown = CHANNELS[:2] if source.kind == ARC and not stays_on(source) else None
    return Row(*own, channels=shown, turns=turns, travel=source.kind)


def of_bend(bent, name, spec, at):
    """One that shows the bend of a joint."""
    at.check_unit("angle", "rad", "m", "sensors", name, "at_start")
    start = spec.at_start if "at_start" in spec.model_fields_set else spec.sign * bent.drawn
    shown = on_joint(bent) | NO_CURVE | {"coordinate": at.sensor(name), "other": bent.other_i}
    own = Own.packed(spec, **shown, source=-1, turns=ON_BEND, drawn=bent.drawn, at_start=start)
    return Row(*own, turns=True, travel="bend")


CHANNELS = (
    moving("", "coordinate", "coordinate of the joint"),
    moving("rate", "coordinate/s", "its rate"),
    Channel("acceleration", "coordinate/s^2", "its acceleration; not for a cam"),
)


@kernel
def coordinate(t, scene, e):
    S = scene.S
    own = Own(scene, e)
    s, x = own.coordinate, own.source
    if own.turns == ON_BEND:
        angle, rate, _ = bend(scene, Bent(scene, e))
        S[s, 0], S[s, 1] = own.sign * (angle - own.drawn) + own.at_start, own.sign * rate
        return
    S[s, 0] = own.sign * (S[x, 0] - own.drawn) + own.at_start
    S[s, 1] = own.sign * S[x, 1]


@measured
def measure(t, scene, e, o):
    S, out = scene.S, scene.out
    own = Own(scene, e)
    out[o], out[o + 1] = S[own.coordinate, 0], S[own.coordinate, 1]
    if own.turns == BESIDE_CURVE:
        return
    if own.turns == ON_BEND:
        out[o + 2] = own.sign * bend_acceleration(scene, Bent(scene, e))
        return
    if own.turns == ON_CURVE:
        out[o + 2] = own.sign * stroke_acceleration(scene, e, tangent(scene, own))
        return
    axis = arm(scene.X, own.i, own.axis)
    if own.turns == 1:
        out[o + 2] = own.sign * turn_acceleration(scene, e, axis)
    else:
        out[o + 2] = own.sign * stroke_acceleration(scene, e, axis)


def turning(row):
    if Own.of(row).turns == ON_BEND:
        return turning_bend(row)
    return Turning(tuple(ends(row)))


ELEMENT = Element(
    key="sensor",
    section="sensors",
    spec=Sensor,
    pack=pack,
    channels=CHANNELS,
    turning=turning,
    kernels={"coordinate": coordinate, "measure": measure},
    example=on_pendulum("elevation: {joint: hinge, at_start: 90 deg}"),
)
