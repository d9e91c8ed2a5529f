"""What all joints share: two bodies, a point, an axis, and the layout of their constants.

par[0:3], par[3:6]              the point in the axes of body i, of body j
par[6:9], [9:12], [12:15]       triad u, w, a in the axes of body i (a = u x w, the axis)
par[15:18], [18:21]             u and a in the axes of body j
par[21]                         joint angle as drawn
"""

from trsim.elements.contract import Looser
from trsim.errors import ScenarioError
from trsim.fields import Spec, direction, point
from trsim.frame import across


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
    largest = max(range(3), key=lambda c: abs(row.par[12 + c]))
    return "xyz"[largest] if abs(row.par[12 + largest]) > ALONG else ""


def of_a_hinge(axial, ball, cross):
    """What a hinge becomes without some of its rows; ball, cross: types that hold what is left."""
    changes = (
        Looser(TILTS, ball or "free to tilt", ball),
        *(Looser((tilt,), "universal", cross, dear=True) for tilt in TILTS),
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
    """par[6:22] of a joint between bodies i and j about a world axis, as drawn in a frame."""
    u, w, a = perpendicular(axis, frame)
    return (
        *at.axes(i, u),
        *at.axes(i, w),
        *at.axes(i, a),
        *at.axes(j, u),
        *at.axes(j, a),
        at.drawn_angle(i, j, a, frame),
    )
