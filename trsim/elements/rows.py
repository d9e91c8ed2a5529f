"""Joints as lists of rows: what each row holds, and the kernels made of them.

A joint stands between the triads u, w, a of body i and of body j, which coincide as drawn, at two
points that coincide too (Axes).  Its rows are, first one of

    POINT          three rows: the points coincide
    along          Phi = u_i . d = 0            d from the point on i to the point on j

and then

    perpendicular  Phi = u_i . a_j = 0          [Nikravesh1988]
    Relation       a row of the joint's own, such as one between its angle and its stroke

A row holds a displacement along one of u, w, a (written u, w, a) or a turn about one (U, W, A);
those of a point are along the world axes (x, y, z), and a relation has any other letter.  Names
that begin with tilt or turn are those of angles.  Coordinates of a joint, of which some may be
there:

    angle          of the triad of body j against that of body i about a_i, unwrapped
    first_angle    the same of a cross, whose pins are a_i and u_j: of u_j against u_i about a_i
    second_angle   of a_j against a_i about u_j
    stroke         a_i . d
    x, y           u_i . d,  w_i . d
    arc            length along a curve of body i, which its joint writes itself (on_curve.py)
"""

from collections.abc import Callable
from functools import cache
from math import atan2
from typing import NamedTuple

from trsim.elements.contract import FIRST_ROW, Pair, kernel
from trsim.elements.frames import (
    TwoPoints,
    along_row,
    arm,
    cross,
    dot,
    nearest_branch,
    perpendicular_row,
    point_rows,
    relative_spin,
    stroke,
)
from trsim.kernels.columns import V3, f8
from trsim.kernels.lazy import internal


class Axes(TwoPoints):
    """Of one instance of a joint."""

    u_i: V3  # triad u, w, a in the axes of body i: a = u x w, the axis
    w_i: V3
    a_i: V3
    u_j: V3  # u and a in the axes of body j
    a_j: V3
    drawn: f8  # rad: joint angle as drawn


class JointRow(NamedTuple):
    """A constraint row of a joint, by the axes of its triads."""

    name: str
    holds: str  # u, w, a: a displacement along it; U, W, A: a turn about it; x, y, z: of a point
    of_i: str = ""  # axis of body i; of a point none
    of_j: str = ""  # axis of body j; of a turn
    fill: Callable | None = None  # (scene, e, k) writes row k, of a relation

    @property
    def places(self) -> bool:
        """Whether it holds a displacement."""
        return self.holds in "xyzuwa"

    @property
    def turns(self) -> bool:
        """Whether it holds a turn about one axis."""
        return self.holds in "UWA"


def along(axis: str, name: str) -> JointRow:
    """The point on j stays in the plane through the point on i across an axis of i."""
    return JointRow(name, axis, axis)


def perpendicular(of_i: str, of_j: str, name: str) -> JointRow:
    """An axis of i and an axis of j stay perpendicular: no turn about the third one."""
    [third] = {*"uwa"} - {of_i, of_j}
    return JointRow(name, third.upper(), of_i, of_j)


POINT = tuple(JointRow(axis, axis) for axis in "xyz")
ACROSS = (along("u", "across 1"), along("w", "across 2"))
TILTS = (perpendicular("u", "a", "tilt 1"), perpendicular("w", "a", "tilt 2"))
TURN = perpendicular("w", "u", "turn")


@cache
def constraint_of(rows):
    """The kernel that fills a list of rows, six at most; those of a point count as one."""
    own = [(row, FIRST_ROW + k) for k, row in enumerate(rows) if row.of_i or row.fill]
    fills = [fill_of(*row) for row in own]
    fills = [point_rows, *fills] if rows[:3] == POINT else fills
    one, two, three, four, five, six = (*fills, *(nothing,) * (6 - len(fills)))

    @kernel
    def constraint(t, scene, e):
        one(scene, e)
        two(scene, e)
        three(scene, e)
        four(scene, e)
        five(scene, e)
        six(scene, e)

    return constraint


@internal
def nothing(scene, e):
    """Where a joint has no more rows."""


def fill_of(row, column):
    """What fills a row whose index stands in a column of con."""
    if row.fill:
        return related(row.fill, column)
    c = Axes.columns[f"{row.of_i}_i"].at
    o = Axes.columns[f"{row.of_j}_j"].at if row.of_j else -1

    @internal
    def turn(scene, e):
        k = scene.con[e, column]
        if k >= 0:
            X, own = scene.X, Pair(scene, e)
            u, w = arm(X, own.i, axis(scene, e, c)), arm(X, own.j, axis(scene, e, o))
            perpendicular_row(scene, own.i, u, own.j, w, k)

    @internal
    def slide(scene, e):
        k = scene.con[e, column]
        if k >= 0:
            along_row(scene, e, arm(scene.X, Pair(scene, e).i, axis(scene, e, c)), k)

    return turn if row.of_j else slide


