"""Worm gear: a constant ratio between the angles of a worm and its wheel, on crossed axes.

    ratio   phi_1 - phi_1,0 = ratio (phi_2 - phi_2,0)        of the angles of the joints
    teeth   starts w_1 = h teeth w_2                         h = 1 or -1: hand and drawing

w_1 and w_2 are the angular velocities of worm and wheel relative to the carrier, about their axes:
the rates of the angles if the carrier is the first body of the joints.  A right-handed worm that
turns about a_1 moves the teeth it meets in the direction of -a_1, like the nut on a screw that
turns in place.  These teeth are at the end of -n on the wheel, where n goes from the axis of the
worm to that of the wheel, perpendicular to both:

    h = sign of  n . (a_1 x a_2)       right hand

It transmits motion in both directions: self-locking needs friction.
"""

from typing import Annotated, ClassVar, Literal

from annotated_types import Gt
from pydantic import model_validator

from trsim.elements.transmission import (
    PARALLEL,
    Transmission,
    apart,
    carried,
    not_zero,
    one_of,
    product,
    relation,
    size,
    transmission,
    whole,
)
from trsim.errors import ScenarioError
from trsim.fields import Unit
from trsim.frame import across

Positive = Annotated[float, Gt(0)]


class Worm(Transmission):
    """A worm and its wheel, each on a hinge of one carrier, which may move.

    joints  the hinges of the worm and of the wheel; they share the carrier
    teeth   starts of the worm, teeth of the wheel; the hand and the drawing decide which way the
            wheel turns
    hand    hand of the thread; right unless given
    ratio   angle of the worm's joint divided by that of the wheel's, with the sign that their
            sensors show; instead of teeth
    """

    type: ClassVar[str] = "worm"
    joints: tuple[str, str]
    teeth: Annotated[tuple[Positive, Positive], Unit("-")] | None = None
    hand: Literal["right", "left"] | None = None
    ratio: Annotated[float, Unit("-")] | None = None

    @model_validator(mode="after")
    def one_ratio(self):
        one_of(self, "teeth", "ratio")
        whole(self.teeth)
        not_zero(self.ratio)
        if self.ratio is not None and self.hand is not None:
            raise ValueError("`hand` goes with teeth; a ratio has a sign instead")
        return self


def pack(name, spec, at):
    found = carried(spec, ("angle", "angle"), at)
    c = across(found.x.axis, found.y.axis)
    if size(c) <= PARALLEL:
        raise ScenarioError(
            f"the axes of '{found.x.joint}' and '{found.y.joint}' are parallel, and those of a "
            "worm and its wheel cross",
            "turn one of them, or use a `gear`",
            ("joints",),
        )
    if spec.ratio is not None:
        return relation((found.x, found.y), (1.0, -spec.ratio))
    d = apart(found.x, found.y)
    if abs(product(d, c)) <= PARALLEL * size(d) * size(c):
        raise ScenarioError(
            f"the axes of '{found.x.joint}' and '{found.y.joint}' meet, so the drawing does not "
            "tell on which side of the wheel the worm is",
            "draw the worm beside the axis of its wheel, or give the `ratio` with its sign",
            ("joints",),
        )
    way = (1.0 if product(d, c) > 0.0 else -1.0) * (-1.0 if spec.hand == "left" else 1.0)
    starts, teeth = spec.teeth
    return relation((found.x, found.y), (found.of_x * starts, -way * found.of_y * teeth))


ELEMENT = transmission(
    key="worm",
    spec=Worm,
    pack=pack,
    picture="helix",
    units=("N*m", "N*m"),
    example="""
planar: false
bodies:
  screw: {mass: 1 kg, inertia: [1e-4, 1e-4, 1e-4], at: [0, 0, 0]}
  wheel: {mass: 2 kg, inertia: [0.01, 0.01, 0.02], at: [0, 0.06, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, screw], at: [0, 0, 0], axis: [1, 0, 0]}
  shaft: {type: revolute, bodies: [ground, wheel], at: [0, 0.06, 0], axis: [0, 0, 1]}
  teeth: {type: worm, joints: [bearing, shaft], teeth: [1, 40], hand: right}
drives:
  motor: {joint: bearing, velocity: 30 rad/s}
solver: {end: 0.5 s}
""",
)
