"""Outlines that touch what is round outside: how far a straight side is from it, and where.

A side is a line from a to b in the axes of the surface, as seen in their x-y plane; the nearest of
its places is a + u (b - a).

    cylinder   s = |a + u (b - a)| - R           u: of the foot of the axis, at most an end
    profile    of its arcs that are seen from the side in a direction that they have, the nearest

What is round outside and straight sides are convex, so no two places far apart are equally near.
"""

from math import inf, sqrt

from trsim.kernels.lazy import internal
from trsim.laws.surfaces import GROUP, PROFILE, ROUNDING, SIZE, STRAIGHT, off_piece


@internal
def beside_side(tab, own, a, b):
    """How far a side is from a surface, and u.

    Parameters
    ----------
    tab, own             as of `away`; what is free inside has none
    a, b : (3) float     m; z is not looked at

    Returns
    -------
    (float, float)       s, m, and u
    """
    if own.shape == PROFILE:
        return beside_profile(tab, own.profile, a, b)
    far, _, _, u = from_place(0.0, 0.0, a, b)
    return far - own.radius, u


@internal
def from_place(x, y, a, b):
    """How far a side is from a place, the way there, and u."""
    x, y, along, up = a[0] - x, a[1] - y, b[0] - a[0], b[1] - a[1]
    square, u = along * along + up * up, 0.0
    if square > 0.0:
        u = min(max(-(x * along + y * up) / square, 0.0), 1.0)
    x, y = x + u * along, y + u * up
    return sqrt(x * x + y * y), x, y, u


@internal
def beside_profile(tab, o, a, b):
    """The same of a closed profile that is round outside.

    Groups that are further away than another one at most is are not looked at.
    """
    groups, surely = int(tab[o]), inf
    if groups > 1:
        for g in range(groups):
            place = o + 1 + GROUP * g
            far, _, _, _ = from_place(tab[place], tab[place + 1], a, b)
            surely = min(surely, far + tab[place + 2])
    nearest, at = inf, 0.0
    for g in range(groups):
        place = o + 1 + GROUP * g
        far, _, _, _ = from_place(tab[place], tab[place + 1], a, b)
        if groups > 1 and far - tab[place + 2] > min(surely, nearest):
            continue
        first = o + int(tab[place + 3])
        for k in range(int(tab[place + 4])):
            s, u = off_arc(tab, first + SIZE * k, a, b)
            if s < nearest:
                nearest, at = s, u
    return nearest, at


@internal
def off_arc(tab, place, a, b):
    """How far a side is from a piece, and u; inf where it lies in no direction of it."""
    if tab[place] == STRAIGHT:  # shorter than anybody sees: its ends are those of arcs
        _, s, _, _ = off_piece(tab, place, 1, a[0], a[1])
        _, t, _, _ = off_piece(tab, place, 1, b[0], b[1])
        s, t = s if s > 0.0 else inf, t if t > 0.0 else inf
        return (s, 0.0) if s <= t else (t, 1.0)
    far, x, y, u = from_place(tab[place + 1], tab[place + 2], a, b)
    if far == 0.0 or x * tab[place + 4] + y * tab[place + 5] < (tab[place + 6] - ROUNDING) * far:
        return inf, 0.0
    return far - tab[place + 3], u
