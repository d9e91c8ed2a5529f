"""Volume, centre and second moments of simple solids, and of what they make together.

    box           V = a b c             J = V/12 (b^2 + c^2, c^2 + a^2, a^2 + b^2)
    cylinder      V = pi (R^2 - r^2) L  J_z = V/2 (R^2 + r^2)
                                        J_x = J_y = V/12 (3 (R^2 + r^2) + L^2)
    sphere        V = 4/3 pi (R^3 - r^3)           J = 8/15 pi (R^5 - r^5)
    prism         of a polygon: area, centre and second moments by Green's theorem

    together      m = sum m_k,  c = sum m_k c_k / m,
                  J = sum J_k + m_k (|d_k|^2 1 - d_k d_k^T),  d_k = c_k - c

J is the inertia tensor about the centre for a density of 1; a hole counts with a negative mass.
R and r are the outer and the inner radius, z the axis.
"""

from collections.abc import Iterable, Sequence
from math import pi
from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array

ROUNDING = 1e-12  # of the trace of a tensor


class Bulk(NamedTuple):
    """A solid, or several together."""

    mass: float  # kg; of a density of 1 the volume, m^3
    centre: Array  # (3,) m
    inertia: Array  # (3, 3) kg m^2, about the centre


def box(a: float, b: float, c: float) -> Bulk:
    """Edges along x, y, z; about its middle."""
    volume = a * b * c
    squares = (b * b + c * c, c * c + a * a, a * a + b * b)
    return Bulk(volume, np.zeros(3), volume / 12.0 * np.diag(squares))


def cylinder(outer: float, inner: float, length: float) -> Bulk:
    """Radii, about the z axis; about its middle."""
    squares = outer * outer + inner * inner
    volume = pi * (outer - inner) * (outer + inner) * length
    across = (3.0 * squares + length * length) / 12.0
    return Bulk(volume, np.zeros(3), volume * np.diag((across, across, 0.5 * squares)))


def sphere(outer: float, inner: float) -> Bulk:
    """Radii; about its middle."""
    volume = 4.0 / 3.0 * pi * (outer**3 - inner**3)
    return Bulk(volume, np.zeros(3), 8.0 / 15.0 * pi * (outer**5 - inner**5) * np.eye(3))


def prism(corners: Sequence[tuple[float, float]], length: float) -> Bulk:
    """A polygon of the x-y plane, from -length/2 to length/2 along z; corners either way round."""
    first = np.array(corners, dtype=float)
    origin = first.mean(axis=0)  # moments about a place inside lose no digits
    p = first - origin
    q = np.roll(p, -1, axis=0)
    cross = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
    area = 0.5 * float(cross.sum())
    if area == 0.0:
        return Bulk(0.0, np.zeros(3), np.zeros((3, 3)))
    centre = (p + q).T @ cross / (6.0 * area)
    # int x_a x_b dA of the triangles with the origin
    square = sum(
        c * (np.outer(a, a) + np.outer(b, b) + np.outer(a + b, a + b))
        for a, b, c in zip(p, q, cross, strict=True)
    ) / (24.0 * area) - np.outer(centre, centre)
    xx, yy, xy = square[0, 0], square[1, 1], square[0, 1]
    thick = length * length / 12.0
    inertia = np.array([[yy + thick, -xy, 0.0], [-xy, xx + thick, 0.0], [0.0, 0.0, xx + yy]])
    volume = abs(area) * length
    return Bulk(volume, np.array([*(centre + origin), 0.0]), volume * inertia)


def placed(one: Bulk, density: float, at: Any, axes: Any) -> Bulk:
    """A solid of a density whose own axes are the columns of `axes` and whose origin is at `at`."""
    R = np.array(axes, dtype=float)
    return Bulk(
        density * one.mass, np.array(at) + R @ one.centre, density * (R @ one.inertia @ R.T)
    )


def together(parts: Iterable[Bulk]) -> Bulk:
    """All of them as one; their mass is not zero."""
    parts = list(parts)
    mass = float(sum(one.mass for one in parts))
    centre = np.sum([one.mass * one.centre for one in parts], axis=0) / mass
    return Bulk(mass, centre, np.sum([moved(one, centre) for one in parts], axis=0))


def moved(one: Bulk, centre: Array) -> Array:
    """The inertia about another point than the centre: Huygens and Steiner."""
    d = one.centre - centre
    return one.inertia + one.mass * (d @ d * np.eye(3) - np.outer(d, d))


def possible(inertia: Array) -> bool:
    """Whether some body has an inertia: int x^2 dm along no principal axis is below zero."""
    trace = float(np.trace(inertia))
    return bool(0.5 * trace - np.linalg.eigvalsh(inertia)[-1] >= -ROUNDING * trace)
