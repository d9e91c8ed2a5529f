"""A small integrator of rigid bodies, written for the truth alone: nothing of trsim is used.

Every body has a place, a quaternion and a twist about its centre of mass, world axes:

    y = (r, p, v, w) of every body, angles of joints, works
    [M  -J^T] [a     ]   [F    ]
    [J   0  ] [lambda] = [gamma]         solved by S = J M^-1 J^T = L L^T, dense, small

The embedded pair of order 8 (Hairer's tableau, from scipy) makes steps of at most a fraction of the
fastest turn.  Each step is followed by one projection of place and velocity.  There is no dense
output: a row is the end of a step, and so is every change of a discrete state: where the distance
of something watched from its value changes its sign, or comes near it and turns, the step is made
again and again until its end is there.  Forces keep the side they are on within a step.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate._ivp import dop853_coefficients as tableau

from .touches import BALLS as BALL_RADIUS
from .touches import (
    BRISTLES,
    LAW,
    meeting,
    normal,
    rolling,
    rubbed,
    seal_ends,
    seal_gap,
    sealed,
    sliding,
)
from .touches import DAMPING as LOSS
from .touches import RAMP as RAMP_OF
from .touches import STATE as BRISTLE
from .touches import K as STIFFNESS
from .vectors import compiled, cross, dot, into, minus, out_of, plus, smooth, three, times

A = np.ascontiguousarray(tableau.A[:12, :12])
B = np.ascontiguousarray(tableau.B)
C = np.ascontiguousarray(tableau.C[:12])
E3 = np.ascontiguousarray(tableau.E3[:12])
E5 = np.ascontiguousarray(tableau.E5[:12])

# rows of constraints: two bodies, arms or directions in them, a component or a coordinate
POINT, ACROSS, ALONG, DISTANCE, ANGLE = range(5)
# forces
(
    FORCE,
    TORQUE,
    SPRING,
    TORSION,
    BUSHING,
    WALL,
    LIMIT,
    SOFT_DRIVE,
    SOFT_LINE,
    CLEARANCE,
    TOUCH,
    SEAL,
) = range(12)
# functions of time or of a coordinate
CONSTANT, SINE, CUBIC, RAMP, BOX, TENT, BELL, TABLE, PULSES = range(9)
# what is watched: the time, a coordinate, its rate, the gap of a force, a train of pulses
# of a contact: its sliding, rolling and turning speed, where its damper is whole, where it would
# pull; of a seal both ends
(W_TIME, W_PLACE, W_RATE, W_GAP, W_PULSE, W_RAMP, W_PUSH, W_SLIP, W_ROLL, W_SPIN, W_WHOLE, W_PULL,
 W_END) = range(13)  # fmt: skip
TURN, SLIDE = range(2)  # kinds of coordinates
LOADS, DRIVES, DAMPERS, IMPACTS, FRICTION, N_WORK = range(6)
DONE, STOPPED, STUCK, TOO_MANY, SINGULAR = range(5)
NEAR = 1e-2  # turning points nearer to zero are told
MOST = 10000  # steps


class Arrays(NamedTuple):
    """A mechanism as numbers; body 0 is the ground."""

    mass: np.ndarray  # (n) inverse masses, 0 of the ground
    inertia: np.ndarray  # (n, 3, 3) in the axes of the body
    inverse: np.ndarray  # (n, 3, 3) of that; 0 of the ground
    gravity: np.ndarray  # (3)
    row: np.ndarray  # (m, 5) kind, i, j, component or coordinate, function or -1
    row_par: np.ndarray  # (m, 10)
    coordinate: np.ndarray  # (c, 3) kind, i, j
    coordinate_par: np.ndarray  # (c, 10) arm in i, arm in j, axis in i, offset
    force: np.ndarray  # (f, 6) kind, i, j, coordinate, function or -1, what is watched or -1
    force_par: np.ndarray  # (f, 44)
    function: np.ndarray  # (g, 5) kind, coordinate or -1 for the time, first watched, table a..b
    function_par: np.ndarray  # (g, 6) its numbers, the time it begins
    table: np.ndarray  # (k, 5) start of an interval, four coefficients
    watch: np.ndarray  # (w, 4) kind, coordinate or force or -1, whether a crossing ends, sense
    watch_par: np.ndarray  # (w, 4) value, sense and origin of a sensor, rate of the pulses


@compiled
def rotation(p, R):
    """Of a quaternion, which is made one of length 1."""
    n = 1.0 / np.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3])
    e0, e1, e2, e3 = p[0] * n, p[1] * n, p[2] * n, p[3] * n
    R[0, 0] = 1 - 2 * (e2 * e2 + e3 * e3)
    R[0, 1] = 2 * (e1 * e2 - e0 * e3)
    R[0, 2] = 2 * (e1 * e3 + e0 * e2)
    R[1, 0] = 2 * (e1 * e2 + e0 * e3)
    R[1, 1] = 1 - 2 * (e1 * e1 + e3 * e3)
    R[1, 2] = 2 * (e2 * e3 - e0 * e1)
    R[2, 0] = 2 * (e1 * e3 - e0 * e2)
    R[2, 1] = 2 * (e2 * e3 + e0 * e1)
    R[2, 2] = 1 - 2 * (e1 * e1 + e2 * e2)


@compiled
def rotations(y, n):
    R = np.zeros((n, 3, 3))
    for c in range(3):
        R[0, c, c] = 1.0
    for b in range(1, n):
        k = 13 * (b - 1) + 3
        rotation((y[k], y[k + 1], y[k + 2], y[k + 3]), R[b])
    return R


@compiled
def places(y, n):
    """Places and twists; the ground's are 0."""
    r, v, w = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    for b in range(1, n):
        k = 13 * (b - 1)
        for c in range(3):
            r[b, c], v[b, c], w[b, c] = y[k + c], y[k + 7 + c], y[k + 10 + c]
    return r, v, w


