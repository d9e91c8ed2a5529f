"""Small stand-ins for the elements, so that these tests need no compiler."""

from types import SimpleNamespace
from typing import Annotated, ClassVar, Literal

import pytest
from annotated_types import Ge, Gt
from pydantic import model_validator

from trsim import elements
from trsim.fields import Spec, Unit, vector
from trsim.varying import Function

Inertia = Annotated[float, Ge(0), Unit("kg*m^2")]


class RigidBody(Spec):
    type: ClassVar[str] = "rigid_body"
    flexible: ClassVar[None] = None
    mass: Annotated[float, Ge(0), Unit("kg")]
    inertia: Inertia | tuple[Inertia, Inertia, Inertia]
    at: vector("m") = (0.0, 0.0, 0.0)


class Revolute(Spec):
    type: ClassVar[str] = "revolute"
    bodies: tuple[str, str]
    at: vector("m")
    axis: vector("-") = (0.0, 0.0, 1.0)


class ClearanceJoint(Revolute):
    type: ClassVar[str] = "clearance_joint"
    clearance: Annotated[float, Ge(0), Unit("m")]
    contact: str | None = None


class Prismatic(Revolute):
    type: ClassVar[str] = "prismatic"


class Compliance(Spec):
    stiffness: Annotated[float, Gt(0), Unit("N/m", "N*m/rad")]
    damping_ratio: Annotated[float, Ge(0), Unit("-")] | None = None


class Drive(Spec):
    type: ClassVar[str] = "drive"
    joint: str
    velocity: Function("m/s", "rad/s") | None = None
    sign: Literal[1, -1] = 1
    compliance: Compliance | None = None

    @model_validator(mode="after")
    def moves(self):
        if self.velocity is None:
            raise ValueError("give `velocity`")
        return self


class Sensor(Spec):
    type: ClassVar[str] = "sensor"
    joint: str
    at_start: Annotated[float, Unit("rad", "m")] = 0.0


class AppliedLoad(Spec):
    type: ClassVar[str] = "applied_load"
    body: str
    direction: vector("-")
    force: Function("N")


class TorsionSpring(Spec):
    type: ClassVar[str] = "torsion_spring"
    joint: str
    stiffness: Annotated[float, Ge(0), Unit("N*m/rad")]
    preload: Annotated[float, Unit("N*m")] = 0.0


FAKES = {
    "bodies": [RigidBody],
    "joints": [Revolute, Prismatic, ClearanceJoint],
    "drives": [Drive],
    "sensors": [Sensor],
    "forces": [AppliedLoad, TorsionSpring],
}


COORDINATES = {Revolute: ("angle",), ClearanceJoint: ("angle",), Prismatic: ("stroke",)}


@pytest.fixture(autouse=True)
def fake_elements(monkeypatch):
    known = {
        spec.type: SimpleNamespace(
            key=spec.type,
            section=section,
            spec=spec,
            rows=(),
            coordinates=COORDINATES.get(spec, ()),
        )
        for section, specs in FAKES.items()
        for spec in specs
    }
    monkeypatch.setattr(
        elements, "ELEMENTS", {word: element.section for word, element in known.items()}
    )
    monkeypatch.setattr(elements, "load", known.__getitem__)


MECHANISM = """\
title: one chain
parameters: {speed: 0.5 m/s}
bodies:
  fairing: {mass: 50, inertia: 2.667, at: [0.128, 0.270]}
  door: {mass: 5, inertia: [1, 2, 1.584e-2], at: [-0.144634, 235.897 mm]}
joints:
  guide: {type: prismatic, bodies: [ground, fairing], at: [0, 0], axis: [1, 0, 0]}
  B: {type: revolute, bodies: [fairing, door], at: [-0.242, 0.241]}
drives:
  actuator: {joint: guide, velocity: speed, sign: -1, compliance: {stiffness: 1e7 N/m}}
sensors:
  stroke: {joint: guide}
  door_angle: {joint: B, at_start: 3 deg}
forces:
  air: {type: applied_load, body: door, direction: [0, 1], force: "2000*smoothstep(stroke/0.3)"}
  spring:
    type: torsion_spring
    joint: B
    stiffness: 3 N*m/rad
    preload: 5 N*m
contact_laws:
  pin:
    normal: lankarani_nikravesh
    bearing_radius: 10 mm
    youngs_modulus: 207 GPa
    poisson: 0.29
    restitution: 0.9
    friction: {law: modified_coulomb, coefficient: 0.3, v0: 1e-4, v1: 1e-3}
"""

CASE = """\
extends: mechanism.yaml
joints:
  B: {clearance: 0.3 mm, contact: pin}
initial: {equilibrium: [B]}
solver: {method: dop853, end: 1 s, tolerance: 1e-8}
output: {every: 0.1 ms, channels: [door_angle, "B.*"]}
poincare:
  orbit: {when: B.eccentricity_x_rate, crosses: up, plot: [B.eccentricity_x, B.eccentricity_y]}
sweep: {joints.B.clearance: [0.1 mm, 0.3 mm]}
report: {units: {angle: deg}}
"""


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder with a mechanism and a load case; the test runs inside it."""
    folder = tmp_path / "scenarios"
    folder.mkdir()
    (folder / "mechanism.yaml").write_text(MECHANISM)
    (folder / "case.yaml").write_text(CASE)
    monkeypatch.chdir(folder)
    return folder
