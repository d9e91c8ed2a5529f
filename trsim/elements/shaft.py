"""Shaft: a hinge on two bearings, of which one also carries the force along the axis.

    Phi_1..3 = d_1 = 0                          d_1, d_2 from the place of the locating and of the
    Phi_4, 5 = u_i . d_2 = 0,  w_i . d_2 = 0    floating bearing on i to that on j

(u, w, a) is a right-handed triad with a from the locating bearing to the floating one.  The rows
hold what those of a revolute joint do.  A bearing carries no moment, so what each carries is unique
in space: the multipliers of its own rows, as of a `spherical` and an `inline` joint in its place.
In the plane nobody can tell which of two bearings behind each other carries what.
reaction is the sum of both, and reaction_moment that about the locating bearing.
"""

from math import sqrt
from typing import ClassVar

from trsim.elements.acted import Part, of_rows
from trsim.elements.contract import Channel, Reach, Row, measured
from trsim.elements.frames import arm, at_both, dot, points, separation_row
from trsim.elements.joint import Joint, joint, of_triad
from trsim.elements.rows import POINT, Axes, JointRow
from trsim.errors import ScenarioError
from trsim.fields import point
from trsim.kernels.columns import V3
from trsim.kernels.lazy import internal

LEAST = 1e-9  # of the distance of the bearings from the origin: less is rounding and no axis


class Shaft(Joint):
    """A shaft of the second body in two bearings of the first, about the line through both.

    at        place of the locating bearing, as drawn: it also carries the force along the axis
    floating  place of the other bearing, which carries force across the axis only; the angle grows
              about the axis from `at` to here
    """

    type: ClassVar[str] = "shaft"
    floating: point("m")

    @property
    def axis(self):
        """From the locating bearing to the floating one, world axes as drawn."""
        return tuple(q - p for p, q in zip(self.at, self.floating, strict=True))


class Own(Axes):
    """Of one instance."""

    q_i: V3  # m, the floating bearing from the centres of mass, in the axes of both bodies
    q_j: V3


def pack(name, spec, at):
    length = sqrt(sum(x * x for x in spec.axis))
    if length <= LEAST * max(map(abs, (*spec.at, *spec.floating))):
        hint = "draw them apart, or take a `revolute`, which has an `axis`"
        raise ScenarioError("both bearings are at one place as drawn", hint, ("floating",))
    i, j = at.bodies(spec.bodies, spec.at, spec.floating)
    places = {"q_i": at.local(i, spec.floating), "q_j": at.local(j, spec.floating)}
    axes = of_triad(i, j, spec, at)
    return Row(*Own.packed(**points(at, i, j, spec.at, spec.at), **axes, **places))


@internal
def across_u(scene, e, k):
    across(scene, e, Own(scene, e).u_i, k)


@internal
def across_w(scene, e, k):
    across(scene, e, Own(scene, e).w_i, k)


@internal
def across(scene, e, u, k):
    """The place of the floating bearing on j in the plane across an axis of i, as row k."""
    X, own = scene.X, Own(scene, e)
    i, j = own.i, own.j
    q_i, q_j = arm(X, i, own.q_i), arm(X, j, own.q_j)
    separation_row(scene, (i, q_i), (j, q_j), arm(X, i, u), k)


# a displacement of the floating bearing along u is a turn about w
ROWS = (
    *POINT,
    JointRow("floating 1", "W", fill=across_u),
    JointRow("floating 2", "U", fill=across_w),
)


@measured
def measure(t, scene, e, o):
    out, own = scene.out, Own(scene, e)
    locating, _ = of_rows(scene, own.j, e, 0, 3)
    floating, _ = of_rows(scene, own.j, e, 3, 2)
    for c in range(3):
        out[o + c], out[o + 3 + c] = locating[c], floating[c]
    out[o + 6], out[o + 7] = sqrt(dot(locating, locating)), sqrt(dot(floating, floating))


def bearings(row):
    """Its rows by the bearing they belong to."""
    own = Own.of(row)
    return Part(0, 3, at_both(row)), Part(3, 2, ((own.i, own.q_i), (own.j, own.q_j)))


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
<<<<<<< HEAD
        Channel("floating_force", "N", "the same at the other bearing, world axes", 3),
=======
        Channel(
            "floating_force", "N", "force on the second body at the other bearing, world axes", 3
        ),
>>>>>>> f73c5219740e5f225d05f2e7f4a0e343d3dd76bd
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
