"""Spherical joint: two points coincide.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0               [Nikravesh1988]

reaction is the force on body j at the point, world axes.
"""

from typing import ClassVar

from trsim.elements.contract import Element, Row, kernel
from trsim.elements.frames import Coincident, between_points, point_rows, points
from trsim.elements.joint import Joint


class Spherical(Joint):
    """A ball joint between two bodies."""

    type: ClassVar[str] = "spherical"


def pack(name, spec, at):
    i, j = at.bodies(spec.bodies, spec.at)
    return Row(*Coincident.packed(**points(at, i, j, spec.at, spec.at)))


@kernel
def constraint(t, scene, a, b):
    for e in range(a, b):
        point_rows(scene, e)


ELEMENT = Element(
    key="spherical",
    section="joints",
    spec=Spherical,
    pack=pack,
    rows=("x", "y", "z"),
    meets=True,
    pin=(2, 3),
    holds_twist=False,
    turning=between_points,
    picture="ball",
    kernels={"constraint": constraint},
    example="""
planar: false
bodies:
  ball: {mass: 2 kg, inertia: [0.01, 0.01, 0.01], at: [0.2, 0, 0], velocity: [0, 1 m/s, 0]}
joints:
  socket: {type: spherical, bodies: [ground, ball], at: [0, 0, 0]}
gravity: [0, 0, -9.81]
solver: {end: 1 s}
""",
)