@compiled
def evaluated(m, g, s, side):
    """A function of time or of a coordinate and two derivatives; on its sides."""
    kind, first = m.function[g, 0], m.function[g, 2]
    p = m.function_par[g]
    if m.function[g, 1] < 0:
        s = s - p[5]
    if kind == CONSTANT:
        return p[0], 0.0, 0.0
    if kind == SINE:
        a = p[2] * s + p[3]
        return (
            p[0] + p[1] * np.sin(a) + p[4] * s,
            p[1] * p[2] * np.cos(a) + p[4],
            -p[1] * p[2] ** 2 * np.sin(a),
        )
    if kind == CUBIC:
        return (
            p[0] + s * (p[1] + s * (p[2] + s * p[3])),
            p[1] + s * (2 * p[2] + 3 * s * p[3]),
            2 * p[2] + 6 * s * p[3],
        )
    if kind == RAMP:  # p0 smoothstep((s - p1)/p2), its integral if p3 = 1
        q = (s - p[1]) / p[2]
        f, f1, f2 = smooth(q)
        if p[3] == 1.0:
            if q <= 0.0:
                area = 0.0
            elif q >= 1.0:
                area = 0.5 + (q - 1.0)
            else:
                area = q**3 - 0.5 * q**4
            return p[0] * p[2] * area, p[0] * f, p[0] / p[2] * f1
        return p[0] * f, p[0] / p[2] * f1, p[0] / p[2] ** 2 * f2
    if kind == BOX:
        inside = side[first] > 0 and side[first + 1] < 0
        return (p[0] if inside else 0.0), 0.0, 0.0
    if kind == TENT:
        if side[first] < 0 or side[first + 2] > 0:
            return 0.0, 0.0, 0.0
        sign = 1.0 if side[first + 1] > 0 else -1.0
        return p[0] * (1 - sign * (s - p[1]) / p[2]), -p[0] * sign / p[2], 0.0
    if kind == BELL:
        q = (s - p[1]) / p[2]
        f = p[0] * np.exp(-q * q)
        return f, -2 * q / p[2] * f, (4 * q * q - 2) / p[2] ** 2 * f
    if kind == TABLE:
        a, b = m.function[g, 3], m.function[g, 4]
        k = a
        while k + 1 < b and side[first + k + 1 - a] > 0:
            k += 1
        if side[first] < 0:  # before the table: its first value
            return m.table[a, 1], 0.0, 0.0
        if side[first + b - a] > 0:  # after it
            return p[0], 0.0, 0.0
        q = s - m.table[k, 0]
        c = m.table[k]
        return (
            c[1] + q * (c[2] + q * (c[3] + q * c[4])),
            c[2] + q * (2 * c[3] + 3 * q * c[4]),
            2 * c[3] + 6 * q * c[4],
        )
    return (p[0] if side[first] > 0 else 0.0), 0.0, 0.0  # PULSES


@compiled
def between(par, e, i, j, r, v, w, R):
    """Arms to two points, how far the second is from the first, and how fast."""
    pi, pj = out_of(R, i, three(par, e, 0)), out_of(R, j, three(par, e, 3))
    wi, wj = three(w, i, 0), three(w, j, 0)
    d = minus(plus(three(r, j, 0), pj), plus(three(r, i, 0), pi))
    dd = minus(plus(three(v, j, 0), cross(wj, pj)), plus(three(v, i, 0), cross(wi, pi)))
    return pi, pj, d, dd


@compiled
def coordinates(m, y, r, v, w, R):
    """Values and rates of all coordinates."""
    n_b, n_c = len(m.mass), len(m.coordinate)
    q, qd = np.zeros(n_c), np.zeros(n_c)
    for k in range(n_c):
        i, j = m.coordinate[k, 1], m.coordinate[k, 2]
        a = out_of(R, i, three(m.coordinate_par, k, 6))
        if m.coordinate[k, 0] == TURN:
            q[k] = y[13 * (n_b - 1) + k]
            qd[k] = dot(a, minus(three(w, j, 0), three(w, i, 0)))
        else:
            _, _, d, dd = between(m.coordinate_par, k, i, j, r, v, w, R)
            q[k] = dot(a, d) - m.coordinate_par[k, 9]
            qd[k] = dot(a, dd) + dot(cross(three(w, i, 0), a), d)
    return q, qd


@compiled
def gap(m, f, r, v, w, R, q, qd):
    """Penetration of a force that acts on one side, its rate, and its direction on body j."""
    i, j, par = m.force[f, 1], m.force[f, 2], m.force_par
    n = (0.0, 0.0, 0.0)
    if m.force[f, 0] == LIMIT:
        k = m.force[f, 3]
        return par[f, 4] * (q[k] - par[f, 3]), par[f, 4] * qd[k], n
    if m.force[f, 0] == TOUCH:
        depth, rate, n, _ = meeting(par, f, i, j, r, v, w, R, m.table)
        return depth, rate, n
    if m.force[f, 0] == SEAL:
        return seal_gap(par, f, i, j, r, v, w, R)
    _, _, d, dd = between(par, f, i, j, r, v, w, R)
    a = out_of(R, i, three(par, f, 6))
    ad = cross(three(w, i, 0), a)
    if m.force[f, 0] == WALL:
        return -dot(a, d), -dot(a, dd) - dot(ad, d), a
    s, sd = dot(a, d), dot(ad, d) + dot(a, dd)  # CLEARANCE
    e = minus(d, times(s, a))
    ed = minus(dd, plus(times(sd, a), times(s, ad)))
    size = np.sqrt(dot(e, e))
    if size == 0.0:
        return -par[f, 9], 0.0, n
    n = times(-1.0 / size, e)
    return size - par[f, 9], -dot(n, ed), n


@compiled
def push(Q, b, arm, f):
    if b > 0:
        t = cross(arm, f)
        for c in range(3):
            Q[b, c] += f[c]
            Q[b, 3 + c] += t[c]


@compiled
def twist(Q, b, t):
    if b > 0:
        for c in range(3):
            Q[b, 3 + c] += t[c]


@compiled
def pair(Q, i, j, pj, r, F):
    """F on body j at an arm and -F on body i at the same place."""
    push(Q, j, pj, F)
    push(Q, i, minus(plus(three(r, j, 0), pj), three(r, i, 0)), times(-1.0, F))


