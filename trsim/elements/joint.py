"""What all joints share: two bodies, a point, an axis, and what follows from a list of rows."""

from trsim.elements.contract import Element, Reach, Row, Turning
from trsim.elements.frames import at_both, between_points, points
from trsim.elements.rows import COORDINATES, POINT, Axes, constraint_of, coordinate_of
from trsim.errors import ScenarioError
from trsim.fields import Spec, direction, point
from trsim.frame import across

Z = (0.0, 0.0, 1.0)


class Joint(Spec):
    """Two bodies and the place they meet.

    bodies  the first one has the bearing; reactions are those acting on the second one
    at      position of the joint, as drawn
    """

    bodies: tuple[str, str]
    at: point("m")


def pack(name, spec, at):
    """A joint about its axis, or z; without a place at the second body's centre of mass."""
    i, j = at.bodies(spec.bodies, spec.at)
    place = at.centre(j) if spec.at is None else spec.at
    return Row(*Axes.packed(**points(at, i, j, place, place), **of_triad(i, j, spec, at)))


def place_on(spec, body):
    """Where a joint holds one of its bodies, as drawn; None: at its centre of mass."""
    points = getattr(spec, "points", ())
    return points[spec.bodies.index(body)] if points else spec.at


def triad(spec):
    """Unit vectors u, w, a of a joint, world axes as drawn: a its axis, u its x axis if given."""
    u, w, a = perpendicular(getattr(spec, "axis", None) or Z, spec.drawn_in)
    if getattr(spec, "x_axis", None) is None:
        return u, w, a
    x = of_key(spec, "x_axis")
    along = sum(p * q for p, q in zip(x, a, strict=True))
    level = tuple(p - along * q for p, q in zip(x, a, strict=True))
    if max(map(abs, level)) < 1e-6:
        near = ", ".join(f"{p:.6g}" for p in u)
        what = "`x_axis` has the direction of `axis`"
        raise ScenarioError(what, f"give one across it, for example [{near}]", ("x_axis",))
    u = direction(level)
    return u, across(a, u), a


def of_triad(i, j, spec, at):
    """The columns of a joint between bodies i and j about the axes of its spec."""
    u, w, a = triad(spec)
    return held(i, j, u, w, a, at) | {"drawn": at.drawn_angle(i, j, a, spec.drawn_in)}


def on_line(row):
    """Of rows that hold a point of body j where it may slide along directions of body i."""
    own = Axes.of(row)
    return Turning(points=((own.j, own.p_j),), axes=((own.i, own.a_i),))


def reach(row, coordinates):
    """Bodies turn about the axis of an angle, and slide along that of a stroke."""
    own, axes = Axes.of(row), {"angle": [], "stroke": []}
    for one in map(COORDINATES.get, coordinates):
        axes[one.kind].append((own.i, getattr(own, f"{one.axis}_i")))
    return Reach(hinges=tuple(axes["angle"]), slides=tuple(axes["stroke"]))


def tilting(row):
    """Of rows that let bodies turn about an axis that is not across the plane."""
    x, y, _ = Axes.of(row).a_i
    return Reach(tilts=max(abs(x), abs(y)) > 1e-9)


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


def joint(key, spec, rows, coordinates=(), pack=pack, **other):
    """The element that a list of rows makes (rows.py), with the coordinates these leave free.

    other: fields of Element, also those that follow from the rows where they are to differ; and
    more kernels.
    """
    room = (-1,) * (len(rows) + len(coordinates[1:]))  # of con, for what assembly knows
    places, turns = sum(row.places for row in rows), sum(row.turns for row in rows)
    ball, whole = rows == POINT, places == len(rows)
    kernels = {"constraint": constraint_of(rows)} | other.pop("kernels", {})
    if coordinates:
        kernels["coordinate"] = coordinate_of(coordinates, len(rows))
        other.setdefault("reach", lambda row: reach(row, coordinates))

    def packed(name, spec, at):
        row = pack(name, spec, at)
        return row.with_con((*row.con, *room))

    follows = {
        "meets": places == 3 or whole,
        "welds": (places, turns) == (3, 3),
        "pin": (2, 3) if ball else (2,) if places == 3 and "angle" in coordinates else (),
        "holds_twist": not whole,
        "acts_at": at_both,
        "turning": between_points if ball else on_line if whole else None,
        "picture": PICTURES.get((places, turns), ""),
    }
    return Element(
        key=key,
        section="joints",
        spec=spec,
        pack=packed,
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


def of_key(spec, key):
    """The unit vector along a direction of a spec."""
    if not any(getattr(spec, key)):
        raise ScenarioError("an axis must not be zero", "for example [0, 0, 1]", (key,))
    return direction(getattr(spec, key))


def held(i, j, u, w, a, at):
    """The axes of a joint, of a triad in world axes as drawn."""
    return {
        "u_i": at.axes(i, u),
        "w_i": at.axes(i, w),
        "a_i": at.axes(i, a),
        "u_j": at.axes(j, u),
        "a_j": at.axes(j, a),
    }


def triads(i, j, axis, at, frame=None):
    """The columns of a joint between bodies i and j about a world axis, as drawn in a frame."""
    u, w, a = perpendicular(axis, frame)
    return held(i, j, u, w, a, at) | {"drawn": at.drawn_angle(i, j, a, frame)}
