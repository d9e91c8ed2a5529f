"""What is stiff brought to rest in a state that was made by other means than the stages of a step.

Constraints and interpolation move a state by far less than the tolerance, as places and rates are
weighed; a spring much faster than the motion answers by w^2 times as much.  The dense output and
the stages of a step far longer than its vibrations are slow, and so is P', the rate of either.
What is stiff leaves of the equations there

    F(y) = f(y) - P' - mu (v - v_0)

which is taken away along the rows of joints, for a mu slow beside what is stiff and fast beside the
rest: what is slow moves by (f - P') / mu^2, less than by what it is off.  The method knows
(mu - J)^-1 of its step; bodies have turned since, and what is stiff with them.  What that makes of
a few directions is learned from the states tried [Anderson1965]: with dF and dy the changes so far

    g = argmin |F - sum g_i dF_i|     y <- y - sum g_i dy_i + (mu - J)^-1 (F - sum g_i dF_i)
"""

from math import sqrt

from trsim.assemble.equations import evaluate
from trsim.assemble.linear import SOUND, smallest_pivot
from trsim.assemble.projection import DOUBTFUL, normalise, onto_rows, put_on_rows
from trsim.elements.contract import N_BOOK
from trsim.elements.scene import PROJECTION
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import all_finite, clear, copy_to
from trsim.solve.march.accelerations import ALLOWED, apart, furthest, largest, settles
from trsim.solve.march.calls import call_rate, call_soften
from trsim.solve.march.record import CHANGES_KEPT

QUIET = 0.5  # times the tolerance and the largest acceleration: what is left
MORE = 4.0  # times that: what is left at most where no state was that quiet
STATES = 15  # tried
FURTHER = 3.0  # times what was left before: too far to learn from
RESOLVED = 1e-15  # of an entry or its unit: no change of it
NEW = 1e-6  # of a change: what is not known from those before
BITS = 1e-15  # of a place: what its last bits, and those of what is added to it, are
AT_END = 2.0  # in place of theta: the end of the step just made, as its stages say
# rows of `tried`: P'; the state as it was; F; the next change; the best state so far; changes
SLOW, GIVEN, LEFT, CHANGE, BEST, DY = range(6)
DF = DY + CHANGES_KEPT


@internal
def at_rest(s, r, b, place, state):
    """y, y' <- a state near y in which what is stiff is at rest, theta of a step h.

    place: P, the dense output of the step, h and theta; state: the time, y and y', which is that of
    y, evaluated last, and so it is again.  b.restless: 1 if it did not come to rest.
    """
    (P, h, theta), (_, y, yd) = place, state
    b.restless = 0
    if not settles(s) or s.status[0] != SOUND:
        return
    K = b.tried
    most = largest(s, r.yd, r.top_acceleration)
    quiet = QUIET * s.tolerance * most
    call_rate(b.rate, b.K, P, h, theta, K[SLOW])
    if not apart(s, yd, 1.0, K[SLOW]) > quiet or (s.m > 0 and not smallest_pivot(s) > DOUBTFUL):
        return
    rest, known = solved(s, r, b, theta, state, quiet)
    if rest > MORE * quiet and rest > rounding(s, K, y, known):
        b.restless = 1
        if rest > ALLOWED * s.tolerance * most:
            r.blur, r.blur_w = max(rest, r.blur), 0.0


@internal
def answered(s, r, yd, before):
    """Note by how much projection changed accelerations at a place that nothing is brought to rest
    at: what is stiff answers to it."""
    if not settles(s):
        return
    off, most = apart(s, yd, 1.0, before), largest(s, r.yd, r.top_acceleration)
    if off > ALLOWED * s.tolerance * most:
        r.blurred = max(r.blurred, off)


@internal
def rounding(s, K, y, known):
    """What the last bits of places make of accelerations, m/s^2: no step leaves less.

    By the stiffest of the changes that are known, which make 1 m/s^2 each.
    """
    stiffest = 0.0
    for i in range(known):
        moved = furthest(s, K[DY + i], 0.0)
        stiffest = max(stiffest, 1.0 / moved) if moved > 0.0 else stiffest
    return BITS * furthest(s, y, s.size) * stiffest


