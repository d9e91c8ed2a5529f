"""Bushing: a spring and a damper in each of six directions between two bodies.

    d     = A_i^T (P_j - P_i)            displacement, zero as drawn
    f     = -K d - C d'                  A_i f on body j at P_j, -A_i f on body i at the same place
    theta = log(A_i^T A_j)               rotation vector of body j against body i, zero as drawn
    m     = -H^T K_r theta - C_r omega   A_i m on body j, -A_i m on body i

A_i are the axes of the stiffnesses, fixed in the first body, A_j the same ones in the second;
omega is the angular velocity of body j against body i in A_i, theta' = H omega.  Both forces act
along one line, so angular momentum is kept whatever the slide, and f and m are the gradient of
(d^T K d + theta^T K_r theta)/2.  theta is that of a turn below pi; beyond, it jumps to the turn
from the other side, and the run says so (doubts.py).  A rail is a bushing without stiffness and
damping along it.
"""

from math import degrees, pi
from typing import Annotated, ClassVar

from annotated_types import Ge

from trsim.elements.contract import (
    DAMPERS,
    SPRINGS,
    Channel,
    Element,
    Held,
    Reach,
    Row,
    Turning,
    kernel,
)
from trsim.elements.frames import (
    dot,
    helper,
    push,
    separation,
    spin,
    twist,
    two_points,
    velocity,
)
from trsim.elements.rotations import gradient, into, out_of, rotation_vector, triad
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, direction, point, vector
from trsim.frame import across

Least0 = Annotated[float, Ge(0)]
Three = tuple[Least0, Least0, Least0]
NONE = (0.0, 0.0, 0.0)
TURN = "rotation_vector"
NEXT_TO_HALF = 0.1  # rad: so near to half a turn it is told
STIFFNESS, DAMPING, ROTATIONAL = 24, 27, 30  # par, after the arms and the axes in both bodies


