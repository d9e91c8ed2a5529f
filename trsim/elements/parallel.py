"""Parallel joint: an axis of body j stays parallel to an axis of body i.

    Phi_1, 2 = u_i . a_j = 0,  w_i . a_j = 0      [Nikravesh1988]

(u, w, a) is a right-handed triad with a the axis; all displacements are free, and the turn about a.
The angle is that of body j's axes minus body i's about a, unwrapped; with d from the point on i to
the point on j the stroke is a . d, x is u . d and y is w . d, zero as drawn.  It passes on no
force: reaction is zero, reaction_moment on body j is across a.
"""

from typing import ClassVar

from trsim.elements.joint import joint, tilting
from trsim.elements.rows import TILTS
from trsim.fields import Spec, point, vector


class Parallel(Spec):
    """Two axes stay parallel: the second body goes where it likes and turns about the axis only.

    bodies  the first one has the axis; moments are those on the second one
    axis    the direction of both axes, as drawn; of any length: the angle grows about it, and the
            stroke along it
    x_axis  direction in which x grows, as drawn, made perpendicular to `axis`; y grows along axis
            cross x.  Unless given the world axis behind the one next to `axis`: of z it is x
    at      where reactions are told, as drawn; the second body's centre of mass unless
            given: from there the second body's place is counted
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
