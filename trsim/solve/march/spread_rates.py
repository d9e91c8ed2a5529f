"""How far the rate of what is watched can go inside a step: spread.py, a derivative further.

With d the separation of the points p_i and p_j of two frames, omega, alpha, beta the angular
velocity of a frame and its first and second rate, and u = R_i^T d what frame i sees of it,

    angle      |g''| <= alpha_i + alpha_j + omega_i W,        W = omega_i + omega_j
               |g'''| <= beta_i + beta_j + 2 omega_i (alpha_i + alpha_j) + (alpha_i + omega_i^2) W
    swing      w = |omega_j - omega_i|: |w'| <= as of an angle, |w''| <= as there + |w'|^2 / w
    stroke     |g''| <= |u''|                                 |g'''| <= |u'''|
    distance   |g''| <= |u''| + |u'|^2 / |u|
               |g'''| <= |u'''| + 6 |u'| |u''| / |u| + 3 |u'|^3 / |u|^2

    |u'''| <= |d'''| + 3 omega_i |d''| + 3 (alpha_i + omega_i^2) |d'| + round_i |d|
    |d'''| <= |r_j''' - r_i'''| + round_i |p_i| + round_j |p_j|
    round  = beta + 3 alpha omega + omega^3

Velocities are polynomials of the dense output of their own, and their rates are bounded by their
control points, as in spread.py.
"""

from math import inf, sqrt

from trsim.assemble.travel import ANGLE, DISTANCE, RATE_OF, SWING, UNKNOWN
from trsim.elements.contract import Pair
from trsim.elements.frames import (
    cross,
    dot,
    relative_spin,
    separation,
    spin,
    two_points,
    velocity,
)
from trsim.kernels.lazy import internal
from trsim.solve.march.spread import cut, spread_at_stages
from trsim.solve.methods.displacements import first_of


@internal
def speeds_of(s, f):
    """Of frame f: its first velocity in y, how many are of its place, and how many of its turn."""
    v = s.n_q + first_of(s, f)
    if s.d == 3:
        return v, 2, 1 if f < s.n_r else 2
    return v, 3, 3


@internal
def fill_speeds(s, b, n, f, first):
    """The control points of a frame's velocities in columns of b.curve from `first` on.

    Returns the column behind them; of the ground there are none.
    """
    if f == 0:
        return first
    v, places, turns = speeds_of(s, f)
    for k in range(n):
        for c in range(places + turns):
            b.curve[k, first + c] = b.net[k, v + c]
    return first + places + turns


@internal
def turned(s, r, b, f, first, length):
    """Bounds of omega, alpha and beta of a frame on a part of `length` seconds."""
    if f == 0:
        return 0.0, 0.0, 0.0
    n, curve = r.degree + 1, b.curve
    v, places, turns = speeds_of(s, f)
    once = twice = thrice = 0.0
    for k in range(n):
        a1 = a2 = a3 = 0.0
        for c in range(turns):
            o = first + places + c
            a1 += (curve[k, o] + r.y[v + places + c]) ** 2
            if k < n - 1:
                a2 += (curve[k + 1, o] - curve[k, o]) ** 2
            if k < n - 2:
                a3 += (curve[k + 2, o] - 2.0 * curve[k + 1, o] + curve[k, o]) ** 2
        once, twice, thrice = max(once, a1), max(twice, a2), max(thrice, a3)
    once = sqrt(once)
    twice = (n - 1) * sqrt(twice) / length
    thrice = (n - 1) * (n - 2) * sqrt(thrice) / length**2
    if f < s.n_r:  # velocities of a body are in its own axes
        return once, twice, thrice + once * twice
    G = s.G  # of a node what turns is its slope
    size = sqrt(G[f, 0] * G[f, 0] + G[f, 1] * G[f, 1] + G[f, 2] * G[f, 2])
    least = size - once * length
    if least < 0.1 * size:
        return inf, inf, inf
    w, bend = once / least, twice / least
    second = 2.0 * bend + 5.0 * w * w
    third = 2.0 * thrice / least + 15.0 * w * bend + 21.0 * w * w * w
    return w, second, third + w * second


