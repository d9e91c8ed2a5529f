"""Coupler: a linear relation between coordinates of any joints.

    sum_k c_k (x_k - x_k,0) = 0        x_k angles (rad) or strokes (m), x_k,0 as drawn

Between angles alone, or strokes alone, the coefficients are plain numbers.  Between both, those of
the angles are in m/rad, or those of the strokes in rad/m.
"""

from typing import Annotated, ClassVar

from pydantic import model_validator

from trsim.elements.coordinates import article
from trsim.elements.transmission import Transmission, relation, transmission
from trsim.errors import ScenarioError
from trsim.fields import Unit
from trsim.units import fits


class Coupler(Transmission):
    """A linear relation of joint coordinates: the sum of coefficients times coordinates is
    constant.

    joints        two or more joints
    coefficients  one for each joint: numbers; or, if angles and strokes are related, m/rad for the
                  angles or rad/m for the strokes
    """

    type: ClassVar[str] = "coupler"
    joints: tuple[str, ...]
    coefficients: Annotated[tuple[float, ...], Unit("-", "m/rad", "rad/m")]

    @model_validator(mode="after")
    def one_each(self):
        if len(self.joints) < 2:
            raise ScenarioError("relates two or more joints", "", ("joints",))
        if len(self.joints) != len(self.coefficients):
            raise ScenarioError(
                f"{len(self.joints)} joints have {len(self.coefficients)} coefficients",
                "give one coefficient for each joint",
                ("coefficients",),
            )
        for k, c in enumerate(self.coefficients):
            if c == 0.0:
                what = "a coefficient must not be zero"
                raise ScenarioError(what, "leave the joint out", ("coefficients", k))
        return self


def pack(name, spec, at):
    found = [at.coordinate(joint, "", ("joints", k)) for k, joint in enumerate(spec.joints)]
    names = [x.name for x in found]
    for k, one in enumerate(names):
        if one in names[:k]:
            raise ScenarioError(f"'{one}' stands there twice", "", ("joints", k))
    check_units(name, found, at)
    return relation(found, spec.coefficients)


def check_units(name, found, at):
    """Refuse units that do not make the terms of one kind."""
    mixed = len({x.kind for x in found}) > 1
    written = [at.scenario.quantity("joints", name, "coefficients", k) for k in range(len(found))]
    units = [one[1] if one else "-" for one in written]
    for k, (x, unit) in enumerate(zip(found, units, strict=True)):
        own = {"angle": "m/rad", "stroke": "rad/m"}[x.kind]
        if fits(unit, "-") or (mixed and fits(unit, own)):
            continue
        what = f"wrong unit: '{unit}'; this is the coefficient of {article(x.kind)}"
        hint = f"of angles and strokes it is in {own}" if mixed else "it is a number"
        raise ScenarioError(what, hint, ("coefficients", k))
    if len({unit for unit in units if not fits(unit, "-")}) > 1 and mixed:
        lengths = any(fits(u, "m/rad") for u in units)
        if lengths and any(fits(u, "rad/m") for u in units):
            what = "coefficients of angles in m/rad and of strokes in rad/m make no sum"
            raise ScenarioError(what, "write units for one kind, numbers for the other",
                                ("coefficients",))  # fmt: skip


ELEMENT = transmission(
    key="coupler",
    spec=Coupler,
    pack=pack,
    units=("N*m", "N"),
    example="""
bodies:
  crank: {mass: 1 kg, inertia: 0.002 kg*m^2, at: [0, 0]}
  slider: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0.8, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  guide: {type: prismatic, bodies: [ground, slider], axis: [0, 1]}
  cable: {type: coupler, joints: [bearing, guide], coefficients: [50 mm/rad, -1]}
gravity: [0, -9.81, 0]
solver: {end: 0.5 s}
""",
)