@internal
def solved(s, r, b, theta, state, quiet):
    """y, y' <- the best state found.  Returns what it leaves of F, 0 if no more than rounding, less
    than 0 where nothing is stiff, and nothing was changed; and how many changes are known."""
    K, (t, y, yd) = b.tried, state
    left, change, n, fine = K[LEFT], K[CHANGE], 0, False
    remaining(s, K, y, yd, y, 0.0)
    copy_to(change, left)
    mu = call_soften(b.soften, s, r, b, change)
    if mu == 0.0 or not apart(s, left, mu, change) > quiet or not resolved(s, b, y, change):
        return -1.0, 0
    copy_to(K[BEST], y)
    copy_to(K[GIVEN], y)
    best, before = apart(s, yd, 1.0, K[SLOW]), largest(s, left, 0.0)
    for _ in range(STATES):
        p = n % CHANGES_KEPT
        copy_to(K[DY + p], y)
        copy_to(K[DF + p], left)
        onto_rows(s, change[s.n_q : s.n_q + s.n_v])  # as far as J is of rows that have turned since
        for k in range(y.size):
            y[k] += change[k]
        normalise(s, y)
        if theta == AT_END and s.m > 0 and s.stabilisation == PROJECTION:
            put_on_rows(s, t, y)
        evaluate(s, t, y, yd)
        if not all_finite(yd):
            break
        remaining(s, K, y, yd, K[GIVEN], mu)
        size = largest(s, left, 0.0)
        if size > FURTHER * before:  # by a change of what is slow, on its way out of what is linear
            copy_to(y, K[DY + p])
            copy_to(left, K[DF + p])
            for k in range(y.size):
                change[k] *= before / size
            continue
        now = apart(s, yd, 1.0, K[SLOW])
        if now < best:
            best = now
            copy_to(K[BEST], y)
        if not size > quiet:
            fine = now == best
            break
        before = size
        for k in range(y.size):
            K[DY + p, k], K[DF + p, k] = y[k] - K[DY + p, k], left[k] - K[DF + p, k]
        n += learned(s, K, n)
        next_change(s, r, b, min(n, CHANGES_KEPT))
        fine = not resolved(s, b, y, change)
        if fine:
            break
    copy_to(y, K[BEST])
    evaluate(s, t, y, yd)
    known = min(n, CHANGES_KEPT)
    if fine:
        return 0.0, known
    remaining(s, K, y, yd, K[GIVEN], mu)
    return largest(s, left, 0.0), known


@internal
def remaining(s, K, y, yd, given, mu):
    """K[LEFT] <- F(y), as far as rows of joints allow it; places follow their rates."""
    left, rate = K[LEFT], K[SLOW]
    for k in range(y.size):
        own = s.n_q <= k < s.n_q + s.n_v + s.n_z and not 0 <= k - s.n_q - s.n_v < N_BOOK
        left[k] = yd[k] - rate[k] - mu * (y[k] - given[k]) if own else 0.0
    onto_rows(s, left[s.n_q : s.n_q + s.n_v])


@internal
def next_change(s, r, b, n):
    """K[CHANGE] <- what takes F away, by n changes that are known and by the method otherwise."""
    K = b.tried
    left, change = K[LEFT], K[CHANGE]
    copy_to(change, left)
    for i in range(n):
        along = product(s, left, K[DF + i])
        for k in range(left.size):
            change[k] -= along * K[DF + i, k]
    call_soften(b.soften, s, r, b, change)
    for i in range(n):
        along = product(s, left, K[DF + i])
        for k in range(left.size):
            change[k] -= along * K[DY + i, k]


@internal
def learned(s, K, n):
    """Make the n-th change one of length 1, across those before; 0: nothing in it is new, 1."""
    p = n % CHANGES_KEPT
    whole = sqrt(product(s, K[DF + p], K[DF + p]))
    for i in range(min(n, CHANGES_KEPT)):
        if i != p:
            along = product(s, K[DF + p], K[DF + i])
            for k in range(K.shape[1]):
                K[DY + p, k] -= along * K[DY + i, k]
                K[DF + p, k] -= along * K[DF + i, k]
    rest = sqrt(product(s, K[DF + p], K[DF + p]))
    if not rest > NEW * whole:
        clear(K[DY + p])
        clear(K[DF + p])
        return 0
    for k in range(K.shape[1]):
        K[DY + p, k], K[DF + p, k] = K[DY + p, k] / rest, K[DF + p, k] / rest
    return 1


@internal
def product(s, a, c):
    """Of two accelerations, of turns at their arm."""
    total = 0.0
    for k in range(s.n_q, s.n_q + s.v_node):
        total += s.scale[k] ** 2 * a[k] * c[k]
    return total


@internal
def resolved(s, b, y, change):
    """Whether a change is more than rounding."""
    for k in range(y.size):
        unit = 1.0 / (s.tolerance * b.weight[k]) if b.weight[k] > 0.0 else 0.0
        if abs(change[k]) > RESOLVED * max(abs(y[k]), unit):
            return True
    return False
