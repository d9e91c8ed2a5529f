"""Inplane joint: a point of body j stays on a plane of body i.

    Phi = a_i . d = 0          d from the point on i to the point on j      [Nikravesh1988]

a is the normal of the plane, which turns with body i.  reaction acts on body j at its point, along
a; positive where it pushes the way the axis points.
"""

from typing import ClassVar

from trsim.elements.joint import Joint, joint
from trsim.elements.rows import along
from trsim.fields import vector


class Inplane(Joint):
    """A point of the second body on a plane of the first: a ball that slides on a table.

    axis  normal of the plane, as drawn; of any length
    """

    type: ClassVar[str] = "inplane"
    axis: vector("-")


ELEMENT = joint(
    key="inplane",
    spec=Inplane,
    rows=(along("a", "across"),),
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0, -0.2]}
joints:
  floor: {type: inplane, bodies: [ground, rod], at: [0, 0], axis: [1, 3]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