@compiled
def on_coordinate(m, Q, k, f, r, R):
    """A torque or force f along coordinate k."""
    i, j = m.coordinate[k, 1], m.coordinate[k, 2]
    a = out_of(R, i, three(m.coordinate_par, k, 6))
    if m.coordinate[k, 0] == TURN:
        twist(Q, j, times(f, a))
        twist(Q, i, times(-f, a))
    else:
        pair(Q, i, j, out_of(R, j, three(m.coordinate_par, k, 3)), r, times(f, a))


@compiled
def note(told, f, size, F):
    told[f, 0] = size
    for c in range(3):
        told[f, 1 + c] = F[c]


@compiled
def gyroscopic(m, b, w, R):
    """w x I w"""
    a = three(w, b, 0)
    l = into(R, b, a)
    I = m.inertia
    h = (
        I[b, 0, 0] * l[0] + I[b, 0, 1] * l[1] + I[b, 0, 2] * l[2],
        I[b, 1, 0] * l[0] + I[b, 1, 1] * l[1] + I[b, 1, 2] * l[2],
        I[b, 2, 0] * l[0] + I[b, 2, 1] * l[1] + I[b, 2, 2] * l[2],
    )
    return cross(a, out_of(R, b, h))


@compiled
def bushing(m, f, Q, r, v, w, R, told):
    """Its forces; the power lost."""
    i, j, p = m.force[f, 1], m.force[f, 2], m.force_par
    _, pj, d, dd = between(p, f, i, j, r, v, w, R)
    wi = three(w, i, 0)
    dd = minus(dd, cross(wi, d))
    wr = minus(three(w, j, 0), wi)
    F, N, lost = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    # the turn of j against i in the axes of the bushing: D_ab = g_a . T g_b
    g0, g1, g2 = three(p, f, 6), three(p, f, 9), three(p, f, 12)
    D = np.zeros((3, 3))
    for b in range(3):
        t = into(R, i, out_of(R, j, three(p, f, 6 + 3 * b)))
        D[0, b], D[1, b], D[2, b] = dot(g0, t), dot(g1, t), dot(g2, t)
    cosine = min(1.0, max(-1.0, 0.5 * (D[0, 0] + D[1, 1] + D[2, 2] - 1.0)))
    s = (D[2, 1] - D[1, 2], D[0, 2] - D[2, 0], D[1, 0] - D[0, 1])
    sine = 0.5 * np.sqrt(dot(s, s))
    a = np.arctan2(sine, cosine)
    theta = times(0.5 * (a / sine if a > 1e-6 else 1.0 + a * a / 6), s)
    beta = 1.0 / 12.0
    if a > 1e-3:
        beta = 1 / (a * a) - (1 + np.cos(a)) / (2 * a * np.sin(a))
    K = (p[f, 21] * theta[0], p[f, 22] * theta[1], p[f, 23] * theta[2])
    # H^T K with H = 1 - [theta]/2 + beta [theta]^2
    first = cross(theta, K)
    second = cross(theta, first)
    moment = minus((0.0, 0.0, 0.0), plus(K, plus(times(0.5, first), times(beta, second))))
    for c in range(3):
        axis = out_of(R, i, three(p, f, 6 + 3 * c))
        x, xd, turn = dot(axis, d), dot(axis, dd), dot(axis, wr)
        F = plus(F, times(-p[f, 15 + c] * x - p[f, 18 + c] * xd, axis))
        N = plus(N, times(moment[c] - p[f, 24 + c] * turn, axis))
        lost += p[f, 18 + c] * xd * xd + p[f, 24 + c] * turn * turn
    pair(Q, i, j, pj, r, F)
    twist(Q, j, N)
    twist(Q, i, times(-1.0, N))
    note(told, f, 0.0, F)
    return lost


@compiled
def one_sided(m, f, side, mem, Q, r, v, w, R, q, qd, told):
    """Of a wall, a limit or a clearance; the power lost."""
    p, kind = m.force_par, m.force[f, 0]
    note(told, f, 0.0, (0.0, 0.0, 0.0))
    if side[m.force[f, 5]] < 0:
        return 0.0
    d, dd, n = gap(m, f, r, v, w, R, q, qd)
    if kind == CLEARANCE:
        elastic = p[f, 10] * max(d, 0.0) ** p[f, 11]
        lost = elastic * 0.75 * (1 - p[f, 12] * p[f, 12]) * dd / mem[f]
    else:
        k = 0 if kind == LIMIT else 9
        elastic = p[f, k] * d
        lost = p[f, k + 1] * smooth(d / p[f, k + 2])[0] * dd
    F = elastic + lost
    if F <= 0.0:
        F, lost = 0.0, -elastic
    if kind == LIMIT:
        on_coordinate(m, Q, m.force[f, 3], -p[f, 4] * F, r, R)
    else:
        i, j = m.force[f, 1], m.force[f, 2]
        pair(Q, i, j, out_of(R, j, three(p, f, 3)), r, times(F, n))
    note(told, f, F, times(F, n))
    return lost * dd


@compiled
def touched(m, f, side, mem, Q, r, v, w, R, z, zd, told, power):
    """Of a contact with a surface."""
    i, j, p = m.force[f, 1], m.force[f, 2], m.force_par
    note(told, f, 0.0, (0.0, 0.0, 0.0))
    if side[m.force[f, 5]] < 0:
        return
    d, rate, n, place = meeting(p, f, i, j, r, v, w, R, m.table)
    elastic, F = normal(p, f, d, rate, mem[f])
    T, M, lost, first, second = rubbed(p, f, i, j, F, n, place, r, v, w, R, z)
    whole = plus(times(F, n), T)
    push(Q, j, minus(place, three(r, j, 0)), whole)
    push(Q, i, minus(place, three(r, i, 0)), times(-1.0, whole))
    twist(Q, j, M)
    twist(Q, i, times(-1.0, M))
    power[IMPACTS] += (F - elastic) * rate
    power[FRICTION] += lost
    if p[f, LAW] == BRISTLES:
        k = int(p[f, BRISTLE])
        zd[k], zd[k + 1] = first, second
    note(told, f, F, whole)


