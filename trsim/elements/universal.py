"""Universal joint: two points coincide and two crossed axes stay perpendicular.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0
    Phi_4    = a_i . b_j = 0               [Nikravesh1988]

a is the axis on body i (a of its triad), b the one on body j (u of its triad).  They are the pins
of the cross between the bodies, which has no mass.  reaction is the force on body j at the point,
world axes; reaction_moment is along a x b.

The cross turns relative to body i by first_angle about a, and body j relative to the cross by
second_angle about b.  Both are zero as drawn, and unwrapped:

    omega_j - omega_i = first_angle' a + second_angle' b,     a . b = 0

The bend is the angle between the shafts; each shaft is a direction fixed in its body.  The angles
are regular however far the joint bends.  A torque T along one of them is T a or T b on body j, and
the opposite on body i.
"""

from typing import ClassVar

from pydantic import model_validator

from trsim.elements.contract import Reach, Row
from trsim.elements.frames import points
from trsim.elements.joint import Joint, held, joint, of_key
from trsim.elements.rows import POINT, Axes, perpendicular
from trsim.errors import ScenarioError
from trsim.fields import direction, vector
from trsim.frame import across

SQUARE = 1e-6  # cosine of the angle between the axes as drawn


class Universal(Joint):
    """A cross joint: each of the two bodies turns about one axis of a cross.

    axis         pin of the cross on the first body, as drawn; of any length. The cross turns about
                 it by `first_angle`, which is 0 as drawn
    second_axis  pin of the cross on the second body, perpendicular to the first one as drawn. The
                 second body turns about it by `second_angle` relative to the cross
    shafts       directions of both shafts, as drawn: of the first one towards the joint, of the
                 second one away from it. The bend is the angle between them. Perpendicular to both
                 pins unless given
    """

    type: ClassVar[str] = "universal"
    axis: vector("-")
    second_axis: vector("-")
    shafts: tuple[vector("-"), vector("-")] | None = None

    @model_validator(mode="after")
    def both_shafts(self):
        for k, shaft in enumerate(self.shafts or ()):
            if not any(shaft):
                raise ScenarioError("a direction must not be zero", "", ("shafts", k))
        return self

    @property
    def x_axis(self):
        """The second axis is the x axis of its triad."""
        return self.second_axis


def axes(spec):
    """Unit vectors along both axes, world axes as drawn, exactly perpendicular."""
    a, b = of_key(spec, "axis"), of_key(spec, "second_axis")
    along = sum(p * q for p, q in zip(a, b, strict=True))
    across = tuple(q - along * p for p, q in zip(a, b, strict=True))
    if abs(along) > SQUARE:
        near = ", ".join(f"{q:.6g}" for q in across)
        hint = f"perpendicular in this plane is [{near}]"
        raise ScenarioError(
            f"`axis` and `second_axis` are not perpendicular: the cosine is {along:.3g}",
            hint if abs(along) < 1.0 - SQUARE else "give a direction across `axis`",
            ("second_axis",),
        )
    return a, direction(across)


def shafts(spec):
    """Unit vectors along both shafts, world axes as drawn."""
    if spec.shafts is not None:
        return tuple(map(direction, spec.shafts))
    n = across(*axes(spec))
    return n, n


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    a, b = axes(spec)
    places, triad = points(at, i, j, spec.at, spec.at), held(i, j, b, across(a, b), a, at)
    return Row(*Axes.packed(**places, **triad, drawn=0.0))


ELEMENT = joint(
    key="universal",
    spec=Universal,
    rows=(*POINT, perpendicular("a", "u", "tilt")),
    coordinates=("first_angle", "second_angle"),
    pack=pack,
    bends=shafts,
    reach=lambda _: Reach(tilts=True),
    dear=True,
    example="""
planar: false
bodies:
  shaft: {mass: 1 kg, inertia: [0.02, 0.02, 0.001], at: [0, 0, -0.2], angular_velocity: [0, 3, 0]}
joints:
  cross: {type: universal, bodies: [ground, shaft], at: [0, 0, 0], axis: [1, 0, 0],
          second_axis: [0, 1, 0]}
gravity: [0, 0, -9.81]
solver: {end: 1 s}
""",
)
