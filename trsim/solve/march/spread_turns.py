"""How far the angle between two axes, or that of a whole turn, can go inside a step: see spread.py.

    bend   x between an axis of frame i and one of frame j
    swing  x of the turn of frame j against frame i about whatever axis       ball_spring.py

Both are distances on a sphere: of a_j from a_i on that of all directions, and of the quaternion of
the turn from that of no turn, where it is x/2.  What moves on a sphere at a speed v, of which v_n
is across the way to a place at a distance x, has x'' = (its acceleration that way) + v_n^2 cot x.
With W and alpha bounds of the angular velocity and acceleration of j as frame i sees it

    bend       |x'| <= W,    x'' in +- (alpha + W^2/2) + [0, W^2] cot x
    swing      |x'| <= W,    x'' in +- alpha + [0, W^2/2] cot(x/2)
"""

from math import atan2, inf, pi, sqrt, tan

from trsim.elements.bend import Bent
from trsim.elements.contract import Pair
from trsim.elements.frames import arm, cross, dot
from trsim.kernels.lazy import internal

NEAR = 0.1  # of how far an angle is from 0, or from pi: a way so far has no bounds


@internal
def rounded(angle, way, sign):
    """The largest of -sign cot on all angles within a way, 0 at least; without bound next to where
    that has none.  Of sign -1 the largest |cot|."""
    low, far = angle - way, pi - angle - way
    if far <= NEAR * (pi - angle):
        return inf
    most = max(0.0, 1.0 / tan(far))
    if sign > 0.0:
        return most
    if low <= NEAR * angle:
        return inf
    return max(most, 1.0 / tan(low))


@internal
def of_bend(s, e, of_angle, sign, length):
    """Bounds of |x'| and -sign x'' in `length` s from the pose of the scene."""
    own, (turn, bend) = Bent(s, e), of_angle
    a_i, a_j = arm(s.X, own.i, own.axis), arm(s.X, own.j, own.other)
    n = cross(a_i, a_j)
    angle = atan2(sqrt(dot(n, n)), dot(a_i, a_j))
    cot = rounded(angle, turn * length, sign)
    return turn, bend + turn * turn * (0.5 + cot)


@internal
def of_swing(s, e, of_angle, sign, length):
    """The same."""
    turn, bend = of_angle
    half = 0.5 * s.S[Pair(s, e).coordinate, 0]
    if half + 0.5 * turn * length >= 0.5 * pi:  # it jumps to the turn from the other side
        return turn, inf
    cot = rounded(half, 0.5 * turn * length, sign)
    return turn, bend + 0.5 * turn * turn * cot
