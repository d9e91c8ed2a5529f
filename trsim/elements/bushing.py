"""Bushing: a spring and a damper between two bodies in each of six directions.

    d     = A_i^T (P_j - P_i)            displacement, zero as drawn
    f     = -K d - C d'                  A_i f on body j at P_j, -A_i f on body i at the same place
    theta = log(A_i^T A_j)               rotation vector of body j relative to body i, zero as drawn
    m     = -H^T K_r theta - C_r omega   A_i m on body j, -A_i m on body i

A_i are the axes of the stiffnesses, fixed in the first body; A_j are the same axes, fixed in the
second.  omega is the angular velocity of body j relative to body i in A_i, and theta' = H omega.
Both forces act along one line, so angular momentum is conserved at any displacement, and f and m
are the gradient of (d^T K d + theta^T K_r theta)/2.  theta describes a rotation below pi.  Beyond,
it jumps to the rotation from the other side, and the run reports this (doubts.py).  A rail is a
bushing with no stiffness and damping along the rail.
"""

from math import degrees, pi
from typing import Annotated, ClassVar

from annotated_types import Ge

from trsim.elements.contract import (
    DAMPERS,
    SPRINGS,
    Channel,
    Element,
    Reach,
    Row,
    Springs,
    Turning,
    kernel,
    measured,
)
from trsim.elements.frames import (
    TwoPoints,
    at_both,
    carried,
    dot,
    minus,
    points,
    push_apart,
    relative_spin,
    scaled,
    twist_apart,
)
from trsim.elements.joint import of_key
from trsim.elements.rotations import gradient, into, out_of, rotation_vector, triad
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, direction, point, vector
from trsim.frame import across
from trsim.kernels.columns import V3, i8
from trsim.kernels.lazy import internal

Least0 = Annotated[float, Ge(0)]
Three = tuple[Least0, Least0, Least0]
NONE = (0.0, 0.0, 0.0)
TURN = "rotation_vector"
NEXT_TO_HALF = 0.1  # rad: so near to half a turn it is told


class Bushing(Spec):
    """A linear spring and damper along three axes and about them.

    bodies                the two bodies; the axes turn with the first one
    at                    its position, as drawn; there its force is zero
    x_axis                x axis of the stiffnesses, as drawn; of any length
    y_axis                y axis of the stiffnesses, made perpendicular to x; z = x cross y
    stiffness             stiffness along x, y, z; 0 lets the bodies slide
    damping               damping along x, y, z
    rotational_stiffness  rotational stiffness about x, y, z
    rotational_damping    rotational damping about x, y, z
    """

    type: ClassVar[str] = "bushing"
    bodies: tuple[str, str]
    at: point("m")
    x_axis: vector("-") = (1.0, 0.0, 0.0)
    y_axis: vector("-") = (0.0, 1.0, 0.0)
    stiffness: Annotated[Three, Unit("N/m")]
    damping: Annotated[Three, Unit("N*s/m")] = NONE
    rotational_stiffness: Annotated[Three, Unit("N*m/rad")] = NONE
    rotational_damping: Annotated[Three, Unit("N*m*s/rad")] = NONE

    @property
    def axes(self):
        """The three unit vectors along which stiffnesses are meant, world axes as drawn."""
        x, y = of_key(self, "x_axis"), of_key(self, "y_axis")
        z = across(x, y)
        if max(map(abs, z)) < 1e-6:
            what = "`y_axis` has the direction of `x_axis`"
            raise ScenarioError(what, "give the one across it, for example [0, 0, 1]", ("y_axis",))
        z = direction(z)
        return x, across(z, x), z


class Own(TwoPoints):
    """Of one instance."""

    turns: i8  # 1: something acts against turns
    x_i: V3  # directions of the stiffnesses in the axes of body i
    y_i: V3
    z_i: V3
    x_j: V3  # and in those of body j
    y_j: V3
    z_j: V3
    stiffness: V3
    damping: V3
    rotational_stiffness: V3
    rotational_damping: V3


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    named = zip(("x", "y", "z"), spec.axes, strict=True)
    own = {f"{k}_{end}": at.axes(f, axis) for k, axis in named for end, f in (("i", i), ("j", j))}
    turns = any((*spec.rotational_stiffness, *spec.rotational_damping))
    return Row(*Own.packed(spec, **points(at, i, j, spec.at, spec.at), **own, turns=turns))


@internal
def diagonal(K, v):
    """K v with the diagonal K."""
    return (K[0] * v[0], K[1] * v[1], K[2] * v[2])


@internal
def half_square(K, v):
    """(v^T K v)/2 with the diagonal K."""
    return 0.5 * dot(v, diagonal(K, v))


@internal
def slide(scene, e):
    """The axes A_i, the arm to P_j on body i and on body j, d and d'."""
    own = Own(scene, e)
    p_i, p_j, d, v = carried(scene, e)
    A = triad(scene.X, own.i, own.x_i, own.y_i, own.z_i)
    return A, p_i, p_j, into(A, d), into(A, v)


