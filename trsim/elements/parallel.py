"""Parallel joint: an axis of body j stays parallel to an axis of body i.

    Phi_1, 2 = u_i . a_j = 0,  w_i . a_j = 0      [Nikravesh1988]

(u, w, a) is a right-handed triad with a the axis; all displacements and the rotation about a are
free.  The angle is that of the axes of body j minus that of body i, about a, unwrapped.  With d
from the point on i to the point on j, the stroke is a . d, x is u . d and y is w . d, all zero as
drawn.  The joint transmits no force: reaction is zero, and reaction_moment on body j is
perpendicular to a.
"""

from typing import ClassVar

from trsim.elements.joint import joint, tilting
from trsim.elements.rows import TILTS
from trsim.fields import Spec, point, vector


class Parallel(Spec):
    """Two axes stay parallel: the second body moves freely but turns about the axis only.

    bodies  the first one has the axis; moments are those acting on the second one
    axis    direction of both axes, as drawn; of any length. The angle is positive about it, and the
            stroke along it
    x_axis  direction in which x grows, as drawn, made perpendicular to `axis`; y grows along axis
            cross x. Unless given, it follows from the world axis nearest to `axis`: x, y, z give y,
            z, x
    at      point at which reactions are reported and from which displacements are measured, as
            drawn; the centre of mass of the second body unless given
    """

    type: ClassVar[str] = "parallel"
    bodies: tuple[str, str]
    axis: vector("-")
    x_axis: vector("-") | None = None
    at: point("m") | None = None


ELEMENT = joint(
    key="parallel",
    spec=Parallel,
    rows=TILTS,
    coordinates=("angle", "stroke", "x", "y"),
    reach=tilting,
    example="""
planar: false
bodies:
  lamp: {mass: 2 kg, inertia: [0.01, 0.02, 0.03], at: [0.3, 0, 0], angular_velocity: [0, 0, 3]}
joints:
  upright: {type: parallel, bodies: [ground, lamp], axis: [0, 0, 1]}
sensors: {turn: {joint: upright.angle}, height: {joint: upright.stroke}}
forces:
  wind: {type: applied_load, body: lamp, at: [0.3, 0, 0.1], direction: [1, 0, 0], force: 5 N}
solver: {end: 1 s}
""",
)
