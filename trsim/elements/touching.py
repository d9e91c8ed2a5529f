"""How a ball touches a surface: the numbers of one touch, where it is, its forces and its rolling.

The equations are in surface_contact.py.
"""

from math import inf, sqrt

from trsim.elements.contract import WHOLE
from trsim.elements.frames import (
    OnSurface,
    arm,
    carried,
    cross,
    dot,
    minus,
    plus,
    relative_spin,
    scaled,
    velocity,
)
from trsim.kernels.columns import V3, f8, i8, run
from trsim.kernels.lazy import internal
from trsim.laws.contact import TABLE, damped, elastic, lossy
from trsim.laws.force_tables import on_piece, piece_at, piece_of, rub_of
from trsim.laws.friction import CODES, N_PARAMETERS, friction_force, on_branch, part_of_bristle
from trsim.laws.outlines import beside_side
from trsim.laws.surfaces import PLANE, PROFILE, away, beside

CORNERED, STICKING = CODES["modified_coulomb"], CODES["sticking"]
APART = 1e-5  # of how far the centre is away: places between which a normal is seen to turn
ON_SEAM = 1e-9  # of the radius of a ball


class Own(OnSurface):
    """Of one instance."""

    u_i: V3  # axes of the surface in those of body i
    w_i: V3
    a_i: V3
    shape: i8
    closed: i8  # 1 of a closed profile, 2 of a part of one
    profile: i8  # its offset in tab
    seams: i8  # that of how many seams it has and where they are, or -1; laws/touches.py
    outline: i8  # that of how many corners an outline has and where they are, or -1: a ball
    touches: i8  # how many rows behind this one it stands for; 0: it is a touch itself
    lost: i8  # of z: what damping takes, what friction takes behind it; or -1
    state: i8  # of z: the deflection of bristles along t, that along z behind it; or -1
    friction_law: i8
    form: i8  # of the elastic law: that of Hertz, or a table
    table: i8  # its offset in tab
    radius: f8  # of the surface, m
    patch: f8  # m: the square of its patch's radius over the depth, where Hertz gives one
    free: f8  # 1, or -1: inside
    clearance: f8  # read by other forms
    stiffness: f8
    exponent: f8
    chi: f8
    damping: f8
    ramp: f8  # 0 of laws that know the impact
    slowest_impact: f8
    rolling: f8  # levers, m
    spinning: f8
    friction: run(f8, N_PARAMETERS)


# --- where it touches and what acts -----------------------------------------------------------


@internal
def met(scene, e):
    """What `carried` tells of the centre of a ball, or of the place of an outline that is nearest
    to the surface."""
    own = Own(scene, e)
    r_i, p_j, d, v = carried(scene, e)
    if own.outline < 0:
        return r_i, p_j, d, v
    q = nearest_of(scene, e, d, 0.0)
    v = plus(v, cross(relative_spin(scene.V, own.i, own.j), q))
    return plus(r_i, q), plus(p_j, q), plus(d, q), v


@internal
def nearest_of(scene, e, d, ahead):
    """From the point of an outline to its place that is nearest to the surface, world axes.

    d: where the point is; ahead: by how many seconds the outline is turned on, as seen from body i.
    """
    own, X, tab = Own(scene, e), scene.X, scene.tab
    x, y, z = arm(X, own.i, own.u_i), arm(X, own.i, own.w_i), arm(X, own.i, own.a_i)
    w, many = relative_spin(scene.V, own.i, own.j), int(tab[own.outline])
    least, found = inf, (0.0, 0.0, 0.0)
    last, before = found, found
    for k in range(many + 1):
        o = own.outline + 1 + 3 * (k % many)
        q = arm(X, own.j, (tab[o], tab[o + 1], tab[o + 2]))
        q = plus(q, scaled(ahead, cross(w, q)))
        r = plus(d, q)
        here = (dot(x, r), dot(y, r), dot(z, r))
        if k > 0:
            s, u = beside_side(tab, own, before, here)
            if s < least:
                least, found = s, plus(scaled(1.0 - u, last), scaled(u, q))
        last, before = q, here
    return found


