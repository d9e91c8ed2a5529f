"""Inplane joint: a point of body j stays on a plane of body i.

    Phi = a_i . d = 0          d from the point on i to the point on j      [Nikravesh1988]

a is the normal of the plane, u its x axis and w = a x u its y axis; all three turn with body i.
x = u_i . d and y = w_i . d are zero as drawn.  reaction acts on body j at its point, along a;
positive where it pushes the way the axis points.
"""

from typing import ClassVar

from trsim.elements.joint import Joint, joint
from trsim.elements.rows import along
from trsim.fields import vector


class Inplane(Joint):
    """A point of the second body on a plane of the first: a ball that slides on a table.

    axis    normal of the plane, as drawn; of any length
    x_axis  direction in which x grows, as drawn, made perpendicular to `axis`; y grows along axis
            cross x. Unless given, it follows from the world axis nearest to `axis`: x, y, z give y,
            z, x
    """

    type: ClassVar[str] = "inplane"
    axis: vector("-")
    x_axis: vector("-") | None = None


ELEMENT = joint(
    key="inplane",
    spec=Inplane,
    rows=(along("a", "across"),),
    coordinates=("x", "y"),
    reach=None,  # one of the two may be across the plane of a scene that stays there
    example="""
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0, -0.2]}
joints:
  floor: {type: inplane, bodies: [ground, rod], at: [0, 0], axis: [1, 3]}
gravity: [0, -9.81, 0]
solver: {end: 1 s}
""",
)
