"""Surfaces: how far a point is from one, on which side, and which way it points away from it.

    plane      s = y
    sphere     s = |p| - R
    cylinder   s = |(x, y)| - R                        its axis is z
    profile    s = the distance of (x, y) from a line of straight pieces and arcs, drawn out along z

p = (x, y, z) is in the axes of the surface, s > 0 on its free side; the unit normal n = grad s
points there.  A hollow sphere, cylinder or closed profile is free inside: s and n change their
signs.  An open profile is a thin plate, free on both sides; and so is a part of a closed one.

s is 1-Lipschitz, and as long as one place alone is nearest its second derivatives lie between

    -1 / (reach - s)  and  1 / (sharp + s)

with `sharp` the least radius by which the surface is round towards the free side, 0 at an edge, and
`reach` the radius of the largest ball that touches no second place anywhere.

A profile in a flat array is, from its offset: how many groups of neighbours, GROUP numbers of each,

    x, y of its middle, how far from there its pieces reach, where they begin, how many they are

and SIZE numbers of each piece,

    STRAIGHT    x, y of its start, unit vector along it, length         the free side is on its left
    ROUND       x, y of its centre, R, unit vector to its middle, cosine of half its angle
    HOLLOW      the same, seen from its centre
    EDGE        x, y of a place where two pieces meet at an angle, or where an open profile ends
"""

from math import inf, sqrt

from trsim.kernels.lazy import internal

PLANE, SPHERE, CYLINDER, PROFILE = range(4)
SHAPES = {"plane": PLANE, "sphere": SPHERE, "cylinder": CYLINDER, "profile": PROFILE}
STRAIGHT, ROUND, HOLLOW, EDGE = range(4)
SIZE, GROUP = 7, 5
ROUNDING = 1e-12  # of the length of a piece: what lies so little beyond its end lies on it


@internal
def away(tab, own, p):
    """s and n of a point p, in the axes of the surface.

    Parameters
    ----------
    tab : (...) float    numbers of profiles
    own                  any record with the numbers
                         shape    one of SHAPES
                         radius   R of a sphere or a cylinder, m
                         free     1, or -1 of what is free inside
                         profile  offset in tab
                         closed   1 of a closed profile, 2 of a part of one
    p : (3) float        m

    Returns
    -------
    (float, (3) float)   s, m, and n; where no direction is nearest n is x
    """
    if own.shape == PLANE:
        return p[1], (0.0, 1.0, 0.0)
    if own.shape == PROFILE:
        s, n = beside(tab, own.profile, own.closed, p[0], p[1])
        return own.free * s, (own.free * n[0], own.free * n[1], 0.0)
    z = p[2] if own.shape == SPHERE else 0.0
    far = sqrt(p[0] * p[0] + p[1] * p[1] + z * z)
    if far == 0.0:
        return -own.free * own.radius, (own.free, 0.0, 0.0)
    by = own.free / far
    return own.free * (far - own.radius), (by * p[0], by * p[1], by * z)


@internal
def beside(tab, o, closed, x, y):
    """s and n of a point of the plane of a profile, n two numbers.

    Groups that are further away than another one at most is are not looked at.
    """
    groups, surely = int(tab[o]), inf
    if groups > 1:
        for g in range(groups):
            place = o + 1 + GROUP * g
            a, b = x - tab[place], y - tab[place + 1]
            surely = min(surely, sqrt(a * a + b * b) + tab[place + 2])
    nearest, s, n = inf, inf, (1.0, 0.0)
    for g in range(groups):
        place = o + 1 + GROUP * g
        a, b = x - tab[place], y - tab[place + 1]
        if groups > 1 and sqrt(a * a + b * b) - tab[place + 2] > min(surely, nearest):
            continue
        first = o + int(tab[place + 3])
        for k in range(int(tab[place + 4])):
            near, away_by, along, across = off_piece(tab, first + SIZE * k, closed, x, y)
            if near < nearest:
                nearest, s, n = near, away_by, (along, across)
    return s, n


@internal
def off_piece(tab, place, closed, x, y):
    """How far a point is from a piece, inf where it is beside its ends; s and the two of n."""
    kind, a, b = tab[place], x - tab[place + 1], y - tab[place + 2]
    if kind == STRAIGHT:
        t, m, length = tab[place + 3], tab[place + 4], tab[place + 5]
        along, aside = t * a + m * b, t * b - m * a
        if not -ROUNDING * length <= along <= (1.0 + ROUNDING) * length:
            return inf, inf, 1.0, 0.0
        sign = 1.0 if closed == 1 or aside >= 0.0 else -1.0
        return abs(aside), sign * aside, -sign * m, sign * t
    far = sqrt(a * a + b * b)
    if far == 0.0:
        return inf, inf, 1.0, 0.0
    if kind == EDGE:
        return far, far, a / far, b / far
    if a * tab[place + 4] + b * tab[place + 5] < (tab[place + 6] - ROUNDING) * far:
        return inf, inf, 1.0, 0.0
    out, off = 1.0 if kind == ROUND else -1.0, far - tab[place + 3]
    if closed != 1 and out * off < 0.0:
        out = -out
    return abs(off), out * off, out * a / far, out * b / far
