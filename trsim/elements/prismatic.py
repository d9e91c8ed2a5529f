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
    points,
    stroke,
    two_points,
)
from trsim.elements.joint import TILTS, Axes, triads
from trsim.fields import Spec, point, vector
from trsim.kernels.columns import constraint_row


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


class Own(Axes):
    """Of one instance."""

    across_1: constraint_row
    across_2: constraint_row
    tilt_1: constraint_row
    tilt_2: constraint_row
    turn: constraint_row


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    place = at.centre(j) if spec.at is None else spec.at
    places = points(at, i, j, place, place)
    return Row(*Own.packed(**places, **triads(i, j, spec.axis, at, spec.drawn_in)))


@kernel
def constraint(t, scene, a, b):
    X = scene.X
    for e in range(a, b):
        own = Own(scene, e)
        i, p_i, j, p_j = two_points(scene, e)
        a_j = arm(X, j, own.a_j)
        if own.across_1 >= 0 or own.tilt_1 >= 0:
            u = arm(X, i, own.u_i)
            along_row(scene, i, p_i, u, j, p_j, own.across_1)
            perpendicular_row(scene, i, u, j, a_j, own.tilt_1)
        if own.across_2 >= 0 or own.tilt_2 >= 0 or own.turn >= 0:
            w, u_j = arm(X, i, own.w_i), arm(X, j, own.u_j)
            along_row(scene, i, p_i, w, j, p_j, own.across_2)
            perpendicular_row(scene, i, w, j, a_j, own.tilt_2)
            perpendicular_row(scene, i, w, j, u_j, own.turn)


@kernel
def coordinate(t, scene, a, b):
    S = scene.S
    for e in range(a, b):
        own = Own(scene, e)
        s = own.coordinate
        if s < 0:
            continue
        S[s, 0], S[s, 1] = stroke(scene, e, arm(scene.X, own.i, own.a_i))


ELEMENT = Element(
    key="prismatic",
    section="joints",
    spec=Prismatic,
    pack=pack,
    reach=lambda row: Reach(slides=((row.con[0], Own.of(row).a_i),)),
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