@internal
def turn(X, A, own):
    """theta."""
    return rotation_vector(A, triad(X, own.j, own.x_j, own.y_j, own.z_j))


@internal
def loads(scene, e):
    """Arms on both bodies, force and moment on body j in world axes, the power lost."""
    own = Own(scene, e)
    A, p_i, p_j, d, rate = slide(scene, e)
    k, c = diagonal(own.stiffness, d), diagonal(own.damping, rate)
    f, m, lost = minus(scaled(-1.0, k), c), (0.0, 0.0, 0.0), dot(c, rate)
    if own.turns == 1:
        theta = turn(scene.X, A, own)
        omega = into(A, relative_spin(scene.V, own.i, own.j))
        k = gradient(theta, diagonal(own.rotational_stiffness, theta))
        c = diagonal(own.rotational_damping, omega)
        m = minus(scaled(-1.0, k), c)
        lost += dot(c, omega)
    return p_i, p_j, out_of(A, f), out_of(A, m), lost


@kernel
def force(t, scene, e):
    own = Own(scene, e)
    p_i, p_j, f, m, lost = loads(scene, e)
    push_apart(scene.F, own.i, p_i, own.j, p_j, f)
    twist_apart(scene.F, own.i, own.j, m)
    scene.zd[DAMPERS] -= lost


@kernel
def energy(t, scene, e):
    own = Own(scene, e)
    A, _, _, d, _ = slide(scene, e)
    scene.E[SPRINGS] += half_square(own.stiffness, d)
    if own.turns == 1:
        scene.E[SPRINGS] += half_square(own.rotational_stiffness, turn(scene.X, A, own))


@measured
def measure(t, scene, e, o):
    out = scene.out
    A, _, _, d, _ = slide(scene, e)
    _, _, f, m, _ = loads(scene, e)
    theta = turn(scene.X, A, Own(scene, e))
    for c in range(3):
        out[o + c], out[o + 3 + c], out[o + 6 + c], out[o + 9 + c] = f[c], m[c], d[c], theta[c]


def turns_against(row):
    """Whether something acts against turns, which has a meaning below half a turn only."""
    return any(Own.of(row).rotational_stiffness)


def doubts(name, spec, largest):
    """A moment that jumps, or is about to: turns in space cannot be counted."""
    if not any(spec.rotational_stiffness):
        return
    angle, when = largest(f"{name}.{TURN}")
    if angle > pi - NEXT_TO_HALF:
        yield (
            f"forces.{name}: turned by {degrees(angle):.4g} deg at {when:.4g} s; from "
            "half a turn on its moment is that of the turn from the other side, since turns "
            "about any axis cannot be counted: a torsion_spring on a hinge counts them"
        )


def springs(row):
    own = Own.of(row)
    return Springs((own.x_i, own.y_i, own.z_i), own.p_j, own.stiffness, own.rotational_stiffness)


def reach(row):
    """Its matrices of stiffness and damping; each acts in the plane where it couples no z to it."""
    own = Own.of(row)
    axes = (*own.x_i, *own.y_i, *own.z_i)
    sliding = (own.stiffness, own.damping)
    turning = (own.rotational_stiffness, own.rotational_damping)
    laws = (*((law, False) for law in sliding), *((law, True) for law in turning))
    return Reach(
        places=((own.i, own.p_i, (own.i, own.j)),) if any(map(any, sliding)) else (),
        always=True,
        tensors=tuple((own.i, axes, law, turns) for law, turns in laws if any(law)),
    )


def turning(row):
    """All turns are felt: two at least of its three axes point across a bar."""
    own = Own.of(row)
    held = (own.j,) if own.turns else ()
    return Turning((own.i, own.j), axes=((own.i, (0.0, 0.0, 0.0)),), held=held)


ELEMENT = Element(
    key="bushing",
    section="forces",
    spec=Bushing,
    pack=pack,
    acts_at=at_both,
    reach=reach,
    judged=turns_against,
    doubts=doubts,
    springs=springs,
    channels=(
        Channel("force", "N", "force on the second body at its point, world axes", 3),
        Channel("moment", "N*m", "moment on the second body, world axes", 3),
        Channel(
            "displacement",
            "m",
            "displacement of the second body's point, in the axes of the first",
            3,
        ),
        Channel(TURN, "rad", "rotation vector of the second body, in the same axes", 3, turn=True),
    ),
    turning=turning,
    picture="block",
    kernels={"force": force, "energy": energy, "measure": measure},
    example="""
planar: false
bodies:
  engine: {mass: 20 kg, inertia: [0.5, 0.8, 0.8], at: [0, 0.1, 0]}
forces:
  mount: {type: bushing, bodies: [ground, engine], at: [0, 0, 0],
          stiffness: [1e5, 1e5, 2e5], damping: [200, 200, 400],
          rotational_stiffness: [2e3, 2e3, 2e3], rotational_damping: [20, 20, 20]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
