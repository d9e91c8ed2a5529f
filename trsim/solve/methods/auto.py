"""Explicit or implicit: which of two methods makes the next step.

An explicit method whose steps are held at its limit of stability,

    h rho > 6.1,    rho = |f(y_1) - f(Y_12)| / |y_1 - Y_12|                 [HairerWanner1996]

with Y_12 the last stage of DOP853 (both at t + h), for 15 steps, of large models for n_v / 4, gives
way to the implicit one: near a singular position some steps look stiff and are not, and Jacobians
of large models are dear.  The implicit one gives back after an event, or when its own steps, with
the largest eigenvalue of its matrices by a few vector iterations, would be stable for the explicit
one as well.

A decay c that nothing is seen of holds steps below that limit too: the error estimate sees what is
left of it, the more the tighter the tolerance.  Whether it is that or the motion no estimate tells,
so the implicit method is tried after PATIENCE steps with h c > 1, and keeps on if its steps are
longer than FADED / c; after each change back with more patience.
"""

from math import sqrt

from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear
from trsim.solve.march.record import (
    EVENT_ANGLE,
    NO_HISTORY,
    NO_JACOBIAN,
    TO_EXPLICIT,
    TO_IMPLICIT,
    note_event,
)
from trsim.solve.march.stiffness import decays, smooth, stiff_load, stiffest, still
from trsim.solve.methods.displacements import active
from trsim.solve.methods.dop853 import FROM_LAST_STAGE, combined

EXPLICIT, IMPLICIT = 0, 1  # rows of `methods`
STABLE = 6.1  # h rho of DOP853 on the negative real axis
HELD = 0.9  # of the longest steps in which what is stiff dies out: as good as held by them
STIFF_STEPS, RELIEF, CHEAP_STEPS = 15, 6, 20
DEAR = 4  # a Jacobian and its dense factors cost about as much as n_v / 4 explicit steps
NEAR, CALM = 3.0, 3.5  # h rho: where steps of DOP853 on contacts are watched, what they are held to
EASY = 3.0  # h rho at which the explicit method takes steps of the same length
FADED = 2.0  # the same where it is a decay: DOP853 takes 1.8 at 1e-6, and steps cost more
PATIENCE = 60  # times the square of the changes so far, counted in pairs
SEEN = 1e-4  # of the error allowed: steps at the limit of stability change by about all of it
ITERATIONS = 12  # of the vector iteration


