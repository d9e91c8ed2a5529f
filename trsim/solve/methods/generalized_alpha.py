"""Generalised-alpha, order 2, with numerical damping of what a step cannot resolve.

    (1 - a_m) b_1 + a_m b_0 = (1 - a_f) f(t_1, y_1) + a_f f(t_0, y_0)        [ChungHulbert1993]
    w_1 = w_0 + h ((1 - gamma) b_0 + gamma b_1)                              [ArnoldBruls2007]
    x_1 = x_0 + h v_0 + h^2 ((1/2 - beta) b_0 + beta b_1)

b is the filtered derivative of w = (v, states of elements); its part for v moves the places x,
turns as body-axes rotation vectors.  The spectral radius at infinity is RADIUS.  On the index-1
equations of motion, positions and velocities projected after each step like every other method's:
index 3 with both stabilised, one right-hand side for all.  Meant where two or three digits are
enough and the motion is stiff: beams, hard springs.
"""

from math import isfinite

import numpy as np

from trsim.assemble.equations import evaluate
from trsim.elements.contract import N_BOOK, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import all_finite, copy_to
from trsim.solve.march.accelerations import FURTHEST, ONE, doubted, held, in_units, largest, share
from trsim.solve.march.calls import DENSE, NO_STEP, STEP
from trsim.solve.march.record import FRESH, NO_JACOBIAN, OLD
from trsim.solve.march.works import first_work, works
from trsim.solve.methods import hermite
from trsim.solve.methods.dense_lu import factorise_real, solve_real
from trsim.solve.methods.displacements import active, place_of, turn, w_index
from trsim.solve.methods.jacobian import jacobian, missing
from trsim.solve.methods.newton import FAILS, GOES_ON, judged, resolution

ESTIMATE = 2  # the error estimate falls with h^2
STAGES = 7
LAST = 2
DENSE_ROWS = hermite.ROWS + 2
DENSE_DEGREE = 3
IMPLICIT = True
interpolate = hermite.value

RADIUS = 0.8
A_M = (2.0 * RADIUS - 1.0) / (RADIUS + 1.0)
A_F = RADIUS / (RADIUS + 1.0)
GAMMA = 0.5 - A_M + A_F
BETA = 0.25 * (1.0 - A_M + A_F) ** 2

B1, NEW, SCRATCH, MOVE = 3, 4, 5, 6  # rows of K: b_1, f at the end, two of scratch
FILTERED, BEFORE = hermite.ROWS, hermite.ROWS + 1  # rows of `past`: b_0, f one step before
MOST_ITERATIONS = 10
KAPPA = 0.02  # of the error allowed: what Newton may leave
STRICT = 12.0  # times the error of one step: errors of accelerations add up from step to step
RESOLVED = 1.5  # times the first difference: the second one of what a step resolves
UNKNOWN = 0.1  # of the first difference: what the second one of a first step is at least
LEFT = 3.0  # times it: what is left of such errors where steps are not held to them
LOST = 0.02  # of the largest acceleration, the same: with more of it nothing is resolved
FURTHER = 10.0  # times the error of velocities: what that of accelerations counts at most
ADDS = 5.0  # the errors of works as estimated are those made, and they add up
QUICK = 0.1  # contraction with which a matrix is kept for the next step
HALVE = NO_STEP  # Newton failed: take about half the step


@compiled(STEP)
def step(s, r, b, setting, t, h):
    K = b.K
    if r.history == 0:
        copy_to(r.past[FILTERED], r.yd)
    for attempt in range(2):
        if missing(r) or (attempt > 0 and r.jacobian == OLD):
            jacobian(s, r, setting, K[SCRATCH], K[MOVE])
            r.factored_h = 0.0
        elif attempt > 0:
            return HALVE
        if r.factored_h != h and not factorised(s, r, h):
            return HALVE
        copy_to(K[B1], r.past[FILTERED])
        done = newton(s, r, b, t, h)
        if done > 0:
            break
        if done < 0 and r.jacobian == FRESH:
            return np.inf
    else:
        return HALVE
    error = estimate(s, r, b, setting, t, h)
    r.next_jacobian = OLD if r.newton_rate < QUICK else NO_JACOBIAN
    return error


