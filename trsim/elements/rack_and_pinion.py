"""Rack and pinion: a constant ratio between the angle of a hinge and the stroke of a slide.

    ratio     s - s_0 = ratio (phi - phi_0)                of the coordinates of the joints
    radius    s' b = (w a x n) . b = w r (a x n/r) . b     w, s' relative to the carrier

a is the axis of the pinion and b that of the slide, perpendicular to a.  n, of length r, goes from
the axis of the pinion to the pitch line of the rack, on which `at` of the slide lies.  w is the
rate of phi if the carrier is the first body of the hinge, otherwise minus that rate; the same holds
for s'.
"""

from typing import Annotated, ClassVar

from annotated_types import Gt
from pydantic import model_validator

from trsim.elements.transmission import (
    PARALLEL,
    TOUCH,
    Transmission,
    apart,
    carried,
    not_zero,
    one_of,
    product,
    relation,
    transmission,
)
from trsim.errors import ScenarioError
from trsim.fields import Unit
from trsim.frame import across


class RackAndPinion(Transmission):
    """A pinion that rolls on a rack, both on one carrier, which may move.

    joints  the hinge of the pinion, then the slide of the rack. They share the carrier; the carrier
            or the rack may be the ground
    radius  radius of the pitch circle. The drawing decides which way the rack moves: `at` of its
            slide must lie on the pitch line, anywhere along it
    ratio   stroke divided by angle, with the sign that their sensors show; instead of a radius
    """

    type: ClassVar[str] = "rack_and_pinion"
    joints: tuple[str, str]
    radius: Annotated[float, Gt(0), Unit("m")] | None = None
    ratio: Annotated[float, Unit("m/rad")] | None = None

    @model_validator(mode="after")
    def one_ratio(self):
        one_of(self, "radius", "ratio")
        not_zero(self.ratio)
        return self


def pack(name, spec, at):
    found = carried(spec, ("angle", "stroke"), at)
    if spec.ratio is not None:
        return relation((found.x, found.y), (-spec.ratio, 1.0))
    way = sense(found.x, found.y, spec.radius)
    return relation((found.x, found.y), (-way * spec.radius * found.of_x, found.of_y))


def sense(pinion, rack, radius):
    """1 where the rack goes along the axis of its slide as the pinion turns about its own."""
    if abs(product(pinion.axis, rack.axis)) > PARALLEL:
        raise ScenarioError(
            f"the axis of '{pinion.joint}' is not across that of '{rack.joint}'",
            "draw the rack across the axis of its pinion, or give the `ratio` of stroke and angle",
            ("joints",),
        )
    aside = product(apart(pinion, rack), across(pinion.axis, rack.axis))
    if abs(abs(aside) - radius) > TOUCH * radius:
        raise ScenarioError(
            f"'{rack.joint}' is drawn at {abs(aside):.6g} m beside the axis of the pinion, not at "
            f"its radius {radius:.6g} m",
            f"put `at` of '{rack.joint}' on the pitch line of the rack, so that the drawing tells "
            "on which side it is, or give the `ratio` of stroke and angle",
            ("radius",),
        )
    return -1.0 if aside > 0.0 else 1.0


ELEMENT = transmission(
    key="rack_and_pinion",
    spec=RackAndPinion,
    pack=pack,
    picture="rack",
    units=("N*m", "N"),
    example="""
bodies:
  pinion: {mass: 1 kg, inertia: 0.002 kg*m^2, at: [0, 0]}
  rack: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0.1, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, pinion], at: [0, 0]}
  guide: {type: prismatic, bodies: [ground, rack], at: [0.05, 0], axis: [0, 1]}
  teeth: {type: rack_and_pinion, joints: [bearing, guide], radius: 5 cm}
gravity: [0, -9.81, 0]
solver: {end: 0.5 s}
""",
)
