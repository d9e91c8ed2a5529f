"""Newton's method for a balance, and what leads on from one.

    [ K  G ] [ dq   ]   [ g    ]         A of balance.py
    [ J  0 ] [ dlam ] = [ -Phi ]

The inverse of a place serves for the next one, as long as the method converges.  A state that is
looked for, its multipliers and what comes out are arrays of one record, and each task is one call:
asking small arrays of numpy one by one takes ten times as long.
"""

from math import inf, isfinite, sqrt

from trsim.assemble.dense import invert
from trsim.assemble.projection import move_all
from trsim.elements.contract import SCENE, Load, compiled
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, A2, f8, i8
from trsim.kernels.signatures import float64, int64, void
from trsim.kernels.vectors import clear, copy_to
from trsim.solve.path.balance import BALANCE, BY_LOAD, BY_SPEED, SLOW, evaluate, ways

RAMP = 1e-9  # of the mechanism's size: sliding over more is full sliding
IN_RAMP = 1e-6  # of the ramp: differences of sliding
ENOUGH = 0.2  # and of the way: what rounding makes of a difference of speeds is a millionth
LOAD = 1e-6  # of the largest multiplier: differences
CLOSE = 1e-13  # of the mechanism's size, rad: the last step of Newton's method
EPS = 4e-16
ROUNDING = 1e-15  # of coordinates: what they are off by
NEARLY = 1e-9  # the same, where rounding lets it come no nearer
BALANCED = 1e-6  # of the largest force: what rounding makes of a stiff contact is less
EXACT = 1e-10  # the same, of a matrix that may be none of the place
ITERATIONS = 25
CHORD = 0.2  # what a step must be of the one before, or the matrix is made anew
TURN = 0.3  # rad, or of the size: a step of Newton's method goes no further
WITHIN = 8  # parts of a step in which drives and loads are asked where they are
# of the size, or rad, and of the largest force: how much further they may go
AWAY, ASKED = 0.05, 0.1
# the quadrature of Gauss and Legendre with five points, on 0..1
_near, _far = (sqrt(5.0 + side * 2.0 * sqrt(10.0 / 7.0)) / 6.0 for side in (-1.0, 1.0))
_of_near, _of_far = ((322.0 + side * 13.0 * sqrt(70.0)) / 1800.0 for side in (1.0, -1.0))
NODES = (0.5 - _far, 0.5 - _near, 0.5, 0.5 + _near, 0.5 + _far)
WEIGHTS = (_of_far, _of_near, 64.0 / 225.0, _of_near, _of_far)
LEFT, FORCING, LEAD, MATRIX, ANEW, INVERSE = range(6)  # what is asked for; the order matters
SLIP = Load.columns["slip"].at

ASKING = int64(SCENE, BALANCE, f8, i8)
call_ask = caller(ASKING)
call_system = caller(void(SCENE, BALANCE, f8))
call_rates = caller(void(A1, i8, A1, A2))


@internal
def larger(most, x):
    """The larger of a number and the size of another; NaN where one of them is."""
    size = abs(x)
    return size if size > most or size != size else most


@internal
def largest(x, size):
    """The largest size of the first numbers; NaN where one is."""
    most = 0.0
    for k in range(size):
        most = larger(most, x[k])
    return most


@internal
def furthest(s, b, x):
    """The furthest of displacements, or the fastest of velocities: rad, or of the size."""
    most = 0.0
    for k in range(s.n_v):
        most = larger(most, x[k] / b.unit[k])
    return most


@internal
def relative(s, b, g):
    """The largest force, or moment by the size, that is left, of the largest there is."""
    most = 0.0
    for k in range(s.n_v):
        most = larger(most, g[k] * b.unit[k])
    return most / (s.size * b.load)


@internal
def product(A, x, out):
    """out <- A x."""
    for i in range(out.size):
        total = 0.0
        for k in range(out.size):
            total += A[i, k] * x[k]
        out[i] = total


