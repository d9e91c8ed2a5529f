"""Applied load: a force at a point, or a torque, of varying magnitude in a given direction.

    F = f(t, sensors) R_f n          at the point p of the body; n constant in the axes of frame f

f is a number, an expression or an Akima table of t or a sensor.  Frame: world (a fixed direction)
or a body (a following load).
"""

from typing import ClassVar

from pydantic import model_validator

from trsim.elements.contract import LOADS, Channel, Element, Reach, Row, Turning, kernel
from trsim.elements.frames import arm, dot, push, spin, twist, velocity
from trsim.fields import Function, Spec, direction, point, vector
from trsim.laws.functions import value


class AppliedLoad(Spec):
    """A force at a point of a body or a torque on it: give one of the two.

    body       the body it acts on
    at         point of a force, as drawn; the centre of mass unless given
    frame      `world`, or a body with which the direction turns
    direction  of the force, or axis of the torque, as drawn; of any length
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


def pack(name, spec, at):
    i = at.body(spec.body, "body", near=spec.at)
    frame = 0 if spec.frame == "world" else at.body(spec.frame, "frame", near=spec.at, off=1.0)
    place = at.centre(i) if spec.at is None else spec.at
    # the direction is drawn in world axes at t = 0 and then turns with its frame
    n = at.axes(frame, direction(spec.direction))
    is_torque = spec.force is None
    load = spec.torque if is_torque else spec.force
    f = at.function(load, "torque" if is_torque else "force")
    con, par = (i, frame, f, int(is_torque)), (*at.local(i, place), *n)
    return Row(con, par, turns=is_torque, reads=load.sensors)


@kernel
def force(t, scene, a, b):
    X, V, S, con = scene.X, scene.V, scene.S, scene.con
    par, tab, F, zd = scene.par, scene.tab, scene.F, scene.zd
    for e in range(a, b):
        i, frame = con[e, 0], con[e, 1]
        f = value(tab, con[e, 2], t, S)
        n = arm(X, frame, par[e, 3], par[e, 4], par[e, 5])
        load = (f * n[0], f * n[1], f * n[2])
        if con[e, 3] == 1:
            twist(F, i, load)
            zd[LOADS] += dot(load, spin(V, i))
        else:
            p = arm(X, i, par[e, 0], par[e, 1], par[e, 2])
            push(F, i, p, load)
            zd[LOADS] += dot(load, velocity(V, i, p))


@kernel
def measure(t, scene, a, b):
    X, S, con = scene.X, scene.S, scene.con
    par, tab, col, out = scene.par, scene.tab, scene.wanted, scene.out
    for e in range(a, b):
        if col[e] < 0:
            continue
        f = value(tab, con[e, 2], t, S)
        n = arm(X, con[e, 1], par[e, 3], par[e, 4], par[e, 5])
        out[col[e]] = f
        for c in range(3):
            out[col[e] + 1 + c] = f * n[c]


def reach(row):
    i, frame, _, is_torque = row.con
    way = ((frame, row.par[3:6]),)
    if is_torque:
        return Reach(torques=way)
    return Reach(forces=way, places=((i, row.par[:3], (i,)),))


def turning(row):
    body, frame, _, is_torque = row.con
    if is_torque:
        return Turning((body, frame), torques=((body, frame, row.par[3:6]),))
    return Turning(points=((body, row.par[:3]),), axes=((frame, row.par[3:6]),))


ELEMENT = Element(
    key="applied_load",
    section="forces",
    spec=AppliedLoad,
    pack=pack,
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
