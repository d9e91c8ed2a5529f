"""Parked: a body that an event holds in its present position.

    Phi_1..3 = r - r_0 = 0                                  its centre of mass
    Phi_4..6 = u_0 . a = 0,  w_0 . a = 0,  w_0 . u = 0      its axes

r_0 and the axes u_0, w_0 are those of the body when it was parked.  force acts on the body at its
centre of mass, and moment about it, in world axes.
"""

from typing import ClassVar

from trsim.elements.contract import Channel, Element, Pair, Row, kernel, measured
from trsim.elements.frames import cross, dot, perpendicular_row
from trsim.elements.rows import POINT, TILTS, TURN
from trsim.fields import Spec
from trsim.kernels.columns import TUPLE, Column, constraint_row
from trsim.kernels.lazy import internal

THREE = Column("mem", 3, TUPLE, packed=False)
UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Parked(Spec):
    """Created from the key `park` of events and phases, one instance for each body that is ever
    parked.

    body  the body
    """

    type: ClassVar[str] = "parked"
    body: str


class Own(Pair):
    """Of one instance; i is the ground."""

    x: constraint_row
    y: constraint_row
    z: constraint_row
    tilt_1: constraint_row
    tilt_2: constraint_row
    turn: constraint_row
    place: THREE
    u: THREE
    w: THREE


def pack(name, spec, at):
    return Row(*Own.packed(i=0, j=at.body(spec.body), coordinate=-1))


def hold(scene, e):
    """Remember where the body is."""
    X, own = scene.X, Own(scene, e)
    first = Own.columns["place"].at
    rotation = X[own.j, 3:].reshape(3, 3)
    scene.mem[e, first : first + 9] = [*X[own.j, :3], *rotation.T[:2].ravel()]


@internal
def axis(scene, f, c):
    """Axis c of a body, in world axes."""
    X = scene.X
    return X[f, 3 + c], X[f, 6 + c], X[f, 9 + c]


@internal
def place_row(scene, own, k, c):
    """The coordinate c of the centre of mass as row k."""
    X, J, l, n = scene.X, scene.J, scene.row_start[k], UNIT[c]
    r = (X[own.j, 0], X[own.j, 1], X[own.j, 2])
    back = cross(r, n)
    for d in range(3):
        J[l, d], J[l, 3 + d] = -n[d], -back[d]
        J[l + 1, d], J[l + 1, 3 + d] = n[d], 0.0
    scene.phi[k] = r[c] - own.place[c] if dot(own.u, own.u) > 0.0 else 0.0
    scene.phi_t[k] = scene.gamma[k] = 0.0


@internal
def begun(scene, own, axis_0, c):
    """An axis as it was when the body was parked; as it is before that, where rows are chosen."""
    return axis_0 if dot(axis_0, axis_0) > 0.0 else axis(scene, own.j, c)


@kernel
def constraint(t, scene, e):
    own = Own(scene, e)
    u, w = begun(scene, own, own.u, 0), begun(scene, own, own.w, 1)
    if own.x >= 0:
        place_row(scene, own, own.x, 0)
    if own.y >= 0:
        place_row(scene, own, own.y, 1)
    if own.z >= 0:
        place_row(scene, own, own.z, 2)
    if own.tilt_1 >= 0:
        perpendicular_row(scene, own.i, u, own.j, axis(scene, own.j, 2), own.tilt_1)
    if own.tilt_2 >= 0:
        perpendicular_row(scene, own.i, w, own.j, axis(scene, own.j, 2), own.tilt_2)
    if own.turn >= 0:
        perpendicular_row(scene, own.i, w, own.j, axis(scene, own.j, 0), own.turn)


@internal
def add(scene, o, row):
    """What a row puts on the body, added to six columns from o on."""
    if row >= 0:
        l = scene.row_start[row] + 1
        for c in range(6):
            scene.out[o + c] -= scene.lam[row] * scene.J[l, c]


@measured
def measure(t, scene, e, o):
    own = Own(scene, e)
    for c in range(6):
        scene.out[o + c] = 0.0
    add(scene, o, own.x)
    add(scene, o, own.y)
    add(scene, o, own.z)
    add(scene, o, own.tilt_1)
    add(scene, o, own.tilt_2)
    add(scene, o, own.turn)


ELEMENT = Element(
    key="parked",
    section="",
    spec=Parked,
    pack=pack,
    rows=tuple(row.name for row in (*POINT, *TILTS, TURN)),
    acts_at=lambda row: ((Own.of(row).j, (0.0, 0.0, 0.0)),),
    channels=(
        Channel(
            "force", "N", "force that holds the parked body, at its centre of mass, world axes", 3
        ),
        Channel("moment", "N*m", "moment that holds it, about its centre of mass", 3),
    ),
    hold=hold,
    n_mem=9,
    kernels={"constraint": constraint, "measure": measure},
    example="""
bodies:
  arm: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0]}
events:
  away: {when: t, value: 0.2 s, do: {park: [arm]}}
gravity: [0, -9.81, 0]
solver: {end: 0.5 s}
""",
)
