"""Parts of a mechanism that are described once, and where they stand.

templates:
  chain: {parameters: {load: 1}, bodies: {door: {...}}, joints: {B: {...}}}
instances:
  left: {template: chain, frame: {at: [0, 0.3, 0.4], y_axis: [0, 0.6, 0.8]}}
"""

from math import sqrt
from typing import Annotated, Any, ClassVar

from pydantic import WrapValidator, model_validator

from trsim.errors import ScenarioError, check_keys
from trsim.fields import EMPTY, Spec, direction, point, vector
from trsim.frame import Frame, across

SECTIONS = ("bodies", "joints", "drives", "sensors", "forces", "events")  # of a template
PARALLEL = 1e-6  # sine of an angle


def _later(value: Any, _: Any) -> Any:
    """The mapping as written, its keys checked: its numbers are read in instances (unfold.py)."""
    check_keys(value if isinstance(value, dict) else (), Placement.model_fields)
    return value


class Placement(Spec):
    """Where an instance stands.

    at      its origin
    x_axis  direction of its x axis, of any length
    y_axis  direction of its y axis, made perpendicular to x; z = x cross y
    """

    type: ClassVar[str] = "placement"
    at: point("m") = (0.0, 0.0, 0.0)  # type: ignore[valid-type]
    x_axis: vector("-") = (1.0, 0.0, 0.0)  # type: ignore[valid-type]
    y_axis: vector("-") = (0.0, 1.0, 0.0)  # type: ignore[valid-type]

    @model_validator(mode="after")
    def axes(self) -> "Placement":
        for key in ("x_axis", "y_axis"):
            if not any(getattr(self, key)):
                raise ScenarioError("an axis must not be zero", "for example [1, 0, 0]", (key,))
        if _across(direction(self.x_axis), direction(self.y_axis))[1] < PARALLEL:
            what = "y_axis is parallel to x_axis"
            raise ScenarioError(what, "z = x cross y needs two directions", ("y_axis",))
        return self

    @property
    def frame(self) -> Frame | None:
        """The frame; None where it is the world's."""
        x = direction(self.x_axis)
        y = direction(_across(x, direction(self.y_axis))[0])
        found = Frame(self.at, (x[0], x[1], x[2]), (y[0], y[1], y[2]), across(x, y))
        return None if found == WORLD else found


WORLD = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def _across(x: Any, y: Any) -> tuple[tuple[float, ...], float]:
    """The part of y across a unit vector x, and its length."""
    along = sum(p * q for p, q in zip(x, y, strict=True))
    part = tuple(q - along * p for p, q in zip(x, y, strict=True))
    return part, sqrt(sum(c * c for c in part))


class Template(Spec):
    """A part of a mechanism.  Its names mean its own entries; all others those of the scenario.

    parameters  numbers an instance may change, with what they are otherwise
    frame       where an instance stands that says nothing else
    bodies      what has mass
    joints      what holds bodies together
    drives      prescribed motion of joints
    sensors     joint coordinates with a name
    forces      what acts on bodies
    events      what happens where a sensor, or the time, crosses a value
    """

    type: ClassVar[str] = "template"
    parameters: dict[str, Any] = EMPTY
    frame: Annotated[Placement | None, WrapValidator(_later)] = None
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

    template    which
    frame       where: its points and directions are seen from there; the world's unless given
    parameters  values of the template's parameters
    bodies      keys of bodies that differ in this instance; null leaves a body out
    joints      the same of joints
    drives      the same of drives
    sensors     the same of sensors
    forces      the same of forces
    events      the same of events
    """

    type: ClassVar[str] = "instance"
    template: str
    frame: Annotated[Placement | None, WrapValidator(_later)] = None
    parameters: dict[str, Any] = EMPTY
    bodies: dict[str, Any] = EMPTY
    joints: dict[str, Any] = EMPTY
    drives: dict[str, Any] = EMPTY
    sensors: dict[str, Any] = EMPTY
    forces: dict[str, Any] = EMPTY
    events: dict[str, Any] = EMPTY
