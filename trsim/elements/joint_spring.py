"""Spring and damper on the angle or the stroke of a joint, with user-defined laws.

    x = coordinate - its value as drawn - free
    T = f(x) + w d(x')              -T on body j along or about the axis, T on body i

f is the elastic force or torque, d the damper (sprung.py).
"""

from typing import Annotated, ClassVar

from trsim.elements.contract import DAMPERS, Channel, Element, Row, kernel, measured
from trsim.elements.frames import (
    arm,
    at_both,
    carried,
    on_joint,
    push_apart,
    scaled,
    twist_apart,
)
from trsim.elements.sprung import RATE, Law, Sprung, X, packed_law, store, tension
from trsim.fields import Unit
from trsim.kernels.columns import f8, i8
from trsim.varying import Function


class JointSpring(Sprung):
    """A spring and damper on a coordinate of a joint, with laws given as functions.

    joint        joint whose angle or stroke it pulls back; `shaft.angle` if the joint has several
    elastic      elastic force or torque that pulls back, a function of `stretch`: the coordinate,
                 measured from the drawing, minus `free`
    damper       force or torque of the damper that pulls back, a function of `rate`, with its sign
    free         coordinate, measured from the drawing, at which the stretch is 0
    """

    type: ClassVar[str] = "joint_spring"
    joint: str
    elastic: Function("N", "N*m", of=X) | None = None
    damper: Function("N", "N*m", of=RATE) | None = None
    free: Annotated[float, Unit("m", "rad")] = 0.0


class Own(Law):
    """Of one instance."""

    source: i8  # coordinate of the joint in S
    turns: i8  # 1: an angle
    origin: f8  # its value at which the stretch is 0


def pack(name, spec, at):
    x = at.coordinate(spec.joint)
    at.check_unit(x.kind, "rad", "m", "forces", name, "free")
    for key in ("elastic", "damper"):
        at.check_unit(x.kind, "N*m", "N", "forces", name, key)
    turns = x.kind == "angle"
    along = on_joint(x) | packed_law(spec, at, at.entry(), turns)
    own = Own.packed(source=x.entry, turns=turns, origin=x.drawn + spec.free, **along)
    return Row(*own, turns=turns, travel=x.kind)


@kernel
def coordinate(t, scene, e):
    S, own = scene.S, Own(scene, e)
    S[own.coordinate, 0] = S[own.source, 0] - own.origin
    S[own.coordinate, 1] = S[own.source, 1]


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    T, elastic = tension(t, scene, e)
    f = scaled(-T, arm(scene.X, own.i, own.axis))
    if own.turns == 1:
        twist_apart(scene.F, own.i, own.j, f)
    else:
        r_i, p_j, _, _ = carried(scene, e)
        push_apart(scene.F, own.i, r_i, own.j, p_j, f)
    scene.zd[DAMPERS] -= (T - elastic) * scene.S[own.coordinate, 1]


@kernel
def energy(t, scene, e):
    store(scene, e)


@measured
def measure(t, scene, e, o):
    T, elastic = tension(t, scene, e)
    scene.out[o], scene.out[o + 1] = -T, -elastic
    scene.out[o + 2] = scene.S[Own(scene, e).coordinate, 0]


ELEMENT = Element(
    key="joint_spring",
    section="forces",
    spec=JointSpring,
    pack=pack,
    acts_at=at_both,
    channels=(
        Channel(
            "force",
            "drive",
            "force or torque on the second body of the joint, along or about its axis",
        ),
        Channel("elastic", "drive", "elastic part of the force"),
        Channel("stretch", "coordinate", "stretch of the spring"),
    ),
    loads={"force": "force"},
    kernels={"coordinate": coordinate, "force": force, "energy": energy, "measure": measure},
    example="""
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2, velocity: [0.5 m/s, 0]}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}
forces:
  buffer: {type: joint_spring, joint: slide, damper: "30*rate*abs(rate)",
           elastic: {table: [[-0.1 m, -50 N], [0 m, 0 N], [50 mm, 20 N], [0.1 m, 80 N]],
                     outside: extend}}
solver: {end: 1 s}
""",
)
