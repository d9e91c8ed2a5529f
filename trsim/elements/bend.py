"""The bend of a joint that turns about several axes: the angle between an axis of either body.

    tan x = |a_i x a_j| / (a_i . a_j),   0 <= x <= pi,      n = a_i x a_j / |a_i x a_j|
    x'    = n . omega                                       omega: of body j relative to body i
    x''   = -((a_i . a_j)'' + cos x x'^2) / sin x

A torque n on body j bends it further.  Straight, and at half a turn, there is no n: x turns back
there, and its rate and acceleration are those just after.
"""

from math import atan2, copysign, sqrt

from trsim.elements.contract import Turning
from trsim.elements.frames import (
    Along,
    arm,
    cross,
    dot,
    minus,
    plus,
    relative_spin,
    scaled,
    spin,
)
from trsim.kernels.columns import V3
from trsim.kernels.lazy import internal


class Bent(Along):
    """Of an element on the bend of a joint: `axis` is that of body i."""

    other: V3  # and this that of body j, in its axes


def turning(row):
    """It feels where both axes point, and turns them."""
    own = Bent.of(row)
    return Turning(frames=(own.i, own.j), axes=((own.i, own.axis), (own.j, own.other)))


STRAIGHT = 1e-10  # sine of a bend below which rounding alone says about which axis it bends


@internal
def bend(scene, own):
    """x, its rate and n, world axes; n is zero where there is none."""
    X = scene.X
    a_i, a_j = arm(X, own.i, own.axis), arm(X, own.j, own.other)
    n, omega = cross(a_i, a_j), relative_spin(scene.V, own.i, own.j)
    sine = sqrt(dot(n, n))
    x = atan2(sine, dot(a_i, a_j))
    if sine < STRAIGHT:
        across = cross(omega, a_i)
        return x, copysign(sqrt(dot(across, across)), 1.0 - x), (0.0, 0.0, 0.0)
    n = scaled(1.0 / sine, n)
    return x, dot(n, omega), n


@internal
def bend_acceleration(scene, own):
    """x''; once the accelerations are known."""
    X, V, A, i, j = scene.X, scene.V, scene.A, own.i, own.j
    a_i, a_j = arm(X, i, own.axis), arm(X, j, own.other)
    n, o_i, o_j = cross(a_i, a_j), spin(V, i), spin(V, j)
    t_i, t_j = spin(A, i), spin(A, j)
    sine, omega, alpha = sqrt(dot(n, n)), minus(o_j, o_i), minus(t_j, t_i)
    v_i, v_j = cross(o_i, a_i), cross(o_j, a_j)
    if sine >= STRAIGHT:
        rate = dot(n, omega) / sine
        turned = plus(cross(v_i, a_j), cross(a_i, v_j))
        return (dot(alpha, n) + dot(omega, turned) - dot(a_i, a_j) * rate * rate) / sine
    way = copysign(1.0, dot(a_i, a_j))  # from straight, or from half a turn
    d_dot = minus(v_j, scaled(way, v_i))
    by_j, by_i = plus(cross(t_j, a_j), cross(o_j, v_j)), plus(cross(t_i, a_i), cross(o_i, v_i))
    d_ddot = minus(by_j, scaled(way, by_i))
    speed = sqrt(dot(d_dot, d_dot))
    return way * (dot(d_dot, d_ddot) / speed if speed > 0.0 else sqrt(dot(d_ddot, d_ddot)))