@internal
def moved_apart(s, b, n, two, length):
    """Bounds of |r_j'' - r_i''| and |r_j''' - r_i'''| from n control points in b.curve.

    two: the frames i and j, and the first column of j.
    """
    curve, once, twice, (i, j, first_j) = b.curve, 0.0, 0.0, two
    for k in range(n - 1):
        a1 = a2 = 0.0
        for c in range(2 if s.d == 3 else 3):
            rate = bend = 0.0
            for side in range(2):
                if (i if side == 0 else j) > 0:
                    o, sign = (c, -1.0) if side == 0 else (first_j + c, 1.0)
                    rate += sign * (curve[k + 1, o] - curve[k, o])
                    if k < n - 2:
                        bend += sign * (curve[k + 2, o] - 2.0 * curve[k + 1, o] + curve[k, o])
            a1 += rate * rate
            a2 += bend * bend
        once, twice = max(once, a1), max(twice, a2)
    return (n - 1) * sqrt(once) / length, (n - 1) * (n - 2) * sqrt(twice) / length**2


@internal
def spread_of_rate(s, r, b, what, part):
    """Bounds of |g'|, |g''| and |g'''| on a part of the step, from theta to theta.

    what: RATE_OF added to the kind of g, and its instance.  The poses are those of one end of the
    part.  All are negative where there are none.
    """
    kind, e = what[0] - RATE_OF, what[1]
    if kind <= UNKNOWN:
        return -1.0, -1.0, -1.0
    own, length, n = Pair(s, e), (part[1] - part[0]) * b.h, r.degree + 1
    i, j = own.i, own.j
    first_j = fill_speeds(s, b, n, i, 0)
    cut(b.curve, n, fill_speeds(s, b, n, j, first_j), part[0], part[1])
    w_i, a_i, b_i = turned(s, r, b, i, 0, length)
    w_j, a_j, b_j = turned(s, r, b, j, first_j, length)
    bent_i = a_i + w_i * w_i
    if kind in (ANGLE, SWING):
        turn, bend = w_i + w_j, a_i + a_j
        once, twice = bend + w_i * turn, b_i + b_j + 2.0 * w_i * bend + bent_i * turn
        return turn, once, twice if kind == ANGLE else of_size(s, i, j, once, twice, length)
    round_i = b_i + 3.0 * a_i * w_i + w_i**3
    round_j = b_j + 3.0 * a_j * w_j + w_j**3
    bend, jerk = moved_apart(s, b, n, (i, j, first_j), length)
    _, p_i, _, p_j = two_points(s, e)
    arm_i, arm_j = sqrt(dot(p_i, p_i)), sqrt(dot(p_j, p_j))
    bend += bent_i * arm_i + (a_j + w_j * w_j) * arm_j
    jerk += round_i * arm_i + round_j * arm_j
    d = separation(s.X, i, p_i, j, p_j)
    v_i, v_j = velocity(s.V, i, p_i), velocity(s.V, j, p_j)
    v = (v_j[0] - v_i[0], v_j[1] - v_i[1], v_j[2] - v_i[2])
    size = sqrt(dot(d, d))
    speed = sqrt(dot(v, v)) + bend * length
    far = size + speed * length
    once = bend + 2.0 * w_i * speed + bent_i * far
    twice = jerk + 3.0 * w_i * bend + 3.0 * bent_i * speed + round_i * far
    about = cross(spin(s.V, i), d)
    seen = (v[0] - about[0], v[1] - about[1], v[2] - about[2])
    fastest = sqrt(dot(seen, seen)) + once * length
    if kind != DISTANCE:
        return fastest, once, twice
    least = size - fastest * length
    if least <= 0.1 * size:  # a line next to its other end turns as fast as it likes
        return fastest, inf, inf
    w = fastest / least
    return fastest, once + w * fastest, twice + 6.0 * w * once + 3.0 * w * w * fastest


@internal
def of_size(s, i, j, once, twice, length):
    """A bound of |w''| of the size w of omega_j - omega_i, from those of its rates: it turns round
    at once where it is zero."""
    omega = relative_spin(s.V, i, j)
    size = sqrt(dot(omega, omega))
    least = size - once * length
    return twice + once * once / least if least > 0.1 * size else inf


@internal
def rate_at_stages(s, r, b, what):
    """The same over the whole step, from its stages, which tell nothing of |g'''|."""
    kind, e = what[0] - RATE_OF, what[1]
    if kind <= UNKNOWN:
        return -1.0, -1.0, -1.0
    L, M = spread_at_stages(s, r, b, (kind, e), -1.0)
    return L, M, -1.0