@compiled
def forces(m, t, side, mem, r, v, w, R, q, qd, z, zd, Q, told, power):
    """All applied forces into Q (n, 6); told (f, 4): a magnitude and a vector for each."""
    for c in range(N_WORK):
        power[c] = 0.0
    for b in range(1, len(m.mass)):
        G = gyroscopic(m, b, w, R)
        for c in range(3):
            Q[b, c] += m.gravity[c] / m.mass[b]
            Q[b, 3 + c] -= G[c]
    p = m.force_par
    for f in range(len(m.force)):
        kind, i, j = m.force[f, 0], m.force[f, 1], m.force[f, 2]
        k, g = m.force[f, 3], m.force[f, 4]
        if kind in (FORCE, TORQUE):
            of = m.function[g, 1]
            value = evaluated(m, g, t if of < 0 else p[f, 6] * q[of] + p[f, 7], side)[0]
            n = times(value, out_of(R, i, three(p, f, 3)))  # i: the frame it turns with
            if kind == FORCE:
                pj = out_of(R, j, three(p, f, 0))
                push(Q, j, pj, n)
                power[LOADS] += dot(n, plus(three(v, j, 0), cross(three(w, j, 0), pj)))
            else:
                twist(Q, j, n)
                power[LOADS] += dot(n, three(w, j, 0))
            note(told, f, value, n)
        elif kind in (SPRING, SOFT_LINE):
            _, pj, d, dd = between(p, f, i, j, r, v, w, R)
            l = np.sqrt(dot(d, d))
            n = times(1.0 / l, d)
            ld = dot(n, dd)
            if kind == SPRING:  # k, c, l0, T0
                T = p[f, 9] + p[f, 6] * (l - p[f, 8]) + p[f, 7] * ld
                power[DAMPERS] += p[f, 7] * ld * ld
            else:
                u, ud, _ = evaluated(m, g, t, side)
                T = p[f, 6] * (l - p[f, 8] - u) + p[f, 7] * (ld - ud)
                power[DRIVES] += -T * ud
                power[DAMPERS] += p[f, 7] * (ld - ud) ** 2
            pair(Q, i, j, pj, r, times(-T, n))
            note(told, f, T, times(-T, n))
        elif kind == TORSION:
            T = p[f, 2] - p[f, 0] * q[k] - p[f, 1] * qd[k]
            on_coordinate(m, Q, k, T, r, R)
            power[DAMPERS] += p[f, 1] * qd[k] ** 2
            told[f, 0] = T
        elif kind == SOFT_DRIVE:  # k, c, offset
            u, ud, _ = evaluated(m, g, t, side)
            T = -p[f, 0] * (q[k] - u - p[f, 2]) - p[f, 1] * (qd[k] - ud)
            on_coordinate(m, Q, k, T, r, R)
            power[DRIVES] += T * ud
            power[DAMPERS] += p[f, 1] * (qd[k] - ud) ** 2
            told[f, 0] = T
        elif kind == BUSHING:
            power[DAMPERS] += bushing(m, f, Q, r, v, w, R, told)
        elif kind == TOUCH:
            touched(m, f, side, mem, Q, r, v, w, R, z, zd, told, power)
        elif kind == SEAL:
            lost, rub, n = sealed(p, f, i, j, r, v, w, R, Q)
            power[IMPACTS] += lost
            power[FRICTION] += rub
            note(told, f, dot(out_of(R, i, three(p, f, 6)), n), n)
        else:
            power[IMPACTS] += one_sided(m, f, side, mem, Q, r, v, w, R, q, qd, told)


@compiled
def put(J, e, k, a):
    for c in range(3):
        J[e, k + c] = a[c]


@compiled
def rows(m, t, side, r, v, w, R, q, Ji, Jj, gamma, phi, phid):
    """Jacobians (m, 6) of each row on its two bodies, J a = gamma, and residuals."""
    p = m.row_par
    for e in range(len(m.row)):
        kind, i, j, k, g = m.row[e, 0], m.row[e, 1], m.row[e, 2], m.row[e, 3], m.row[e, 4]
        f, f1, f2 = (0.0, 0.0, 0.0)
        if g >= 0:
            f, f1, f2 = evaluated(m, g, t, side)
        wi, wj = three(w, i, 0), three(w, j, 0)
        for c in range(6):
            Ji[e, c], Jj[e, c] = 0.0, 0.0
        if kind == ACROSS:
            a, b = out_of(R, i, three(p, e, 0)), out_of(R, j, three(p, e, 3))
            n = cross(a, b)
            put(Ji, e, 3, n)
            put(Jj, e, 3, times(-1.0, n))
            nd = plus(cross(cross(wi, a), b), cross(a, cross(wj, b)))
            gamma[e] = -dot(nd, minus(wi, wj))
            phi[e] = dot(a, b)
        elif kind == ANGLE:
            a = out_of(R, i, three(p, e, 6))
            put(Ji, e, 3, times(-1.0, a))
            put(Jj, e, 3, a)
            gamma[e] = f2 - dot(cross(wi, a), minus(wj, wi))
            phi[e] = q[k] - f - p[e, 9]
        else:
            pi, pj, d, dd = between(p, e, i, j, r, v, w, R)
            bend = minus(cross(wj, cross(wj, pj)), cross(wi, cross(wi, pi)))
            if kind == POINT:
                u = (1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0)
                gamma[e], phi[e] = -dot(bend, u), dot(d, u)
                lean = (0.0, 0.0, 0.0)
            elif kind == ALONG:
                u = out_of(R, i, three(p, e, 6))
                ud = cross(wi, u)
                lean = cross(u, d)
                gamma[e] = f2 - dot(u, bend) - 2 * dot(ud, dd) - dot(cross(wi, ud), d)
                phi[e] = dot(u, d) - f - p[e, 9]
            else:
                l = np.sqrt(dot(d, d))
                u = times(1.0 / l, d)
                lean = (0.0, 0.0, 0.0)
                ld = dot(u, dd)
                gamma[e] = f2 - dot(u, bend) - (dot(dd, dd) - ld * ld) / l
                phi[e] = l - f - p[e, 9]
            put(Jj, e, 0, u)
            put(Ji, e, 0, times(-1.0, u))
            put(Jj, e, 3, cross(pj, u))
            put(Ji, e, 3, minus(lean, cross(pi, u)))
        s = -f1
        for c in range(3):
            s += Ji[e, c] * v[i, c] + Jj[e, c] * v[j, c]
            s += Ji[e, 3 + c] * wi[c] + Jj[e, 3 + c] * wj[c]
        phid[e] = s