@internal
def touch(scene, e):
    """Arms of the centre on both bodies, s, n in world axes, penetration and its rate."""
    own, X = Own(scene, e), scene.X
    r_i, p_j, d, v = met(scene, e)
    x, y, z = arm(X, own.i, own.u_i), arm(X, own.i, own.w_i), arm(X, own.i, own.a_i)
    s, m = away(scene.tab, own, (dot(x, d), dot(y, d), dot(z, d)))
    n = plus(plus(scaled(m[0], x), scaled(m[1], y)), scaled(m[2], z))
    return r_i, p_j, s, n, own.ball - s, -dot(n, v)


@internal
def slides(scene, e):
    """The place of contact seen from both centres of mass, n, d, d', v_t and its size."""
    V, own = scene.V, Own(scene, e)
    r_i, p_j, s, n, depth, rate = touch(scene, e)
    c_i, c_j = minus(r_i, scaled(s, n)), minus(p_j, scaled(s, n))
    v = minus(velocity(V, own.j, c_j), velocity(V, own.i, c_i))
    v_t = minus(v, scaled(dot(n, v), n))
    return c_i, c_j, n, depth, rate, v_t, sqrt(dot(v_t, v_t))


@internal
def pressed(scene, own, depth):
    """The elastic force; of a table that of the piece that is held."""
    if own.form != TABLE:
        return elastic(depth, own)
    if depth <= 0.0:
        return 0.0
    tab, o = scene.tab, own.table
    k = piece_at(tab, o, depth) if own.branch == WHOLE else piece_of(own.branch)
    return on_piece(tab, o, k, depth)


@internal
def normal_of(scene, own, depth, rate):
    """F_n."""
    F_e = pressed(scene, own, depth)
    if own.ramp > 0.0:
        return damped(F_e, depth, rate, own)
    first = own.impact_speed
    if first == 0.0:  # not latched yet (UNLOCATED): this approach is the impact
        first = max(rate, own.slowest_impact)
    return lossy(F_e, rate, first, own.chi)


@internal
def part_of(own, F_n, speed):
    """Friction at a speed, N, positive against it; bristles aside."""
    f = own.friction
    if own.friction_law == CORNERED and own.branch != WHOLE:
        return -on_branch(rub_of(own.branch), F_n, speed, f[0], f[1], f[2])
    F_t, _ = friction_force(own.friction_law, F_n, speed, 0.0, f)
    return -F_t


@internal
def friction_of(scene, e, F_n, n, v_t, speed):
    """Friction on body j, world axes, and the rates of both bristles."""
    own = Own(scene, e)
    if own.friction_law != STICKING:  # along a static path what sticks slides
        by = -part_of(own, F_n, speed) / speed if speed > 0.0 else 0.0
        return scaled(by, v_t), 0.0, 0.0
    f, z = own.friction, arm(scene.X, own.i, own.a_i)
    t = cross(n, z)
    if own.shape == PLANE:
        t = arm(scene.X, own.i, own.u_i)
    w_t, w_z = scene.z[own.state], scene.z[own.state + 1]
    F_1, rate_1 = part_of_bristle(F_n, dot(t, v_t), speed, w_t, f)
    F_2, rate_2 = part_of_bristle(F_n, dot(z, v_t), speed, w_z, f)
    return plus(scaled(F_1, t), scaled(F_2, z)), rate_1, rate_2


