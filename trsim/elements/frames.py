"""Vectors, arms and the three constraint rows every joint is made of.

A frame i has position r_i, rotation R_i and twist (r_i', omega_i).  With s_i a vector in its axes,

    p_i  = R_i s_i                     arm: a point seen from the centre of mass, world axes
    p_i' = omega_i x p_i
    v_i  = r_i' + omega_i x p_i        velocity of the point

All joints are intersections of four rows [Nikravesh1988] [Haug1989]:

    point          Phi = (r_j + p_j - r_i - p_i) . e      e a world axis
    along          Phi = u . (r_j + p_j - r_i - p_i)      u fixed in frame i
    perpendicular  Phi = u . w                            u fixed in frame i, w in frame j
    distance       Phi = |r_j + p_j - r_i - p_i| - f

J holds a row line by line, one of (r_f', omega_f) for each frame f it names: of these rows i, then
j.  gamma are the terms without accelerations, J V' = gamma.  A row index below 0 means the row was
dropped (planar scene, redundant).
The multiplier of a row is minus the generalised force it puts on body j along its direction.
"""

from math import sqrt

from trsim.elements.contract import Pair, Turning
from trsim.kernels.columns import V3, constraint_row, f8, i8
from trsim.kernels.lazy import internal

PARALLEL = 0.9  # a cosine: nearer to a line directions span no plane well


class TwoPoints(Pair):
    """Of an element between a point of each frame."""

    p_i: V3  # m, from the centre of mass in the axes of frame i
    p_j: V3


class TwoAngles(Pair):
    """Of an element between two hinges, each between two frames: c_1 phi_1 + c_2 phi_2."""

    i_2: i8
    j_2: i8
    c_1: f8  # m
    c_2: f8


class OnSurface(TwoPoints):
    """Of an element between a surface of body i and a ball around a point of body j, or an outline
    with a round edge."""

    ball: f8  # m, its radius; 0 of a point
    sharp: f8  # m: how its distance from the surface bends, see laws/surfaces.py
    reach: f8
    span: f8  # m: of an outline, how far its corners are from its point
    wide: f8  # m: how far the places of a profile are from its origin where an outline meets it
    bulge: f8  # m: the largest radius of its arcs


class Edge(TwoPoints):
    """Of an element between a plane of body i and a straight line of body j from its point on."""

    length: f8  # m


def points(at, i, j, p, q, coordinate=-1):
    """These columns, of the points p of body i and q of body j as drawn."""
    return {
        "i": i, "j": j, "coordinate": coordinate, "p_i": at.local(i, p), "p_j": at.local(j, q),
    }  # fmt: skip


def between_points(row):
    """Turning of what acts between a point of either body and does nothing else to them."""
    own = TwoPoints.of(row)
    return Turning(points=((own.i, own.p_i), (own.j, own.p_j)))


def at_both(row):
    """The places where what is between two points acts on their bodies."""
    own = TwoPoints.of(row)
    return (own.i, own.p_i), (own.j, own.p_j)


class Along(TwoPoints):
    """Of an element along an axis or about it, such as that of a joint."""

    axis: V3  # in the axes of frame i


def on_joint(x):
    """These columns, of the coordinate of a joint."""
    places = {"p_i": x.s_i, "p_j": x.s_j, "axis": x.axis_i}
    return {"i": x.i, "j": x.j, "coordinate": x.entry, **places}


class Coincident(TwoPoints):
    """Of a joint whose points coincide along the world axes."""

    x: constraint_row
    y: constraint_row
    z: constraint_row


@internal
def arm(X, i, s):
    """R_i s, world axes."""
    return (
        X[i, 3] * s[0] + X[i, 4] * s[1] + X[i, 5] * s[2],
        X[i, 6] * s[0] + X[i, 7] * s[1] + X[i, 8] * s[2],
        X[i, 9] * s[0] + X[i, 10] * s[1] + X[i, 11] * s[2],
    )


@internal
def inside(X, i, v):
    """R_i^T v: a vector in world axes, in those of frame i."""
    return (
        X[i, 3] * v[0] + X[i, 6] * v[1] + X[i, 9] * v[2],
        X[i, 4] * v[0] + X[i, 7] * v[1] + X[i, 10] * v[2],
        X[i, 5] * v[0] + X[i, 8] * v[1] + X[i, 11] * v[2],
    )


