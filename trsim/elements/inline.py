"""Inline joint: a point of body j stays on a line of body i.

    Phi_1, 2 = u_i . d = 0,  w_i . d = 0          d from the point on i to the point on j

The stroke is a_i . d, zero as drawn; all rotations are free.  reaction acts on body j at its point.
"""

from typing import ClassVar

from trsim.elements.joint import Joint, joint
from trsim.elements.rows import ACROSS
from trsim.fields import vector


class Inline(Joint):
    """A point of the second body on a line of the first: a bead on a wire, a pin in a slot.

    axis  direction of the line, in which the stroke grows, as drawn; of any length
    """

    type: ClassVar[str] = "inline"
    axis: vector("-")


ELEMENT = joint(
    key="inline",
    spec=Inline,
    rows=ACROSS,
    coordinates=("stroke",),
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0, -0.2]}
joints:
  slot: {type: inline, bodies: [ground, rod], at: [0, 0], axis: [3, -1]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
