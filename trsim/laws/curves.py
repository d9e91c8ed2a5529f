"""Plane curves: places, tangents and curvature, length, and what is nearest to a point or a line.

    c(u) = (x, y), c', c''              of a cubic spline, or of two expressions
    footpoint of p    c'(u) . (p - c(u)) = 0    where the distance to p is least, near a given u
    touch of a line   c'(u) . m = 0             where m . c is largest; m is normal to the line

u is scaled so that the curve turns by BEND at most while u grows by 1.  So from a place less than
2 away on the curve the distance only falls on the way to the footpoint, and a search that goes
downhill by at most STRIDE at a time does not come to another piece of the curve.  A closed curve
begins anew after each turn, and u goes on; beyond its ends an open one goes on as a parabola, with
no jump in c''.

A curve in a flat array is, from its offset,

    closed, n, of x, of y, first, per u, u (n), length (n), 4 coefficients of x and 4 of y (n - 1)

with `of x` and `of y` the offsets of its expressions, counted from its own, in first + (per u) u;
0 of a spline.
"""

from math import copysign, floor, sqrt

from trsim.kernels.lazy import internal
from trsim.laws.functions import motion
from trsim.laws.tables import interval

BEND = 0.75  # rad: what the tangent turns by at most while u grows by 1
STRIDE = 0.5  # of u: the longest step of a search
SEARCHES = 400  # steps of one
SETTLED = 1e-9  # of u: the next step of Newton's method is below rounding
CLOSED, NODES, OF_X, OF_Y, FIRST, PER_U, HEAD = range(7)
# of Gauss and Legendre, on -1 .. 1
PLACES = (0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363)
WEIGHTS = (0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763)


@internal
def dot2(a, b):
    return a[0] * b[0] + a[1] * b[1]


@internal
def end_of(tab, o):
    """u at the end of the curve, which begins at 0."""
    return tab[o + HEAD + int(tab[o + NODES]) - 1]


@internal
def length_of(tab, o):
    """Length of the curve, m."""
    return tab[o + HEAD + 2 * int(tab[o + NODES]) - 1]


@internal
def turns_of(tab, o, u):
    """How many times a closed curve has been gone round; 0 of an open one."""
    return floor(u / end_of(tab, o)) if tab[o + CLOSED] == 1.0 else 0.0


@internal
def piece(tab, o, u):
    """Between which nodes u lies: 1 for the first and the second."""
    return interval(tab, o + HEAD - 1, int(tab[o + NODES]), u)


@internal
def polynomial(tab, p, s):
    """Value and two derivatives of the cubic whose coefficients begin at p."""
    a, b, c, d = tab[p], tab[p + 1], tab[p + 2], tab[p + 3]
    return a + s * (b + s * (c + s * d)), b + s * (2.0 * c + s * 3.0 * d), 2.0 * c + 6.0 * s * d


@internal
def place(tab, o, u):
    """c, c' and c'' at u, two numbers each."""
    end = end_of(tab, o)
    r = min(max(u - end * turns_of(tab, o, u), 0.0), end)
    if tab[o + OF_X] > 0.0:
        at, per = tab[o + FIRST] + tab[o + PER_U] * r, tab[o + PER_U]
        x0, x1, x2 = motion(tab, o + int(tab[o + OF_X]), at)
        y0, y1, y2 = motion(tab, o + int(tab[o + OF_Y]), at)
        x1, y1, x2, y2 = per * x1, per * y1, per * per * x2, per * per * y2
    else:
        n, k = int(tab[o + NODES]), piece(tab, o, r)
        p, s = o + HEAD + 2 * n + 8 * (k - 1), r - tab[o + HEAD + k - 1]
        x0, x1, x2 = polynomial(tab, p, s)
        y0, y1, y2 = polynomial(tab, p + 4, s)
    beyond = u - r if tab[o + CLOSED] == 0.0 else 0.0
    x0, y0 = x0 + beyond * (x1 + 0.5 * beyond * x2), y0 + beyond * (y1 + 0.5 * beyond * y2)
    return (x0, y0), (x1 + beyond * x2, y1 + beyond * y2), (x2, y2)


@internal
def stretch(tab, o, begin, end):
    """Length of the curve between two places of one piece, m."""
    middle, half, total = 0.5 * (begin + end), 0.5 * (end - begin), 0.0
    for k in range(len(PLACES)):
        for sign in (-1.0, 1.0):
            _, c1, _ = place(tab, o, middle + sign * half * PLACES[k])
            total += WEIGHTS[k] * sqrt(dot2(c1, c1))
    return half * total


@internal
def length(tab, o, u):
    """Length of the curve from its beginning to u, m; negative before it."""
    end, turns = end_of(tab, o), turns_of(tab, o, u)
    r = u - turns * end
    n, k = int(tab[o + NODES]), piece(tab, o, r)
    there = tab[o + HEAD + n + k - 1] + turns * length_of(tab, o)
    if r <= end:
        return there + stretch(tab, o, tab[o + HEAD + k - 1], r)
    return length_of(tab, o) + stretch(tab, o, end, r)


@internal
def onward(slope, bend):
    """How far to go where the slope of what is to be largest falls by `bend` per unit."""
    if bend > 0.0 and abs(slope) < STRIDE * bend:
        return slope / bend
    return copysign(STRIDE, slope) if slope != 0.0 else 0.0


@internal
def footpoint(tab, o, u, p):
    """u where the curve is nearest to a point, downhill from a given u."""
    for _ in range(SEARCHES):
        c, c1, c2 = place(tab, o, u)
        d = (p[0] - c[0], p[1] - c[1])
        step = onward(dot2(c1, d), dot2(c1, c1) - dot2(c2, d))
        u += step
        if not abs(step) > SETTLED:
            break
    return u


@internal
def touch(tab, o, u, m):
    """u where a line of normal m touches the curve, uphill from a given u."""
    for _ in range(SEARCHES):
        _, c1, c2 = place(tab, o, u)
        step = onward(dot2(c1, m), -dot2(c2, m))
        u += step
        if not abs(step) > SETTLED:
            break
    return u