@internal
def follow(s, b, y, t0, t):
    """Places in y of drives that a velocity prescribes: from t0 to t."""
    for k in range(b.moving.shape[0]):
        for i in range(len(NODES)):
            b.times[i] = t0 - b.since[k] + NODES[i] * (t - t0)
        call_rates(b.write_rates, s.tab, b.moving[k, 1], b.times, b.rates)
        total = 0.0
        for i in range(len(NODES)):
            total += WEIGHTS[i] * b.rates[i, 0]
        y[s.n_q + s.n_v + b.moving[k, 0]] += (t - t0) * total


@internal
def remain(s, b, t, y, lam, g):
    """g and Phi; sets the velocities of y."""
    if b.frozen == 0.0:
        ways(s, b.anchor, y, SLOW, y, s.n_q)
    evaluate(s, b, t, y, lam, g)


@internal
def matrix(s, b, t):
    """A where the scene is, by differences that what rubs and the largest force allow."""
    b.steps[BY_LOAD] = LOAD * max(largest(b.lam, s.m), 1e-3 * b.load)
    if b.rubs > 0:
        most = 0.0
        for k in range(s.n_v):
            most = larger(most, b.y[s.n_q + k] / b.unit[k])
        part = min(max(IN_RAMP, ENOUGH * most / SLOW), 0.1)
        b.steps[BY_SPEED] = part * SLOW * RAMP * s.size
    call_system(b.system, s, b, t)


@internal
def inverted(s, b):
    """The inverse of A, rows of joints weighed like stiffnesses; False where there is none."""
    n, size, unit = s.n_v, b.x.size, b.unit
    K = J = 0.0
    for i in range(n):
        for k in range(n):
            K = larger(K, b.A[i, k] * unit[i] * unit[k])
    for i in range(n, size):
        for k in range(n):
            J = larger(J, b.A[i, k] * unit[k])
    b.stiffest = K
    row = max(K, 1e-300) / max(J, 1e-300) if K > 0.0 else 1.0 / max(J, 1e-300)
    for i in range(size):
        by = unit[i] if i < n else row
        for k in range(size):
            b.inverse[i, k] = b.A[i, k] * by * (unit[k] if k < n else row)
    b.sign = invert(b.inverse, b.order)
    if b.sign == 0.0:
        return False
    for i in range(size):
        by = unit[i] if i < n else row
        for k in range(size):
            b.inverse[i, k] *= by * (unit[k] if k < n else row)
            if not isfinite(b.inverse[i, k]):
                return False
    return True


@internal
def stopped(s, b, t):
    """How much of a step to take: what would turn round stops first, where it may stick."""
    y, lam, least, part = b.room[0], b.room[1], SLOW * RAMP * s.size, 1.0
    for k in range(b.slip.size):
        b.slip[k] = s.loads[s.rubbing[k, 0], SLIP]
    copy_to(y, b.y)
    move_all(s, y, b.x)
    for k in range(s.m):
        lam[k] = b.lam[k] + b.x[s.n_v + k]
    remain(s, b, t, y, lam, b.room[2])
    for k in range(b.slip.size):
        first, last = b.slip[k], s.loads[s.rubbing[k, 0], SLIP]
        if first * last < 0.0 and min(abs(first), abs(last)) > least:
            part = min(part, first / (first - last))
    return part


@internal
def forced(s, b, t):
    """g <- dg/dt at one place, and -Phi_t."""
    n, y = s.n_v, b.room[0]
    clear(b.g)
    if b.timed > 0 or b.moving.shape[0] > 0:
        for side in range(2):
            dt = b.small * (1.0 - 2.0 * side)
            copy_to(y, b.y)
            follow(s, b, y, t, t + dt)
            evaluate(s, b, t + dt, y, b.lam, b.room[2 + side])
        for k in range(n):
            b.g[k] = (b.room[2, k] - b.room[3, k]) / (2.0 * b.small)
    evaluate(s, b, t, b.y, b.lam, b.room[2])
    for k in range(s.m):
        b.g[n + k] = -s.phi_t[k]


