"""Revolute joint: two points coincide and two axes stay parallel.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0
    Phi_4    = u_i . a_j = 0
    Phi_5    = w_i . a_j = 0               [Nikravesh1988]

(u, w, a) is a right-handed triad with a the axis.  The joint angle is that of body j's axes minus
body i's about a, unwrapped.  reaction is the force on body j at the pin, world axes.
"""

from math import atan2
from typing import ClassVar

from trsim.elements.contract import Element, Reach, Row, kernel
from trsim.elements.frames import (
    arm,
    dot,
    nearest_branch,
    perpendicular_row,
    point_rows,
    points,
    spin,
)
from trsim.elements.joint import Axes, Joint, axial_row, of_a_hinge, triads
from trsim.fields import vector
from trsim.kernels.columns import constraint_row


class Revolute(Joint):
    """A hinge between two bodies.  With the key `clearance` it is a clearance_joint.

    axis  direction of the hinge, as drawn; of any length
    """

    type: ClassVar[str] = "revolute"
    axis: vector("-") = (0.0, 0.0, 1.0)


class Own(Axes):
    """Of one instance."""

    x: constraint_row
    y: constraint_row
    z: constraint_row
    tilt_1: constraint_row
    tilt_2: constraint_row


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    places = points(at, i, j, spec.at, spec.at)
    return Row(*Own.packed(**places, **triads(i, j, spec.axis, at, spec.drawn_in)))


@kernel
def constraint(t, scene, a, b):
    X = scene.X
    for e in range(a, b):
        i, j = point_rows(scene, e)
        own = Own(scene, e)
        if own.tilt_1 >= 0 or own.tilt_2 >= 0:
            axis = arm(X, j, own.a_j)
            perpendicular_row(scene, i, arm(X, i, own.u_i), j, axis, own.tilt_1)
            perpendicular_row(scene, i, arm(X, i, own.w_i), j, axis, own.tilt_2)


@kernel
def coordinate(t, scene, a, b):
    X, V, S = scene.X, scene.V, scene.S
    for e in range(a, b):
        own = Axes(scene, e)
        i, j, s = own.i, own.j, own.coordinate
        if s < 0:
            continue
        axis = arm(X, i, own.a_i)
        o_i, o_j = spin(V, i), spin(V, j)
        # of rigid bodies in a plane what comes in is the angle itself
        if scene.d == 6 or i >= scene.n_r or j >= scene.n_r:
            u, w, u_j = arm(X, i, own.u_i), arm(X, i, own.w_i), arm(X, j, own.u_j)
            angle = atan2(dot(w, u_j), dot(u, u_j)) + own.drawn
            S[s, 0] = nearest_branch(angle, S[s, 0])
        S[s, 1] = dot(axis, (o_j[0] - o_i[0], o_j[1] - o_i[1], o_j[2] - o_i[2]))


ELEMENT = Element(
    key="revolute",
    section="joints",
    spec=Revolute,
    pack=pack,
    reach=lambda row: Reach(hinges=((row.con[0], Own.of(row).a_i),)),
    rows=("x", "y", "z", "tilt 1", "tilt 2"),
    coordinate="angle",
    meets=True,
    pin=(2,),
    changes=lambda row: of_a_hinge(axial_row(row), "spherical", "universal"),
    picture="pin",
    kernels={"constraint": constraint, "coordinate": coordinate},
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
