"""Surfaces: how far a point is from one, on which side, and which way it points away from it.

    plane      s = y
    sphere     s = |p| - R
    cylinder   s = |(x, y)| - R                        its axis is z
    profile    s = the distance of (x, y) from a line of straight pieces and arcs, drawn out along z

p = (x, y, z) is in the axes of the surface, s > 0 on its free side; the unit normal n = grad s
points there.  A hollow sphere, cylinder or closed profile is free inside: s and n change their
signs.  An open profile is a thin plate, free on both sides.

s is 1-Lipschitz, and as long as one place alone is nearest its second derivatives lie between

    -1 / (reach - s)  and  1 / (sharp + s)

with `sharp` the least radius by which the surface is round towards the free side, 0 at an edge, and
`reach` the radius of the largest ball that touches no second place anywhere.

A profile in a flat array is, from its offset: how many pieces, and SIZE numbers of each,

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
SIZE = 7
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
                         closed   1 of a closed profile
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
    """s and n of a point of the plane of a profile, n two numbers."""
    nearest, s, n = inf, inf, (1.0, 0.0)
    for k in range(int(tab[o])):
        place = o + 1 + SIZE * k
        kind, a, b = tab[place], x - tab[place + 1], y - tab[place + 2]
        if kind == STRAIGHT:
            t, m, length = tab[place + 3], tab[place + 4], tab[place + 5]
            along, aside = t * a + m * b, t * b - m * a
            near = abs(aside)
            if near < nearest and -ROUNDING * length <= along <= (1.0 + ROUNDING) * length:
                sign = 1.0 if closed == 1 or aside >= 0.0 else -1.0
                nearest, s, n = near, sign * aside, (-sign * m, sign * t)
            continue
        far = sqrt(a * a + b * b)
        if kind == EDGE:
            if far < nearest and far > 0.0:
                nearest, s, n = far, far, (a / far, b / far)
            continue
        R = tab[place + 3]
        near = abs(far - R)
        turned = a * tab[place + 4] + b * tab[place + 5]
        if near < nearest and far > 0.0 and turned >= (tab[place + 6] - ROUNDING) * far:
            out = 1.0 if kind == ROUND else -1.0
            if closed == 0 and out * (far - R) < 0.0:
                out = -out
            nearest, s, n = near, out * (far - R), (out * a / far, out * b / far)
    return s, n
