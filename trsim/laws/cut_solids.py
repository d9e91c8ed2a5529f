"""The part of a solid on one side of a plane: volume, centre and second moments, as in solids.py.

    n . x > d                  the part that counts, in the axes of the solid

    box, prism    tetrahedra, each cut by the plane into one to three others
                  V = |det|/6,  int x dV = V s/4,  int x x^T dV = V/20 (sum v v^T + s s^T),
                  s the sum of the corners v
    sphere        discs along n, polynomials in their height: three nodes of Gauss are exact
    cylinder      slices x = R cos phi across the plane of n and the axis: rectangles, whose edge on
                  the plane is z = (d - n_x x)/n_z; polynomials in cos phi and sin phi, integrated
                  between the angles where the plane meets an end, to rounding

Signed triangles from one point make any polygon.  A tube is a cylinder less one.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from math import acos, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from trsim.arrays import Array
from trsim.laws.solids import Bulk

GAUSS = ((-sqrt(0.6), 5.0 / 9.0), (0.0, 8.0 / 9.0), (sqrt(0.6), 5.0 / 9.0))  # to degree 5
# to degree 9, nodes within: at the ends of an interval of phi a slice may begin.  PARTS of such an
# interval, of whose powers of cos and sin the error is below rounding
PARTS = 32
_near, _far = (sqrt(5.0 + side * 2.0 * sqrt(10.0 / 7.0)) / 3.0 for side in (-1.0, 1.0))
_of_near, _of_far = ((322.0 + side * 13.0 * sqrt(70.0)) / 900.0 for side in (1.0, -1.0))
FIVE = ((-_far, _of_far), (-_near, _of_near), (0.0, 128.0 / 225.0), (_near, _of_near),
        (_far, _of_far))  # fmt: skip


class Moments(NamedTuple):
    """int 1, x, x x^T dV about the origin."""

    volume: float
    first: Array  # (3,)
    second: Array  # (3, 3)


NONE = Moments(0.0, np.zeros(3), np.zeros((3, 3)))


def bulk(of: Moments) -> Bulk:
    """The inertia about the centre."""
    if of.volume <= 0.0:
        return Bulk(0.0, np.zeros(3), np.zeros((3, 3)))
    centre = of.first / of.volume
    square = of.second - of.volume * np.outer(centre, centre)
    return Bulk(of.volume, centre, float(np.trace(square)) * np.eye(3) - square)


def less(one: Moments, other: Moments) -> Moments:
    """What is left without another one."""
    return Moments(one.volume - other.volume, one.first - other.first, one.second - other.second)


# --- boxes and plates ----------------------------------------------------------------------------


def box(a: float, b: float, c: float, n: Array, d: float) -> Bulk:
    """Edges along x, y, z; about its middle."""
    x, y = 0.5 * a, 0.5 * b
    return prism(((-x, -y), (x, -y), (x, y), (-x, y)), c, n, d)


def prism(corners: Sequence[tuple[float, float]], length: float, n: Array, d: float) -> Bulk:
    """A polygon of the x-y plane, from -length/2 to length/2 along z; corners either way round."""
    first = np.array(corners, dtype=float)
    origin = first.mean(axis=0)  # moments about a place inside lose no digits
    d = d - float(n[0] * origin[0] + n[1] * origin[1])
    volume, once, twice = 0.0, np.zeros(3), np.zeros((3, 3))
    p = first - origin
    for a, b in zip(p, np.roll(p, -1, axis=0), strict=True):
        sense = 1.0 if a[0] * b[1] - a[1] * b[0] > 0.0 else -1.0
        found = of_tetrahedra(
            cut for whole in upright(a, b, length) for cut in clipped(whole, n, d)
        )
        volume += sense * found.volume
        once += sense * found.first
        twice += sense * found.second
    if volume < 0.0:  # clockwise
        volume, once, twice = -volume, -once, -twice
    part = bulk(Moments(volume, once, twice))
    return part._replace(centre=part.centre + np.array((origin[0], origin[1], 0.0)))


def upright(a: Array, b: Array, length: float) -> Iterator[Array]:
    """The tetrahedra of the triangle of two corners and the origin, over the whole length."""
    low, high = -0.5 * length, 0.5 * length
    feet = np.array([(0.0, 0.0, low), (*a, low), (*b, low)])
    return wedge(feet, feet + np.array((0.0, 0.0, high - low)))


def wedge(low: Array, high: Array) -> Iterator[Array]:
    """The tetrahedra between two triangles whose corners are joined, in plane sides."""
    yield np.array((low[0], low[1], low[2], high[2]))
    yield np.array((low[0], low[1], high[2], high[1]))
    yield np.array((low[0], high[0], high[1], high[2]))


def clipped(corners: Array, n: Array, d: float) -> Iterator[Array]:
    """The tetrahedra that are left of one, (4, 3)."""
    height = corners @ n - d
    order = np.argsort(-height, kind="stable")
    v, h = corners[order], height[order]
    inside = int((h > 0.0).sum())

    def on(a: int, b: int) -> Array:
        """Where the edge from a corner inside to one that is not meets the plane."""
        met: Array = v[a] + h[a] / (h[a] - h[b]) * (v[b] - v[a])
        return met

    if inside == 4:
        yield v
    elif inside == 3:
        yield from wedge(v[:3], np.array((on(0, 3), on(1, 3), on(2, 3))))
    elif inside == 2:
        near, far = (v[0], on(0, 2), on(0, 3)), (v[1], on(1, 2), on(1, 3))
        yield from wedge(np.array(near), np.array(far))
    elif inside == 1:
        yield np.array((v[0], on(0, 1), on(0, 2), on(0, 3)))


def of_tetrahedra(parts: Iterable[Array]) -> Moments:
    """All of them together."""
    volume, once, twice = 0.0, np.zeros(3), np.zeros((3, 3))
    for v in parts:
        a, b, c = v[1] - v[0], v[2] - v[0], v[3] - v[0]
        one = abs(float(a @ np.cross(b, c))) / 6.0
        s = v.sum(axis=0)
        volume += one
        once += one * s / 4.0
        twice += one / 20.0 * (v.T @ v + np.outer(s, s))
    return Moments(volume, once, twice)


# --- balls ---------------------------------------------------------------------------------------


def sphere(outer: float, inner: float, n: Array, d: float) -> Bulk:
    """Radii; about its middle."""
    return bulk(less(cap(outer, n, d), cap(inner, n, d)))


def cap(radius: float, n: Array, d: float) -> Moments:
    """A full ball."""
    low = min(max(d, -radius), radius)
    volume = height = along = across = 0.0
    for node, weight in GAUSS:
        z = 0.5 * (low + radius) + 0.5 * (radius - low) * node
        square = (radius - z) * (radius + z)
        slab = 0.5 * (radius - low) * weight * pi * square
        volume += slab
        height += slab * z
        along += slab * z * z
        across += slab * square / 4.0
    nn = np.outer(n, n)
    return Moments(volume, height * n, along * nn + across * (np.eye(3) - nn))


# --- cylinders -----------------------------------------------------------------------------------


def cylinder(outer: float, inner: float, length: float, n: Array, d: float) -> Bulk:
    """Radii, about the z axis; about its middle."""
    return bulk(less(full(outer, length, n, d), full(inner, length, n, d)))


def full(radius: float, length: float, n: Array, d: float) -> Moments:
    """A cylinder without a bore."""
    if radius == 0.0:
        return NONE
    s, c, half = hypot(n[0], n[1]), float(n[2]), 0.5 * length
    e = (n[0] / s, n[1] / s) if s > 0.0 else (1.0, 0.0)
    axes = np.array(((e[0], -e[1], 0.0), (e[1], e[0], 0.0), (0.0, 0.0, 1.0)))
    ends = [x / s for x in (d - c * half, d + c * half) if abs(x) < s * radius]
    angles = [0.0, *sorted(acos(x / radius) for x in ends), pi]
    total = np.zeros(7)
    for low, high in pairwise(angles):
        total += slices(radius, half, (s, c, d), low, high)
    volume, x, z, xx, yy, zz, xz = total
    second = np.array(((xx, 0.0, xz), (0.0, yy, 0.0), (xz, 0.0, zz)))
    return Moments(float(volume), axes @ (x, 0.0, z), axes @ second @ axes.T)


def slices(
    radius: float, half: float, plane: tuple[float, float, float], low: float, high: float
) -> Array:
    """int 1, x, z, x^2, y^2, z^2, x z dV over x = R cos phi, phi from low to high, where
    s x + c z > d."""
    s, c, d = plane
    total, h = np.zeros(7), (high - low) / PARTS
    for k in range(PARTS):
        for node, weight in FIVE:
            phi = low + h * (k + 0.5 + 0.5 * node)
            x, w = radius * cos(phi), radius * sin(phi)
            below, above = heights(half, s * x - d, c)
            long, mean = above - below, 0.5 * (above + below)
            area = 0.5 * h * weight * w * 2.0 * w * long  # dx = w dphi
            square = mean * mean + long * long / 12.0
            total += area * np.array((1.0, x, mean, x * x, w * w / 3.0, square, x * mean))
    return total


def heights(half: float, over: float, c: float) -> tuple[float, float]:
    """From where to where c z > -over, within the ends."""
    if abs(over) >= abs(c) * half:  # the plane is beyond the ends
        return (-half, half) if over > 0.0 else (0.0, 0.0)
    met = -over / c
    return (met, half) if c > 0.0 else (-half, met)
