"""Ball spring: a spring and a damper against any rotation of a joint that holds a point.

    theta = log(A_i^T A_j)              rotation vector of body j relative to body i; x = |theta|
    m     = -A_i (k x + f(x)) theta/x - (c w + d(w)) omega/w         w = |omega|
                                        on body j, -m on body i; omega = omega_j - omega_i
    E     = k x^2 / 2 + integral of f from 0 to x

f and d are user-defined functions; they are zero at zero, where their moments have no direction.
A_i, A_j are the triads of the joint.  Those of a spherical joint coincide as drawn, so theta is
zero there.  Those of a constant-velocity joint coincide when its shafts are straight, so |theta| is
its bend.  Because the spring is equal about all axes, the moment is the gradient of E: x' = omega .
A_i theta/x (rotations.py).  theta describes a rotation below pi.  Beyond, it jumps to the rotation
from the other side, and the run reports this.
"""

from math import degrees, pi, sqrt
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
from trsim.elements.sprung import RATE, check_damper, of_number
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit
from trsim.kernels.columns import V3, f8, i8
from trsim.kernels.lazy import internal
from trsim.laws.functions import value
from trsim.laws.quadrature import integral
from trsim.varying import Function

TURN, ANGLE = "rotation_vector", "angle"
BEGUN = (1e-12, 1e-6)  # rad, rad/s: what is half as large at the first as at the second jumps at 0
NEXT_TO_HALF = 0.1  # rad: so near to half a turn it is told


class BallSpring(Spec):
    """A spring and a damper against rotation about any axis, equal about all axes.

    joint      a spherical joint, whose rotation is measured from the drawing, or a
               constant_velocity joint, whose bend is measured from straight shafts
    stiffness  moment per angle of rotation, about the axis of the rotation; for rotations below 180
               deg
    damping    moment per angular velocity of the second body relative to the first, along that
               velocity
    elastic    elastic moment in addition to that of `stiffness`, a function of `angle`: the angle
               by which the second body is rotated, about any axis, never below 0
    damper     damping moment in addition to that of `damping`, a function of `rate`: the magnitude
               of the angular velocity, never below 0
    """

    type: ClassVar[str] = "ball_spring"
    joint: str
    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")] = 0.0
    damping: Annotated[float, Ge(0), Unit("N*m*s/rad")] = 0.0
    elastic: Function("N*m", of=ANGLE) | None = None
    damper: Function("N*m", of=RATE) | None = None

    @model_validator(mode="after")
    def some_moment(self):
        if self.elastic is not None:
            check_elastic(self.elastic)
        if self.damper is not None:
            check_damper(self.damper, backward=False)
            check_begins(self.damper, "damper", RATE, "what resists at once is `joint_friction`")
        if self.springs or self.damping > 0.0 or self.damper is not None:
            return self
        what = "give `stiffness`, `damping`, `elastic` or `damper`"
        raise ScenarioError("nothing acts", what)

    @property
    def springs(self):
        """Whether it pulls back."""
        return self.stiffness > 0.0 or self.elastic is not None


def check_elastic(f):
    """Refuse a moment at no turn, which has no axis."""
    if f.kind == "table":
        if 0.0 not in f.x:
            what = "without a row at an angle of 0 it may act there, about no axis"
            raise ScenarioError(what, "add a row [0, 0]", ("elastic", "table"))
        at_rest = f.y[f.x.index(0.0)]
    else:
        at_rest = of_number(f, ANGLE, 0.0)
    hint = "it is 0 where nothing is turned; of a preload about one axis take `applied_load`"
    if at_rest != 0.0:
        what = f"a moment of {at_rest:g} at an angle of 0, about no axis"
        raise ScenarioError(what, hint, ("elastic",))
    check_begins(f, "elastic", ANGLE, hint)


def check_begins(f, key, name, hint):
    """Refuse a moment that does not begin at 0: its axis is any that rounding makes."""
    if f.kind == "table":
        return
    at_once, soon = (abs(of_number(f, name, x)) for x in BEGUN)
    if at_once > 0.5 * soon:
        what = f"a moment of {at_once:g} at once, where `{name}` is hardly above 0"
        raise ScenarioError(what, hint, (key,))