class Bushing(Spec):
    """A linear spring and damper in three directions and about them.

    bodies                the two bodies; the axes turn with the first one
    at                    the place, as drawn, where nothing acts
    x_axis                first direction of the stiffnesses, as drawn; of any length
    y_axis                second one, made perpendicular to the first; the third is x cross y
    stiffness             along x, y, z; 0 lets the bodies slide
    damping               along x, y, z
    rotational_stiffness  about x, y, z
    rotational_damping    about x, y, z
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
        for key in ("x_axis", "y_axis"):
            if not any(getattr(self, key)):
                raise ScenarioError("an axis must not be zero", "for example [0, 0, 1]", (key,))
        x, y = direction(self.x_axis), direction(self.y_axis)
        z = across(x, y)
        if max(map(abs, z)) < 1e-6:
            what = "`y_axis` has the direction of `x_axis`"
            raise ScenarioError(what, "give the one across it, for example [0, 0, 1]", ("y_axis",))
        z = direction(z)
        return x, across(z, x), z


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    own = spec.axes
    turning = any((*spec.rotational_stiffness, *spec.rotational_damping))
    return Row(
        (i, j, -1, int(turning)),
        (
            *at.local(i, spec.at),
            *at.local(j, spec.at),
            *(c for axis in own for c in at.axes(i, axis)),
            *(c for axis in own for c in at.axes(j, axis)),
            *(*spec.stiffness, *spec.damping),
            *(*spec.rotational_stiffness, *spec.rotational_damping),
        ),
    )


@helper
def diagonal(par, e, k, v):
    """Three numbers of par from k on times those of v."""
    return (par[e, k] * v[0], par[e, k + 1] * v[1], par[e, k + 2] * v[2])


@helper
def half_square(par, e, k, v):
    """(v^T K v)/2 with three numbers K of par from k on."""
    return 0.5 * dot(v, diagonal(par, e, k, v))


@helper
def slide(X, con, par, e):
    """The axes A_i, the arm to P_j on body i and on body j, and d."""
    i, p_i, j, p_j = two_points(X, con, par, e)
    D = separation(X, i, p_i, j, p_j)
    A = triad(X, i, par, e, 6)
    return A, (p_i[0] + D[0], p_i[1] + D[1], p_i[2] + D[2]), p_j, into(A, D)


@helper
def turn(X, A, con, par, e):
    """theta."""
    return rotation_vector(A, triad(X, con[e, 1], par, e, 15))


@helper
def loads(X, V, con, par, e):
    """Arms on both bodies, force and moment on body j in world axes, the power lost."""
    i, j = con[e, 0], con[e, 1]
    A, p_i, p_j, d = slide(X, con, par, e)
    v_i, v_j, o_i, o_j = velocity(V, i, p_i), velocity(V, j, p_j), spin(V, i), spin(V, j)
    rate = into(A, (v_j[0] - v_i[0], v_j[1] - v_i[1], v_j[2] - v_i[2]))
    k, c = diagonal(par, e, STIFFNESS, d), diagonal(par, e, DAMPING, rate)
    f, m, lost = (-k[0] - c[0], -k[1] - c[1], -k[2] - c[2]), (0.0, 0.0, 0.0), dot(c, rate)
    if con[e, 3] == 1:
        theta = turn(X, A, con, par, e)
        omega = into(A, (o_j[0] - o_i[0], o_j[1] - o_i[1], o_j[2] - o_i[2]))
        k = gradient(theta, diagonal(par, e, ROTATIONAL, theta))
        c = diagonal(par, e, ROTATIONAL + 3, omega)
        m = (-k[0] - c[0], -k[1] - c[1], -k[2] - c[2])
        lost += dot(c, omega)
    return p_i, p_j, out_of(A, f), out_of(A, m), lost


@kernel
def force(t, scene, a, b):
    X, V, con, par, F, zd = scene.X, scene.V, scene.con, scene.par, scene.F, scene.zd
    for e in range(a, b):
        i, j = con[e, 0], con[e, 1]
        p_i, p_j, f, m, lost = loads(X, V, con, par, e)
        push(F, j, p_j, f)
        push(F, i, p_i, (-f[0], -f[1], -f[2]))
        twist(F, j, m)
        twist(F, i, (-m[0], -m[1], -m[2]))
        zd[DAMPERS] -= lost


@kernel
def energy(t, scene, a, b):
    X, con, par, E = scene.X, scene.con, scene.par, scene.E
    for e in range(a, b):
        A, _, _, d = slide(X, con, par, e)
        E[SPRINGS] += half_square(par, e, STIFFNESS, d)
        if con[e, 3] == 1:
            E[SPRINGS] += half_square(par, e, ROTATIONAL, turn(X, A, con, par, e))


@kernel
def measure(t, scene, a, b):
    X, V, con, par, col, out = scene.X, scene.V, scene.con, scene.par, scene.wanted, scene.out
    for e in range(a, b):
        o = col[e]
        if o < 0:
            continue
        A, _, _, d = slide(X, con, par, e)
        _, _, f, m, _ = loads(X, V, con, par, e)
        theta = turn(X, A, con, par, e)
        for c in range(3):
            out[o + c], out[o + 3 + c], out[o + 6 + c], out[o + 9 + c] = f[c], m[c], d[c], theta[c]


def turns_against(row):
    """Whether something acts against turns, which has a meaning below half a turn only."""
    return any(row.par[ROTATIONAL : ROTATIONAL + 3])


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


def holds(row):
    stiff = (row.par[n : n + 3] for n in (STIFFNESS, ROTATIONAL))
    return Held(row.par[6:15], row.par[3:6], *stiff)


def reach(row):
    """Its matrices of stiffness and damping; each acts in the plane where it couples no z to it."""
    i, j = row.con[:2]
    axes, k, c, k_r, c_r = (
        row.par[n : n + m] for n, m in ((6, 9), (24, 3), (27, 3), (30, 3), (33, 3))
    )
    return Reach(
        places=((i, row.par[:3], (i, j)),) if any(k + c) else (),
        always=True,
        tensors=tuple(
            (i, axes, law, turns)
            for law, turns in ((k, False), (c, False), (k_r, True), (c_r, True))
            if any(law)
        ),
    )


def turning(row):
    """All turns are felt: two at least of its three axes point across a bar."""
    i, j, _, turns = row.con
    return Turning((i, j), axes=((i, (0.0, 0.0, 0.0)),), held=(j,) if turns else ())


ELEMENT = Element(
    key="bushing",
    section="forces",
    spec=Bushing,
    pack=pack,
    reach=reach,
    judged=turns_against,
    doubts=doubts,
    holds=holds,
    channels=(
        Channel("force", "N", "on the second body at its point, world axes", 3),
        Channel("moment", "N*m", "on the second body, world axes", 3),
        Channel("displacement", "m", "of the second body's point, in the axes of the first", 3),
        Channel(TURN, "rad", "of the second body, in the same axes", 3, turn=True),
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
