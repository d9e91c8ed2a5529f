"""Cylindrical joint: body j slides along an axis of body i and turns about it.

    Phi_1, 2 = u_i . d = 0,  w_i . d = 0          d from the point on i to the point on j
    Phi_3, 4 = u_i . a_j = 0,  w_i . a_j = 0      [Nikravesh1988]

The angle is that of the axes of body j minus that of body i, about a, unwrapped; the stroke is
a_i . d, zero as drawn.  reaction acts on body j at its point.
"""

from typing import ClassVar

from trsim.elements.joint import Joint, joint
from trsim.elements.rows import ACROSS, TILTS
from trsim.fields import vector


class Cylindrical(Joint):
    """A sleeve of the second body on an axis of the first: it slides and turns.

    axis  direction, as drawn; of any length. The stroke is positive along it, and the angle about
          it
    """

    type: ClassVar[str] = "cylindrical"
    axis: vector("-")


ELEMENT = joint(
    key="cylindrical",
    spec=Cylindrical,
    rows=(*ACROSS, *TILTS),
    coordinates=("angle", "stroke"),
    example="""
planar: false
bodies:
  ring: {mass: 2 kg, inertia: [0.01, 0.01, 0.02], angular_velocity: [0, 0, 3]}
joints:
  shaft: {type: cylindrical, bodies: [ground, ring], at: [0, 0, 0], axis: [0, 0, 1]}
sensors:
  turn: {joint: shaft.angle}
  height: {joint: shaft.stroke}
gravity: [0, 0, -9.81]
solver: {end: 1 s}
""",
)
