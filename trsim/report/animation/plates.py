"""Plates of any outline, and what has one outline inside another one."""

import numpy as np
from numpy.typing import NDArray

from trsim.report.animation.solids import Array, Mesh, joined, quads

SHARP = 0.9  # cosine: sides that turn by less are shaded as one


def anticlockwise(outline: Array) -> Array:
    """The outline (n, 2) in that order."""
    x, y = outline.T
    twice = x @ np.roll(y, -1) - y @ np.roll(x, -1)
    return outline if twice >= 0.0 else outline[::-1]


def plate(outline: Array, thickness: float, axes: Array) -> Mesh:
    """A simple outline (n, 2), either way round, thick to both sides of its plane.

    axes: right-handed, (3, 3) rows; the outline lies along the first two.
    """
    flat = anticlockwise(np.asarray(outline, dtype=float))
    half = 0.5 * thickness
    ring, ears = flat @ axes[:2], triangles(flat)
    up, down = ring + half * axes[2], ring - half * axes[2]
    normal = np.tile(axes[2], (len(flat), 1))
    ends = joined(Mesh(up, normal, ears), Mesh(down, -normal, ears[:, ::-1]))
    return joined(ends, side(flat, (-half, half), axes))


def annulus(outer: Array, inner: Array, thickness: float, axes: Array) -> Mesh:
    """Between two outlines (n, 2) of as many corners, both anticlockwise."""
    half, n = 0.5 * thickness, len(outer)
    k = np.arange(n)
    after = np.roll(k, -1)
    strip = np.concatenate([np.stack([k, after, n + after], 1), np.stack([k, n + after, n + k], 1)])
    both = np.concatenate([outer, inner]) @ axes[:2]
    normal = np.tile(axes[2], (2 * n, 1))
    ends = (
        Mesh(both + half * axes[2], normal, strip),
        Mesh(both - half * axes[2], -normal, strip[:, ::-1]),
    )
    return joined(*ends, side(outer, (-half, half), axes), side(inner[::-1], (-half, half), axes))


def side(flat: Array, heights: tuple[float, float], axes: Array) -> Mesh:
    """The side of a closed outline, from one height to another; round where it is all but so."""
    along = np.roll(flat, -1, axis=0) - flat
    out = np.stack([along[:, 1], -along[:, 0]], axis=1)
    out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-300)
    before = np.roll(out, 1, axis=0)
    mean = out + before
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-300)
    round_ = np.sum(out * before, axis=1, keepdims=True) > SHARP
    first = np.where(round_, mean, out)
    last = np.where(np.roll(round_, -1, axis=0), np.roll(mean, -1, axis=0), out)
    ring = flat @ axes[:2]
    down, up = (ring + height * axes[2] for height in heights)
    after = np.roll(np.arange(len(flat)), -1)
    points = np.stack([down, down[after], up[after], up], axis=1).reshape(-1, 3)
    normals = np.stack([first, last, last, first], axis=1).reshape(-1, 2) @ axes[:2]
    return Mesh(points, normals, quads(len(flat)))


def triangles(flat: Array) -> NDArray[np.int64]:
    """The triangles of a simple outline that goes anticlockwise, by cutting its ears."""
    left, found = list(range(len(flat))), []
    while len(left) > 3:
        k = ear(flat, left)
        found.append([left[k - 1], left[k], left[(k + 1) % len(left)]])
        del left[k]
    return np.array([*found, left])


def ear(flat: Array, left: list[int]) -> int:
    """Which of the corners that are left can be cut: no other one is in its triangle.

    Of several the one whose triangle is fattest; where rounding hides all, the most convex one.
    """
    there = flat[left]
    a, c = np.roll(there, 1, axis=0), np.roll(there, -1, axis=0)
    area = cross(there - a, c - there)
    longest = np.maximum.reduce([np.sum((p - q) ** 2, axis=1)
                                 for p, q in ((a, there), (there, c), (c, a))])  # fmt: skip
    order = np.argsort(-area / np.maximum(longest, 1e-300), kind="stable")
    for k in order:
        if area[k] < 0.0:
            break
        p, q, r = a[k], there[k], c[k]
        inside = (cross(q - p, there - p) >= 0.0) & (cross(r - q, there - q) >= 0.0)
        inside &= cross(p - r, there - r) >= 0.0
        # neighbours and corners that lie on them are no hindrance
        for corner in (p, q, r):
            inside &= np.any(there != corner, axis=1)
        if not inside.any():
            return int(k)
    return int(order[0])


def cross(a: Array, b: Array) -> Array:
    """a x b of vectors of a plane, (n)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