class Own(TwoPoints):
    """Of one instance."""

    u_i: V3  # two axes of the joint's triad in the axes of body i
    a_i: V3
    u_j: V3  # and in those of body j
    a_j: V3
    stiffness: f8
    damping: f8
    elastic: i8  # f in tab, or -1
    whole: i8  # f again, which no run holds on a piece: for the energy
    damper: i8  # d, or -1
    speed: i8  # entry of S whose rate is w; that of the coordinate is x


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
    laws, entries = packed_laws(spec, at)
    own = Own.packed(spec, **where, **laws, **entries)
    return Row(*own, turns=True, travel="swing", speed=entries["speed"])


def packed_laws(spec, at):
    """The columns of its functions, and those of their entries of S; -1 where there are none."""
    laws = dict.fromkeys(("elastic", "whole", "damper"), -1)
    entries = dict.fromkeys(("coordinate", "speed"), -1)
    if spec.elastic is None and spec.damper is None:
        return laws, entries
    entries = {key: at.entry() for key in entries}
    local = {
        ANGLE: (entries["coordinate"], "rad"),
        RATE: (at.rate_of(entries["speed"]), "rad/s"),
    }
    for key, f, free in (("elastic", spec.elastic, False), ("whole", spec.elastic, True),
                         ("damper", spec.damper, False)):  # fmt: skip
        if f is not None:
            path = "elastic" if key == "whole" else key
            laws[key] = at.function(f, path, wanted="N*m", local=local, free=free)
    return laws, entries


@internal
def turn(scene, e):
    """theta, world axes."""
    X, own = scene.X, Own(scene, e)
    A_i = triad(X, own.i, own.u_i, cross(own.a_i, own.u_i), own.a_i)
    A_j = triad(X, own.j, own.u_j, cross(own.a_j, own.u_j), own.a_j)
    return out_of(A_i, rotation_vector(A_i, A_j))


@kernel
def coordinate(t, scene, e):
    S, own = scene.S, Own(scene, e)
    if own.coordinate < 0:
        return
    theta, omega = turn(scene, e), relative_spin(scene.V, own.i, own.j)
    x, w = sqrt(dot(theta, theta)), sqrt(dot(omega, omega))
    S[own.coordinate, 0], S[own.coordinate, 1] = x, (dot(theta, omega) / x if x > 0.0 else w)
    S[own.speed, 0], S[own.speed, 1] = 0.0, w


@internal
def moment(t, scene, e):
    """On body j, world axes; and the power lost."""
    own = Own(scene, e)
    omega = relative_spin(scene.V, own.i, own.j)
    held, slowed = own.stiffness, own.damping
    if own.elastic >= 0:
        x = scene.S[own.coordinate, 0]
        held += value(scene.tab, own.elastic, t, scene.S) / x if x > 0.0 else 0.0
    if own.damper >= 0:
        w = scene.S[own.speed, 1]
        slowed += value(scene.tab, own.damper, t, scene.S) / w if w > 0.0 else 0.0
    m = scaled(-slowed, omega)
    if held != 0.0:
        m = minus(m, scaled(held, turn(scene, e)))
    return m, slowed * dot(omega, omega)


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    m, lost = moment(t, scene, e)
    twist_apart(scene.F, own.i, own.j, m)
    scene.zd[DAMPERS] -= lost


@kernel
def energy(t, scene, e):
    own, theta = Own(scene, e), turn(scene, e)
    square = dot(theta, theta)
    scene.E[SPRINGS] += 0.5 * own.stiffness * square
    if own.whole >= 0:
        k = own.coordinate
        scene.E[SPRINGS] += integral(scene.tab, own.whole, scene.S, k, 0.0, sqrt(square))


@measured
def measure(t, scene, e, o):
    m, _ = moment(t, scene, e)
    theta = turn(scene, e)
    for c in range(3):
        scene.out[o + c], scene.out[o + 3 + c] = m[c], theta[c]


def doubts(name, spec, largest):
    """A moment that jumps, or is about to: turns in space cannot be counted."""
    if not spec.springs:
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
    judged=lambda row: Own.of(row).stiffness > 0.0 or Own.of(row).elastic >= 0,
    doubts=doubts,
    channels=(
        Channel("moment", "N*m", "moment on the second body, world axes", 3),
        Channel(
            TURN,
            "rad",
            "rotation vector of the second body relative to the first, world axes",
            3,
            turn=True,
        ),
    ),
    turning=turning,
    kernels={"coordinate": coordinate, "force": force, "energy": energy, "measure": measure},
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