@compiled
def light(m, R, b, J, e, out):
    """M^-1 J of body b into row e."""
    for c in range(6):
        out[e, c] = 0.0
    if b > 0:
        for c in range(3):
            out[e, c] = J[e, c] * m.mass[b]
        l = into(R, b, three(J, e, 3))
        I = m.inverse
        h = (
            I[b, 0, 0] * l[0] + I[b, 0, 1] * l[1] + I[b, 0, 2] * l[2],
            I[b, 1, 0] * l[0] + I[b, 1, 1] * l[1] + I[b, 1, 2] * l[2],
            I[b, 2, 0] * l[0] + I[b, 2, 1] * l[1] + I[b, 2, 2] * l[2],
        )
        put(out, e, 3, out_of(R, b, h))


@compiled
def shared(A, a, B, b):
    s = 0.0
    for c in range(6):
        s += A[a, c] * B[b, c]
    return s


@compiled
def factored(m, R, Ji, Jj, Wi, Wj, S):
    """L of S = J M^-1 J^T, and M^-1 J^T on both bodies of each row; the smallest pivot."""
    n = len(m.row)
    for e in range(n):
        light(m, R, m.row[e, 1], Ji, e, Wi)
        light(m, R, m.row[e, 2], Jj, e, Wj)
    for a in range(n):
        ai, aj = m.row[a, 1], m.row[a, 2]
        for b in range(a + 1):
            bi, bj = m.row[b, 1], m.row[b, 2]
            s = 0.0
            if ai == bi:
                s += shared(Ji, a, Wi, b)
            if ai == bj:
                s += shared(Ji, a, Wj, b)
            if aj == bi:
                s += shared(Jj, a, Wi, b)
            if aj == bj:
                s += shared(Jj, a, Wj, b)
            S[a, b] = s
    smallest = 1.0
    for a in range(n):  # Cholesky, in place
        for b in range(a + 1):
            s = S[a, b]
            for c in range(b):
                s -= S[a, c] * S[b, c]
            if a == b:
                smallest = min(smallest, s / S[a, a])
                S[a, a] = np.sqrt(max(s, 1e-300))
            else:
                S[a, b] = s / S[b, b]
    return smallest


@compiled
def solve(L, s):
    """In place of s."""
    n = len(s)
    for a in range(n):
        for c in range(a):
            s[a] -= L[a, c] * s[c]
        s[a] /= L[a, a]
    for a in range(n - 1, -1, -1):
        for c in range(a + 1, n):
            s[a] -= L[c, a] * s[c]
        s[a] /= L[a, a]


@compiled
def spread(m, Wi, Wj, lam, out):
    """M^-1 J^T lambda, added."""
    for e in range(len(lam)):
        i, j = m.row[e, 1], m.row[e, 2]
        for c in range(6):
            if i > 0:
                out[i, c] += Wi[e, c] * lam[e]
            if j > 0:
                out[j, c] += Wj[e, c] * lam[e]


@compiled
def turned(y, k, w, f, out, o):
    """f times half the product of (0, w) and the quaternion at k, added at o."""
    p0, p1, p2, p3 = y[k], y[k + 1], y[k + 2], y[k + 3]
    h = 0.5 * f
    d0 = h * (-p1 * w[0] - p2 * w[1] - p3 * w[2])
    d1 = h * (p0 * w[0] + w[1] * p3 - w[2] * p2)
    d2 = h * (p0 * w[1] + w[2] * p1 - w[0] * p3)
    d3 = h * (p0 * w[2] + w[0] * p2 - w[1] * p1)
    out[o] += d0
    out[o + 1] += d1
    out[o + 2] += d2
    out[o + 3] += d3


@compiled
def derivative(m, t, y, side, mem, yd, lam, told):
    """y' into yd, multipliers into lam; the smallest relative pivot of S."""
    n_b, n_r, n_c = len(m.mass), len(m.row), len(m.coordinate)
    R = rotations(y, n_b)
    r, v, w = places(y, n_b)
    q, qd = coordinates(m, y, r, v, w, R)
    Q, a, power = np.zeros((n_b, 6)), np.zeros((n_b, 6)), np.zeros(N_WORK)
    k = 13 * (n_b - 1) + n_c
    z, zd = y[k : len(y) - N_WORK], np.zeros(len(y) - N_WORK - k)
    forces(m, t, side, mem, r, v, w, R, q, qd, z, zd, Q, told, power)
    for b in range(1, n_b):
        light(m, R, b, Q, b, a)
    pivot = 1.0
    if n_r > 0:
        Ji, Jj, Wi, Wj = (
            np.empty((n_r, 6)), np.empty((n_r, 6)), np.empty((n_r, 6)), np.empty((n_r, 6)),
        )  # fmt: skip
        phi, phid, S = np.empty(n_r), np.empty(n_r), np.zeros((n_r, n_r))
        rows(m, t, side, r, v, w, R, q, Ji, Jj, lam, phi, phid)
        pivot = factored(m, R, Ji, Jj, Wi, Wj, S)
        for e in range(n_r):
            lam[e] -= shared(Ji, e, a, m.row[e, 1]) + shared(Jj, e, a, m.row[e, 2])
        solve(S, lam)
        spread(m, Wi, Wj, lam, a)
        for e in range(n_r):
            if m.row[e, 4] >= 0:
                power[DRIVES] += lam[e] * evaluated(m, m.row[e, 4], t, side)[1]
    for k in range(len(yd)):
        yd[k] = 0.0
    for b in range(1, n_b):
        k = 13 * (b - 1)
        for c in range(3):
            yd[k + c] = v[b, c]
        turned(y, k + 3, three(w, b, 0), 1.0, yd, k + 3)
        for c in range(6):
            yd[k + 7 + c] = a[b, c]
    k = 13 * (n_b - 1)
    for c in range(n_c):
        yd[k + c] = qd[c] if m.coordinate[c, 0] == TURN else 0.0
    for c in range(len(zd)):
        yd[k + n_c + c] = zd[c]
    for c in range(N_WORK):
        yd[len(y) - N_WORK + c] = power[c]
    return pivot