@internal
def factorised(s, r, h):
    """Factors of (1 - a_m) - (1 - a_f) (h gamma by_rate + h^2 beta by_place)."""
    n = active(s)
    A, f = r.lu, 1.0 - A_F
    for i in range(n):
        for k in range(n):
            B = r.by_place[i, k] if k < s.n_v else 0.0
            A[i, k] = -f * h * (GAMMA * r.by_rate[i, k] + h * BETA * B)
        A[i, i] += 1.0 - A_M
    r.factored_h = h if factorise_real(A, r.pivot[0], n) else 0.0
    return n == 0 or r.factored_h == h


@internal
def arrive(s, r, b, h):
    """y_1 from b_0 and b_1."""
    K, y, y1, past = b.K, r.y, b.y1, r.past
    for c in range(s.n_q, y.size):
        y1[c] = y[c] + h * ((1.0 - GAMMA) * past[FILTERED, c] + GAMMA * K[B1, c])
    for k in range(s.n_v):
        c = s.n_q + k
        bend = (0.5 - BETA) * past[FILTERED, c] + BETA * K[B1, c]
        K[MOVE, k] = h * (y[c] + h * bend)
    for k in range(s.n_v):
        q = place_of(s, k)
        if s.d == 3 or k >= s.v_node or k % 6 < 3:
            y1[q] = y[q] + K[MOVE, k]
        elif k % 6 == 3:
            turn(y, y1, q, K[MOVE, k], K[MOVE, k + 1], K[MOVE, k + 2])


@internal
def newton(s, r, b, t, h):
    """Solve for b_1.  1: converged, 0: not, -1: a value is not finite."""
    K, weight, n_w = b.K, b.weight, active(s)
    floor = resolution(r, weight, h)
    kappa, before = max(KAPPA, floor), 0.0
    for iteration in range(MOST_ITERATIONS):
        r.iterations += 1
        arrive(s, r, b, h)
        evaluate(s, t + h, b.y1, K[NEW])
        if not all_finite(K[NEW]):
            return -1
        for i in range(n_w):
            c = w_index(s, i)
            wanted = (1.0 - A_F) * K[NEW, c] + A_F * r.yd[c]
            K[SCRATCH, i] = wanted - (1.0 - A_M) * K[B1, c] - A_M * r.past[FILTERED, c]
        solve_real(r.lu, r.pivot[0], K[SCRATCH], n_w)
        moved = 0.0
        for i in range(n_w):
            c = w_index(s, i)
            K[B1, c] += K[SCRATCH, i]
            moved = max(moved, abs(h * GAMMA * K[SCRATCH, i] * weight[c]))
        if not isfinite(moved):
            return -1
        verdict, rate = judged(moved, before, iteration, MOST_ITERATIONS, kappa)
        if verdict == FAILS:
            return 0
        if verdict != GOES_ON:
            r.newton_rate = rate if iteration > 0 else 0.0
            arrive(s, r, b, h)
            for c in range(first_work(s), first_work(s) + N_BOOK):
                # works feed nothing back: the trapezoidal rule, which no change of step disturbs
                b.y1[c] = r.y[c] + 0.5 * h * (r.yd[c] + K[NEW, c])
            return 1
        before = moved
    return 0


