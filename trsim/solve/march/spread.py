"""How far what is watched can go inside a step: bounds, not samples.

Gaps of contacts and watched sensors are angles, strokes and distances between two frames i and j.
With d the separation of their points p_i and p_j, and u = R_i^T d what frame i sees of it,

    angle      |g'| <= omega_i + omega_j    |g''| <= alpha_i + alpha_j + omega_i (omega_i + omega_j)
    stroke     |g'| <= |u'|                 |g''| <= |u''|
    distance   |g'| <= |u'|                 -|u''| <= g'' <= |u''| + |u'|^2 / |u|
    twist      |g'| <= k Omega              |g''| <= k (alpha_i + alpha_j + omega_i Omega)
                                                     + k^2 (1 + k) Omega^2 / 2
               Omega = omega_i + omega_j,  k = 1 / cos(tilt / 2) of its axes  relative_angle.py
    train      |c_1| and |c_2| times those of two angles                      gear_mesh.py
    surface    |g'| <= |u'|                 -|u''| - |u'|^2 / (sharp + s) <= g''
               g = ball - s                      g'' <= |u''| + |u'|^2 / (reach - s)   surfaces.py
    outline    that of convex bodies                                       spread_outlines.py
    bend, swing    angles between axes, or of the whole turn                  spread_turns.py
    edge       |g'| <= that of one end + Omega l         g'' >= likewise; it may turn round at once,
               and has no bound above                                                  seal.py

    |u''| <= |d''| + 2 omega_i |d'| + (alpha_i + omega_i^2) |d|
    |d''| <= |r_j'' - r_i''| + (alpha_i + omega_i^2) |p_i| + (alpha_j + omega_j^2) |p_j|

Inside a step the generalised coordinates are polynomials, the dense output.  Their second
derivatives are bounded by the control points of Bernstein's basis [Farin2002], on any part of the
step by de Casteljau's subdivision; a direction x / |x| turns no faster than |x'| / |x|.

Before the dense output is built, which costs an explicit method further evaluations, the same
bounds are taken from the derivatives at the stages of the step, of which it is a combination, and
enlarged: accelerations twice.
"""

from math import acos, comb, cos, inf, pi, sqrt

import numpy as np

from trsim.assemble.dense import inverse
from trsim.assemble.equations import call_one
from trsim.assemble.travel import (
    ANGLE,
    BEND,
    CLOCK,
    DISTANCE,
    EDGE,
    OUTLINE,
    SURFACE,
    SWING,
    TRAIN,
    TWIST,
    UNKNOWN,
)
from trsim.elements.contract import Pair
from trsim.elements.frames import (
    Edge,
    OnSurface,
    TwoAngles,
    arm,
    centripetal,
    cross,
    dot,
    separation,
    spin,
    two_points,
    velocity,
)
from trsim.elements.rows import Axes
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import (
    CONTROL_AT,
    DEGREE_AT,
    INTERPOLATE_AT,
    call_control,
    call_interpolate,
)
from trsim.solve.march.spread_outlines import of_outline
from trsim.solve.march.spread_turns import of_bend, of_swing
from trsim.solve.methods.displacements import first_of

CUBIC, MOST = 3, 8  # degrees of dense outputs whose methods do not tell their control points
NARROW = 0.1  # of how far a place is from where another is as near: for bounds of how it bends
MOST_LEAN = 1.5  # rad: half of what axes may lean apart by where their angle has bounds
SAFETY, SAFE_RATE = 2.0, 1.25  # of accelerations and of rates taken from the stages
SEEN = (0, 4, 8, 10, 12)  # which of DOP853's: at 0, 0.28, 0.65, 0.86 and 1 of the step


def _to_bernstein(degree):
    """Nodes on [0, 1], and the control points from values there: the inverse of B_k(nodes[m])."""
    x = 0.5 - 0.5 * np.array([cos(pi * k / degree) for k in range(degree + 1)])
    k = np.arange(degree + 1)
    binomial = np.array([comb(degree, int(j)) for j in k], float)
    return x, inverse(binomial * x[:, None] ** k * (1.0 - x[:, None]) ** (degree - k))


NODES_CUBIC, FROM_CUBIC = _to_bernstein(CUBIC)
NODES, FROM_NODES = _to_bernstein(MOST)


