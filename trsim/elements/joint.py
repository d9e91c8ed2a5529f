"""What all joints share: two bodies, a point, an axis, and the names of their constants."""

from trsim.elements.contract import Looser
from trsim.elements.frames import TwoPoints
from trsim.errors import ScenarioError
from trsim.fields import Spec, direction, point
from trsim.frame import across
from trsim.kernels.columns import V3, f8


class Axes(TwoPoints):
    """Of a joint with an axis."""

    u_i: V3  # triad u, w, a in the axes of body i: a = u x w, the axis
    w_i: V3
    a_i: V3
    u_j: V3  # u and a in the axes of body j
    a_j: V3
    drawn: f8  # rad: joint angle as drawn


class Joint(Spec):
    """Two bodies and the place they meet.

    bodies  the first one has the bearing; reactions are those on the second one
    at      the place, as drawn
    """

    bodies: tuple[str, str]
    at: point("m")


TILTS = ("tilt 1", "tilt 2")
ALONG = 1.0 - 1e-9  # cosine of an axis along a world axis


def axial_row(row):
    """The row that holds a joint along its axis, where one row does."""
    axis = Axes.of(row).a_i
    largest = max(range(3), key=lambda c: abs(axis[c]))
    return "xyz"[largest] if abs(axis[largest]) > ALONG else ""


def of_a_hinge(axial, ball, cross):
    """What a hinge becomes without some of its rows; ball, cross: types that hold what is left."""
    changes = (
        Looser(TILTS, ball or "free to tilt", ball),
        *(Looser((tilt,), "universal", cross) for tilt in TILTS),
    )
    if not axial:
        return changes
    return (
        *changes,
        Looser((axial,), "cylindrical"),
        Looser((axial, *TILTS), "a ball in a sleeve"),
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


def triads(i, j, axis, at, frame=None):
    """The axes of a joint between bodies i and j about a world axis, as drawn in a frame."""
    u, w, a = perpendicular(axis, frame)
    return {
        "u_i": at.axes(i, u),
        "w_i": at.axes(i, w),
        "a_i": at.axes(i, a),
        "u_j": at.axes(j, u),
        "a_j": at.axes(j, a),
        "drawn": at.drawn_angle(i, j, a, frame),
    }
