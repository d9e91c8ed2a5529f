"""Revolute joint: two points coincide and two axes stay parallel.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0
    Phi_4    = u_i . a_j = 0
    Phi_5    = w_i . a_j = 0               [Nikravesh1988]

(u, w, a) is a right-handed triad with a the axis.  The joint angle is the angle of the axes of body
j minus that of body i, about a, unwrapped.  reaction is the force on body j at the pin, world axes.
"""

from typing import ClassVar

from trsim.elements.joint import Joint, Z, joint
from trsim.elements.rows import POINT, TILTS
from trsim.fields import vector


class Revolute(Joint):
    """A hinge between two bodies.  With the key `clearance` it is a clearance_joint.

    axis  direction of the hinge, as drawn; of any length
    """

    type: ClassVar[str] = "revolute"
    axis: vector("-") = Z


ELEMENT = joint(
    key="revolute",
    spec=Revolute,
    rows=(*POINT, *TILTS),
    coordinates=("angle",),
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