@internal
def times(I, v):
    """A tensor, row by row, times a vector."""
    return (
        I[0] * v[0] + I[1] * v[1] + I[2] * v[2],
        I[3] * v[0] + I[4] * v[1] + I[5] * v[2],
        I[6] * v[0] + I[7] * v[1] + I[8] * v[2],
    )


@internal
def plus(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@internal
def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@internal
def scaled(c, a):
    return c * a[0], c * a[1], c * a[2]


@internal
def cross(a, b):
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@internal
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@internal
def two_points(scene, e):
    """Both bodies of instance e with the arms of its points."""
    own = TwoPoints(scene, e)
    return own.i, arm(scene.X, own.i, own.p_i), own.j, arm(scene.X, own.j, own.p_j)


@internal
def spin(V, i):
    """omega_i."""
    return (V[i, 3], V[i, 4], V[i, 5])


@internal
def point(X, i, p):
    """World position of the end of the arm p."""
    return (X[i, 0] + p[0], X[i, 1] + p[1], X[i, 2] + p[2])


@internal
def velocity(V, i, p):
    """World velocity of the end of the arm p."""
    o0, o1, o2 = V[i, 3], V[i, 4], V[i, 5]
    return (
        V[i, 0] + o1 * p[2] - o2 * p[1],
        V[i, 1] + o2 * p[0] - o0 * p[2],
        V[i, 2] + o0 * p[1] - o1 * p[0],
    )


@internal
def centripetal(V, i, p):
    """omega x (omega x p)."""
    o = (V[i, 3], V[i, 4], V[i, 5])
    w = dot(o, p)
    o2 = dot(o, o)
    return (o[0] * w - p[0] * o2, o[1] * w - p[1] * o2, o[2] * w - p[2] * o2)


@internal
def inward(V, i, p):
    """omega x (omega x p) where nothing leaves the plane."""
    o2 = V[i, 5] * V[i, 5]
    return (-p[0] * o2, -p[1] * o2, 0.0)


@internal
def push(F, i, p, f):
    """Apply the force f to body i at the end of the arm p."""
    F[i, 0] += f[0]
    F[i, 1] += f[1]
    F[i, 2] += f[2]
    F[i, 3] += p[1] * f[2] - p[2] * f[1]
    F[i, 4] += p[2] * f[0] - p[0] * f[2]
    F[i, 5] += p[0] * f[1] - p[1] * f[0]


@internal
def push_apart(F, i, p_i, j, p_j, f):
    """Apply the force f to body j at the end of the arm p_j, and -f to body i at that of p_i."""
    push(F, j, p_j, f)
    push(F, i, p_i, (-f[0], -f[1], -f[2]))


@internal
def twist_apart(F, i, j, m):
    """Apply the moment m to body j and -m to body i."""
    twist(F, j, m)
    twist(F, i, (-m[0], -m[1], -m[2]))


@internal
def twist(F, i, m):
    """Apply the moment m to body i."""
    F[i, 3] += m[0]
    F[i, 4] += m[1]
    F[i, 5] += m[2]


@internal
def impulse(blow, k, p_i, p_j, f):
    """Row k of what an impact acts with: the impulse f on body j at the end of the arm p_j, and -f
    on body i at that of p_i; see `strike` of contract.py."""
    m_i, m_j = cross(p_i, f), cross(p_j, f)
    for c in range(3):
        blow[k, c], blow[k, 3 + c] = f[c], m_j[c]
        blow[k, 6 + c], blow[k, 9 + c] = -f[c], -m_i[c]


@internal
def impulses(blow, p_i, p_j, n, z, x):
    """All rows of it: n and two directions across it, one across z, or x where n is nearly z."""
    a = x if abs(dot(z, n)) > PARALLEL else z
    t = cross(n, a)
    t = scaled(1.0 / sqrt(dot(t, t)), t)
    impulse(blow, 0, p_i, p_j, n)
    impulse(blow, 1, p_i, p_j, t)
    impulse(blow, 2, p_i, p_j, cross(n, t))


@internal
def separation(X, i, p_i, j, p_j):
    """From the point on i to the point on j, world axes."""
    return (
        X[j, 0] + p_j[0] - X[i, 0] - p_i[0],
        X[j, 1] + p_j[1] - X[i, 1] - p_i[1],
        X[j, 2] + p_j[2] - X[i, 2] - p_i[2],
    )


@internal
def apart(scene, e):
    """Arms of the points of instance e, their separation and its rate."""
    V = scene.V
    i, p_i, j, p_j = two_points(scene, e)
    d_dot = minus(velocity(V, j, p_j), velocity(V, i, p_i))
    return p_i, p_j, separation(scene.X, i, p_i, j, p_j), d_dot


@internal
def carried(scene, e):
    """Arms on both bodies of the second point of instance e, their separation as above, and how
    fast the point moves against body i there."""
    V = scene.V
    i, p_i, j, p_j = two_points(scene, e)
    d = separation(scene.X, i, p_i, j, p_j)
    r_i = plus(p_i, d)
    return r_i, p_j, d, minus(velocity(V, j, p_j), velocity(V, i, r_i))


@internal
def act_along(scene, e, f, turns):
    """Apply f to body j of instance e and -f to body i: a moment where the coordinate that it acts
    along turns, else a force at the point of body j."""
    own = Pair(scene, e)
    if turns == 1:
        twist_apart(scene.F, own.i, own.j, f)
    else:
        r_i, p_j, _, _ = carried(scene, e)
        push_apart(scene.F, own.i, r_i, own.j, p_j, f)


@internal
def turned_round(scene, e, v_t):
    """Whether what rubbed fully at the start of a step slides the other way round at v_t."""
    slid = scene.slid
    return slid[e, 3] * v_t[0] + slid[e, 4] * v_t[1] + slid[e, 5] * v_t[2] < 0.0


@internal
def relative_spin(V, i, j):
    """Angular velocity of body j against body i."""
    return minus(spin(V, j), spin(V, i))


@internal
def lines(scene, k, f, m_i, m_j):
    """J of row k between two frames: the force f on j and -f on i, with their moments."""
    _put(scene.J, scene.row_start[k], -1.0, f, m_i)
    _put(scene.J, scene.row_start[k] + 1, 1.0, f, m_j)


@internal
def _put(J, line, sign, f, m):
    """A line of J: the force f and the moment m, times sign."""
    J[line, 0], J[line, 1], J[line, 2] = sign * f[0], sign * f[1], sign * f[2]
    J[line, 3], J[line, 4], J[line, 5] = sign * m[0], sign * m[1], sign * m[2]


@internal
def turn_lines(scene, k, n):
    """J of row k between two frames, where Phi' = n . (omega_j - omega_i)."""
    J, l = scene.J, scene.row_start[k]
    for c in range(3):
        J[l, c] = 0.0
        J[l + 1, c] = 0.0
        J[l, 3 + c] = -n[c]
        J[l + 1, 3 + c] = n[c]


@internal
def point_rows(scene, e):
    """The points of instance e coincide along the world axes whose row is not negative."""
    V, phi, phi_t, gamma = scene.V, scene.phi, scene.phi_t, scene.gamma
    i, p_i, j, p_j = two_points(scene, e)
    own = Coincident(scene, e)
    kx, ky, kz = own.x, own.y, own.z
    d = separation(scene.X, i, p_i, j, p_j)
    if scene.d == 3:
        c = minus(inward(V, i, p_i), inward(V, j, p_j))
    else:
        c = minus(centripetal(V, i, p_i), centripetal(V, j, p_j))
    if kx >= 0:
        phi[kx], phi_t[kx], gamma[kx] = d[0], 0.0, c[0]
        lines(scene, kx, (1.0, 0.0, 0.0), (0.0, p_i[2], -p_i[1]), (0.0, p_j[2], -p_j[1]))
    if ky >= 0:
        phi[ky], phi_t[ky], gamma[ky] = d[1], 0.0, c[1]
        lines(scene, ky, (0.0, 1.0, 0.0), (-p_i[2], 0.0, p_i[0]), (-p_j[2], 0.0, p_j[0]))
    if kz >= 0:
        phi[kz], phi_t[kz], gamma[kz] = d[2], 0.0, c[2]
        lines(scene, kz, (0.0, 0.0, 1.0), (p_i[1], -p_i[0], 0.0), (p_j[1], -p_j[0], 0.0))


@internal
def along_row(scene, e, u, k):
    """u . d as row k, u an arm of body i (world axes), d the separation of the points of e."""
    V, phi, phi_t, gamma = scene.V, scene.phi, scene.phi_t, scene.gamma
    i, p_i, j, p_j = two_points(scene, e)
    d = separation(scene.X, i, p_i, j, p_j)
    # the direction turns with body i, so its lever on i reaches to the point on j
    lines(scene, k, u, cross(plus(p_i, d), u), cross(p_j, u))
    phi_t[k] = 0.0
    if scene.d == 3:
        o_i, o_j = V[i, 5], V[j, 5]
        v_x = V[j, 0] - o_j * p_j[1] - (V[i, 0] - o_i * p_i[1])
        v_y = V[j, 1] + o_j * p_j[0] - (V[i, 1] + o_i * p_i[0])
        c_i, c_j, u_c = inward(V, i, p_i), inward(V, j, p_j), inward(V, i, u)
        phi[k] = u[0] * d[0] + u[1] * d[1]
        gamma[k] = (
            u[0] * c_i[0] + u[1] * c_i[1] - (u[0] * c_j[0] + u[1] * c_j[1])
            - 2.0 * (o_i * u[0] * v_y - o_i * u[1] * v_x) - (u_c[0] * d[0] + u_c[1] * d[1])
        )  # fmt: skip
        return
    d_dot = minus(velocity(V, j, p_j), velocity(V, i, p_i))
    u_dot = cross(spin(V, i), u)
    c_i, c_j = centripetal(V, i, p_i), centripetal(V, j, p_j)
    phi[k] = dot(u, d)
    gamma[k] = dot(u, c_i) - dot(u, c_j) - 2.0 * dot(u_dot, d_dot) - dot(centripetal(V, i, u), d)


@internal
def perpendicular_row(scene, i, u, j, w, k):
    """u . w as row k, with u an arm of body i and w an arm of body j, both in world axes."""
    V, n = scene.V, cross(u, w)
    scene.phi[k], scene.phi_t[k] = dot(u, w), 0.0
    scene.gamma[k] = (
        -2.0 * dot(cross(spin(V, i), u), cross(spin(V, j), w))
        - dot(centripetal(V, i, u), w)
        - dot(u, centripetal(V, j, w))
    )
    turn_lines(scene, k, (-n[0], -n[1], -n[2]))


@internal
def line(scene, e):
    """Arms, unit vector from i to j, length and its rate of the line between two points.

    A line without length has no direction: its unit vector is zero.
    """
    p_i, p_j, d, d_dot = apart(scene, e)
    length = sqrt(dot(d, d))
    if length == 0.0:
        return p_i, p_j, (0.0, 0.0, 0.0), 0.0, 0.0
    n = (d[0] / length, d[1] / length, d[2] / length)
    return p_i, p_j, n, length, dot(n, d_dot)


@internal
def distance_row(scene, e, k):
    """The length of the line of instance e, as row k; phi is the length itself."""
    V, own = scene.V, Pair(scene, e)
    p_i, p_j, n, length, rate = line(scene, e)
    _, _, _, d_dot = apart(scene, e)
    c_i, c_j = centripetal(V, own.i, p_i), centripetal(V, own.j, p_j)
    scene.phi[k], scene.phi_t[k] = length, 0.0
    scene.gamma[k] = dot(n, c_i) - dot(n, c_j) - (dot(d_dot, d_dot) - rate * rate) / length
    lines(scene, k, n, cross(p_i, n), cross(p_j, n))


@internal
def nearest_branch(angle, guess):
    """The value of an angle known up to full turns that lies nearest to the guess."""
    turns = (guess - angle) / 6.283185307179586
    return angle + 6.283185307179586 * round(turns)


@internal
def turn_acceleration(scene, e, axis):
    """Second rate of the angle of body j against body i about an axis of body i."""
    V, A, own = scene.V, scene.A, Pair(scene, e)
    i, j = own.i, own.j
    return dot(axis, relative_spin(A, i, j)) + dot(cross(spin(V, i), axis), relative_spin(V, i, j))


@internal
def stroke(scene, e, axis):
    """axis . d and its rate, with the axis fixed in body i and d the separation."""
    _, _, d, d_dot = apart(scene, e)
    return dot(axis, d), dot(axis, d_dot) + dot(cross(spin(scene.V, Pair(scene, e).i), axis), d)


@internal
def stroke_acceleration(scene, e, axis):
    """Second rate of the same."""
    V, A = scene.V, scene.A
    i, p_i, j, p_j = two_points(scene, e)
    _, _, d, d_dot = apart(scene, e)
    a_j = plus(velocity(A, j, p_j), centripetal(V, j, p_j))
    d_ddot = minus(minus(a_j, velocity(A, i, p_i)), centripetal(V, i, p_i))
    axis_ddot = plus(cross(spin(A, i), axis), centripetal(V, i, axis))
    return dot(axis, d_ddot) + 2.0 * dot(cross(spin(V, i), axis), d_dot) + dot(axis_ddot, d)
