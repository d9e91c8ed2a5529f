"""Spherical joint: two points coincide.

    Phi_1..3 = r_j + p_j - r_i - p_i = 0               [Nikravesh1988]

reaction is the force on body j at the point, world axes.
"""

from typing import ClassVar

from pydantic import model_validator

from trsim.elements.joint import Joint, joint, of_key
from trsim.elements.rows import POINT
from trsim.errors import ScenarioError
from trsim.fields import vector


class Spherical(Joint):
    """A ball joint between two bodies.

    axis         direction on the first body, as drawn, from which the bend is measured: the axis of
                 the socket
    second_axis  direction on the second body, as drawn: the axis of the stud; equal to `axis`
                 unless given
    """

    type: ClassVar[str] = "spherical"
    axis: vector("-") | None = None
    second_axis: vector("-") | None = None

    @model_validator(mode="after")
    def both_axes(self):
        if self.second_axis is not None and self.axis is None:
            what = "`second_axis` is counted from `axis`, and that is missing"
            raise ScenarioError(what, "give both", ("second_axis",))
        for key in ("axis", "second_axis"):
            if getattr(self, key) is not None:
                of_key(self, key)
        return self


def studs(spec):
    """Unit vectors along both axes, world axes as drawn; None where it has none."""
    if spec.axis is None:
        return None
    a = of_key(spec, "axis")
    return a, a if spec.second_axis is None else of_key(spec, "second_axis")


ELEMENT = joint(
    key="spherical",
    spec=Spherical,
    rows=POINT,
    sways=True,
    bends=studs,
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
