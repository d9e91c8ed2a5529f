"""Outlines that touch what is round outside: how far a straight side is from it, and where.

A side is a line from a to b in the axes of the surface, as seen in their x-y plane; the nearest of
its places is a + u (b - a).

    cylinder   s = |a + u (b - a)| - R           u: of the foot of the axis, at most an end
    profile    of its arcs that are seen from the side in a direction that they have, the nearest

What is round outside and straight sides are convex, so no two places far apart are equally near.
"""

from math import inf, sqrt

from trsim.kernels.lazy import internal
from trsim.laws.surfaces import (
    HEAD,
    NODE,
    PROFILE,
    ROUNDING,
    SIZE,
    STRAIGHT,
    following,
    leaf,
    off_piece,
    to_piece,
)


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

    Of two children of a node the nearer one is looked at first.  Nodes that are further away than
    another one at most is are left out: behind the side there are arcs that have its direction too.
    """
    node, leaves = 1, 1 << int(tab[o + 1])
    while node < leaves:
        node *= 2
        if to_ball(tab, o, node + 1, a, b)[0] < to_ball(tab, o, node, a, b)[0]:
            node += 1
    far, radius = to_ball(tab, o, node, a, b)
    surely = far + radius
    nearest, at = in_leaf(tab, o, node - leaves, a, b, (inf, 0.0))
    while node > 1:
        top = node ^ 1
        node >>= 1
        k = top
        while k > 0:
            far, radius = to_ball(tab, o, k, a, b)
            if far - radius > min(surely, nearest):
                k = following(k, top)
            elif k < leaves:
                k *= 2
            else:
                nearest, at = in_leaf(tab, o, k - leaves, a, b, (nearest, at))
                k = following(k, top)
    return nearest, at


@internal
def to_ball(tab, o, node, a, b):
    """How far a side is from the middle of the box of a node, and how far its corners are."""
    k = o + HEAD + NODE * (node - 1)
    u, v = tab[k], tab[k + 1]
    along, across = 0.5 * (tab[k + 4] + tab[k + 3]), 0.5 * (tab[k + 6] + tab[k + 5])
    wide, high = 0.5 * (tab[k + 4] - tab[k + 3]), 0.5 * (tab[k + 6] - tab[k + 5])
    far, _, _, _ = from_place(u * along - v * across, v * along + u * across, a, b)
    return far, sqrt(wide * wide + high * high)


@internal
def in_leaf(tab, o, k, a, b, known):
    """How far a side is from the nearest piece of a leaf, and u, if it is nearer than what is
    known."""
    nearest, at = known
    place, end = leaf(tab, o, k)
    while place < end:
        s, u = off_arc(tab, place, a, b)
        if s < nearest:
            nearest, at = s, u
        place += SIZE
    return nearest, at


@internal
def off_arc(tab, place, a, b):
    """How far a side is from a piece, and u; inf where it lies in no direction of it."""
    if tab[place] == STRAIGHT:  # shorter than anybody sees: its ends are those of arcs
        s, t = in_front(tab, place, a), in_front(tab, place, b)
        return (s, 0.0) if s <= t else (t, 1.0)
    far, x, y, u = from_place(tab[place + 1], tab[place + 2], a, b)
    if far == 0.0 or x * tab[place + 4] + y * tab[place + 5] < (tab[place + 6] - ROUNDING) * far:
        return inf, 0.0
    return far - tab[place + 3], u


@internal
def in_front(tab, place, p):
    """How far a point is in front of a straight piece; inf where it is beside it or behind it."""
    far = to_piece(tab, place, p[0], p[1])
    s, _, _ = off_piece(tab, place, 1, p[0], p[1])
    return far if s > 0.0 else inf
