"""Shaft: a hinge on two bearings, of which one also carries the force along the axis.

    Phi_1..5                       those of a revolute joint, at the locating bearing
    F_2 = (M x a) / l              on body j at the floating bearing, across the axis
    F_1 = R - F_2                  on body j at the locating one

R and M are reaction and reaction_moment on body j at the locating bearing, a is the axis from it to
the floating one, and l their distance.  A bearing carries no moment, so M = l a x F_2, and the load
of each bearing is unique, as it would be with a `spherical` and an `inline` joint instead.  The
rows of a hinge stay well conditioned however close the bearings are.  In a planar scene M is not
known; all force is then reported at the locating bearing.
"""

from math import sqrt
from typing import ClassVar

from trsim.elements.acted import FLOATING, LOCATING, Part, TwoBearings, share_of
from trsim.elements.contract import Channel, Reach, Row, measured
from trsim.elements.frames import at_both, dot, points
from trsim.elements.joint import Joint, joint, of_triad
from trsim.elements.rows import POINT, TILTS, Axes
from trsim.errors import ScenarioError
from trsim.fields import point

ROWS = (*POINT, *TILTS)
LEAST = 1e-9  # of the distance of the bearings from the origin: less is rounding and no axis


class Shaft(Joint):
    """A shaft on the second body in two bearings of the first; its axis is the line through both.

    at        position of the locating bearing, as drawn; it also carries the force along the axis
    floating  position of the other bearing, which carries only forces across the axis; the angle is
              positive about the axis from `at` to here
    """

    type: ClassVar[str] = "shaft"
    floating: point("m")

    @property
    def axis(self):
        """From the locating bearing to the floating one, world axes as drawn."""
        return tuple(q - p for p, q in zip(self.at, self.floating, strict=True))


def pack(name, spec, at):
    span = sqrt(sum(x * x for x in spec.axis))
    if span <= LEAST * max(map(abs, (*spec.at, *spec.floating))):
        hint = "draw them apart, or take a `revolute`, which has an `axis`"
        raise ScenarioError("both bearings are at one place as drawn", hint, ("floating",))
    i, j = at.bodies(spec.bodies, spec.at, spec.floating)
    axes = of_triad(i, j, spec, at)
    return Row(*TwoBearings.packed(**points(at, i, j, spec.at, spec.at), **axes, span=span))


@measured
def measure(t, scene, e, o):
    out, j = scene.out, TwoBearings(scene, e).j
    locating, _ = share_of(scene, j, e, len(ROWS), LOCATING)
    floating, _ = share_of(scene, j, e, len(ROWS), FLOATING)
    for c in range(3):
        out[o + c], out[o + 3 + c] = locating[c], floating[c]
    out[o + 6], out[o + 7] = sqrt(dot(locating, locating)), sqrt(dot(floating, floating))


def bearings(row):
    """What its rows do, by the bearings."""
    own = TwoBearings.of(row)
    far = tuple(
        (frame, tuple(p + own.span * a for p, a in zip(place, axis, strict=True)))
        for (frame, place), axis in zip(at_both(row), (own.a_i, own.a_j), strict=True)
    )
    return Part(LOCATING, at_both(row)), Part(FLOATING, far)


def reach(row):
    """What its bearings carry is told out of the plane, too."""
    own = Axes.of(row)
    axis = (own.i, own.a_i)
    return Reach(hinges=(axis,), shown=(axis,))


ELEMENT = joint(
    key="shaft",
    spec=Shaft,
    rows=ROWS,
    coordinates=("angle",),
    pack=pack,
    reach=reach,
    acts_at=lambda row: tuple(place for part in bearings(row) for place in part.places),
    bearings=bearings,
    kernels={"measure": measure},
    channels=(
        Channel("locating_force", "N", "force on the second body at this bearing, world axes", 3),
        Channel(
            "floating_force", "N", "force on the second body at the other bearing, world axes", 3
        ),
        Channel("locating_load", "N", "size of the force at the locating bearing", least=0.0),
        Channel("floating_load", "N", "size of the force at the floating bearing", least=0.0),
    ),
    example="""
bodies:
  wheel: {mass: 2 kg, inertia: [0.01, 0.006, 0.006], at: [0.1, 0, 0.05]}
joints:
  axle: {type: shaft, bodies: [ground, wheel], at: [0, 0, 0], floating: [0.3, 0, 0]}
gravity: [0, 0, -9.81]
solver: {end: 1 s}
""",
)
