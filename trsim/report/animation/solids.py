"""Simple solids as triangles: places (n, 3), outward unit normals (n, 3), triangles (m, 3).

Edges are sharp: corners stand once for every face that meets there.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.elements.joint import perpendicular

Array = NDArray[np.float64]

ROUND = 24  # corners of a circle
WINDING, WIRE = 12, 6  # of a turn of a coil, of its wire


class Mesh(NamedTuple):
    points: Array  # (n, 3) m
    normals: Array  # (n, 3)
    triangles: NDArray[np.int64]  # (m, 3), anticlockwise seen from outside

    def moved(self, by: Array) -> "Mesh":
        return self._replace(points=self.points + by)


def joined(*parts: Mesh) -> Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0, *(len(part.points) for part in parts)])
    triangles = [part.triangles + start for part, start in zip(parts, starts, strict=False)]
    return Mesh(
        np.concatenate([part.points for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.concatenate(triangles),
    )


def frame(axis: Array) -> Array:
    """Rows: two directions across an axis, and the axis; x, y, z of z."""
    return np.array(perpendicular(tuple(axis)))


def prism(outline: Array, thickness: float, axis: Array, smooth: bool = False) -> Mesh:
    """A convex outline (n, 2), anticlockwise about the axis, thick to both sides of its plane.

    smooth: the side is shaded as round.
    """
    flat = np.asarray(outline)
    n, axes, half = len(flat), frame(axis), 0.5 * thickness
    ring = flat @ axes[:2]
    up, down = ring + half * axes[2], ring - half * axes[2]
    fan = np.array([[0, k, k + 1] for k in range(1, n - 1)])
    ends = joined(
        Mesh(up, np.tile(axes[2], (n, 1)), fan),
        Mesh(down, np.tile(-axes[2], (n, 1)), fan[:, ::-1]),
    )
    along = np.roll(flat, -1, axis=0) - flat
    out = np.stack([along[:, 1], -along[:, 0]], axis=1)
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    first = last = out
    if smooth:
        mean = out + np.roll(out, 1, axis=0)
        first = mean / np.linalg.norm(mean, axis=1, keepdims=True)
        last = np.roll(first, -1, axis=0)
    after = np.roll(np.arange(n), -1)
    points = np.stack([down, down[after], up[after], up], axis=1).reshape(-1, 3)
    normals = np.stack([first, last, last, first], axis=1).reshape(-1, 2) @ axes[:2]
    return joined(ends, Mesh(points, normals, quads(n)))


def quads(n: int) -> NDArray[np.int64]:
    """Two triangles for each of n faces of four corners."""
    return (4 * np.arange(n)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)


def circle(radius: float, corners: int = ROUND) -> Array:
    angle = 2.0 * np.pi * np.arange(corners) / corners
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def cylinder(radius: float, length: float, axis: Array) -> Mesh:
    """About its middle."""
    return prism(circle(radius), length, axis, smooth=True)


def box(sides: Array, axes: Array) -> Mesh:
    """About its middle; sides (3) along the rows of axes (3, 3), which are right-handed."""
    x, y = 0.5 * sides[0], 0.5 * sides[1]
    block = prism(np.array([[-x, -y], [x, -y], [x, y], [-x, y]]), sides[2], np.array([0, 0, 1.0]))
    return Mesh(block.points @ axes, block.normals @ axes, block.triangles)


def bar(a: Array, b: Array, radius: float, thickness: float, axis: Array) -> Mesh:
    """A flat link with round ends, from a to b, which lie in a plane across the axis."""
    axes = frame(axis)
    p, q = axes[:2] @ a, axes[:2] @ b
    heading = np.arctan2(*(q - p)[::-1])
    half = np.linspace(-0.5 * np.pi, 0.5 * np.pi, ROUND // 2 + 1) + heading
    arc = radius * np.stack([np.cos(half), np.sin(half)], axis=1)
    outline = np.concatenate([q + arc, p - arc])
    return prism(outline, thickness, axis, smooth=True).moved((axes[2] @ a) * axes[2])


def ring(inner: float, outer: float, length: float, axis: Array, corners: int = ROUND) -> Mesh:
    """A tube about its middle."""
    axes = frame(axis)
    spokes = circle(1.0, corners) @ axes[:2]
    up = np.tile(axes[2], (corners, 1))
    profile = [(outer, -1.0), (outer, 1.0), (inner, 1.0), (inner, -1.0)]
    edges = [r * spokes + 0.5 * side * length * up for r, side in profile]
    outward = [spokes, up, -spokes, -up]
    parts = []
    after = np.roll(np.arange(corners), -1)
    for k, normal in enumerate(outward):
        low, high = edges[k], edges[(k + 1) % 4]
        points = np.stack([low, low[after], high[after], high], axis=1).reshape(-1, 3)
        normals = np.stack([normal, normal[after], normal[after], normal], axis=1).reshape(-1, 3)
        parts.append(Mesh(points, normals, quads(corners)))
    return joined(*parts)


def turned_profile(profile: Array, axis: Array, corners: int = ROUND) -> Mesh:
    """A profile (n, 4) of radius, height and their normal, turned about an axis; n >= 2."""
    axes = frame(axis)
    angle = 2.0 * np.pi * np.arange(corners + 1) / corners
    spokes = np.stack([np.cos(angle), np.sin(angle)], axis=1) @ axes[:2]
    r, z, n_r, n_z = (column[:, None, None] for column in np.asarray(profile).T)
    points = (r * spokes + z * axes[2]).reshape(-1, 3)
    normals = (n_r * spokes + n_z * axes[2]).reshape(-1, 3)
    return Mesh(points, normals, skin(len(r), corners))


def skin(rings: int, corners: int) -> NDArray[np.int64]:
    """Triangles between rings, each of that many corners with the first once more at its end."""
    wide = corners + 1
    low = (wide * np.arange(rings - 1)[:, None] + np.arange(corners)).reshape(-1)
    return np.concatenate([
        np.stack([low, low + 1, low + wide + 1], axis=1),
        np.stack([low, low + wide + 1, low + wide], axis=1),
    ])  # fmt: skip


def rod(a: Array, b: Array, radius: float) -> Mesh:
    """A round bar with the ends of a ball, from a to b; a ball where they are one."""
    a, b = np.asarray(a), np.asarray(b)
    length = float(np.linalg.norm(b - a))
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 10)
    height = radius * np.sin(angle) + np.where(np.arange(10) < 5, 0.0, length)
    profile = np.stack([radius * np.cos(angle), height, np.cos(angle), np.sin(angle)], axis=1)
    along = b - a if length > 0.0 else np.array([0.0, 0.0, 1.0])
    return turned_profile(profile, along, 16).moved(a)


def ball(radius: float) -> Mesh:
    return rod(np.zeros(3), np.zeros(3), radius)


def tube() -> Mesh:
    """A round tube of radius and length 1 from the origin along x, to be scaled."""
    profile = np.array([[1.0, 0.0, 1.0, 0.0], [1.0, 1.0, 1.0, 0.0]])
    return turned_profile(profile, np.array([1.0, 0.0, 0.0]), 12)


def arrow(head: float = 0.28, shaft: float = 0.42) -> Mesh:
    """An arrow of length 1 along x with its tip in the origin; its head has radius 1."""
    slope = np.hypot(1.0, head)
    n_r, n_x = head / slope, 1.0 / slope
    profile = np.array([
        [0.0, -1.0, 0.0, -1.0], [shaft, -1.0, 0.0, -1.0],
        [shaft, -1.0, 1.0, 0.0], [shaft, -head, 1.0, 0.0],
        [shaft, -head, 0.0, -1.0], [1.0, -head, 0.0, -1.0],
        [1.0, -head, n_r, n_x], [0.0, 0.0, n_r, n_x],
    ])  # fmt: skip
    return turned_profile(profile, np.array([1.0, 0.0, 0.0]), 16)


def coil(length: float, radius: float, wire: float, turns: float, winding: int = WINDING,
         sides: int = WIRE) -> Mesh:  # fmt: skip
    """A spring from the origin along x: a wire by its radius, wound by another about the axis.

    winding, sides: corners of a turn, and of the wire.
    """
    corners = int(np.ceil(winding * turns))
    along = 2.0 * np.pi * turns * np.linspace(0.0, 1.0, corners + 1)
    # at both ends the wire closes to a point
    thick = np.pad(np.full(len(along), wire), 1)[:, None, None]
    angle = 2.0 * np.pi * np.linspace(0.0, 1.0, sides + 1)
    t, around = np.meshgrid(np.pad(along, 1, mode="edge"), angle, indexing="ij")
    pitch, level = length / (2.0 * np.pi * turns), np.zeros_like(t)
    out = np.stack([level, np.cos(t), np.sin(t)], axis=2)
    heading = np.stack([level + pitch, -radius * np.sin(t), radius * np.cos(t)], axis=2)
    aside = np.cross(heading / np.hypot(pitch, radius), out)
    normals = np.cos(around)[..., None] * out + np.sin(around)[..., None] * aside
    points = np.stack([pitch * t, level, level], axis=2) + radius * out + thick * normals
    return Mesh(points.reshape(-1, 3), normals.reshape(-1, 3), skin(len(t), sides))
