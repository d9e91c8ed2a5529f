"""Torsion spring: a preloaded linear spring and damper about the axis of a joint, or along it.

    tau = T_0 - k (phi - phi_0) - c phi'        on body j about the axis, -tau on body i

phi is the joint angle, phi_0 its value as drawn.  On a stroke it is a force along the axis, by the
same law.
"""

from typing import Annotated, ClassVar

from annotated_types import Ge

from trsim.elements.contract import (
    DAMPERS,
    SPRINGS,
    Channel,
    Element,
    Row,
    kernel,
    measured,
)
from trsim.elements.coordinates import of_joint
from trsim.elements.frames import Along, act_along, arm, at_both, on_joint, scaled
from trsim.fields import Spec, Unit
from trsim.kernels.columns import f8, i8


class TorsionSpring(Spec):
    """A spring and a damper about the axis of a joint, or along it.

    joint      joint on whose coordinate it acts, an angle or a stroke; if the joint has several,
               the angle, unless one is named
    stiffness  stiffness of the spring
    preload    torque or force on the second body, as drawn
    damping    damping of the damper
    """

    type: ClassVar[str] = "torsion_spring"
    joint: str
    stiffness: Annotated[float, Ge(0), Unit("N/m", "N*m/rad")]
    preload: Annotated[float, Unit("N", "N*m")] = 0.0
    damping: Annotated[float, Ge(0), Unit("N*s/m", "N*m*s/rad")] = 0.0


class Own(Along):
    """Of one instance."""

    preload: f8
    stiffness: f8
    damping: f8
    drawn: f8  # rad, m
    turns: i8  # 1: about the axis


WITH_UNITS = ("stiffness", "preload", "damping")
FORCE = Channel("force", "N", "on the second body of the joint, along its coordinate")


def pack(name, spec, at):
    # of a joint with several coordinates the angle is meant where none is named
    several = len(of_joint(spec.joint, at.scenario.joints)) > 1
    x = at.coordinate(spec.joint, "angle" if several else "")
    at.check_units(x.kind, TorsionSpring, WITH_UNITS, "forces", name)
    turns = x.kind == "angle"
    own = Own.packed(spec, **on_joint(x), drawn=x.drawn, turns=turns)
    return Row(*own, turns=turns, channels=None if turns else (FORCE,))


@kernel
def force(t, scene, e):
    S, own = scene.S, Own(scene, e)
    s, axis = own.coordinate, arm(scene.X, own.i, own.axis)
    damping = -own.damping * S[s, 1]
    tau = own.preload - own.stiffness * (S[s, 0] - own.drawn) + damping
    act_along(scene, e, scaled(tau, axis), own.turns)
    scene.zd[DAMPERS] += damping * S[s, 1]


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    turn = scene.S[own.coordinate, 0] - own.drawn
    scene.E[SPRINGS] += 0.5 * own.stiffness * turn * turn - own.preload * turn


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    s = own.coordinate
    spring = own.preload - own.stiffness * (scene.S[s, 0] - own.drawn)
    scene.out[o] = spring - own.damping * scene.S[s, 1]


ELEMENT = Element(
    key="torsion_spring",
    section="forces",
    spec=TorsionSpring,
    pack=pack,
    acts_at=at_both,
    channels=(Channel("torque", "N*m", "torque on the second body of the joint, about its axis"),),
    loads={"torque": "torque", "force": "force"},
    kernels={"force": force, "energy": energy, "measure": measure},
    example="""
bodies:
  disc: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  bearing: {type: revolute, bodies: [ground, disc], at: [0, 0]}
forces:
  spring: {type: torsion_spring, joint: bearing, stiffness: 2 N*m/rad, preload: 0.5 N*m}
solver: {end: 1 s}
""",
)
