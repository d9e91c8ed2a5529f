"""What makes a bar flexible: its section, its material and how finely it is divided.

    EA, EI, rho A        of the section, or rho A = mass / length
    section              a shape, from which A and I follow, or `area` and `second_moment`

It stands in two places: under the key `flexible` of a rigid body that is a straight bar, and as
part of an ancf_cable, a body of its own.
"""

from math import pi, sqrt
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Interval
from pydantic import model_validator

from trsim.errors import ScenarioError
from trsim.fields import Spec, Unit

Length = Annotated[float, Gt(0), Unit("m")]
MOST_ELEMENTS = 1000


class Section(Spec):
    """The shape of a cross-section: a diameter, or width and height.

    diameter  diameter of a round bar
    wall      wall thickness, if the bar is a tube
    width     width of a rectangle, perpendicular to the plane of a planar scene
    height    height of a rectangle, in that plane; equal to the width unless given
    """

    type: ClassVar[str] = "section"
    diameter: Length | None = None
    wall: Length | None = None
    width: Length | None = None
    height: Length | None = None

    @model_validator(mode="after")
    def one_shape(self):
        if (self.diameter is None) == (self.width is None):
            hint = "for example {diameter: 45 mm} or {width: 5 mm, height: 8 mm}"
            raise ScenarioError("give either `diameter` or `width`", hint)
        if self.wall is not None and (self.diameter is None or 2.0 * self.wall > self.diameter):
            raise ScenarioError(
                "a tube's wall is at most half of its diameter", "a solid bar has none", ("wall",)
            )
        if self.height is not None and self.width is None:
            raise ScenarioError("a height belongs to a width", path=("height",))
        return self

    @property
    def numbers(self) -> tuple[float, float, bool]:
        """A (m^2), I (m^4) and whether it bends alike in all directions."""
        if self.width is not None:
            height = self.height or self.width
            return self.width * height, self.width * height**3 / 12.0, height == self.width
        assert self.diameter is not None  # noqa: S101
        hole = self.diameter - 2.0 * self.wall if self.wall else 0.0
        area = pi / 4.0 * (self.diameter**2 - hole**2)
        return area, pi / 64.0 * (self.diameter**4 - hole**4), True


class Cable(Spec):
    """A straight bar that stretches and bends; it does not resist torsion.

    elements        number of elements of equal length; joints and loads must be at nodes, that is
                    where elements meet, or at the ends
    section         shape of its cross-section
    area            area of the cross-section, if no shape is given
    second_moment   second moment of area, if no shape is given
    youngs_modulus  Young's modulus of its material
    density         density of its material
    mass            mass of the whole bar, instead of a density
    strain          green: (r'.r' - 1)/2; engineering: |r'| - 1
    curvature       exact: |r' x r''|/|r'|^3; gerstmayr: |r' x r''|/|r'|^2; paper: |r''|
    stretching      assumed: the strain is a parabola through its values at both nodes, with the
                    mean of the element; full: the strain at every point, which makes slender bars
                    too stiff
    damping         beta of a Kelvin-Voigt material: stress = E (strain + beta strain rate)
    """

    type: ClassVar[str] = "cable"
    elements: Annotated[int, Interval(ge=1, le=MOST_ELEMENTS)] = 4
    section: Section | None = None
    area: Annotated[float, Gt(0), Unit("m^2")] | None = None
    second_moment: Annotated[float, Gt(0), Unit("m^4")] | None = None
    youngs_modulus: Annotated[float, Gt(0), Unit("Pa")]
    density: Annotated[float, Gt(0), Unit("kg/m^3")] | None = None
    mass: Annotated[float, Gt(0), Unit("kg")] | None = None
    strain: Literal["green", "engineering"] = "green"
    curvature: Literal["exact", "gerstmayr", "paper"] = "exact"
    stretching: Literal["assumed", "full"] = "assumed"
    damping: Annotated[float, Ge(0), Unit("s")] = 0.0

    @model_validator(mode="after")
    def one_section(self):
        given = (self.area is not None, self.second_moment is not None)
        if self.section is not None and any(given):
            hint = "A and I follow from the section: leave the two out"
            raise ScenarioError(
                "give either a `section` or `area` and `second_moment`", hint, ("section",)
            )
        if self.section is None and not all(given):
            hint = "for example `section: {diameter: 45 mm}`"
            raise ScenarioError("give a `section`, or `area` and `second_moment`", hint)
        if self.density is not None and self.mass is not None:
            hint = "the mass of a bar is its density times its volume: leave one of the two out"
            raise ScenarioError("give either `density` or `mass`", hint, ("mass",))
        return self

    @property
    def numbers(self) -> tuple[float, float, bool]:
        """A (m^2), I (m^4) and whether it bends alike in all directions."""
        if self.section is not None:
            return self.section.numbers
        assert self.area and self.second_moment  # noqa: S101
        return self.area, self.second_moment, True

    @property
    def thickness(self) -> float:
        """Its thickness in the direction of bending, m; without a shape that of a rectangle."""
        if self.section is not None:
            section = self.section
            return section.diameter or section.height or section.width or 0.0
        area, moment, _ = self.numbers
        return sqrt(12.0 * moment / area)