# --- the dense output as control points ------------------------------------------------------


@internal
def fill_net(s, r, b, method):
    """b.net[k] = k-th control points of q over the step, less q at its beginning; of v too where
    rates are looked at (spread_rates.py)."""
    degree, net = method[DEGREE_AT], b.net
    n = degree + 1
    r.degree = degree
    if method[CONTROL_AT] > 0:
        call_control(method[CONTROL_AT], b.P, net)
        return
    for k in range(n):
        for c in range(net.shape[1]):
            net[k, c] = 0.0
    for m in range(n):
        node = NODES_CUBIC[m] if degree == CUBIC else NODES[m]
        call_interpolate(method[INTERPOLATE_AT], b.P, r.y, node, b.y2)
        for k in range(n):
            weight = FROM_CUBIC[k, m] if degree == CUBIC else FROM_NODES[k, m]
            for c in range(net.shape[1]):
                net[k, c] += weight * (b.y2[c] - r.y[c])


@internal
def cut(curve, n, columns, low, high):
    """From control points over the step to those on [low, high], of both frames.  de Casteljau"""
    if high < 1.0:
        for m in range(1, n):
            for k in range(n - 1, m - 1, -1):
                for c in range(columns):
                    curve[k, c] += (1.0 - high) * (curve[k - 1, c] - curve[k, c])
    if low > 0.0:
        at = low / high
        for m in range(1, n):
            for k in range(n - m):
                for c in range(columns):
                    curve[k, c] += at * (curve[k + 1, c] - curve[k, c])


@internal
def coordinates_of(s, f):
    """Of frame f: its first coordinate, how many say where it is, and how many how it is turned."""
    if s.d == 3:
        if f < s.n_r:
            return 3 * (f - 1), 2, 1
        return s.q_node + 4 * (f - s.n_r), 2, 2
    if f < s.n_r:
        return 7 * (f - 1), 3, 4
    return s.q_node + 6 * (f - s.n_r), 3, 3


@internal
def fill_curve(s, b, n, f, first):
    """The control points of a frame in columns of b.curve from `first` on: places, then attitude.

    Returns the column behind them; of the ground there are none.
    """
    if f == 0:
        return first
    net, curve = b.net, b.curve
    q, places, attitude = coordinates_of(s, f)
    for k in range(n):
        for c in range(places + attitude):
            curve[k, first + c] = net[k, q + c]
    return first + places + attitude


