"""Prismatic joint: body j slides along an axis of body i and does not turn against it.

    Phi_1, 2 = u_i . d = 0,  w_i . d = 0          d from the point on i to the point on j
    Phi_3, 4 = u_i . a_j = 0,  w_i . a_j = 0
    Phi_5    = w_i . u_j = 0                      [Nikravesh1988]

The stroke is a_i . d, zero as drawn.  reaction acts on body j at its point.
"""

from typing import ClassVar

from trsim.elements.contract import Element, Looser, Reach, Row, kernel
from trsim.elements.frames import (
    along_row,
    arm,
    perpendicular_row,
    stroke,
    two_points,
)
from trsim.elements.joint import TILTS, triads
from trsim.fields import Spec, point, vector


class Prismatic(Spec):
    """A slide of the second body along an axis of the first.

    bodies  the first one has the axis; reactions are those on the second one
    axis    direction in which the stroke grows, as drawn; of any length
    at      where reactions are told, as drawn; the second body's centre of mass unless given
    """

    type: ClassVar[str] = "prismatic"
    bodies: tuple[str, str]
    axis: vector("-")
    at: point("m") | None = None


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    place = at.centre(j) if spec.at is None else spec.at
    return Row(
        (i, j, -1),
        (*at.local(i, place), *at.local(j, place), *triads(i, j, spec.axis, at, spec.drawn_in)),
    )


@kernel
def constraint(t, scene, a, b):
    X, con, par = scene.X, scene.con, scene.par
    for e in range(a, b):
        i, p_i, j, p_j = two_points(X, con, par, e)
        a_j = arm(X, j, par[e, 18], par[e, 19], par[e, 20])
        k3, k4, k5, k6, k7 = con[e, 3], con[e, 4], con[e, 5], con[e, 6], con[e, 7]
        if k3 >= 0 or k5 >= 0:
            u = arm(X, i, par[e, 6], par[e, 7], par[e, 8])
            along_row(scene, i, p_i, u, j, p_j, k3)
            perpendicular_row(scene, i, u, j, a_j, k5)
        if k4 >= 0 or k6 >= 0 or k7 >= 0:
            w = arm(X, i, par[e, 9], par[e, 10], par[e, 11])
            u_j = arm(X, j, par[e, 15], par[e, 16], par[e, 17])
            along_row(scene, i, p_i, w, j, p_j, k4)
            perpendicular_row(scene, i, w, j, a_j, k6)
            perpendicular_row(scene, i, w, j, u_j, k7)


@kernel
def coordinate(t, scene, a, b):
    X, V, S, con, par = scene.X, scene.V, scene.S, scene.con, scene.par
    for e in range(a, b):
        s = con[e, 2]
        if s < 0:
            continue
        axis = arm(X, con[e, 0], par[e, 12], par[e, 13], par[e, 14])
        S[s, 0], S[s, 1] = stroke(X, V, con, par, e, axis)


ELEMENT = Element(
    key="prismatic",
    section="joints",
    spec=Prismatic,
    pack=pack,
    reach=lambda row: Reach(slides=((row.con[0], row.par[12:15]),)),
    rows=("across 1", "across 2", "tilt 1", "tilt 2", "turn"),
    coordinate="stroke",
    changes=lambda _: (
        Looser(("turn",), "cylindrical"),
        Looser((*TILTS, "turn"), "a ball in a sleeve"),
    ),
    picture="slide",
    kernels={"constraint": constraint, "coordinate": coordinate},
    example="""
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, -1, 0]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
