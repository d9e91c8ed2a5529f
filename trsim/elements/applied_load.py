"""Applied load: a force at a point, or a torque, of varying magnitude in a given direction.

    F = f(t, sensors) R_f n          at the point p of the body; n constant in the axes of frame f

f is a number, an expression or an Akima table of t or a sensor.  Frame: world (a fixed direction)
or a body (a follower load).
"""

from typing import ClassVar

from pydantic import model_validator

from trsim.elements.contract import (
    LOADS,
    Channel,
    Element,
    Memory,
    Reach,
    Row,
    Turning,
    kernel,
    measured,
)
from trsim.elements.frames import arm, dot, push, scaled, spin, twist, velocity
from trsim.elements.loads import Load
from trsim.fields import direction, point, vector
from trsim.kernels.columns import V3, i8
from trsim.kernels.lazy import internal
from trsim.laws.functions import value
from trsim.varying import Function


class AppliedLoad(Load):
    """A force at a point of a body, or a torque on it; give one of the two.

    body       the body it acts on
    at         point at which the force acts, as drawn; the centre of mass unless given
    frame      `world`, or a body: the direction turns with it
    direction  direction of the force, or axis of the torque, as drawn; of any length
    force      magnitude along the direction
    torque     magnitude about the direction
    """

    type: ClassVar[str] = "applied_load"
    body: str
    at: point("m") | None = None
    frame: str = "world"
    direction: vector("-")
    force: Function("N") | None = None
    torque: Function("N*m") | None = None

    @model_validator(mode="after")
    def one_load(self):
        if (self.force is None) == (self.torque is None):
            raise ValueError("give either `force` or `torque`")
        if not any(self.direction):
            raise ValueError("`direction` must not be zero")
        return self


class Directed(Memory):
    """Of every load with a direction."""

    body: i8  # or the first node of a bar
    frame: i8  # with which the direction turns
    function: i8  # f in tab
    direction: V3  # in the axes of the frame


class Own(Directed):
    """Of one instance."""

    turns: i8  # 1: a torque
    point: V3  # m, in the axes of the body


def pack(name, spec, at):
    i = at.body(spec.body, "body", near=spec.at)
    frame = 0 if spec.frame == "world" else at.body(spec.frame, "frame", near=spec.at, off=1.0)
    place = at.centre(i) if spec.at is None else spec.at
    # the direction is drawn in world axes at t = 0 and then turns with its frame
    n = at.axes(frame, direction(spec.direction))
    is_torque = spec.force is None
    load = spec.torque if is_torque else spec.force
    f = at.function(load, "torque" if is_torque else "force")
    own = Own.packed(
        body=i, frame=frame, function=f, turns=is_torque, point=at.local(i, place), direction=n
    )
    return Row(*own, turns=is_torque, reads=load.sensors)


@internal
def magnitude_and_load(t, scene, e):
    """f, and f along its direction, world axes."""
    own = Directed(scene, e)
    f = value(scene.tab, own.function, t, scene.S)
    return f, scaled(f, arm(scene.X, own.frame, own.direction))


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    i = own.body
    _, load = magnitude_and_load(t, scene, e)
    if own.turns == 1:
        twist(scene.F, i, load)
        scene.zd[LOADS] += dot(load, spin(scene.V, i))
    else:
        p = arm(scene.X, i, own.point)
        push(scene.F, i, p, load)
        scene.zd[LOADS] += dot(load, velocity(scene.V, i, p))


@measured
def measure(t, scene, e, o):
    out = scene.out
    out[o], (out[o + 1], out[o + 2], out[o + 3]) = magnitude_and_load(t, scene, e)


def reach(row):
    own = Own.of(row)
    way = ((own.frame, own.direction),)
    if own.turns:
        return Reach(torques=way)
    return Reach(forces=way, places=((own.body, own.point, (own.body,)),))


def acts_at(row):
    """Of a torque without a point of its own nobody knows where."""
    own = Own.of(row)
    return ((own.body, None if own.turns and not any(own.point) else own.point),)


def turning(row):
    own = Own.of(row)
    if own.turns:
        torque = (own.body, own.frame, own.direction)
        return Turning((own.body, own.frame), torques=(torque,))
    return Turning(points=((own.body, own.point),), axes=((own.frame, own.direction),))


ELEMENT = Element(
    key="applied_load",
    section="forces",
    spec=AppliedLoad,
    pack=pack,
    acts_at=acts_at,
    reach=reach,
    channels=(
        Channel("magnitude", "drive", "the force or torque along its direction"),
        Channel("load", "drive", "its components, world axes", 3),
    ),
    turning=turning,
    loads={"magnitude": "load"},
    kernels={"force": force, "measure": measure},
    example="""
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
forces:
  push: {type: applied_load, body: block, direction: [1, 0, 0], force: "10*sin(20*t)"}
solver: {end: 1 s}
""",
)
