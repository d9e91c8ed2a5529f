"""Spherical joint: two points coincide.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0               [Nikravesh1988]

reaction is the force on body j at the point, world axes.
"""

from typing import ClassVar

from trsim.elements.joint import Joint, joint
from trsim.elements.rows import POINT


class Spherical(Joint):
    """A ball joint between two bodies."""

    type: ClassVar[str] = "spherical"


ELEMENT = joint(
    key="spherical",
    spec=Spherical,
    rows=POINT,
    sways=True,
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