@internal
def turning(s, r, b, f, first, length):
    """Bounds of the angular velocity and acceleration of a frame on a part of `length` seconds."""
    if f == 0:
        return 0.0, 0.0
    n = r.degree + 1
    q, places, attitude = coordinates_of(s, f)
    once, twice, off = 0.0, 0.0, 0.0
    size, curve = 0.0, b.curve
    for c in range(attitude):
        centre = curve[n // 2, first + places + c] + r.y[q + places + c]
        size += centre * centre
    for k in range(n):
        a1 = a2 = away = 0.0
        for c in range(first + places, first + places + attitude):
            away += (curve[k, c] - curve[n // 2, c]) ** 2
            if k < n - 1:
                a1 += (curve[k + 1, c] - curve[k, c]) ** 2
            if k < n - 2:
                a2 += (curve[k + 2, c] - 2.0 * curve[k + 1, c] + curve[k, c]) ** 2
        once, twice, off = max(once, a1), max(twice, a2), max(off, away)
    rate = (n - 1) * sqrt(once) / length
    bend = (n - 1) * (n - 2) * sqrt(twice) / length**2
    if attitude == 1:
        return rate, bend
    # of x / |x|: rate |x'| / |x|, second rate 2 |x''| / |x| + 5 (|x'| / |x|)^2; a quaternion
    # turns half as fast as its frame
    least = sqrt(size) - sqrt(off)
    if least < 0.1 * sqrt(size):
        return inf, inf
    rate, bend = rate / least, 2.0 * bend / least + 5.0 * (rate / least) ** 2
    return (2.0 * rate, 2.0 * bend + 2.0 * rate * rate) if attitude == 4 else (rate, bend)


@internal
def apart(s, b, n, two, length):
    """A bound of |r_j'' - r_i''| from n control points in b.curve.

    two: the frames i and j, and the first column of j.
    """
    worst, curve, (i, j, first_j) = 0.0, b.curve, two
    for k in range(n - 2):
        square = 0.0
        for c in range(2 if s.d == 3 else 3):
            bend = 0.0
            if i > 0:
                bend -= curve[k + 2, c] - 2.0 * curve[k + 1, c] + curve[k, c]
            if j > 0:
                o = first_j + c
                bend += curve[k + 2, o] - 2.0 * curve[k + 1, o] + curve[k, o]
            square += bend * bend
        worst = max(worst, square)
    return (n - 1) * (n - 2) * sqrt(worst) / length**2


# --- bounds of what is watched ---------------------------------------------------------------


@internal
def spread(s, r, b, what, sign, part):
    """Bounds L of |g'| and M of -sign g'' on a part of the step, from theta to theta.

    what: the kind of the quantity, and the instance between whose frames and points it is.  The
    poses are those of one end of the part.  Both are negative where there are none.
    """
    kind, e = what[0], what[1]
    if kind == UNKNOWN:
        return -1.0, -1.0
    if kind == CLOCK:
        return 1.0, 0.0
    own, length = Pair(s, e), (part[1] - part[0]) * b.h
    i, j = own.i, own.j
    n = r.degree + 1
    first_j = fill_curve(s, b, n, i, 0)
    cut(b.curve, n, fill_curve(s, b, n, j, first_j), part[0], part[1])
    of_i, of_j = turning(s, r, b, i, 0, length), turning(s, r, b, j, first_j, length)
    if kind == ANGLE:
        return of_angle(of_i, of_j)
    if kind == TWIST:
        return of_twist(s, e, of_i, of_j, length)
    if kind == BEND:
        return of_bend(s, e, of_angle(of_i, of_j), sign, length)
    if kind == SWING:
        return of_swing(s, e, of_angle(of_i, of_j), sign, length)
    if kind == TRAIN:
        two = TwoAngles(s, e)
        first_j = fill_curve(s, b, n, two.i_2, 0)
        cut(b.curve, n, fill_curve(s, b, n, two.j_2, first_j), part[0], part[1])
        of_2 = turning(s, r, b, two.i_2, 0, length), turning(s, r, b, two.j_2, first_j, length)
        return of_train(s, e, of_angle(of_i, of_j), of_angle(of_2[0], of_2[1]))
    (spin_i, bend_i), (spin_j, bend_j) = of_i, of_j
    away = apart(s, b, n, (i, j, first_j), length)
    _, p_i, _, p_j = two_points(s, e)
    round_i, round_j = bend_i + spin_i * spin_i, bend_j + spin_j * spin_j
    bend = away + round_i * sqrt(dot(p_i, p_i)) + round_j * sqrt(dot(p_j, p_j))
    if kind == OUTLINE:
        return of_outline(s, e, sign, length, bend, (of_i, of_j))
    return over_edge(s, what, sign, from_points(s, what, sign, length, bend, of_i), of_i, of_j)


@internal
def over_edge(s, what, sign, bounds, of_i, of_j):
    """The bounds of one end of a line, for both; of anything else as they are."""
    if what[0] != EDGE:
        return bounds
    turn, bend = of_angle(of_i, of_j)
    length = Edge(s, what[1]).length
    once = bounds[0] + turn * length
    return once, inf if sign < 0.0 else bounds[1] + (bend + turn * turn) * length


@internal
def of_angle(of_i, of_j):
    """Bounds of |g'| and |g''| of an angle, from those of both frames: angular velocity and
    acceleration."""
    turn = of_i[0] + of_j[0]
    return turn, of_i[1] + of_j[1] + of_i[0] * turn


@internal
def of_train(s, e, of_1, of_2):
    """The same of two angles, each times a radius."""
    own = TwoAngles(s, e)
    c, d = abs(own.c_1), abs(own.c_2)
    return c * of_1[0] + d * of_2[0], c * of_1[1] + d * of_2[1]


@internal
def of_twist(s, e, of_i, of_j, length):
    """The same in `length` s of an angle about axes that lean apart, by no more than they lean at
    the pose of the scene and turn against each other by from there."""
    own = Axes(s, e)
    turn, bend = of_angle(of_i, of_j)
    share = dot(arm(s.X, own.i, own.a_i), arm(s.X, own.j, own.a_j))
    half = 0.5 * (acos(min(max(share, -1.0), 1.0)) + turn * length)
    if not half < MOST_LEAN:
        return inf, inf
    k = 1.0 / cos(half)
    return k * turn, k * bend + 0.5 * k * k * (1.0 + k) * turn * turn


@internal
def from_points(s, what, sign, length, bend, of_i):
    """Bounds of |g'| and -sign g'' of a stroke or a distance in `length` s, with |d''| <= bend."""
    kind, e, (spin_i, bend_i) = what[0], what[1], of_i
    V, round_i = s.V, bend_i + spin_i * spin_i
    i, p_i, j, p_j = two_points(s, e)
    d = separation(s.X, i, p_i, j, p_j)
    v_i, v_j = velocity(V, i, p_i), velocity(V, j, p_j)
    v = (v_j[0] - v_i[0], v_j[1] - v_i[1], v_j[2] - v_i[2])
    size = sqrt(dot(d, d))
    speed = sqrt(dot(v, v)) + bend * length
    curved = bend + 2.0 * spin_i * speed + round_i * (size + speed * length)
    turned = cross(spin(V, i), d)
    seen = (v[0] - turned[0], v[1] - turned[1], v[2] - turned[2])
    fastest = sqrt(dot(seen, seen)) + curved * length
    if kind == DISTANCE and sign < 0.0:  # what goes past a point only ever gains distance
        least = size - fastest * length
        if least <= 0.1 * size:
            return fastest, inf
        curved += fastest * fastest / least
    if kind == SURFACE:
        own, way = OnSurface(s, e), fastest * length
        call_one(s, s.gaps, 0.0, e)
        away = own.ball - s.gap[e, 0]
        far = own.reach - away if sign < 0.0 else own.sharp + away  # from where it has no bend
        if far < inf:
            if far - way <= NARROW * far:
                return fastest, inf
            curved += fastest * fastest / (far - way)
    return fastest, curved


# --- before the dense output is built --------------------------------------------------------


@internal
def flat(s, f):
    """Whether a frame is that of a rigid body in a plane, or the ground's there."""
    return s.d == 3 and f < s.n_r


@internal
def at_stages(s, r, b, f):
    """Angular velocity and acceleration of a frame, their largest at the stages, enlarged."""
    if f == 0:
        return 0.0, 0.0
    if flat(s, f):
        K, turn, fastest, largest = b.K, 3 * (f - 1) + 2, 0.0, 0.0
        for k in SEEN:
            fastest = max(fastest, abs(K[k, turn]))
            largest = max(largest, abs(K[k, s.n_q + turn]))
        return SAFE_RATE * fastest, SAFETY * largest
    q, places, attitude = coordinates_of(s, f)
    v, rigid = s.n_q + first_of(s, f) + places, f < s.n_r
    rates = (1 if s.d == 3 else 3) if rigid else attitude
    once = twice = 0.0
    for k in SEEN:
        a1 = a2 = 0.0
        for c in range(attitude):
            a1 += b.K[k, q + places + c] ** 2
        for c in range(rates):
            a2 += b.K[k, v + c] ** 2
        once, twice = max(once, a1), max(twice, a2)
    once, twice = SAFE_RATE * sqrt(once), SAFETY * sqrt(twice)
    if not rigid:
        size = 0.0
        for c in range(attitude):
            size += r.y[q + places + c] ** 2
        once, twice = once / sqrt(size), 2.0 * twice / sqrt(size) + 5.0 * once * once / size
    return (2.0 * once if attitude == 4 else once), twice


@internal
def point_at_stage(s, b, k, f, p):
    """Acceleration at stage k of a point of a frame, with its arm and spin as they are now.

    Of a node of a beam it is that of its place; the spin is bounded by the caller.
    """
    if f == 0:
        return 0.0, 0.0, 0.0
    K, v = b.K, s.n_q + first_of(s, f)
    if s.d == 3:
        a0, a1, a2 = K[k, v], K[k, v + 1], 0.0
    else:
        a0, a1, a2 = K[k, v], K[k, v + 1], K[k, v + 2]
    if f >= s.n_r:
        return a0, a1, a2
    X = s.X
    if s.d == 3:
        turn = (0.0, 0.0, K[k, v + 2])
    else:
        turn = arm(X, f, (K[k, v + 3], K[k, v + 4], K[k, v + 5]))
    c, e = cross(turn, p), centripetal(s.V, f, p)
    return a0 + c[0] + e[0], a1 + c[1] + e[1], a2 + c[2] + e[2]


@internal
def apart_at_stages(s, b, e, of_i, of_j):
    """The largest |d''| of an instance's points at the stages, enlarged.

    Arms and spins are those at the end of the step, and what they turn by in it is added.
    """
    i, p_i, j, p_j = two_points(s, e)
    worst = 0.0
    slack = slack_of(s, b, i, p_i, of_i) + slack_of(s, b, j, p_j, of_j)
    if flat(s, i) and flat(s, j):
        return SAFETY * apart_in_plane(s, b, i, p_i, j, p_j) + slack
    for k in SEEN:
        a_i, a_j = point_at_stage(s, b, k, i, p_i), point_at_stage(s, b, k, j, p_j)
        d = (a_j[0] - a_i[0], a_j[1] - a_i[1], a_j[2] - a_i[2])
        worst = max(worst, dot(d, d))
    return SAFETY * sqrt(worst) + slack


@internal
def apart_in_plane(s, b, i, p_i, j, p_j):
    """The largest |d''| at the stages, of points of two bodies in a plane."""
    K, V, worst = b.K, s.V, 0.0
    round_i, round_j = V[i, 5] * V[i, 5], V[j, 5] * V[j, 5]
    x, y = round_i * p_i[0] - round_j * p_j[0], round_i * p_i[1] - round_j * p_j[1]
    v_i, v_j = s.n_q + 3 * (i - 1), s.n_q + 3 * (j - 1)
    for k in SEEN:
        a, c = x, y
        if i > 0:
            a -= K[k, v_i] - K[k, v_i + 2] * p_i[1]
            c -= K[k, v_i + 1] + K[k, v_i + 2] * p_i[0]
        if j > 0:
            a += K[k, v_j] - K[k, v_j + 2] * p_j[1]
            c += K[k, v_j + 1] + K[k, v_j + 2] * p_j[0]
        worst = max(worst, a * a + c * c)
    return sqrt(worst)


@internal
def slack_of(s, b, f, p, motion):
    """What |d''| may change by as the arm p of a frame turns, with its spin and their rate."""
    spin, bend = motion
    more = bend + spin * spin  # for each m of the arm
    if f < s.n_r:
        more = min(more, b.h * (spin * more + 2.0 * spin * bend))
    return sqrt(dot(p, p)) * more


@internal
def spread_at_stages(s, r, b, what, sign):
    """`spread` over the whole step, from its stages; the poses are those of its end."""
    kind, e = what[0], what[1]
    if kind == UNKNOWN:
        return -1.0, -1.0
    if kind == CLOCK:
        return 1.0, 0.0
    own = Pair(s, e)
    of_i, of_j = at_stages(s, r, b, own.i), at_stages(s, r, b, own.j)
    if kind == ANGLE:
        return of_angle(of_i, of_j)
    if kind == TWIST:
        return of_twist(s, e, of_i, of_j, b.h)
    if kind == BEND:
        return of_bend(s, e, of_angle(of_i, of_j), sign, b.h)
    if kind == SWING:
        return of_swing(s, e, of_angle(of_i, of_j), sign, b.h)
    if kind == TRAIN:
        two = TwoAngles(s, e)
        of_2 = of_angle(at_stages(s, r, b, two.i_2), at_stages(s, r, b, two.j_2))
        return of_train(s, e, of_angle(of_i, of_j), of_2)
    bend = apart_at_stages(s, b, e, of_i, of_j)
    if kind == OUTLINE:
        return of_outline(s, e, sign, b.h, bend, (of_i, of_j))
    bounds = from_points(s, what, sign, b.h, bend, of_i)
    return over_edge(s, what, sign, bounds, of_i, of_j)