@compiled
def projected(m, t, y, side):
    """Place and velocity back on the rows, once; how far they were off."""
    n_b, n_r = len(m.mass), len(m.row)
    if n_r == 0:
        return 0.0
    Ji, Jj, Wi, Wj = (
        np.empty((n_r, 6)), np.empty((n_r, 6)), np.empty((n_r, 6)), np.empty((n_r, 6)),
    )  # fmt: skip
    gamma, phi, phid = np.empty(n_r), np.empty(n_r), np.empty(n_r)
    S = np.zeros((n_r, n_r))
    off = 0.0
    for part in range(2):
        R = rotations(y, n_b)
        r, v, w = places(y, n_b)
        q, _ = coordinates(m, y, r, v, w, R)
        rows(m, t, side, r, v, w, R, q, Ji, Jj, gamma, phi, phid)
        factored(m, R, Ji, Jj, Wi, Wj, S)
        for e in range(n_r):
            if part == 0:
                off = max(off, abs(phi[e]))
            gamma[e] = -phi[e] if part == 0 else -phid[e]
        solve(S, gamma)
        d = np.zeros((n_b, 6))
        spread(m, Wi, Wj, gamma, d)
        for b in range(1, n_b):
            k = 13 * (b - 1)
            if part == 1:
                for c in range(6):
                    y[k + 7 + c] += d[b, c]
                continue
            for c in range(3):
                y[k + c] += d[b, c]
            turned(y, k + 3, three(d, b, 3), 1.0, y, k + 3)
            size = np.sqrt(y[k + 3] ** 2 + y[k + 4] ** 2 + y[k + 5] ** 2 + y[k + 6] ** 2)
            for c in range(3, 7):
                y[k + c] /= size
        if part == 0:
            k = 13 * (n_b - 1)
            for c in range(len(m.coordinate)):
                if m.coordinate[c, 0] == TURN:
                    i, j = m.coordinate[c, 1], m.coordinate[c, 2]
                    a = out_of(R, i, three(m.coordinate_par, c, 6))
                    y[k + c] += dot(a, minus(three(d, j, 3), three(d, i, 3)))
    return off


@compiled
def of_contact(m, kind, f, value, r, v, w, R, par):
    """What is watched of a contact with a surface, or of a seal."""
    i, j = m.force[f, 1], m.force[f, 2]
    if kind == W_END:
        _, _, _, x0, x1 = seal_ends(par, f, i, j, r, R)
        return x0 if value == 0.0 else x1
    d, rate, n, place = meeting(par, f, i, j, r, v, w, R, m.table)
    if kind == W_SLIP:
        return sliding(n, i, j, r, v, w, place)[1] - value
    if kind == W_WHOLE:
        return d / par[f, RAMP_OF] - 1.0
    if kind == W_PULL:
        if d <= 0.0:
            return 1.0
        loss = par[f, LOSS] * smooth(d / par[f, RAMP_OF])[0] * rate
        return 1.0 + loss / (par[f, STIFFNESS] * d ** par[f, STIFFNESS + 1])
    _, size, along = rolling(n, i, j, w)
    return par[f, BALL_RADIUS] * (size if kind == W_ROLL else abs(along)) - value


@compiled
def watched(m, t, y, out):
    """How far everything watched is above its value."""
    n_b = len(m.mass)
    if len(m.watch) == 0:
        return
    R = rotations(y, n_b)
    r, v, w = places(y, n_b)
    q, qd = coordinates(m, y, r, v, w, R)
    p = m.watch_par
    for k in range(len(m.watch)):
        kind, of = m.watch[k, 0], m.watch[k, 1]
        if kind == W_TIME:
            out[k] = t - p[k, 0]
        elif kind == W_PLACE:
            out[k] = p[k, 1] * q[of] + p[k, 2] - p[k, 0]
        elif kind == W_RATE:
            out[k] = p[k, 1] * qd[of] - p[k, 0]
        elif kind == W_GAP:
            out[k] = gap(m, of, r, v, w, R, q, qd)[0]
        elif kind >= W_SLIP:
            out[k] = of_contact(m, kind, of, p[k, 0], r, v, w, R, m.force_par)
        elif kind in (W_RAMP, W_PUSH):
            d, dd, _ = gap(m, of, r, v, w, R, q, qd)
            first = 0 if m.force[of, 0] == LIMIT else 9
            ramp = m.force_par[of, first + 2]
            out[k] = d / ramp - 1.0
            if kind == W_PUSH:
                # force over that of its spring: below 0 it would pull, and is none
                loss = m.force_par[of, first + 1] / m.force_par[of, first]
                out[k] = 1.0
                if d > 0.0:
                    out[k] += loss * dd * smooth(d / ramp)[0] / d
        else:
            x = t if of < 0 else p[k, 1] * q[of] + p[k, 2]
            out[k] = np.sin(p[k, 3] * x) - p[k, 0]


@compiled
def remembers(m, k):
    """Whether what is watched is a contact whose force depends on how it began."""
    of = m.watch[k, 1]
    kind = m.force[of, 0]
    return m.watch[k, 0] == W_GAP and kind in (CLEARANCE, TOUCH) and m.force_par[of, 12] < 1.0


