"""What a body weighs: mass, centre and inertia of its solids, in world axes as drawn."""

from typing import Any

import numpy as np

from trsim.arrays import Array
from trsim.elements.joint import triad
from trsim.elements.solid import Solid
from trsim.errors import ScenarioError
from trsim.frame import Frame
from trsim.laws import solids
from trsim.laws.solids import Bulk


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


def own_density(of: Solid) -> float | None:
    """The density a solid has of its own; None where it has that of its body."""
    return of.mass / shape(of).mass if of.mass is not None else of.density


def of_solid(of: Solid, density: float | None) -> Bulk:
    """Mass, centre and inertia of a solid; of a hole negative ones.

    density: kg/m^3, of a solid that has none of its own.  Raises ScenarioError without any.
    """
    own = own_density(of) or density
    if own is None:
        hint = "give the body a `density` or a `mass`, or the solid one of them"
        raise ScenarioError("a solid without a density", hint)
    axes: Any = tuple(zip(*triad(of), strict=True))
    return solids.placed(shape(of), -own if of.hole else own, of.at, axes)


def of_solids(parts: tuple[Solid, ...], density: float | None, mass: float | None) -> Bulk:
    """What solids are together.

    density: of those that have none of their own; mass: what all of them weigh, which their
    densities are scaled to.  Raises ScenarioError with the place among the parts.
    """
    if density is None and mass is not None and all(own_density(part) is None for part in parts):
        density = 1.0  # any: it is scaled
    found = []
    for k, part in enumerate(parts):
        try:
            found.append(of_solid(part, density))
        except ScenarioError as error:
            raise error.at(k) from None
    if sum(one.mass for one in found) <= 0.0:
        raise ScenarioError("its holes take away more than there is", "check their sizes")
    whole = solids.together(found)
    if not solids.possible(whole.inertia):
        what = "no body has such an inertia: a hole lies outside of what it is taken from"
        raise ScenarioError(what, "check `at` and the sizes of the holes")
    scale = 1.0 if mass is None else mass / whole.mass
    return Bulk(scale * whole.mass, whole.centre, scale * whole.inertia)


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
