"""Rigid body: a mass with a frame at its centre.

    m r'' = F,    I omega' + omega x I omega = M          omega and I in body axes

Its axes are at t = 0 those of the frame it is drawn in, the world's or its instance's, unless
`angle` turns them about the z axis of that frame.  There is no force kernel: the
equations of motion hold the masses (assemble/equations.py).
"""

from math import dist
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge
from pydantic import BeforeValidator

from trsim import elements
from trsim.elements.cable import Cable
from trsim.elements.contract import Channel, Element, Memory, Row, measured
from trsim.elements.inertia import Inertia, tensor_of
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, point, vector
from trsim.kernels.columns import f8, i8

ON_LINE = 1e-3  # of its length: how far the centre of mass of a bar may be from its middle


def _switched_off(value: Any) -> Any:
    """`false` is none: how a file that extends another makes its bar rigid again."""
    return None if value is False else value


SWITCH = BeforeValidator(_switched_off, json_schema_input_type=Cable | Literal[False] | None)


class RigidBody(Spec):
    """A rigid body and its centre of mass.

    mass              its mass
    inertia           about the centre of mass: one about z, for a planar scene; three principal
                      ones; or Ixx, Iyy, Izz, Ixy, Ixz, Iyz, products with the sign of the
                      tensor's entries, in body axes
    at                centre of mass, as drawn
    angle             turns the body axes about z; those of an instance about the z of its frame
    velocity          of the centre of mass at the start; where any body has a velocity, clearance
                      joints start free, otherwise as ideal ones
    angular_velocity  at the start, world axes
    flexible          what makes it an ancf_cable: a straight bar between the two of its joints that
                      lie farthest apart; its mass is the body's unless a density is given, its
                      inertia that of the bar; `false` in a file that extends makes it rigid again
    """

    type: ClassVar[str] = "rigid_body"
    mass: Annotated[float, Ge(0), Unit("kg")]
    inertia: Inertia
    at: point("m") = (0.0, 0.0, 0.0)
    angle: Annotated[float, Unit("rad")] = 0.0
    velocity: vector("m/s") = (0.0, 0.0, 0.0)
    angular_velocity: vector("rad/s") = (0.0, 0.0, 0.0)
    flexible: Annotated[Cable | None, SWITCH] = None

    @property
    def tensor(self):
        """The 3 x 3 inertia tensor, row by row, and whether it is known in all directions."""
        return tensor_of(self.inertia)

    def bar(self, start, end):
        if start == end:
            what = "a flexible bar lies between two of its joints, and this one has fewer"
            hint = "give it joints at both ends, or make it an ancf_cable with `start` and `end`"
            raise ScenarioError(what, hint, ("flexible",))
        own = self.flexible.density is not None or self.flexible.mass is not None
        if self.mass == 0.0 and not own:
            hint = "give the body a `mass`, or `flexible` a `density`"
            raise ScenarioError("a flexible bar needs a mass", hint, ("mass",))
        away = dist((0.5 * (a + b) for a, b in zip(start, end, strict=True)), self.at)
        if away > ON_LINE * dist(start, end):
            raise ScenarioError(
                f"its centre of mass is {away:.3g} m away from the middle between its joints",
                "a flexible bar is straight and alike all along; make it an ancf_cable with "
                "`start` and `end`, or fix rigid bodies to it",
                ("flexible",),
            )
        words = {**dict(self.flexible), **({} if own else {"mass": self.mass})}
        words |= {"velocity": self.velocity, "angular_velocity": self.angular_velocity}
        return elements.load("ancf_cable").spec.model_construct(**words, start=start, end=end)

    def as_rigid(self):
        return self


class Own(Memory):
    """Of one instance."""

    body: i8
    mass: f8


def pack(name, spec, at):
    return Row(*Own.packed(spec, body=at.body(name)))


@measured
def measure(t, scene, e, o):
    X, V, A, out = scene.X, scene.V, scene.A, scene.out
    i = Own(scene, e).body
    for c in range(3):
        out[o + c] = X[i, c]
        out[o + 3 + c] = V[i, c]
        out[o + 6 + c] = A[i, c]
        out[o + 9 + c] = V[i, 3 + c]
        out[o + 12 + c] = A[i, 3 + c]
    for c in range(9):
        out[o + 15 + c] = X[i, 3 + c]


ELEMENT = Element(
    key="rigid_body",
    section="bodies",
    spec=RigidBody,
    pack=pack,
    channels=(
        Channel("position", "m", "centre of mass, world axes", 3),
        Channel("velocity", "m/s", "of the centre of mass, world axes", 3),
        Channel("acceleration", "m/s^2", "of the centre of mass, world axes", 3),
        Channel("angular_velocity", "rad/s", "world axes", 3),
        Channel("angular_acceleration", "rad/s^2", "world axes", 3),
        Channel("rotation", "-", "rotation matrix, row by row", 9),
    ),
    kernels={"measure": measure},
    example="""
bodies:
  ball: {mass: 2 kg, inertia: 8e-4 kg*m^2, at: [0, 1 m], velocity: [3 m/s, 0]}
gravity: [0, -9.81, 0]
solver: {end: 0.4 s}
""",
)
