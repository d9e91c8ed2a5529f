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
    spin,
)
from trsim.elements.joint import Joint, axial_row, of_a_hinge, triads
from trsim.fields import vector


class Revolute(Joint):
    """A hinge between two bodies.  With the key `clearance` it is a clearance_joint.

    axis  direction of the hinge, as drawn; of any length
    """

    type: ClassVar[str] = "revolute"
    axis: vector("-") = (0.0, 0.0, 1.0)


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    return Row(
        (i, j, -1),
        (*at.local(i, spec.at), *at.local(j, spec.at), *triads(i, j, spec.axis, at, spec.drawn_in)),
    )


@kernel
def constraint(t, scene, a, b):
    X, con, par = scene.X, scene.con, scene.par
    for e in range(a, b):
        i, j = point_rows(scene, e)
        k4, k5 = con[e, 6], con[e, 7]
        if k4 >= 0 or k5 >= 0:
            u = arm(X, i, par[e, 6], par[e, 7], par[e, 8])
            w = arm(X, i, par[e, 9], par[e, 10], par[e, 11])
            axis = arm(X, j, par[e, 18], par[e, 19], par[e, 20])
            perpendicular_row(scene, i, u, j, axis, k4)
            perpendicular_row(scene, i, w, j, axis, k5)


@kernel
def coordinate(t, scene, a, b):
    X, V, S, con, par = scene.X, scene.V, scene.S, scene.con, scene.par
    for e in range(a, b):
        s = con[e, 2]
        if s < 0:
            continue
        i, j = con[e, 0], con[e, 1]
        axis = arm(X, i, par[e, 12], par[e, 13], par[e, 14])
        o_i, o_j = spin(V, i), spin(V, j)
        # of rigid bodies in a plane what comes in is the angle itself
        if scene.d == 6 or i >= scene.n_r or j >= scene.n_r:
            u = arm(X, i, par[e, 6], par[e, 7], par[e, 8])
            w = arm(X, i, par[e, 9], par[e, 10], par[e, 11])
            u_j = arm(X, j, par[e, 15], par[e, 16], par[e, 17])
            angle = atan2(dot(w, u_j), dot(u, u_j)) + par[e, 21]
            S[s, 0] = nearest_branch(angle, S[s, 0])
        S[s, 1] = dot(axis, (o_j[0] - o_i[0], o_j[1] - o_i[1], o_j[2] - o_i[2]))


ELEMENT = Element(
    key="revolute",
    section="joints",
    spec=Revolute,
    pack=pack,
    reach=lambda row: Reach(hinges=((row.con[0], row.par[12:15]),)),
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