@internal
def choose(s, r, b, h, event):
    """Change r.method where the steps so far say so; leaves a line among the events."""
    if r.method == EXPLICIT:
        if event:  # behind it the derivative changes by other rates
            r.explicit_rate = 0.0
            r.fading = 0
            return
        rate = explicit_rate(s, r, b, h)
        load, light = h * max(rate, STABLE / HELD * stiff_load(r, 1.0)), calmed(s, r, h, rate)
        if load > STABLE or light:
            r.stiff += 1
            r.not_stiff = 0
            if r.stiff >= max(STIFF_STEPS, s.n_v // DEAR):
                change(s, r, b, IMPLICIT, load, max(rate, stiffest(r)))
        else:
            r.not_stiff += 1
            if r.not_stiff >= RELIEF:
                r.stiff = 0
            if impatient(s, r, h):
                change(s, r, b, IMPLICIT, h * r.decay, r.decay)
        return
    if event:
        change(s, r, b, EXPLICIT, 0.0, 0.0)
        return
    if r.jacobian_rate < 0.0:
        r.jacobian_rate = implicit_rate(s, r, b)
    load = h * r.jacobian_rate
    r.stiff = r.stiff + 1 if load < (FADED if fades(r) else EASY) else 0
    if r.stiff >= CHEAP_STEPS:
        change(s, r, b, EXPLICIT, load, r.jacobian_rate)


@internal
def impatient(s, r, h):
    """Whether a decay may have held the explicit steps for so long that the implicit method is
    tried."""
    held = fades(r) and h * r.decay > 1.0 and smooth(s, r)
    r.fading = r.fading + 1 if held else 0
    tried = 1 + r.method_switches // 2
    return r.fading >= max(PATIENCE, s.n_v) * tried * tried


@internal
def fades(r):
    """Whether the stiffest that is known is a decay."""
    return r.vibration > 0.0 and decays(r)


@internal
def calm(s, r, b, h, event):
    """Keep the steps of DOP853 stable where it runs alone."""
    if event:
        r.explicit_rate = 0.0
    else:
        calmed(s, r, h, explicit_rate(s, r, b, h))


@internal
def calmed(s, r, h, rate):
    """Shorten the next step to where it is stable, after a step h at this rate; whether it would
    have been beyond the limit.

    Only where something touches, and by the lesser of two rates in a row.  Between 5 and 6.1 on the
    real axis the error estimate sees down to an eighth of the error: what is stiff trembles there
    by many times the error allowed, and the damping of a light touch makes forces of it.
    """
    sure = min(rate, r.explicit_rate)
    r.explicit_rate = rate
    if s.contact.size == 0 or h * sure <= NEAR or r.h * sure <= CALM:
        return False
    stiff = r.h * sure > STABLE
    r.h = CALM / sure
    return stiff


@internal
def change(s, r, b, method, load, rate):
    """Go on with the other method; the line says how stiff the last step was, and the rate, 1/s, of
    what is stiffest."""
    r.method = method
    r.stiff, r.not_stiff, r.fading = 0, 0, 0
    r.history, r.jacobian = NO_HISTORY, NO_JACOBIAN
    r.past_error, r.factored_h, r.next_look = 0.0, 0.0, r.steps
    r.explicit_rate = 0.0
    r.method_switches += 1
    kind = TO_IMPLICIT if method == IMPLICIT else TO_EXPLICIT
    note_event(r, b, r.t, kind, s.con.shape[0], rate)
    b.events[r.event_rows - 1, EVENT_ANGLE] = load


@internal
def explicit_rate(s, r, b, h):
    """rho, 1/s: how much the derivative changes with the state, in the units of the error.

    0 where what changes is SEEN by no tolerance, and of bodies that rows hold at rest, where it
    would be a quotient of two roundings.
    """
    K, weight, away = b.K, b.weight, b.y2
    # r.y is the end of the step by now: the difference to the last stage is in K alone
    combined(K, FROM_LAST_STAGE, 0, away.size, away)
    top = bottom = 0.0
    first = s.n_q + s.n_v if still(s, r) else 0
    for c in range(first, away.size):
        if weight[c] > 0.0:
            top += ((K[12, c] - K[11, c]) * weight[c]) ** 2
            bottom += (h * away[c] * weight[c]) ** 2
    return sqrt(top / bottom) if bottom > 0.0 and h * sqrt(top) > SEEN else 0.0


@internal
def implicit_rate(s, r, b):
    """Largest eigenvalue of the linearised motion, 1/s, by vector iteration on (dx, dw)."""
    n, n_v = active(s), s.n_v
    x, w, u = b.K[3], b.K[4], b.K[5]
    sown(s, n, x, w)
    product = 1.0
    for turn in range(ITERATIONS):
        clear(u)
        for k in range(n_v):
            for i in range(n):
                u[i] += r.by_place[i, k] * x[k]
        for k in range(n):
            for i in range(n):
                u[i] += r.by_rate[i, k] * w[k]
        growth = grown(s, n, x, w, u)
        if growth == 0.0:
            return 0.0
        if turn >= ITERATIONS - 4:  # an oscillation grows by rho^2 in two turns
            product *= growth
    return sqrt(sqrt(product))


@internal
def sown(s, n, x, w):
    """Displacements x (n_v) and rates w (n) of a vector iteration at its start."""
    for k in range(s.n_v):
        x[k] = 1.0 if k % 2 == 0 else -0.7
    for k in range(n):
        w[k] = 1.0 if k % 3 == 0 else 0.6


@internal
def grown(s, n, x, w, u):
    """(x, w) <- (w, u) over the size of u = w'; u over w in size, 0 where either is 0."""
    before = size = 0.0
    for k in range(n):
        before, size = max(before, abs(w[k])), max(size, abs(u[k]))
    if size == 0.0 or before == 0.0:
        return 0.0
    for k in range(s.n_v):
        x[k] = w[k] / size
    for k in range(n):
        w[k] = u[k] / size
    return size / before