def related(fill, column):
    """The same of a relation."""

    @internal
    def relation(scene, e):
        k = scene.con[e, column]
        if k >= 0:
            fill(scene, e, k)

    return relation


@internal
def axis(scene, e, c):
    """What stands in the columns of par from c on."""
    return scene.par[e, c], scene.par[e, c + 1], scene.par[e, c + 2]


@internal
def write_angle(scene, e, s):
    """The angle of instance e and its rate, as entry s of S."""
    X, V, S, own = scene.X, scene.V, scene.S, Axes(scene, e)
    i, j = own.i, own.j
    # of rigid bodies in a plane what comes in is the angle itself
    if scene.d == 6 or i >= scene.n_r or j >= scene.n_r:
        u, w, u_j = arm(X, i, own.u_i), arm(X, i, own.w_i), arm(X, j, own.u_j)
        angle = atan2(dot(w, u_j), dot(u, u_j)) + own.drawn
        S[s, 0] = nearest_branch(angle, S[s, 0])
    S[s, 1] = dot(arm(X, i, own.a_i), relative_spin(V, i, j))


@internal
def write_second_angle(scene, e, s):
    """The angle of the second body of a cross against its pin a_i, about its own pin u_j."""
    X, V, S, own = scene.X, scene.V, scene.S, Axes(scene, e)
    i, j = own.i, own.j
    u = arm(X, j, own.u_j)
    if scene.d == 6 or i >= scene.n_r or j >= scene.n_r:
        a, a_j = arm(X, i, own.a_i), arm(X, j, own.a_j)
        S[s, 0] = nearest_branch(atan2(dot(cross(u, a), a_j), dot(a, a_j)), S[s, 0])
    S[s, 1] = dot(u, relative_spin(V, i, j))


def write_along(letter):
    """What writes the displacement along an axis of body i and its rate, as entry s of S."""
    c = Axes.columns[f"{letter}_i"].at

    @internal
    def write(scene, e, s):
        a = arm(scene.X, Pair(scene, e).i, axis(scene, e, c))
        scene.S[s, 0], scene.S[s, 1] = stroke(scene, e, a)

    return write


class Coordinate(NamedTuple):
    """A coordinate that a joint may have."""

    kind: str  # angle, stroke, or ARC
    axis: str  # u, w or a, along which it is, or about which; of a curve none
    of: str = "i"  # the body that this axis turns with
    counts: str = "axes"  # an angle: from where the axes of its bodies agree, or from the `drawing`


ARC = "arc"  # a length along a curve: it is watched and stopped, and nothing drives or relates it
COORDINATES = {
    "angle": Coordinate("angle", "a"),
    "first_angle": Coordinate("angle", "a", counts="drawing"),
    "second_angle": Coordinate("angle", "u", "j", "drawing"),
    "stroke": Coordinate("stroke", "a"),
    "x": Coordinate("stroke", "u"),
    "y": Coordinate("stroke", "w"),
    ARC: Coordinate(ARC, ""),
}


def slides(coordinates) -> bool:
    """Whether one of some coordinates is a displacement."""
    return any(COORDINATES[one].kind == "stroke" for one in coordinates)


@cache
def writer_of(coordinate):
    """What writes one coordinate."""
    own = COORDINATES[coordinate]
    if own.kind != "angle":
        return write_along(own.axis)
    return write_angle if own.of == "i" else write_second_angle


@cache
def coordinate_of(coordinates, n_rows):
    """The kernel of the coordinates of a joint with so many rows, four at most."""
    own = [(writer_of(one), column_of(k, n_rows)) for k, one in enumerate(coordinates)]
    (first, c), (second, o), (third, q), (last, r) = (*own, *((own[0][0], -1),) * (4 - len(own)))

    @kernel
    def coordinate(t, scene, e):
        con = scene.con
        if con[e, c] >= 0:
            first(scene, e, con[e, c])
        if o >= 0 and con[e, o] >= 0:
            second(scene, e, con[e, o])
        if q >= 0 and con[e, q] >= 0:
            third(scene, e, con[e, q])
        if r >= 0 and con[e, r] >= 0:
            last(scene, e, con[e, r])

    return coordinate


def column_of(k: int, n_rows: int) -> int:
    """Column of con with the k-th coordinate of a joint; behind its rows but for the first."""
    return Pair.columns["coordinate"].at if k == 0 else FIRST_ROW + n_rows + k - 1