@compiled
def step(m, t, y, h, side, mem, first, K, lam, told, rtol, size, out):
    """One step of order 8 into out; its error in units of the tolerance."""
    n = len(y)
    for c in range(n):
        K[0, c] = first[c]
    z = np.empty(n)
    for s in range(1, 12):
        for c in range(n):
            inc = 0.0
            for a in range(s):
                inc += A[s, a] * K[a, c]
            z[c] = y[c] + h * inc
        derivative(m, t + C[s] * h, z, side, mem, K[s], lam, told)
    e3, e5 = 0.0, 0.0
    for c in range(n):
        inc, a3, a5 = 0.0, 0.0, 0.0
        for s in range(12):
            inc += B[s] * K[s, c]
            a3 += E3[s] * K[s, c]
            a5 += E5[s] * K[s, c]
        out[c] = y[c] + h * inc
        scale = rtol * max(size[c], max(abs(y[c]), abs(out[c])))
        e3 += (a3 / scale) ** 2
        e5 += (a5 / scale) ** 2
    if e5 == 0.0 and e3 == 0.0:
        return 0.0
    return abs(h) * e5 / np.sqrt((e5 + 0.01 * e3) * n)


@compiled
def fastest(m, y):
    w = 0.0
    for b in range(1, len(m.mass)):
        k = 13 * (b - 1) + 10
        w = max(w, np.sqrt(y[k] ** 2 + y[k + 1] ** 2 + y[k + 2] ** 2))
    return w


@compiled
def slopes(m, t, y, yd, out):
    """Rates of everything watched, by a central difference along the motion."""
    n = len(y)
    if len(m.watch) == 0:
        return
    e = 1e-6 / (1.0 + fastest(m, y))
    z, down = np.empty(n), np.zeros(len(m.watch))
    for c in range(n):
        z[c] = y[c] + e * yd[c]
    watched(m, t + e, z, out)
    for c in range(n):
        z[c] = y[c] - e * yd[c]
    watched(m, t - e, z, down)
    for k in range(len(m.watch)):
        out[k] = (out[k] - down[k]) / (2 * e)


@compiled
def copied(a, b):
    for c in range(len(a)):
        b[c] = a[c]


@compiled
def kept_end(ends, k, t, stretch, y, yd, lam, told):
    """The end of a step kept as the k-th, if there is room; how many there are."""
    if k >= len(ends[0]):
        return k
    ends[0][k, 0], ends[0][k, 1] = t, stretch
    copied(y, ends[1][k])
    copied(yd, ends[2][k])
    copied(lam, ends[3][k])
    for f in range(len(told)):
        copied(told[f], ends[4][k, f])
    return k + 1