@internal
def resistance(scene, e, F_n, n):
    """Moment on body j against rolling and spinning, world axes, and its power."""
    own = Own(scene, e)
    f, w = own.friction, relative_spin(scene.V, own.i, own.j)
    spin = dot(n, w)
    roll = minus(w, scaled(spin, n))
    size, code = sqrt(dot(roll, roll)), own.friction_law
    by_roll, _ = friction_force(code, F_n, own.ball * size, 0.0, f)
    by_spin, _ = friction_force(code, F_n, own.ball * spin, 0.0, f)
    share = own.rolling * by_roll / (f[0] * size) if size > 0.0 else 0.0
    m = plus(scaled(share, roll), scaled(own.spinning * by_spin / f[0], n))
    return m, dot(m, w)


@internal
def is_behind(scene, e):
    """Whether the ball is on the side of an open profile on which it was not drawn: its right."""
    own = Own(scene, e)
    if own.shape != PROFILE or own.closed == 1:
        return False
    _, _, d, _ = met(scene, e)
    x, y = dot(arm(scene.X, own.i, own.u_i), d), dot(arm(scene.X, own.i, own.w_i), d)
    side, _ = beside(scene.tab, own.profile, 1, x, y)
    return side < 0.0


@internal
def acting(scene, e, met):
    """What a touch does, rolling resistance aside: F_n, F_t, the rates of bristles, and the powers
    of damping and friction, W.

    met: what `slides` tells, without the arms.
    """
    own = Own(scene, e)
    n, depth, rate, v_t, speed = met
    F_n = normal_of(scene, own, depth, rate)
    F_t, rate_t, rate_z = friction_of(scene, e, F_n, n, v_t, speed)
    taken = -(F_n - pressed(scene, own, depth)) * rate
    return F_n, F_t, (rate_t, rate_z), (taken, dot(F_t, v_t))


# --- what it reports ---------------------------------------------------------------------------


@internal
def rolls(scene, e):
    """The mean of the velocities at which the place of touch moves along both bodies, world axes.

    Seen from body i it is the place p - s n of the surface that is nearest to a centre p, or to the
    nearest place p of an outline; along body j it moves by that less the sliding.
    """
    own = Own(scene, e)
    _, _, d, u = carried(scene, e)
    _, _, s, n, _, _ = touch(scene, e)
    _, _, _, _, _, v_t, _ = slides(scene, e)
    speed = sqrt(dot(u, u))
    if own.outline >= 0:
        w = relative_spin(scene.V, own.i, own.j)
        speed += own.span * sqrt(dot(w, w))
    if own.ball == 0.0 or speed == 0.0:  # of a point it is the point
        return minus(minus(u, scaled(dot(n, u), n)), scaled(0.5, v_t))
    step = APART * abs(s) / speed
    change = minus(foot_of(scene, e, d, u, step), foot_of(scene, e, d, u, -step))
    return minus(scaled(0.5 / step, change), scaled(0.5, v_t))


@internal
def foot_of(scene, e, d, u, ahead):
    """The place of the surface that is touched some seconds on, seen from body i; world axes.

    d, u: where the point of the ball is, and its velocity seen from body i.
    """
    own, X = Own(scene, e), scene.X
    x, y, z = arm(X, own.i, own.u_i), arm(X, own.i, own.w_i), arm(X, own.i, own.a_i)
    p = plus(d, scaled(ahead, u))
    if own.outline >= 0:
        p = plus(p, nearest_of(scene, e, p, ahead))
    s, m = away(scene.tab, own, (dot(x, p), dot(y, p), dot(z, p)))
    n = plus(plus(scaled(m[0], x), scaled(m[1], y)), scaled(m[2], z))
    return minus(p, scaled(s, n))


@internal
def on_seam(scene, own, x, y):
    """Whether a place of the surface is where a part of a profile is cut."""
    if own.seams < 0:
        return False
    tab, near = scene.tab, ON_SEAM * own.ball
    for k in range(int(tab[own.seams])):
        a, b = x - tab[own.seams + 1 + 2 * k], y - tab[own.seams + 2 + 2 * k]
        if a * a + b * b <= near * near:
            return True
    return False
