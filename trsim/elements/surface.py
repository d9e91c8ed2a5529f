"""What a surface is that something touches: as a user writes it, and its numbers.

A plane, a sphere, a cylinder or a profile; how far from it a place is tells laws/surfaces.py.
"""

from functools import lru_cache
from math import inf
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt
from pydantic import model_validator

from trsim.elements.placed import Placed
from trsim.errors import ScenarioError
from trsim.fields import Flag, Spec, Unit, point, vector
from trsim.laws.friction import CODES
from trsim.laws.profiles import Flaw, profile, smooth
from trsim.laws.surfaces import CYLINDER, PLANE, SHAPES, SPHERE
from trsim.laws.touches import touches

SIDE = 1e-6  # of the size of a profile: a centre so near to it is on no side
OTHERS = {"plane": (), "sphere": ("radius",), "cylinder": ("radius",), "profile": ("points",)}
ONLY_OF = {
    "radius": ("sphere", "cylinder"),
    "hollow": ("sphere", "cylinder", "profile"),
    "points": ("profile",),
    "closed": ("profile",),
    "corner_radius": ("profile",),
    "smooth": ("profile",),
}
SPLINE = 1e-7  # of its size: how far arcs are from a spline through points
FINE = 1e-8  # the same where a side touches it, whose force follows the radii of the arcs


class Surface(Placed):
    """A surface of a body; it turns with the body.

    body           the body, or ground
    shape          plane: through `at`, free on the side of its y axis; sphere: around `at`;
                   cylinder: around the z axis; profile: a line in the x-y plane, extruded along z
    at             its origin, as drawn: a position, or the name of a point
    x_axis         direction of its x axis, as drawn
    y_axis         direction of its y axis, made perpendicular to x
    radius         radius of a sphere or a cylinder
    hollow         whether the free side is inside: a bowl, a hole, a slot
    points         points [x, y] that a profile passes through
    closed         whether a profile continues from the last point to the first
    smooth         whether it is a cubic spline; otherwise it is straight from one point to the next
    corner_radius  radius of the corners between its straight parts; 0: sharp edges
    """

    type: ClassVar[str] = "surface"
    body: str
    shape: Literal["plane", "sphere", "cylinder", "profile"] = "plane"
    at: point("m") = (0.0, 0.0, 0.0)
    x_axis: vector("-") = (1.0, 0.0, 0.0)
    y_axis: vector("-") = (0.0, 1.0, 0.0)
    radius: Annotated[float, Gt(0), Unit("m")] | None = None
    hollow: Flag = False
    points: tuple[Annotated[tuple[float, float], Unit("m")], ...] | None = None
    closed: Flag = False
    smooth: Flag = False
    corner_radius: Annotated[float, Ge(0), Unit("m")] = 0.0

    @model_validator(mode="after")
    def of_its_shape(self):
        for key in OTHERS[self.shape]:
            if getattr(self, key) is None:
                raise ScenarioError(f"a {self.shape} needs `{key}`")
        for key, shapes in ONLY_OF.items():
            if key in self.model_fields_set and self.shape not in shapes:
                raise ScenarioError(f"{key} is no number of a {self.shape}", "", (key,))
        if self.smooth and self.corner_radius:
            what = "a smooth profile has no corners"
            raise ScenarioError(what, "leave out `corner_radius` or `smooth`", ("corner_radius",))
        if self.hollow and self.shape == "profile" and not self.closed:
            raise ScenarioError("only a closed profile has an inside", "closed: true", ("hollow",))
        return self

    @property
    def outline(self):
        """Places of a profile that lie far out, as drawn; of another shape none."""
        return self.outermost(self.points) if self.points else []


class Ball(Spec):
    """A ball of a body, or a roller whose axis is the z axis of the surface, or a point; or an
    outline with a round edge.

    body     the body
    at       its centre, as drawn: a position, or the name of a point
    radius   radius; 0 for a point; for an outline, the radius of its rounded edge
    corners  corners of an outline, in order: the centres [x, y] of its rounded corners, measured
             from `at` along the axes of the surface, as drawn; two corners make a straight face
    """

    type: ClassVar[str] = "ball"
    body: str
    at: point("m")
    radius: Annotated[float, Ge(0), Unit("m")] = 0.0
    corners: tuple[Annotated[tuple[float, float], Unit("m")], ...] | None = None


def shapes_of(spec, at, centre) -> tuple[list[dict[str, Any]], float | None]:
    """The columns that say what a surface is, of each touch it has with its ball, and its curvature
    where Hertz's law has one.

    centre: of the ball, in the axes of the surface.
    """
    surface, r = spec.surface, spec.ball.radius
    code, R = SHAPES[surface.shape], surface.radius or 0.0
    free = -1.0 if surface.hollow else 1.0
    shaped = {"shape": code, "radius": R, "free": free, "profile": 0, "closed": 0, "seams": -1}
    shaped |= {"outline": -1, "span": 0.0, "wide": 0.0, "bulge": 0.0}
    if code == PLANE:
        return [{**shaped, "sharp": inf, "reach": inf}], 0.0
    if code in (SPHERE, CYLINDER):
        if surface.hollow and r >= R:
            what = f"a ball of radius {r:g} m does not fit into one of {R:g} m"
            raise ScenarioError(what, "", ("ball", "radius"))
        bends = {"sharp": inf, "reach": R} if surface.hollow else {"sharp": R, "reach": inf}
        return [{**shaped, **bends}], free / R if code == SPHERE else None
    return [{**shaped, **one} for one in of_profile(spec, at, centre)], None


