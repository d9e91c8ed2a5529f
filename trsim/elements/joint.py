"""What all joints share: two bodies, a point, an axis, and the layout of their constants.

par[0:3], par[3:6]              the point in the axes of body i, of body j
par[6:9], [9:12], [12:15]       triad u, w, a in the axes of body i (a = u x w, the axis)
par[15:18], [18:21]             u and a in the axes of body j
par[21]                         joint angle as drawn
"""

from trsim.elements.contract import Element, Reach, Row, Turning, between_points
from trsim.elements.rows import POINT, constraint_of, coordinate_of
from trsim.errors import ScenarioError
from trsim.fields import Spec, direction, point
from trsim.frame import across

Z = (0.0, 0.0, 1.0)


class Joint(Spec):
    """Two bodies and the place they meet.

    bodies  the first one has the bearing; reactions are those on the second one
    at      the place, as drawn
    """

    bodies: tuple[str, str]
    at: point("m")


def pack(name, spec, at):
    """A joint about its axis, or z; without a place at the second body's centre of mass."""
    i, j = at.bodies(spec.bodies, spec.at)
    place = at.centre(j) if spec.at is None else spec.at
    axes = triads(i, j, getattr(spec, "axis", Z), at, spec.drawn_in)
    return Row((i, j, -1), (*at.local(i, place), *at.local(j, place), *axes))


def on_line(row):
    """Of rows that hold a point of body j where it may slide along directions of body i."""
    i, j = row.con[:2]
    return Turning(points=((j, row.par[3:6]),), axes=((i, row.par[12:15]),))


def reach(row, coordinates):
    """Bodies turn about the axis of an angle, and slide along that of a stroke."""
    axis = ((row.con[0], row.par[12:15]),)
    return Reach(
        hinges=axis if "angle" in coordinates else (),
        slides=axis if "stroke" in coordinates else (),
    )


# by how many displacements and turns a joint holds: its picture, see report/animation/drawing.py
PICTURES = {
    (3, 0): "ball",
    (3, 1): "cross",
    (3, 2): "pin",
    (3, 3): "weld",
    (2, 0): "bead",
    (2, 2): "sleeve",
    (2, 3): "slide",
}


def joint(key, spec, rows, coordinates=(), **other):
    """The element that a list of rows makes (rows.py), with the coordinates these leave free.

    other: fields of Element, also those that follow from the rows where they are to differ.
    """
    places = sum(not row.of_j for row in rows)
    turns, ball = len(rows) - places, rows == POINT
    kernels = {"constraint": constraint_of(rows)}
    if coordinates:
        kernels["coordinate"] = coordinate_of(coordinates, len(rows))
        other.setdefault("reach", lambda row: reach(row, coordinates))
    follows = {
        "pack": pack,
        "meets": places == 3,
        "welds": (places, turns) == (3, 3),
        "pin": (2, 3) if ball else (2,) if places == 3 and "angle" in coordinates else (),
        "holds_twist": turns > 0,
        "turning": between_points if ball else None if turns else on_line,
        "picture": PICTURES.get((places, turns), ""),
    }
    return Element(
        key=key,
        section="joints",
        spec=spec,
        rows=tuple(row.name for row in rows),
        holds=tuple(row.holds for row in rows),
        coordinates=coordinates,
        kernels=kernels,
        **(follows | other),
    )


def perpendicular(axis, frame=None):
    """Unit vectors u, w, a with a along the axis; (x, y, z) for the z axis.

    frame: what the axis was drawn in; there u and w are those of the same axis in the world.
    """
    if not any(axis):
        raise ScenarioError("an axis must not be zero", "for example [0, 0, 1]", ("axis",))
    if frame:
        return tuple(frame.turned(v) for v in perpendicular(frame.inside(axis)))
    a = direction(axis)
    # project the world axis least aligned with a, cyclically after the largest component,
    # so that a z axis gives u = x and w = y exactly
    largest = max(range(3), key=lambda c: abs(a[c]))
    u = [0.0, 0.0, 0.0]
    u[(largest + 1) % 3] = 1.0
    along = sum(p * q for p, q in zip(u, a, strict=True))
    u = direction(p - along * q for p, q in zip(u, a, strict=True))
    return u, across(a, u), a


def held(i, j, u, w, a, at):
    """par[6:21] of a joint between bodies i and j: u, w, a as drawn in i, u and a in j."""
    return (*at.axes(i, u), *at.axes(i, w), *at.axes(i, a), *at.axes(j, u), *at.axes(j, a))


def triads(i, j, axis, at, frame=None):
    """par[6:22] of a joint between bodies i and j about a world axis, as drawn in a frame."""
    u, w, a = perpendicular(axis, frame)
    return (*held(i, j, u, w, a, at), at.drawn_angle(i, j, a, frame))
