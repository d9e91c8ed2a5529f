"""Rigid body: a mass with a frame at its centre.

    m r'' = F,    I omega' + omega x I omega = M          omega and I in body axes

At t = 0 its axes are those of the frame in which it is drawn (the world, the file or the instance),
unless `angle` rotates them about the z axis of that frame.  There is no force kernel: the masses
are in the equations of motion (assemble/equations.py).
"""

from math import dist
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, MinLen
from pydantic import BeforeValidator, ConfigDict, model_validator

from trsim import elements
from trsim.elements.cable import Cable
from trsim.elements.contract import Channel, Element, Memory, Row, measured, moving
from trsim.elements.inertia import Inertia, tensor_of, written
from trsim.elements.solid import Solid
from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit, point, vector
from trsim.kernels.columns import f8, i8

NEEDED = {"mass": "mass (kg)", "inertia": "inertia (kg*m^2)"}  # unless there is a shape
FOLLOW = {"mass": "mass", "at": "centre", "inertia": "inertia"}  # from a shape, in words
ON_LINE = 1e-3  # of its length: how far the centre of mass of a bar may be from its middle


def _switched_off(value: Any) -> Any:
    """`false` is none: how a file that extends another makes its bar rigid again."""
    return None if value is False else value


SWITCH = BeforeValidator(_switched_off, json_schema_input_type=Cable | Literal[False] | None)


class RigidBody(Spec):
    """A rigid body and its centre of mass.

    mass              mass of the body; with a shape, the mass of the whole shape, unless densities
                      give it
    inertia           moments of inertia about the centre of mass, in body axes: one about z, for a
                      planar scene; three principal ones; or Ixx, Iyy, Izz, Ixy, Ixz, Iyz, with the
                      products signed as entries of the tensor. With a shape it follows from the
                      shape unless given
    at                centre of mass, as drawn; with a shape it follows from the shape unless given
    shape             solids and holes that make up the body, as drawn; mass, inertia and centre of
                      mass follow from them
    density           density of all solids without a density of their own
    angle             angle by which the body axes are rotated about z; in an instance, about the z
                      axis of its frame
    velocity          velocity of the centre of mass at the start. If any body has a velocity,
                      clearance joints start free; otherwise they start as ideal joints
    angular_velocity  angular velocity at the start, in world axes, or in the axes in which the body
                      is drawn
    flexible          makes the body an ancf_cable: a straight bar between those two of its joints
                      that are farthest apart. Its mass is that of the body unless a density is
                      given; its inertia is that of the bar. `false`, in a file that extends
                      another, makes it rigid again
    """

    model_config = ConfigDict(
        json_schema_extra={"anyOf": [{"required": [*NEEDED]}, {"required": ["shape"]}]}
    )
    type: ClassVar[str] = "rigid_body"
    mass: Annotated[float, Ge(0), Unit("kg")] | None = None
    inertia: Inertia | None = None
    at: point("m") | None = None
    shape: Annotated[tuple[Solid, ...], MinLen(1)] | None = None
    density: Annotated[float, Gt(0), Unit("kg/m^3")] | None = None
    angle: Annotated[float, Unit("rad")] = 0.0
    velocity: vector("m/s") = (0.0, 0.0, 0.0)
    angular_velocity: vector("rad/s") = (0.0, 0.0, 0.0)
    flexible: Annotated[Cable | None, SWITCH] = None

    @model_validator(mode="after")
    def complete(self):
        """Fill in what follows from the shape; without one mass and inertia are needed."""
        for key in FOLLOW:
            if self.says(key) and getattr(self, key) is None:
                raise ScenarioError("must be a number or numbers, got nothing", "", (key,))
        origin = self.drawn_in.at if self.drawn_in else (0.0, 0.0, 0.0)
        if self.shape is None:
            if self.density is not None:
                raise ScenarioError("a density needs a `shape`", "or give a `mass`", ("density",))
            missing = [told for key, told in NEEDED.items() if getattr(self, key) is None]
            if missing:
                hint = "Or give the body a `shape` and a `density`."
                raise ScenarioError(f"field required: {' and '.join(missing)}", hint)
            self.__dict__["at"] = origin if self.at is None else self.at
            return self
        from trsim.elements.weighing import of_solids, turned  # needs numpy

        try:
            whole = of_solids(self.shape, self.density, self.mass)
        except ScenarioError as error:
            raise error.at("shape") from None
        follows = {"mass": whole.mass, "at": tuple(whole.centre.tolist())}
        follows["inertia"] = written(turned(self, whole.inertia, into_body=True))
        self.__dict__.update({key: of for key, of in follows.items() if not self.says(key)})
        return self

    @property
    def origin(self) -> str:
        """Where its mass, centre and inertia come from."""
        if self.shape is None:
            return "given"
        count = f"{len(self.shape)} solid{'s' if len(self.shape) > 1 else ''}"
        given = [what for key, what in FOLLOW.items() if self.says(key)]
        scaled = " scaled to its mass" if self.says("mass") else ""
        told = f"of {count}{scaled}"
        others = [what for what in given if what != "mass"]
        return f"{told}; {' and '.join(others)} given" if others else told

    def says(self, key: str) -> bool:
        """Whether a key is written, so that it does not follow from the shape."""
        return key in self.model_fields_set

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
        moving("position", "m", "centre of mass, world axes", 3),
        moving("velocity", "m/s", "of the centre of mass, world axes", 3),
        Channel("acceleration", "m/s^2", "of the centre of mass, world axes", 3),
        moving("angular_velocity", "rad/s", "world axes", 3),
        Channel("angular_acceleration", "rad/s^2", "world axes", 3),
        moving("rotation", "-", "rotation matrix, row by row", 9),
    ),
    kernels={"measure": measure},
    example="""
bodies:
  ball: {mass: 2 kg, inertia: 8e-4 kg*m^2, at: [0, 1 m], velocity: [3 m/s, 0]}
gravity: [0, -9.81, 0]
solver: {end: 0.4 s}
""",
)
