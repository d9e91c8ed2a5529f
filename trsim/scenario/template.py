"""Parts of a mechanism that are described once, and where they stand.

templates:
  chain: {parameters: {load: 1}, bodies: {door: {...}}, joints: {B: {...}}}
instances:
  left: {template: chain, frame: {at: [0, 0.3, 0.4], y_axis: [0, 0.6, 0.8]}}
"""

from math import cos, sin
from typing import Annotated, Any, ClassVar

from pydantic import WrapValidator, model_validator

from trsim.elements.placed import Placed
from trsim.errors import ScenarioError, check_keys
from trsim.fields import EMPTY, Spec, Unit, direction, vector
from trsim.frame import Frame, across

SECTIONS = ("points", "bodies", "joints", "drives", "sensors", "forces", "events")  # of a template


def _later(value: Any, _: Any) -> Any:
    """The mapping as written, its keys checked: its numbers are read in instances (unfold.py)."""
    check_keys(value if isinstance(value, dict) else (), Placement.model_fields)
    return value


class Placement(Placed):
    """Where an instance, or all that a scenario describes, stands.

    angle  angle by which these axes are rotated
    about  direction about which they are rotated, given in the same axes as `x_axis`; the z axis
           unless given
    """

    type: ClassVar[str] = "placement"
    angle: Annotated[float, Unit("rad")] = 0.0
    about: vector("-", named=False) | None = None  # type: ignore[valid-type]

    @model_validator(mode="after")
    def turn(self) -> "Placement":
        if self.about is None:
            return self
        if not any(self.about):
            raise ScenarioError("an axis must not be zero", "for example [0, 1, 0]", ("about",))
        if "angle" not in self.model_fields_set:
            raise ScenarioError(
                "`about` needs an `angle`", "for example `angle: 5 deg`", ("about",)
            )
        return self

    @property
    def frame(self) -> Frame:
        """The place with its axes, turned."""
        straight = super().frame
        if not self.angle:
            return straight
        n = straight.z if self.about is None else direction(self.about)
        x, y = (rotated(v, n, self.angle) for v in (straight.x, straight.y))
        return Frame(self.at, x, y, across(x, y))

    @property
    def moved(self) -> Frame | None:
        """The frame; None where it is the world's."""
        return None if self.frame == WORLD else self.frame


WORLD = Placed().frame


def rotated(v: Any, n: Any, angle: float) -> tuple[float, float, float]:
    """A vector turned about a unit vector n: cos v + sin n x v + (1 - cos) (n . v) n."""
    c, s, turned = cos(angle), sin(angle), across(n, v)
    along = 2.0 * sin(0.5 * angle) ** 2 * sum(p * q for p, q in zip(n, v, strict=True))
    x, y, z = (c * v[k] + s * turned[k] + along * n[k] for k in range(3))
    return x, y, z


class Template(Spec):
    """A part of a mechanism.  Its names mean its own entries; all others those of the scenario.

    parameters  numbers that an instance may change, with their default values
    frame       position and axes of an instance that gives none
    points      named points on bodies or on the ground, which other entries may use
    bodies      rigid bodies and flexible bars
    joints      what holds bodies together
    drives      prescribed motion of joints
    sensors     named measurements, such as angles and strokes
    forces      what acts on bodies
    events      what happens when a sensor or the time crosses a value
    """

    type: ClassVar[str] = "template"
    parameters: dict[str, Any] = EMPTY
    frame: Annotated[Placement | None, WrapValidator(_later)] = None
    points: dict[str, Any] = EMPTY
    bodies: dict[str, Any] = EMPTY
    joints: dict[str, Any] = EMPTY
    drives: dict[str, Any] = EMPTY
    sensors: dict[str, Any] = EMPTY
    forces: dict[str, Any] = EMPTY
    events: dict[str, Any] = EMPTY

    @model_validator(mode="before")
    @classmethod
    def no_templates(cls, data: Any) -> Any:
        for key in ("instances", "templates", "template"):
            if isinstance(data, dict) and key in data:
                what = "a template has no instances of others"
                raise ScenarioError(what, "Put all of it into one template.", (key,))
        return data


class Instance(Spec):
    """A template put in a place.  Its entry `door` is INSTANCE_door in the scenario.

    template    name of the template
    frame       position and axes of the instance: the points and directions of the template are
                given in this frame; the world frame unless given
    parameters  values of the template's parameters
    bodies      keys of bodies that differ in this instance; null removes a body
    points      the same for points
    joints      the same for joints
    drives      the same for drives
    sensors     the same for sensors
    forces      the same for forces
    events      the same for events
    """

    type: ClassVar[str] = "instance"
    template: str
    frame: Annotated[Placement | None, WrapValidator(_later)] = None
    parameters: dict[str, Any] = EMPTY
    points: dict[str, Any] = EMPTY
    bodies: dict[str, Any] = EMPTY
    joints: dict[str, Any] = EMPTY
    drives: dict[str, Any] = EMPTY
    sensors: dict[str, Any] = EMPTY
    forces: dict[str, Any] = EMPTY
    events: dict[str, Any] = EMPTY
