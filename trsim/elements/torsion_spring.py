"""Torsion spring: a preloaded linear spring and damper about the axis of a joint.

    tau = T_0 - k (phi - phi_0) - c phi'        on body j about the axis, -tau on body i

phi is the joint angle, phi_0 its value as drawn.
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
)
from trsim.elements.frames import arm, twist
from trsim.fields import Spec, Unit


class TorsionSpring(Spec):
    """A torsion spring about the axis of a joint.

    joint      revolute joint whose bodies it turns
    stiffness  of the spring
    preload    torque on the second body, as drawn
    damping    of the damper
    """

    type: ClassVar[str] = "torsion_spring"
    joint: str
    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")]
    preload: Annotated[float, Unit("N*m")] = 0.0
    damping: Annotated[float, Ge(0), Unit("N*m*s/rad")] = 0.0


def pack(name, spec, at):
    x = at.coordinate(spec.joint, "angle")
    return Row(
        (x.i, x.j, x.entry),
        (*x.axis_i, spec.preload, spec.stiffness, spec.damping, x.drawn),
    )


@kernel
def force(t, scene, a, b):
    X, S, con, par, F, zd = scene.X, scene.S, scene.con, scene.par, scene.F, scene.zd
    for e in range(a, b):
        i, j, s = con[e, 0], con[e, 1], con[e, 2]
        axis = arm(X, i, par[e, 0], par[e, 1], par[e, 2])
        damping = -par[e, 5] * S[s, 1]
        tau = par[e, 3] - par[e, 4] * (S[s, 0] - par[e, 6]) + damping
        twist(F, j, (tau * axis[0], tau * axis[1], tau * axis[2]))
        twist(F, i, (-tau * axis[0], -tau * axis[1], -tau * axis[2]))
        zd[DAMPERS] += damping * S[s, 1]


@kernel
def energy(t, scene, a, b):
    S, con, par, E = scene.S, scene.con, scene.par, scene.E
    for e in range(a, b):
        turn = S[con[e, 2], 0] - par[e, 6]
        E[SPRINGS] += 0.5 * par[e, 4] * turn * turn - par[e, 3] * turn


@kernel
def measure(t, scene, a, b):
    S, con, par, col, out = scene.S, scene.con, scene.par, scene.wanted, scene.out
    for e in range(a, b):
        if col[e] < 0:
            continue
        s = con[e, 2]
        out[col[e]] = par[e, 3] - par[e, 4] * (S[s, 0] - par[e, 6]) - par[e, 5] * S[s, 1]


ELEMENT = Element(
    key="torsion_spring",
    section="forces",
    spec=TorsionSpring,
    pack=pack,
    channels=(Channel("torque", "N*m", "on the second body of the joint, about its axis"),),
    loads={"torque": "torque"},
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
