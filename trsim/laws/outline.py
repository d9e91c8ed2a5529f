"""Outlines: polygons given by their corners [x, y], in order, either way round."""

from collections.abc import Sequence
from typing import Any

Corners = Sequence[tuple[float, float]]


def area(corners: Corners) -> float:
    """Of a polygon, m^2: half the sum of p x q of its sides, seen from its first corner."""
    x, y = corners[0]
    seen = [(a - x, b - y) for a, b in corners]
    sides = zip(seen, [*seen[1:], seen[0]], strict=True)
    return abs(0.5 * sum(a * d - b * c for (a, b), (c, d) in sides))


def crossed(corners: Corners) -> tuple[int, int] | None:
    """Two sides of a polygon that meet where they should not; None where it is simple."""
    n = len(corners)
    sides = [(corners[k], corners[(k + 1) % n]) for k in range(n)]
    for k, (a, b) in enumerate(sides):
        for o in range(k + 1, n):
            c, d = sides[o]
            if o == k + 1 or (o + 1) % n == k:  # neighbours share a corner; they must not fold back
                one, two = (a, d) if o == k + 1 else (b, c)
                corner = b if o == k + 1 else a
                if _side(corner, one, two) == 0.0 and _along(corner, one, two) > 0.0:
                    return k, o
            elif _meet(a, b, c, d):
                return k, o
    return None


def _side(a: Any, b: Any, c: Any) -> float:
    """Twice the area of a triangle, with its sense."""
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _along(a: Any, b: Any, c: Any) -> float:
    """(b - a) . (c - a)"""
    return float((b[0] - a[0]) * (c[0] - a[0]) + (b[1] - a[1]) * (c[1] - a[1]))


def _meet(a: Any, b: Any, c: Any, d: Any) -> bool:
    """Whether two segments have a point in common."""
    of_c, of_d, of_a, of_b = _side(a, b, c), _side(a, b, d), _side(c, d, a), _side(c, d, b)
    if of_c == of_d == 0.0:  # on one line
        return any(_along(p, a, b) <= 0.0 for p in (c, d)) or _along(a, c, d) <= 0.0
    return of_c * of_d <= 0.0 and of_a * of_b <= 0.0