@compiled
def march(m, t, y, side, mem, deep, times, h_max, turn, rtol, size, limit, singular, room):
    """Integrate over the times.

    deep (w): how far each has been on the side it is on.  singular: the least pivot let pass.
    room: for so many ends of steps, which are returned too; a crossing is there twice, with the
    sides before it and behind it.

    Returns rows of y, y', multipliers, forces; crossings (time, watched, rate, new side, how far it
    was on the old side, all coordinates, all rates); touches of zero that turned back or nearly
    got there (time, watched, distance); time, rows, status, steps, the worst residual of a row,
    the smallest pivot; y; ends of steps: time, which stretch between crossings, as rows.
    """
    n, n_w, n_t = len(y), len(m.watch), len(times)
    Y, YD = np.full((n_t, n), np.nan), np.full((n_t, n), np.nan)
    LAM = np.full((n_t, len(m.row)), np.nan)
    F = np.full((n_t, len(m.force), 4), np.nan)
    n_c, n_b = len(m.coordinate), len(m.mass)
    crossed, grazed = np.empty((limit, 5 + 2 * n_c)), np.empty((limit, 3))
    opening, n_o, opened = np.empty((limit, 3)), 0, np.full(n_w, -1.0)
    n_x, n_g = 0, 0
    K, yd, out = np.zeros((12, n)), np.zeros(n), np.zeros(n)
    trial, ydt = np.zeros(n), np.zeros(n)
    lam, told = np.zeros(len(m.row)), np.zeros((len(m.force), 4))
    g0, g1, gt = np.zeros(n_w), np.zeros(n_w), np.zeros(n_w)
    s0, s1, sm = np.zeros(n_w), np.zeros(n_w), np.zeros(n_w)
    pivot = derivative(m, t, y, side, mem, yd, lam, told)
    when_at, ends_y, ends_yd = np.empty((room, 2)), np.empty((room, n)), np.empty((room, n))
    ends_lam, ends_f = np.empty((room, len(m.row))), np.empty((room, len(m.force), 4))
    ends = (when_at, ends_y, ends_yd, ends_lam, ends_f)
    n_e, stretch = kept_end(ends, 0, t, 0, y, yd, lam, told), 0
    watched(m, t, y, g0)
    h, row, worst, status, steps = min(h_max, 1e-3), 0, 0.0, DONE, 0
    rejected = False
    while row < n_t:
        if t >= times[row] - 1e-14 * max(1.0, abs(t)):
            copied(y, Y[row])
            copied(yd, YD[row])
            copied(lam, LAM[row])
            for f in range(len(told)):
                copied(told[f], F[row, f])
            row += 1
            continue
        steps += 1
        if steps > MOST:
            status = TOO_MANY
            break
        h = min(h, h_max, turn / max(fastest(m, y), 1e-30))
        left = times[row] - t
        hit = h >= left
        hs = left if hit else (h if left > 2 * h else 0.5 * left)
        if hs < 1e-15 * max(1.0, abs(t)):
            status = STUCK
            break
        error = step(m, t, y, hs, side, mem, yd, K, lam, told, rtol, size, out)
        if pivot < singular:
            status = SINGULAR
            break
        if not error <= 1.0:
            h = hs * (0.2 if not error < 1e30 else max(0.2, 0.9 * error ** (-1 / 8)))
            rejected = True
            derivative(m, t, y, side, mem, yd, lam, told)
            continue
        grow = min(4.0, 0.9 * max(error, 1e-12) ** (-1 / 8))
        h_next = hs * (min(1.0, grow) if rejected else grow)
        rejected = False
        off = projected(m, t + hs, out, side)
        # does something cross, or come near and turn?
        watched(m, t + hs, out, g1)
        which, when = -1, hs
        if n_w > 0:
            slopes(m, t, y, yd, s0)
            derivative(m, t + hs, out, side, mem, ydt, lam, told)
            slopes(m, t + hs, out, ydt, s1)
            for k in range(n_w):
                sd = side[k]
                inside = -1.0
                a, b = 0.0, hs
                if g1[k] * sd < 0.0:
                    inside = hs
                elif s0[k] * sd < 0.0 and s1[k] * sd > 0.0 and g0[k] * sd > 0.0:
                    near = min(abs(g0[k]), abs(g1[k]))
                    if near >= 2.0 * hs * max(abs(s0[k]), abs(s1[k])):
                        # no step from it: it turns back at half of that, at least
                        if remembers(m, k) and sd > 0.0 and n_o < limit:
                            opening[n_o, 0], opening[n_o, 1], opening[n_o, 2] = t, k, near
                            n_o += 1
                    else:
                        # the turning point, by halving the slope's sign
                        lo, hi = 0.0, hs
                        for _ in range(60):
                            mid = 0.5 * (lo + hi)
                            step(m, t, y, mid, side, mem, yd, K, lam, told, rtol, size, trial)
                            projected(m, t + mid, trial, side)
                            watched(m, t + mid, trial, gt)
                            if gt[k] * sd < 0.0:
                                inside = mid
                                break
                            derivative(m, t + mid, trial, side, mem, ydt, lam, told)
                            slopes(m, t + mid, trial, ydt, sm)
                            if sm[k] * sd < 0.0:
                                lo = mid
                            else:
                                hi = mid
                            if hi - lo < 1e-7 * hs:
                                break
                        low = abs(gt[k])
                        if inside < 0.0 and remembers(m, k) and sd > 0.0 and n_o < limit:
                            opening[n_o, 0], opening[n_o, 1], opening[n_o, 2] = t + mid, k, low
                            n_o += 1
                        if n_g < limit and low < NEAR:
                            grazed[n_g, 0], grazed[n_g, 1], grazed[n_g, 2] = t + mid, k, gt[k]
                            n_g += 1
                if inside < 0.0:
                    continue
                # the root between 0, where its sign is that of its side, and inside
                a, b = 0.0, inside
                ga, gb = max(abs(g0[k]), 1e-300), -1.0
                for it in range(80):
                    mid = 0.5 * (a + b)
                    if it % 3 != 2 and gb < 0.0 and it > 0:
                        mid = a + (b - a) * ga / (ga - gb)
                    step(m, t, y, mid, side, mem, yd, K, lam, told, rtol, size, trial)
                    projected(m, t + mid, trial, side)
                    watched(m, t + mid, trial, gt)
                    if gt[k] * sd > 0.0:
                        a, ga = mid, gt[k] * sd
                    else:
                        b, gb = mid, gt[k] * sd
                    if b - a < 1e-15 * max(abs(t), 1e-3) or gt[k] == 0.0:
                        break
                if b < when or which < 0:
                    which, when = k, b
        if which >= 0:
            step(m, t, y, when, side, mem, yd, K, lam, told, rtol, size, out)
            off = projected(m, t + when, out, side)
            hit = False
        worst = max(worst, off)
        t = times[row] if hit and which < 0 else t + when
        copied(out, y)
        pivot = min(pivot, derivative(m, t, y, side, mem, yd, lam, told))
        n_e = kept_end(ends, n_e, t, stretch, y, yd, lam, told)
        watched(m, t, y, g0)
        for k in range(n_w):
            if k != which:
                deep[k] = max(deep[k], g0[k] * side[k])
        h = h_next
        if which >= 0:
            slopes(m, t, y, yd, s1)
            if n_x == limit:
                status = TOO_MANY
                break
            crossed[n_x, 0], crossed[n_x, 1] = t, which
            crossed[n_x, 2], crossed[n_x, 3] = s1[which], -side[which]
            crossed[n_x, 4] = deep[which]
            R = rotations(y, n_b)
            r, v, w = places(y, n_b)
            q, qd = coordinates(m, y, r, v, w, R)
            for c in range(n_c):
                crossed[n_x, 5 + c], crossed[n_x, 5 + n_c + c] = q[c], qd[c]
            n_x += 1
            side[which] = -side[which]
            if remembers(m, which) and side[which] > 0.0 and opened[which] >= 0.0 and n_o < limit:
                opening[n_o, 0], opening[n_o, 1], opening[n_o, 2] = (
                    opened[which],
                    which,
                    deep[which],
                )
                n_o += 1
            opened[which] = t
            deep[which] = 0.0
            if m.watch[which, 0] == W_GAP and side[which] > 0:
                mem[m.watch[which, 1]] = max(s1[which], mem[m.watch[which, 1]])
                of = m.watch[which, 1]
                if m.force[of, 0] == TOUCH and m.force_par[of, LAW] == BRISTLES:
                    first = 13 * (n_b - 1) + n_c + int(m.force_par[of, BRISTLE])
                    y[first], y[first + 1] = 0.0, 0.0
            if m.watch[which, 0] == W_GAP and side[which] < 0:
                mem[m.watch[which, 1]] = m.force_par[m.watch[which, 1], 13]
            h = min(h, 1e-2 * h + 1e-6)
            derivative(m, t, y, side, mem, yd, lam, told)
            stretch += 1
            n_e = kept_end(ends, n_e, t, stretch, y, yd, lam, told)
            if m.watch[which, 2] == 1 and (
                m.watch[which, 3] == 0 or m.watch[which, 3] == side[which]
            ):
                status = STOPPED
                break
    return (
        (Y, YD, LAM, F), crossed[:n_x], grazed[:n_g], opening[:n_o],
        (t, row, status, steps, worst, pivot), y,
        (when_at[:n_e], ends_y[:n_e], ends_yd[:n_e], ends_lam[:n_e], ends_f[:n_e]),
    )  # fmt: skip