@compiled(ASKING)
def ask(s, b, t, task):
    """At the state of b: g; dg/dt and -Phi_t; that with A, its inverse, and x, how the balance
    moves with t; A and its inverse; the same where the scene is there already; the inverse of A.

    Returns 0 where A has none."""
    if task == LEFT:
        remain(s, b, t, b.y, b.lam, b.g)
    if FORCING <= task <= LEAD:
        forced(s, b, t)
    if task == MATRIX:
        evaluate(s, b, t, b.y, b.lam, b.g)
    if LEAD <= task <= ANEW:
        matrix(s, b, t)
    found = task < LEAD or inverted(s, b)
    if task == LEAD:
        product(b.inverse, b.g, b.x)
    return 1 if found else 0


@compiled(int64(SCENE, BALANCE, f8, i8))
def solve(s, b, t, known):
    """Bring the state of b and its multipliers into balance at t: 1, or 0 where none is found.

    known: 1 where `inverse` is that of a place that may be near.
    """
    n, m, fresh = s.n_v, s.m, False
    before = last = before_left = inf
    places = largest(b.y, s.n_q) / s.size
    near = max(CLOSE, ROUNDING * places)
    for _ in range(ITERATIONS):
        remain(s, b, t, b.y, b.lam, b.g)
        left = relative(s, b, b.g)
        if not isfinite(left):
            return 0
        if known == 0:
            if call_ask(b.ask, s, b, t, ANEW) == 0:
                return 0
            known, fresh = 1, True
        for k in range(n, n + m):
            b.g[k] = -b.g[k]
        product(b.inverse, b.g, b.x)
        far = furthest(s, b, b.x)
        if not isfinite(far):
            return 0
        close = far < near or (far < NEARLY and far > 0.5 * last)
        if not fresh and (left > EXACT if close else far > CHORD * before):
            known, before = 0, inf
            continue
        for k in range(n):
            b.x[k] *= min(1.0, TURN / max(far, TURN))
        part = stopped(s, b, t) if b.slip.size > 0 else 1.0
        for k in range(n + m):
            b.x[k] *= part
        move_all(s, b.y, b.x)
        for k in range(m):
            b.lam[k] += b.x[n + k]
        noise = EPS * max(1.0, places) * b.stiffest / (s.size * b.load)
        if close and (left < max(EXACT, noise) or 0.5 * before_left < left < BALANCED):
            if b.frozen == 0.0:
                ways(s, b.anchor, b.y, SLOW, b.y, s.n_q)
            b.load = max(b.load, largest(b.lam, m))
            return 1
        before_left = left if close else inf
        before = last = far if part == 1.0 else inf
        fresh, known = False, known if part == 1.0 else 0
    return 0


@compiled(int64(SCENE, BALANCE, f8, f8))
def passes_over(s, b, t0, t1):
    """Whether what drives and loads ask for goes much further between two times than at both, from
    the state of b, which is one of t1; or a rate of a row changes its sign where something rubs."""
    n, y, first, turned = s.n_v, b.room[0], b.room[2], b.room[3]
    way = force = 0.0
    for k in range(WITHIN + 1):
        t = t0 + k / WITHIN * (t1 - t0)
        copy_to(y, b.y)
        follow(s, b, y, t1, t)
        remain(s, b, t, y, b.lam, b.g)
        w = 0.0
        for j in range(s.m):
            w = larger(w, b.g[n + j] / s.row_unit[j])
        f = relative(s, b, b.g)
        if k == 0:
            way, force = w, f
        elif w > way + AWAY or f > force + ASKED:
            return 1
        if b.rubs == 0:
            continue
        for j in range(s.m):
            if k == 0:
                first[j], turned[j] = s.phi_t[j], 0.0
            elif first[j] * s.phi_t[j] < 0.0:
                turned[j] = 1.0
            elif k == WITHIN and first[j] * s.phi_t[j] > 0.0 and turned[j] > 0.0:
                return 1
    return 0


@compiled(float64(SCENE, BALANCE, A1, A1, A1))
def went(s, b, before, y, out):
    """out (n_v) <- the ways of all bodies from one state to another, along the velocities of the
    solve; the furthest of them, rad or of the size."""
    ways(s, before, y, 1.0, out, 0)
    return furthest(s, b, out)
