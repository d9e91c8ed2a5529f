"""What a body weighs, and a part of it beyond a plane: mass, centre and inertia of its solids, in
world axes as drawn."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array
from trsim.elements.joint import triad
from trsim.elements.solid import Solid
from trsim.errors import ScenarioError
from trsim.frame import Frame
from trsim.laws import cut_solids, solids
from trsim.laws.solids import Bulk, possible, together

ROUNDING = 1e-12  # of a mass: so little is none
NEAR = 1e-9  # of what follows from a shape: what is as near is the same
NOTHING = Bulk(0.0, np.zeros(3), np.zeros((3, 3)))


def shape(of: Solid) -> Bulk:
    """Volume, centre and second moments of a solid, in its own axes."""
    length = of.length or 0.0
    if of.box is not None:
        return solids.box(*of.box)
    if of.polygon is not None:
        return solids.prism(of.polygon, length)
    outer = 0.5 * (of.cylinder or of.sphere or 0.0)
    inner = outer - of.wall if of.wall else 0.0
    if of.sphere is not None:
        return solids.sphere(outer, inner)
    return solids.cylinder(outer, inner, length)


def cut(of: Solid, n: Array, d: float) -> Bulk:
    """The same of the part n . x > d of a solid, in its own axes."""
    length = of.length or 0.0
    if of.box is not None:
        return cut_solids.box(*of.box, n, d)
    if of.polygon is not None:
        return cut_solids.prism(of.polygon, length, n, d)
    outer = 0.5 * (of.cylinder or of.sphere or 0.0)
    inner = outer - of.wall if of.wall else 0.0
    if of.sphere is not None:
        return cut_solids.sphere(outer, inner, n, d)
    return cut_solids.cylinder(outer, inner, length, n, d)


def own_density(of: Solid) -> float | None:
    """The density a solid has of its own; None where it has that of its body."""
    return of.mass / shape(of).mass if of.mass is not None else of.density


Plane = tuple[Any, Any]  # a point of it, and the unit normal that points to the part that counts


def of_solid(of: Solid, density: float | None, plane: Plane | None = None) -> Bulk:
    """Mass, centre and inertia of a solid, or of its part beyond a plane; of a hole negative ones.

    density: kg/m^3, of a solid that has none of its own.  Raises ScenarioError without any.
    """
    own = own_density(of) or density
    if own is None:
        hint = "give the body a `density` or a `mass`, or the solid one of them"
        raise ScenarioError("a solid without a density", hint)
    axes: Any = tuple(zip(*triad(of), strict=True))
    whole = shape(of)
    if plane is not None:
        R = np.array(axes)
        n = R.T @ np.array(plane[1])
        whole = cut(of, n, float(np.array(plane[1]) @ (np.array(plane[0]) - np.array(of.at))))
    return solids.placed(whole, -own if of.hole else own, of.at, axes)


def each(
    parts: tuple[Solid, ...], density: float | None, mass: float | None, plane: Plane | None = None
) -> list[Bulk]:
    """What each solid is, before their densities are scaled to a mass."""
    if density is None and mass is not None and all(own_density(part) is None for part in parts):
        density = 1.0  # any: it is scaled
    found = []
    for k, part in enumerate(parts):
        try:
            found.append(of_solid(part, density, plane))
        except ScenarioError as error:
            raise error.at(k) from None
    return found


def of_solids(parts: tuple[Solid, ...], density: float | None, mass: float | None) -> Bulk:
    """What solids are together.

    density: of those that have none of their own; mass: what all of them weigh, which their
    densities are scaled to.  Raises ScenarioError with the place among the parts.
    """
    found = each(parts, density, mass)
    if sum(one.mass for one in found) <= 0.0:
        raise ScenarioError("its holes take away more than there is", "check their sizes")
    whole = solids.together(found)
    if not solids.possible(whole.inertia):
        what = "no body has such an inertia: a hole lies outside of what it is taken from"
        raise ScenarioError(what, "check `at` and the sizes of the holes")
    scale = 1.0 if mass is None else mass / whole.mass
    return Bulk(scale * whole.mass, whole.centre, scale * whole.inertia)


class Part(NamedTuple):
    """What a plane leaves of a body, and how the body differs from its shape."""

    beyond: Bulk
    differs: tuple[str, ...]  # centre, inertia: where they are not those of the shape


def beyond(body: Any, plane: Plane) -> Part:
    """The part of a body with a shape beyond a plane, scaled to what the body weighs.

    Raises ScenarioError where holes take away more than there is.
    """
    mass = body.mass if body.says("mass") else None
    whole = together(each(body.shape, body.density, mass))
    found = [one for one in each(body.shape, body.density, mass, plane) if one.mass]
    scale, least = body.mass / whole.mass, ROUNDING * sum(abs(one.mass) for one in found)
    part = together(found) if abs(sum(one.mass for one in found)) > least else NOTHING
    if part.mass < 0.0 or not possible(part.inertia):
        what = "beyond the section its holes take away more than there is"
        raise ScenarioError(what, "check `at` and the sizes of the holes")
    if whole.mass - part.mass <= ROUNDING * whole.mass:
        part = whole
    weighs = min(scale * part.mass, body.mass)  # not more by rounding
    found_part = Bulk(weighs, part.centre, scale * part.inertia)
    return Part(found_part, tuple(differing(body, whole, scale * whole.inertia)))


def differing(body: Any, whole: Bulk, inertia: Array) -> Iterator[str]:
    """What of a body is not as its shape has it."""
    own = of_body(body)
    size = np.sqrt(np.trace(whole.inertia) / whole.mass)
    if np.abs(own.centre - whole.centre).max() > NEAR * size:
        yield "centre"
    off = own.inertia - inertia
    off = off if body.tensor[1] else off[2:, 2:]  # nothing else is known of it
    if np.abs(off).max() > NEAR * np.abs(inertia).max():
        yield "inertia"


def of_body(body: Any) -> Bulk:
    """The same of a body as it is written."""
    rigid = body.as_rigid()
    inertia = turned(rigid, np.reshape(rigid.tensor[0], (3, 3)))
    return Bulk(rigid.mass, np.array(rigid.at), inertia)


def turned(body: Any, tensor: Array, into_body: bool = False) -> Array:
    """A tensor (3, 3) from the axes of a rigid body into those of the world; or back."""
    c, s = np.cos(body.angle), np.sin(body.angle)
    R = np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
    R = axes_of(body.drawn_in) @ R
    return R.T @ tensor @ R if into_body else R @ tensor @ R.T


def axes_of(frame: Frame | None) -> Array:
    """The axes of a frame, or the world's, as columns."""
    return np.eye(3) if frame is None else np.array((frame.x, frame.y, frame.z)).T