@internal
def estimate(s, r, b, setting, t, h):
    """The local error, h/12 of the second difference of the derivative, over the part of a radian
    that the motion turns in the step: h/12 of the first difference.

    Errors of order 3 at a distance h add up to one of order 2.  Steps held to a local error would
    leave tolerance^(2/3) times the turns at the end; held to this, it is the tolerance times them.
    A motion that turns by less than a radian in the whole run, as a fall does, has no more than the
    local errors of all its steps: the second difference times the run's length.
    Since errors add up from turn to turn, the worst entry counts and not a mean over those at rest.
    Works feed nothing back, so theirs only add up.
    """
    K, weight, ratio = b.K, b.weight, grown(r, h)
    moved = bent = 0.0
    for c in range(r.y.size):
        if weight[c] > 0.0:
            by = K[NEW, c] - r.yd[c]
            moved = max(moved, abs(by) * weight[c])
            bent = max(bent, abs(by - ratio * (r.yd[c] - r.past[BEFORE, c])) * weight[c])
    moved *= h / 12.0
    if ratio > 0.0:
        moved = min(moved, setting.t_end / 12.0 * bent)
    if ratio == 0.0 and held(s, r, h):
        halved(s, r, b, t, h)
    if ratio > 0.0 or held(s, r, h):
        moved = max(moved, accelerated(s, r, b, setting, h, FURTHER * moved))
    worst = size = 0.0
    for c in range(first_work(s), first_work(s) + N_BOOK):
        bend = K[NEW, c] - r.yd[c]
        if ratio > 0.0:
            bend -= ratio * (r.yd[c] - r.past[BEFORE, c])
        worst = max(worst, abs(h / 12.0 * bend))
        size = max(size, 0.5 * h * (abs(K[NEW, c]) + abs(r.yd[c])))
    booked = works(r, setting, h, ADDS * worst, size)
    return max(moved, booked, 1e-10)


@internal
def halved(s, r, b, t, h):
    """The derivative at the middle of a step with none before it, into K[SCRATCH]."""
    K = b.K
    for c in range(r.y.size):
        K[MOVE, c] = 0.5 * (r.y[c] + b.y1[c]) + 0.125 * h * (r.yd[c] - K[NEW, c])
    evaluate(s, t + 0.5 * h, K[MOVE], K[SCRATCH])


@internal
def grown(r, h):
    """How many times as long as the step before a step h is; 0: there was none."""
    return h / r.past_h if r.history > 0 else 0.0


@internal
def accelerated(s, r, b, setting, h, further):
    """The error of accelerations, a 12th of the second difference of the derivative, in units of
    the tolerance times the largest one met; at most `further` where a step does not resolve them.

    A fast vibration beside a slow motion may have the larger accelerations and forces with speeds
    that are small beside it: errors that are nothing of the speed are then much of these.  What is
    not resolved turns back from step to step, and is left to the damping of the method unless it is
    a plain part of the largest acceleration.  Waves of bars are left to the speeds: steps are to
    pass over them.
    """
    K, weight, ratio = b.K, b.weight, grown(r, h)
    most, bent, moved = largest(s, K[NEW], r.top_acceleration), 0.0, 0.0
    for c in range(s.n_q, s.n_q + s.v_node):
        by = K[NEW, c] - r.yd[c]
        if ratio > 0.0:
            bend = by - ratio * (r.yd[c] - r.past[BEFORE, c])
        else:  # of half the step, or a part of the first difference
            bend = max(4.0 * abs(by - 2.0 * (K[SCRATCH, c] - r.yd[c])), UNKNOWN * abs(by))
        bent = max(bent, abs(bend) * weight[c])
        moved = max(moved, abs(by) * weight[c])
    off, strict = setting.step_error * r.speed * bent / 12.0, 0.0
    if held(s, r, h):
        doubted(s, r, setting, h, (LEFT * off, most, 0.0))
        if ratio == 0.0 or bent <= RESOLVED * moved or off > LOST * most:
            units = in_units(s, r, setting, h, (off, most, 0.0), share(s, setting, h, ONE))
            strict = min(STRICT * units, FURTHEST * further)
    turned = max(most, r.speed**2 / r.length)  # at the largest speed
    return max(strict, min(off / (setting.step_error * turned), further)) if turned > 0.0 else 0.0


@compiled(DENSE)
def dense(scene, K, t, h, ends, P):
    hermite.build(K[0], K[LAST], h, ends, P)
    for c in range(ends.shape[1]):  # not for the dense output: for the next step
        P[FILTERED, c], P[BEFORE, c] = K[B1, c], K[0, c]