def of_profile(spec, at, centre) -> list[dict[str, Any]]:
    """What is other than in `shapes_of` of each touch of a profile."""
    surface, r = spec.surface, spec.ball.radius
    turned = False
    try:
        side = (-1 if surface.hollow else 1) if surface.closed else side_of(surface, centre)
        turned = side < 0 and not surface.closed  # the drawn side is the left one
        if turned:
            surface, side = turned_round(surface), 1
        spline = SPLINE if spec.ball.corners is None else FINE
        found = pieces_of(surface, side, inward=r > 0.0, spline=spline)
        many = [] if found.reach > r else touches_of(surface, side, r)
    except Flaw as flaw:
        k = flaw.point
        if turned and k is not None:
            k = len(surface.points) - 1 - k
        where = ("points",) if k is None else ("points", k)
        raise ScenarioError(flaw.what, flaw.hint, ("surface", *where)) from None
    if r == 0.0 and found.sharp == 0.0:
        what = "a point on an edge has no direction to be pushed in"
        hint = (
            "give `corner_radius`, or the ball a `radius`"
            if surface.closed
            else ("close the profile and give `corner_radius`, or give the ball a `radius`")
        )
        raise ScenarioError(what, hint, ("ball", "radius"))
    body = at.body(surface.body, "surface", "body", near=surface.at, off=1.0)
    for x, y in (found.outline.min(axis=0), found.outline.max(axis=0)):
        at.local(body, surface.frame.moved((float(x), float(y), 0.0)))
    if not many:
        bends = {"sharp": found.sharp, "reach": found.reach}
        return [{**bends, "profile": listed(at, found.numbers), "closed": int(surface.closed)}]
    part = 2 if surface.closed else 0
    return [
        {"free": 1.0, "closed": part, "profile": listed(at, one.numbers), "sharp": one.sharp,
         "reach": one.reach, "seams": listed(at, seams_of(one))}
        for one in many
    ]  # fmt: skip


def listed(at, numbers) -> int:
    """Where numbers are in `tab`; -1 of none."""
    offset = len(at.tab)
    at.tab.extend(numbers)
    return offset if numbers else -1


def seams_of(one) -> list[float]:
    """How many seams a touch has, and where; nothing where it has none."""
    flat = [float(c) for seam in one.seams for c in seam]
    return [float(len(one.seams)), *flat] if flat else []


@lru_cache(maxsize=64)
def found_touches(points, radius, closed, side, r):
    """The touches of a profile and a ball that has several with it."""
    return touches(made(points, radius, closed, side, True), closed, side, r)


def touches_of(surface, side, r):
    """The same of a surface.  Raises Flaw."""
    radius = None if surface.smooth else surface.corner_radius
    return found_touches(surface.points, radius, surface.closed, side, r)


def pieces_of(surface, side, inward=False, spline=SPLINE):
    """The profile of a surface, whose free side is as laws/profiles.py has it.  Raises Flaw.

    inward: whether straight sides may meet inwards at an edge; spline: a tolerance.
    """
    radius = None if surface.smooth else surface.corner_radius
    return made(surface.points, radius, surface.closed, side, inward, spline)


@lru_cache(maxsize=256)  # a run assembles several times, and looks for how large a ball fits
def made(points, radius, closed, side, inward=False, spline=SPLINE):
    """The profile through points, straight with a radius at its corners, or else smooth."""
    if radius is None:
        return smooth(points, closed, side, spline)
    return profile(points, radius, closed, side, inward)


def turned_round(surface):
    """The same profile from its last point to the first."""
    return surface.model_copy(update={"points": surface.points[::-1]})


def fits_behind(surface, r):
    """Whether a ball touches an open profile in one place only from either side."""
    try:
        return all(pieces_of(surface, side).reach > r for side in (1, -1))
    except Flaw:
        return False


def thickness(surface):
    """How deep something may be in a body before it is nearer to its other side, m."""
    if surface.shape in ("sphere", "cylinder") and not surface.hollow:
        return surface.radius
    if surface.shape != "profile" or not surface.closed or surface.hollow:
        return inf
    try:
        return pieces_of(surface, -1).reach
    except Flaw:  # it has edges
        return inf


def side_of(surface, centre):
    """On which side of an open profile the ball is drawn: 1 left, -1 right."""
    import numpy as np

    line = pieces_of(surface, 1).outline if surface.smooth else np.array(surface.points)
    start, way = line[:-1], np.diff(line, axis=0)
    square = np.maximum(np.sum(way * way, axis=1), 1e-300)
    d = np.array(centre[:2]) - start
    along = np.clip(np.sum(d * way, axis=1) / square, 0.0, 1.0)
    far = np.linalg.norm(d - along[:, None] * way, axis=1)
    k = int(np.argmin(far))
    if far[k] <= SIDE * float(np.linalg.norm(np.ptp(line, axis=0))):
        what = "the centre is drawn on the profile, so nobody knows on which side it is"
        raise ScenarioError(what, "draw it a radius away", ("ball", "at"))
    return 1 if way[k][0] * d[k][1] - way[k][1] * d[k][0] >= 0.0 else -1


def check_levers(spec, code, friction):
    """Refuse resistance to rolling and spinning where it has no meaning."""
    if spec.ball.corners is not None:
        what = "an outline has no resistance to rolling and spinning"
        raise ScenarioError(what, "leave the levers out", ("ball", "corners"))
    if code != CODES["modified_coulomb"] or friction[0] == 0.0:
        what = "resistance to rolling and spinning comes in with speed as sliding friction does"
        hint = "take `modified_coulomb`, with `v0`, `v1` and a `coefficient` above 0"
        raise ScenarioError(what, hint, ("contact",))
    if spec.ball.radius == 0.0:
        what = "a point neither rolls nor spins"
        raise ScenarioError(what, "give the ball a radius, or no levers", ("ball", "radius"))
