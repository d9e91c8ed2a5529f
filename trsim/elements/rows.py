"""Joints as lists of rows: what each row holds, and the kernels made of them.

A joint stands between the triads u, w, a of body i and of body j, which coincide as drawn, at two
points that coincide too (JointPar of joint.py).  Its rows are, first one of

    POINT          three rows: the points coincide
    along          Phi = u_i . d = 0            d from the point on i to the point on j

and then

    perpendicular  Phi = u_i . a_j = 0          [Nikravesh1988]

A row holds a displacement along one of u, w, a (written u, w, a) or a turn about one (U, W, A);
those of a point are along the world axes (x, y, z).  Names that begin with tilt or turn are those
of angles.  Coordinates of a joint, of which some may be there:

    angle          of the triad of body j against that of body i about a_i, unwrapped
    stroke         a_i . d
"""

from functools import cache
from math import atan2
from typing import NamedTuple

from trsim.elements.contract import COORDINATE_INDEX, FIRST_ROW, kernel
from trsim.elements.frames import (
    along_row,
    arm,
    dot,
    helper,
    nearest_branch,
    perpendicular_row,
    point_rows,
    spin,
    stroke,
    two_points,
)

# par: where the triads of both bodies begin, and the angle as drawn
ON_I, ON_J, DRAWN = {"u": 6, "w": 9, "a": 12}, {"u": 15, "a": 18}, 21
U_I, W_I, A_I, U_J = ON_I["u"], ON_I["w"], ON_I["a"], ON_J["u"]
MOST = 6  # rows of a joint


class JointRow(NamedTuple):
    """A constraint row of a joint, by the axes of its triads."""

    name: str
    holds: str  # u, w, a: a displacement along it; U, W, A: a turn about it; x, y, z: of a point
    of_i: str = ""  # axis of body i; none of a point's
    of_j: str = ""  # axis of body j; of a turn


def along(axis: str, name: str) -> JointRow:
    """The point on j stays in the plane through the point on i across an axis of i."""
    return JointRow(name, axis, axis)


def perpendicular(of_i: str, of_j: str, name: str) -> JointRow:
    """An axis of i and an axis of j stay perpendicular: no turn about the third one."""
    [third] = {*ON_I} - {of_i, of_j}
    return JointRow(name, third.upper(), of_i, of_j)


POINT = tuple(JointRow(axis, axis) for axis in "xyz")
ACROSS = (along("u", "across 1"), along("w", "across 2"))
TILTS = (perpendicular("u", "a", "tilt 1"), perpendicular("w", "a", "tilt 2"))
TURN = perpendicular("w", "u", "turn")


@cache
def constraint_of(rows):
    """The kernel that fills a list of rows."""
    turning = tuple(row for row in rows if row.of_j)
    points, n, before = rows[:3] == POINT, len(turning), len(rows) - len(turning)
    none = (-1,) * MOST
    slides = (*(ON_I[row.of_i] for row in rows[:before] if row.of_i), *none)
    of_i = (*(ON_I[row.of_i] for row in turning), *none)
    of_j = (*(ON_J[row.of_j] for row in turning), *none)

    @kernel
    def constraint(t, scene, a, b):
        X, con, par = scene.X, scene.con, scene.par
        for e in range(a, b):
            if points:
                i, j = point_rows(scene, e)
            else:
                i, p_i, j, p_j = two_points(X, con, par, e)
                for r in range(before):
                    k, c = con[e, FIRST_ROW + r], slides[r]
                    if k >= 0:
                        u = arm(X, i, par[e, c], par[e, c + 1], par[e, c + 2])
                        along_row(scene, i, p_i, u, j, p_j, k)
            for r in range(n):
                k, c, o = con[e, FIRST_ROW + before + r], of_i[r], of_j[r]
                if k >= 0:
                    u = arm(X, i, par[e, c], par[e, c + 1], par[e, c + 2])
                    w = arm(X, j, par[e, o], par[e, o + 1], par[e, o + 2])
                    perpendicular_row(scene, i, u, j, w, k)

    return constraint


@helper
def on_i(scene, e, c):
    """The axis of body i at column c of par, world axes."""
    par = scene.par
    return arm(scene.X, scene.con[e, 0], par[e, c], par[e, c + 1], par[e, c + 2])


@helper
def write_angle(scene, e, s):
    """The angle of instance e and its rate, as entry s of S."""
    V, S, con, par = scene.V, scene.S, scene.con, scene.par
    i, j = con[e, 0], con[e, 1]
    o_i, o_j = spin(V, i), spin(V, j)
    # of rigid bodies in a plane what comes in is the angle itself
    if scene.d == 6 or i >= scene.n_r or j >= scene.n_r:
        u, w = on_i(scene, e, U_I), on_i(scene, e, W_I)
        u_j = arm(scene.X, j, par[e, U_J], par[e, U_J + 1], par[e, U_J + 2])
        angle = atan2(dot(w, u_j), dot(u, u_j)) + par[e, DRAWN]
        S[s, 0] = nearest_branch(angle, S[s, 0])
    turn = (o_j[0] - o_i[0], o_j[1] - o_i[1], o_j[2] - o_i[2])
    S[s, 1] = dot(on_i(scene, e, A_I), turn)


@cache
def coordinate_of(coordinates, n_rows):
    """The kernel of the coordinates of a joint with so many rows."""
    column = {name: column_of(k, n_rows) for k, name in enumerate(coordinates)}
    angle, sliding = column.get("angle", -1), column.get("stroke", -1)

    @kernel
    def coordinate(t, scene, a, b):
        S, con = scene.S, scene.con
        for e in range(a, b):
            if angle >= 0:
                s = con[e, angle]
                if s >= 0:
                    write_angle(scene, e, s)
            if sliding >= 0:
                s = con[e, sliding]
                if s >= 0:
                    axis = on_i(scene, e, A_I)
                    S[s, 0], S[s, 1] = stroke(scene.X, scene.V, con, scene.par, e, axis)

    return coordinate


def column_of(k: int, n_rows: int) -> int:
    """Column of con with the k-th coordinate of a joint; behind its rows but for the first."""
    return COORDINATE_INDEX if k == 0 else FIRST_ROW + n_rows + k - 1
