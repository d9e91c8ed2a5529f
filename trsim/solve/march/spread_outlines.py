"""How far the distance of an outline from what is round outside can go inside a step: bounds.

Seen from frame i a corner k of the outline is at x_k, and o, the origin of the surface, seen from
frame j at y.  W and A bound the angular velocity and acceleration of the frames against each other.
The nearest places are those of two convex bodies.  With those places held

    s'' <= |x''| + |x'|^2 / (sharp + s)

A corner that is nearest has s'' >= -|x''|.  A side that is nearest turns its normal by W, so that
the place of touch runs along arcs of radii up to R, at most E from o:

    s'' >= -|y''| - (R + E) W^2 - E A

Seen from a frame that turns,

    |x''| <= |d''| + 2 omega |d'| + (alpha + omega^2) |d|
"""

from math import inf, sqrt

from trsim.assemble.equations import call_one
from trsim.elements.frames import (
    OnSurface,
    cross,
    dot,
    minus,
    separation,
    spin,
    two_points,
    velocity,
)
from trsim.kernels.lazy import internal

NARROW = 0.1  # of how far a place is from where another is as near: for bounds of how it bends


@internal
def seen(bend, speed, far, turn):
    """A bound of |x''| in a frame of this angular velocity and acceleration."""
    omega, alpha = turn
    return bend + 2.0 * omega * speed + (alpha + omega * omega) * far


@internal
def of_outline(s, e, sign, length, bend, of_both):
    """Bounds L of |g'| and M of -sign g'' of an outline in `length` s, with |d''| <= bend of the
    points between which it lies.

    of_both: angular velocity and acceleration of both frames.
    """
    own, V, (of_i, of_j) = OnSurface(s, e), s.V, of_both
    i, p_i, j, p_j = two_points(s, e)
    d = separation(s.X, i, p_i, j, p_j)
    v, far = minus(velocity(V, j, p_j), velocity(V, i, p_i)), sqrt(dot(d, d))
    speed, turn = sqrt(dot(v, v)) + bend * length, of_i[0] + of_j[0]
    far += speed * length
    u = minus(v, cross(spin(V, i), d))
    once = sqrt(dot(u, u)) + seen(bend, speed, far, of_i) * length + turn * own.span
    of_corners = seen(
        bend + (of_j[1] + of_j[0] * of_j[0]) * own.span,
        speed + of_j[0] * own.span,
        far + own.span,
        of_i,
    )
    if sign > 0.0:
        call_one(s, s.gaps, 0.0, e)
        there = own.sharp + own.ball - s.gap[e, 0]
        if there - once * length <= NARROW * there:
            return once, inf
        return once, of_corners + once * once / (there - once * length)
    if s.d != 3:  # the frames may turn about more than one axis
        return once, inf
    of_sides = seen(bend, speed, far, of_j)
    of_sides += (own.bulge + own.wide) * turn * turn + own.wide * (of_i[1] + of_j[1])
    return once, max(of_corners, of_sides)
