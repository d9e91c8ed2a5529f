"""Prismatic joint: body j slides along an axis of body i and does not rotate relative to it.

    Phi_1, 2 = u_i . d = 0,  w_i . d = 0          d from the point on i to the point on j
    Phi_3, 4 = u_i . a_j = 0,  w_i . a_j = 0
    Phi_5    = w_i . u_j = 0                      [Nikravesh1988]

The stroke is a_i . d, zero as drawn.  reaction acts on body j at its point.
"""

from typing import ClassVar

from trsim.elements.joint import joint
from trsim.elements.rows import ACROSS, TILTS, TURN
from trsim.fields import Spec, point, vector


class Prismatic(Spec):
    """A slide of the second body along an axis of the first.

    bodies  the first one has the axis; reactions are those acting on the second one
    axis    direction in which the stroke grows, as drawn; of any length
    at      point at which reactions are reported, as drawn; the centre of mass of the second body
            unless given
    """

    type: ClassVar[str] = "prismatic"
    bodies: tuple[str, str]
    axis: vector("-")
    at: point("m") | None = None


ELEMENT = joint(
    key="prismatic",
    spec=Prismatic,
    rows=(*ACROSS, *TILTS, TURN),
    coordinates=("stroke",),
    example="""
bodies:
  block: {mass: 2 kg, inertia: 0.01 kg*m^2}
joints:
  slide: {type: prismatic, bodies: [ground, block], axis: [1, -1, 0]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
