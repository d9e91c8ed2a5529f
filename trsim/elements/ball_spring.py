"""Ball spring: a spring and a damper against every turn of a joint that holds a point.

    theta = log(A_i^T A_j)              rotation vector of body j against body i
    m     = -A_i k theta - c omega      on body j, -m on body i; omega = omega_j - omega_i
    E     = k |theta|^2 / 2

A_i, A_j are the triads of the joint.  Those of a spherical joint agree as drawn, so theta is zero
there; of a constant-velocity joint where its shafts are straight, so |theta| is its bend.  As k is
the same about every axis, k theta is the gradient of E (rotations.py: theta' . theta = theta .
omega).  theta is that of a turn below pi; beyond, it jumps to the turn from the other side, and the
run says so.
"""

from math import degrees, pi
from typing import Annotated, ClassVar

from annotated_types import Ge
from pydantic import model_validator

from trsim.elements.contract import (
    DAMPERS,
    SPRINGS,
    Channel,
    Element,
    Reach,
    Row,
    Turning,
    kernel,
    measured,
)
from trsim.elements.frames import (
    TwoPoints,
    at_both,
    cross,
    dot,
    minus,
    relative_spin,
    scaled,
    twist_apart,
)
from trsim.elements.rotations import out_of, rotation_vector, triad
from trsim.elements.rows import Axes
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.kernels.columns import V3, f8
from trsim.kernels.lazy import internal

TURN = "rotation_vector"
NEXT_TO_HALF = 0.1  # rad: so near to half a turn it is told


class BallSpring(Spec):
    """A spring and a damper against turns about every axis, alike about all.

    joint      a spherical joint, whose turns are counted from the drawing, or a constant_velocity
               joint, whose bend is counted from where its shafts are straight
    stiffness  moment for a turn, about the axis of the turn; of turns below 180 deg
    damping    moment for an angular velocity of the second body against the first, along that
    """

    type: ClassVar[str] = "ball_spring"
    joint: str
    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")] = 0.0
    damping: Annotated[float, Ge(0), Unit("N*m*s/rad")] = 0.0

    @model_validator(mode="after")
    def some_moment(self):
        if self.stiffness == 0.0 and self.damping == 0.0:
            raise ScenarioError("nothing acts", "give `stiffness`, `damping` or both")
        return self


class Own(TwoPoints):
    """Of one instance."""

    u_i: V3  # two axes of the joint's triad in the axes of body i
    a_i: V3
    u_j: V3  # and in those of body j
    a_j: V3
    stiffness: f8
    damping: f8


def pack(name, spec, at):
    joint = at.packed("joints", spec.joint, ("joint",))
    if not joint.element.sways:
        raise ScenarioError(
            f"'{spec.joint}' ({joint.element.key}) does not turn about every axis",
            "name a spherical or a constant_velocity joint; of others take `torsion_spring`",
            ("joint",),
        )
    axes = Axes.of(joint.row)
    where = {
        key: getattr(axes, key) for key in ("i", "j", "p_i", "p_j", "u_i", "a_i", "u_j", "a_j")
    }
    return Row(*Own.packed(spec, coordinate=-1, **where), turns=True)


@internal
def turn(scene, e):
    """theta, world axes."""
    X, own = scene.X, Own(scene, e)
    A_i = triad(X, own.i, own.u_i, cross(own.a_i, own.u_i), own.a_i)
    A_j = triad(X, own.j, own.u_j, cross(own.a_j, own.u_j), own.a_j)
    return out_of(A_i, rotation_vector(A_i, A_j))


@internal
def moment(scene, e):
    """On body j, world axes; and the power lost."""
    own = Own(scene, e)
    omega = relative_spin(scene.V, own.i, own.j)
    m = scaled(-own.damping, omega)
    if own.stiffness > 0.0:
        m = minus(m, scaled(own.stiffness, turn(scene, e)))
    return m, own.damping * dot(omega, omega)


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    m, lost = moment(scene, e)
    twist_apart(scene.F, own.i, own.j, m)
    scene.zd[DAMPERS] -= lost


@kernel
def energy(t, scene, e):
    theta = turn(scene, e)
    scene.E[SPRINGS] += 0.5 * Own(scene, e).stiffness * dot(theta, theta)


@measured
def measure(t, scene, e, o):
    m, _ = moment(scene, e)
    theta = turn(scene, e)
    for c in range(3):
        scene.out[o + c], scene.out[o + 3 + c] = m[c], theta[c]


def doubts(name, spec, largest):
    """A moment that jumps, or is about to: turns in space cannot be counted."""
    if spec.stiffness == 0.0:
        return
    angle, when = largest(f"{name}.{TURN}")
    if angle > pi - NEXT_TO_HALF:
        yield (
            f"forces.{name}: '{spec.joint}' turned by {degrees(angle):.4g} deg at {when:.4g} s; "
            "from half a turn on its moment is that of the turn from the other side, since turns "
            "about any axis cannot be counted: a universal joint counts those about its two pins"
        )


def turning(row):
    """All turns are felt, those of a flexible bar about itself too."""
    own = Own.of(row)
    return Turning((own.i, own.j), held=(own.i, own.j))


ELEMENT = Element(
    key="ball_spring",
    section="forces",
    spec=BallSpring,
    pack=pack,
    acts_at=at_both,
    reach=lambda _: Reach(),  # about the axis of the turn there is
    judged=lambda row: Own.of(row).stiffness > 0.0,
    doubts=doubts,
    channels=(
        Channel("moment", "N*m", "on the second body, world axes", 3),
        Channel(TURN, "rad", "of the second body against the first, world axes", 3, turn=True),
    ),
    turning=turning,
    kernels={"force": force, "energy": energy, "measure": measure},
    example="""
planar: false
bodies:
  mirror: {mass: 0.2 kg, inertia: [1e-4, 1e-4, 2e-4], at: [0, 0.05, 0], angular_velocity: [1, 0, 0]}
joints:
  neck: {type: spherical, bodies: [ground, mirror], at: [0, 0, 0]}
forces:
  rubber: {type: ball_spring, joint: neck, stiffness: 0.5 N*m/rad, damping: 2e-3 N*m*s/rad}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
