"""Bodies that are made of solids: these as meshes, and holes as the lines of their edges."""

from itertools import product

import numpy as np

from trsim.elements.joint import triad
from trsim.elements.solid import Solid
from trsim.report.animation import solids
from trsim.report.animation.drawing import Array
from trsim.report.animation.plates import anticlockwise, plate
from trsim.report.animation.solids import Mesh

Z = np.array([0.0, 0.0, 1.0])
ROUND = 48  # corners of a circle


def mesh(of: Solid) -> Mesh:
    """A solid in its place as drawn; a hollow sphere as a full one."""
    at, axes = np.array(of.at), np.array(triad(of))
    length = of.length or 0.0
    if of.box is not None:
        own = solids.box(np.array(of.box), np.eye(3))
    elif of.polygon is not None:
        own = plate(np.array(of.polygon), length, np.eye(3))
    elif of.sphere is not None:
        own = solids.ball(0.5 * of.sphere)
    else:
        outer = 0.5 * (of.cylinder or 0.0)
        inner = outer - of.wall if of.wall else 0.0
        own = (solids.ring(inner, outer, length, Z, ROUND) if inner > 0.0
               else solids.prism(solids.circle(outer, ROUND), length, Z, smooth=True))  # fmt: skip
    return Mesh(at + own.points @ axes, own.normals @ axes, own.triangles)


def edges(of: Solid) -> list[tuple[Array, Array]]:
    """The closed lines around the ends of a solid as drawn, (n, 3) each, and the normals of their
    planes; of a sphere three great circles."""
    at, axes = np.array(of.at), np.array(triad(of))
    if of.sphere is not None:
        ring = solids.circle(0.5 * of.sphere)
        return [(at + np.insert(ring, k, 0.0, axis=1) @ axes, axes[k]) for k in range(3)]
    if of.box is not None:
        x, y, length = (0.5 * of.box[0], 0.5 * of.box[1], of.box[2])
        outline = np.array([[-x, -y], [x, -y], [x, y], [-x, y]])
    elif of.polygon is not None:
        outline, length = anticlockwise(np.array(of.polygon)), of.length or 0.0
    else:
        outline, length = solids.circle(0.5 * (of.cylinder or 0.0)), of.length or 0.0
    ends = [np.insert(outline, 2, z, axis=1) for z in (-0.5 * length, 0.5 * length)]
    return [(at + line @ axes, axes[2]) for line in ends]


def box(of: Solid) -> tuple[Array, Array, Array]:
    """Middle (3), half sides (3) and axes (3, 3), rows, of the box around a solid as drawn."""
    at, axes = np.array(of.at), np.array(triad(of))
    half = 0.5 * (of.length or 0.0)
    if of.box is not None:
        return at, 0.5 * np.array(of.box), axes
    if of.sphere is not None:
        return at, np.full(3, 0.5 * of.sphere), axes
    if of.polygon is not None:
        corners = np.array(of.polygon)
        low, high = corners.min(axis=0), corners.max(axis=0)
        middle, sides = 0.5 * (low + high), 0.5 * (high - low)
        return at + middle @ axes[:2], np.array([*sides, half]), axes
    radius = 0.5 * (of.cylinder or 0.0)
    return at, np.array([radius, radius, half]), axes


def boxed(parts: tuple[Solid, ...]) -> list[Array]:
    """The corners of the boxes around solids, as drawn."""
    found = []
    for middle, half, axes in (box(part) for part in parts if not part.hole):
        found += [middle + (half * side) @ axes for side in product((-1.0, 1.0), repeat=3)]
    return found


def nearest(parts: tuple[Solid, ...], at: Array) -> Array:
    """The place nearest to a point in the boxes around solids."""
    places = []
    for middle, half, axes in (box(part) for part in parts if not part.hole):
        places.append(middle + np.clip(axes @ (at - middle), -half, half) @ axes)
    return min(places, key=lambda place: float(np.linalg.norm(place - at)))
