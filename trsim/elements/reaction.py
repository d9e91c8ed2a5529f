"""Reaction sensor: a component, or the magnitude, of the force or moment of a joint on a body.

    s = a . F,  a . (M - p x F)      or  |F|,  |M - p x F|         F, M = -J^T lambda of its rows

F and M act on the body `on`, M about its centre of mass; p is the vector from there to the point
`at`.  The axis a is fixed in the body `frame`.  For a joint with clearance F and M include its
contact.
"""

from math import sqrt
from typing import ClassVar, Literal

from trsim.elements.acted import Acted, acting, parts_of, whole, wrench
from trsim.elements.contract import Channel, Element, Row, Turning, measured
from trsim.elements.frames import arm, cross, dot, minus
from trsim.elements.joint import of_key
from trsim.elements.shown import on_pendulum
from trsim.errors import ScenarioError, known
from trsim.fields import Spec, point, vector
from trsim.kernels.columns import V3, f8


class Reaction(Spec):
    """Force or moment of a joint on one of its bodies: a component, or the magnitude.

    joint  the joint
    of     `force` or `moment`
    axis   direction of the component, as drawn; without it the sensor shows the magnitude
    frame  `world`, or the name of a body or point: the axis turns with that body
    on     the body on which force and moment act; the second one of the joint unless given
    at     point about which the moment is taken, as drawn; it is fixed in the body `on`. The point
           of the joint unless given
    """

    type: ClassVar[str] = "reaction"
    joint: str
    of: Literal["force", "moment"] = "force"
    axis: vector("-") | None = None
    frame: str = "world"
    on: str | None = None
    at: point("m") | None = None


class Own(Acted):
    """Of one instance; j is the frame of the axis."""

    turns: f8  # 1: a moment
    place: V3  # m, from the centre of mass, in the axes of the body
    axis: V3  # in the axes of the frame; zero: the size


def pack(name, spec, at):
    joints = at.scenario.joints
    if spec.joint not in joints:
        what = f"no joint named '{spec.joint}'"
        raise ScenarioError(what, known(spec.joint, joints), ("joint",))
    joint, e, instance = joints[spec.joint], *at.numbered("joints", spec.joint)
    if not instance.element.bears:
        what = f"joint '{spec.joint}' ({instance.element.key}) relates others and bears nothing"
        raise ScenarioError(what, "its torques are channels of its own", ("joint",))
    body = joint.bodies[1] if spec.on is None else spec.on
    if body not in joint.bodies:
        raise ScenarioError(f"'{body}' is none of its bodies", known(body, joint.bodies), ("on",))
    first, second = parts_of(instance)[0].places
    i, drawn = first if body == joint.bodies[0] else second
    frame = at.frame(spec.frame, spec.at)
    own = Own.packed(
        i=i, j=frame, coordinate=at.sensor(name), **acting(whole(e, instance)),
        turns=spec.of == "moment",
        place=drawn if spec.at is None else at.looked_at(i, spec.at),
        axis=(0.0, 0.0, 0.0) if spec.axis is None else at.axes(frame, of_key(spec, "axis")),
    )  # fmt: skip
    return Row(*own, turns=spec.of == "moment")


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    f, m = wrench(t, scene, e)
    if own.turns == 1.0:
        f = minus(m, cross(arm(scene.X, own.i, own.place), f))
        if scene.d == 3:
            f = (0.0, 0.0, f[2])
    elif scene.d == 3:
        f = (f[0], f[1], 0.0)
    axis = arm(scene.X, own.j, own.axis)
    shown = dot(axis, f) if dot(axis, axis) > 0.0 else sqrt(dot(f, f))
    scene.out[o] = scene.S[own.coordinate, 0] = shown  # in S for formulas


def turning(row):
    own = Own.of(row)
    axes = ((own.j, own.axis),) if any(own.axis) else ()
    return Turning(points=((own.i, own.place),), axes=axes)


ELEMENT = Element(
    key="reaction",
    section="sensors",
    spec=Reaction,
    pack=pack,
    channels=(Channel("", "drive", "component, or magnitude, of the force or moment"),),
    turning=turning,
    kernels={"measure": measure},
    example=on_pendulum("pull: {type: reaction, joint: hinge, axis: [1, 0, 0], frame: rod}"),
)
