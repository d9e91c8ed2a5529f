"""Solids: the shape of a rigid body, from which its mass, centre and inertia follow.

    m, c, J      of boxes, cylinders, tubes, spheres, prisms, and of holes in them; laws/solids.py

A solid has a density or a mass of its own, or the density of its body.
"""

from typing import Annotated, ClassVar

from annotated_types import Gt, MinLen
from pydantic import model_validator

from trsim.elements.joint import Z
from trsim.errors import ScenarioError
from trsim.fields import Flag, Spec, Unit, point, vector
from trsim.laws.outline import area, crossed

Length = Annotated[float, Gt(0), Unit("m")]
KINDS = ("box", "cylinder", "sphere", "polygon")
THIN = 1e-12  # of the square of its extent: an outline of less area has none
MOST_CORNERS = 1000


class Solid(Spec):
    """A box, a cylinder, a sphere or a plate of any outline; or a hole of this shape.

    box       edge lengths of a box along its x, y and z axes
    cylinder  diameter of a cylinder about its z axis
    sphere    diameter of a sphere
    polygon   corners [x, y] of an outline in its x-y plane, in order, measured from `at`
    length    length of a cylinder, or thickness of a polygon, along the z axis; half of it on
              either side
    wall      wall thickness of a tube or of a hollow sphere
    at        its centre, as drawn; for a polygon, the origin of the corners
    axis      direction of its z axis, as drawn; of any length
    x_axis    direction of its x axis, as drawn, made perpendicular to `axis`
    density   density of its material; that of the body unless given
    mass      mass of the solid, instead of a density
    hole      whether the solid is a hole: it is subtracted from the others
    """

    type: ClassVar[str] = "solid"
    box: tuple[Length, Length, Length] | None = None
    cylinder: Length | None = None
    sphere: Length | None = None
    polygon: Annotated[tuple[tuple[float, float], ...], MinLen(3), Unit("m")] | None = None
    length: Length | None = None
    wall: Length | None = None
    at: point("m") = (0.0, 0.0, 0.0)
    axis: vector("-") = Z
    x_axis: vector("-") | None = None
    density: Annotated[float, Gt(0), Unit("kg/m^3")] | None = None
    mass: Annotated[float, Gt(0), Unit("kg")] | None = None
    hole: Flag = False

    @model_validator(mode="after")
    def one_shape(self):
        given = [kind for kind in KINDS if getattr(self, kind) is not None]
        if len(given) != 1:
            got = f"got {' and '.join(given)}" if given else "got none"
            hint = "for example {box: [0.4, 0.3, 2 mm]} or {cylinder: 20 mm, length: 0.3}"
            raise ScenarioError(f"give one of {', '.join(KINDS)}; {got}", hint)
        long, hollow = given[0] in ("cylinder", "polygon"), self.cylinder or self.sphere
        if long and self.length is None:
            raise ScenarioError(f"a {given[0]} needs a `length`")
        for key, has in (("length", long), ("wall", hollow)):
            if getattr(self, key) is not None and not has:
                raise ScenarioError(f"a {given[0]} has no {key}", "leave it out", (key,))
        if self.wall is not None and 2.0 * self.wall > hollow:
            what = "a wall is at most half of the diameter"
            raise ScenarioError(what, "a full one has none", ("wall",))
        if self.density is not None and self.mass is not None:
            raise ScenarioError("give either `density` or `mass`", "leave one out", ("mass",))
        if self.hole and self.mass is not None:
            hint = "it takes away as much as fills it: leave `mass` out"
            raise ScenarioError("a hole has no mass", hint, ("mass",))
        if self.polygon is not None:
            self.check_outline(self.polygon)
        return self

    def check_outline(self, corners):
        if len(corners) > MOST_CORNERS:
            raise ScenarioError(f"at most {MOST_CORNERS} corners", "", ("polygon",))
        meeting = crossed(corners)
        if meeting is not None:
            what = f"sides {meeting[0] + 1} and {meeting[1] + 1} of the outline meet"
            raise ScenarioError(what, "give its corners in order, each once", ("polygon",))
        extent = max(max(abs(a - b) for a, b in zip(p, corners[0], strict=True)) for p in corners)
        if area(corners) <= THIN * extent**2:
            raise ScenarioError("the outline has no area", "", ("polygon",))
