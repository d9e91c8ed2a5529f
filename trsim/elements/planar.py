"""Planar joint: a plane of body j stays in a plane of body i.

    Phi_1    = a_i . d = 0                        d from the point on i to the point on j
    Phi_2, 3 = u_i . a_j = 0,  w_i . a_j = 0      [Nikravesh1988]

a is the normal of the plane, u its x axis and w = a x u its y axis; all three turn with body i.
x = u_i . d and y = w_i . d are zero as drawn; the angle is that of the axes of body j minus that of
body i, about a, unwrapped.  reaction acts on body j at its point, along a; reaction_moment is
perpendicular to a.  If a is the z axis of a planar scene, the joint constrains nothing there; it
only gives a body its three coordinates.
"""

from typing import ClassVar

from trsim.elements.joint import Joint, Z, joint
from trsim.elements.rows import TILTS, along
from trsim.fields import vector


class Planar(Joint):
    """A plane of the second body stays in a plane of the first: a plate that slides on a table.

    axis    normal of the planes, as drawn; of any length. The angle is positive about it
    x_axis  direction in which x grows, as drawn, made perpendicular to `axis`; y grows along axis
            cross x. Unless given, it follows from the world axis nearest to `axis`: x, y, z give y,
            z, x
    """

    type: ClassVar[str] = "planar"
    axis: vector("-") = Z
    x_axis: vector("-") | None = None


ELEMENT = joint(
    key="planar",
    spec=Planar,
    rows=(along("a", "across"), *TILTS),
    coordinates=("angle", "x", "y"),
    example="""
planar: false
bodies:
  plate: {mass: 2 kg, inertia: [0.01, 0.01, 0.02], velocity: [0.8, 0.6, 0],
          angular_velocity: [0, 0, 3]}
joints:
  table: {type: planar, bodies: [ground, plate], at: [0, 0, 0], axis: [0, 0, 1]}
sensors:
  turn: {joint: table.angle}
  east: {joint: table.x}
  north: {joint: table.y}
gravity: [0, 0, -9.81]
solver: {end: 1 s}
""",
)
