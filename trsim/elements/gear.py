"""Gear: two wheels on one carrier, with a constant ratio of their angles.

    ratio         phi_1 - phi_1,0 = ratio (phi_2 - phi_2,0)      of the angles of the joints
    teeth, radii  z_1 w_1 = e z_2 w_2                            e = -1 or 1, from the drawing

w_k is the angular velocity of wheel k relative to the carrier, about its axis.  It is the rate of
the angle of joint k if the carrier is the first body of the joint, otherwise minus that rate.
Wheels on parallel axes turn in opposite senses (e = -1 if both axes point in the same direction);
with one inside the other (`internal`) they turn in the same sense.  For bevel gears, whose axes
intersect, take the directions from the intersection to the wheels instead.  The carrier may move: a
planet wheel is a gear with a rotating carrier [Willis1841].
"""

from typing import Annotated, ClassVar

from annotated_types import Gt
from pydantic import model_validator

from trsim.elements.transmission import (
    PARALLEL,
    TOUCH,
    Transmission,
    apart,
    aside,
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
from trsim.fields import Flag, Unit
from trsim.frame import across

Positive = Annotated[float, Gt(0)]


class Gear(Transmission):
    """Two wheels in mesh, each on a hinge of one carrier, which may move.

    joints    the hinges of the first and the second wheel. They share the carrier; the carrier or a
              wheel may be the ground
    teeth     numbers of teeth; the drawing decides which way the second wheel turns
    radii     radii of the pitch circles, instead of numbers of teeth
    ratio     angle of the first joint divided by that of the second one, with the sign that their
              sensors show. Instead of teeth and radii, and for axes that are neither parallel nor
              intersect
    internal  whether one wheel is inside the other
    """

    type: ClassVar[str] = "gear"
    joints: tuple[str, str]
    teeth: Annotated[tuple[Positive, Positive], Unit("-")] | None = None
    radii: Annotated[tuple[Positive, Positive], Unit("m")] | None = None
    ratio: Annotated[float, Unit("-")] | None = None
    internal: Flag = False

    @model_validator(mode="after")
    def one_ratio(self):
        one_of(self, "teeth", "radii", "ratio")
        whole(self.teeth)
        not_zero(self.ratio)
        if self.ratio is not None and self.internal:
            raise ValueError("`internal` goes with teeth or radii; a ratio has a sign instead")
        return self


def pack(name, spec, at):
    found = carried(spec, ("angle", "angle"), at)
    if spec.ratio is not None:
        return relation((found.x, found.y), (1.0, -spec.ratio))
    first, second = spec.teeth or spec.radii
    way = sense(found.x, found.y, spec)
    return relation((found.x, found.y), (found.of_x * first, -way * found.of_y * second))


def sense(x, y, spec):
    """1 where the wheels turn alike about the axes of their joints, else -1."""
    c = across(x.axis, y.axis)
    alike = 1.0 if spec.internal else -1.0
    if size(c) <= PARALLEL:
        check_distance(x, y, spec)
        return alike if product(x.axis, y.axis) > 0.0 else -alike
    d = apart(x, y)
    if abs(product(d, c)) > PARALLEL * size(d) * size(c):
        raise ScenarioError(
            f"the axes of '{x.joint}' and '{y.joint}' neither are parallel nor meet, so the "
            "drawing does not tell which way the wheels turn",
            "give the `ratio` of their angles, with its sign, instead of teeth or radii",
            ("joints",),
        )
    # how far from either place, along its axis, the axes meet
    to_x, to_y = product(across(d, y.axis), c), product(across(d, x.axis), c)
    for one, way in ((x, to_x), (y, to_y)):
        if abs(way) <= PARALLEL * size(d) or size(d) == 0.0:
            raise ScenarioError(
                f"'{one.joint}' is drawn where the axes meet, so the drawing does not tell on "
                "which side its wheel is",
                f"put `at` of '{one.joint}' into the middle of its wheel, or give the `ratio`",
                ("joints",),
            )
    return alike if to_x * to_y > 0.0 else -alike


def check_distance(x, y, spec):
    """Refuse wheels on one axis, and radii that do not touch as drawn."""
    distance, whole_way = aside(x, y)
    if distance <= PARALLEL * whole_way:
        raise ScenarioError(
            f"'{x.joint}' and '{y.joint}' turn about one axis, where teeth do not meet",
            "draw the wheels beside each other, with a planet wheel between them where they have "
            "one, or give the `ratio`",
            ("joints",),
        )
    if spec.radii is None:
        return
    first, second = spec.radii
    wanted = abs(first - second) if spec.internal else first + second
    if abs(wanted - distance) > TOUCH * max(spec.radii):
        raise ScenarioError(
            f"the axes are {distance:.6g} m apart, and wheels of these radii touch at {wanted:.6g}",
            "correct the radii, `at` of the joints or `internal`; numbers of teeth do not ask for "
            "a distance",
            ("radii",),
        )


ELEMENT = transmission(
    key="gear",
    spec=Gear,
    pack=pack,
    picture="wheels",
    units=("N*m", "N*m"),
    example="""
bodies:
  arm: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [0, 0], angular_velocity: [0, 0, 10]}
  sun: {mass: 1 kg, inertia: 0.002 kg*m^2, at: [0, 0]}
  planet: {mass: 0.5 kg, inertia: 0.001 kg*m^2, at: [0.15, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, arm], at: [0, 0]}
  middle: {type: revolute, bodies: [arm, sun], at: [0, 0]}
  pin: {type: revolute, bodies: [arm, planet], at: [0.15, 0]}
  teeth: {type: gear, joints: [middle, pin], teeth: [40, 20]}
solver: {end: 0.5 s}
""",
)
