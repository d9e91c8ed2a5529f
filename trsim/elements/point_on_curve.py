"""Point on curve: a point of body j stays on a curve of body i.

    Phi_1 = n . (p - c) = 0          n, c at the footpoint of p, see on_curve.py
    Phi_2 = a_i . d = 0              a the normal of the plane of the curve, d from its origin to p

The coordinate is the length along the curve from its beginning; on a closed curve it goes on over
any number of turns.  reaction acts on body j at its point, perpendicular to the curve: there is no
friction.
"""

from typing import ClassVar

from trsim.elements.contract import Row, kernel, measured
from trsim.elements.curve import Curve, sampled
from trsim.elements.on_curve import (
    LENGTH,
    OnCurve,
    distance_row,
    drawn_at,
    end_gap,
    ends_of,
    follow,
    frames,
    on_curve,
    stay,
    stored,
)
from trsim.elements.rows import Axes, JointRow, along
from trsim.fields import point
from trsim.kernels.columns import constraint_row, i8
from trsim.kernels.lazy import internal


class PointOnCurve(OnCurve):
    """A point of the second body on a plane curve of the first: a bead on a wire, a pin in a slot.

    curve  the curve, which moves with the first body; at the end of an open curve the run ends as
           `jammed`
    at     the point of the second body, as drawn: on the curve, or so close that it can be moved
           there at the start
    """

    type: ClassVar[str] = "point_on_curve"
    curve: Curve
    at: point("m")


class Own(Axes):
    """Of one instance; its first point is the origin of the curve."""

    normal: constraint_row
    axial: constraint_row
    curve: i8  # in tab
    parameter: i8  # entry of S with u


def pack(name, spec, at):
    curve = sampled(spec.curve)
    u, length, _ = drawn_at(curve, spec)
    found = frames(spec, at) | {"curve": stored(curve, spec, at)}
    own = Own.of(Row(*Own.packed(parameter=-1, **found)))
    _, parameter = at.on_curve(name, own, (length, u), "on")
    return Row(*Own.packed(parameter=parameter, **found), limits=ends_of(curve))


@internal
def normal(scene, e, k):
    distance_row(scene, e, Own(scene, e), k, 1.0, 0.0)


@kernel
def coordinate(t, scene, e):
    own = Own(scene, e)
    if own.normal < 0:
        stay(scene, own)
    else:
        follow(scene, e, own)


@kernel
def gap(t, scene, e):
    own = Own(scene, e)
    end_gap(scene, e, own, own.normal)


@measured
def measure(t, scene, e, o):
    scene.out[o] = scene.S[Own(scene, e).coordinate, 0]


ELEMENT = on_curve(
    key="point_on_curve",
    spec=PointOnCurve,
    pack=pack,
    rows=(JointRow("normal", "n", fill=normal), along("a", "axial")),
    channels=(LENGTH,),
    picture="slot",
    kernels={"coordinate": coordinate, "gaps": gap, "measure": measure},
    example="""
bodies:
  bead: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [-0.5, 0.25]}
joints:
  wire:
    type: point_on_curve
    bodies: [ground, bead]
    at: [-0.5, 0.25]
    curve: {x: s, y: s**2, range: [-1, 1]}
sensors:
  way: {joint: wire}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
