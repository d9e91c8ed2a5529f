"""Radau IIA, three stages, order 5, implicit, L-stable, on the index-1 equations of motion.

    Z_i = h sum_j a_ij f(t + c_j h, y + Z_j)        y_1 = y + Z_3        [HairerWanner1996]

A^-1 is brought to one real and one complex eigenvalue; a Newton step then solves, with mu one of
them over h, (mu - J) dW = r.  The equations are of second order: with x' = v the displacements are
eliminated,

    (mu - by_rate - by_place / mu) dw = r_w + by_place r_x / mu,     dx = (r_x + dv) / mu

so the systems have n_w unknowns instead of two for each.  The energy book feeds nothing back and
needs no matrix.  Dense output: the collocation polynomial, order 3; it starts the next Newton.
"""

from math import isfinite, sqrt

import numpy as np

from trsim.assemble.dense import inverse
from trsim.assemble.equations import evaluate
from trsim.elements.contract import N_BOOK, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import all_finite, clear, copy_to
from trsim.solve.march.accelerations import (
    ONE,
    apart,
    doubted,
    frequency,
    held,
    in_units,
    jumped,
    largest,
    settles,
    share,
    together,
)
from trsim.solve.march.calls import DENSE, INTERPOLATE, NO_STEP, RATE, SOFTEN, STEP
from trsim.solve.march.norm import squares
from trsim.solve.march.record import AHEAD, BEHIND, FRESH, NO_HISTORY, NO_JACOBIAN, NO_RATES, OLD
from trsim.solve.march.rounding import MARGIN, jitter, noted, to_look
from trsim.solve.march.settle import AT_END
from trsim.solve.march.works import first_work, works
from trsim.solve.methods.dense_lu import (
    divide,
    factorise_complex,
    factorise_real,
    quotient,
    solve_complex,
    solve_real,
)
from trsim.solve.methods.displacements import active, moved_by, twisted, w_index
from trsim.solve.methods.jacobian import jacobian, missing
from trsim.solve.methods.newton import (
    CONVERGED,
    FAILS,
    GOES_ON,
    NEXT_TO_NOTHING,
    judged,
    resolution,
    size_of_change,
)
from trsim.solve.methods.radau_tableau import ALPHA, BETA, GAMMA, T_INVERSE, A, C, E, T

ESTIMATE = 4  # the error estimate falls with h^4
STAGES = 13
LAST = 2
DENSE_ROWS = 4
DENSE_DEGREE = 3
IMPLICIT = True

Z, W, F, DW = 3, 6, 9, 12  # rows of K: three each of Z, W, F; one of scratch
# second differences over the stages: of what Z is, and of its rate times h; that rate at the end
BENT = np.array([1.0 / ((C[0] - C[1]) * (C[0] - 1.0)), 1.0 / ((C[1] - C[0]) * (C[1] - 1.0)),
    1.0 / ((1.0 - C[0]) * (1.0 - C[1]))])  # fmt: skip
TURNED, LEAVING = BENT @ inverse(A), inverse(A)[2]
MOST_ITERATIONS = 8
KAPPA = 0.01  # of the error allowed: what Newton may leave
RATES = 1.0  # times the tolerance and the largest acceleration: what it may leave of rates
SHARPEST = 0.01  # contraction that is believed without a second iteration
QUICK = 0.1  # contraction with which a matrix is kept for the next step
# entries of a body that an error of accelerations is the mean of: with all of them hardly any
# margin is left where a step holds some rad of a vibration and the estimate is no larger than the
# error; and what the error is likely to be, as a part of that, which is told
FEW, LIKELY = 2.0, 0.4
HALVE = NO_STEP  # Newton failed: take about half the step


@compiled(STEP)
def step(s, r, b, setting, t, h):
    corner = r.jacobian == NO_RATES
    for attempt in range(2):
        if missing(r) or (attempt > 0 and r.jacobian == OLD):
            jacobian(s, r, setting, b.K[Z], b.K[W])
            r.contraction = 1.0
            r.factored_h = 0.0
        elif attempt > 0:  # no older matrix is to blame
            return hidden(s, r, b, setting, h)
        if r.factored_h != h and not factorised(s, r, h):
            r.factored_h = 0.0
            return HALVE
        guess(s, r, b, h)
        converged = newton(s, r, b, setting, t, h)
        if converged > 0:
            break
        if converged < 0 and r.jacobian == FRESH:
            return np.inf
        if corner:  # the step is too long for the new branch, more often than its matrix too old
            return hidden(s, r, b, setting, h)
    else:
        return hidden(s, r, b, setting, h)
    at_stage(r, b, 2)
    error = estimate(s, r, b, setting, t, h)
    # a shorter step from the same state, to an event or after a rejection, begins on this one
    collocation(b.K, r.y, b.y1, r.past)
    r.past_h, r.history = h, AHEAD
    # where the state moves on its matrix is good for as long as Newton is quick
    r.next_jacobian = OLD if r.newton_rate < QUICK else NO_JACOBIAN
    return error


@internal
def hidden(s, r, b, setting, h):
    """HALVE: Newton failed.  If it is rounding that it could not go below, it is not asked to."""
    if to_look(r, h) and r.factored_h == h:
        jitter(s, r, b, setting, b.K[F], b.K[F + 1])
        corrected(s, r, b.K[F], b.K[DW], GAMMA / h)
        noted(s, r, setting, b.K[F], h)
    return HALVE


@internal
def factorised(s, r, h):
    """Factors of mu - by_rate - by_place / mu for the real and the complex mu."""
    n = active(s)
    if n == 0:
        r.factored_h = h
        return True
    real, pair = r.lu, r.lu_pair
    g, a, c = GAMMA / h, ALPHA / h, BETA / h
    size = a * a + c * c
    by_g, by_a, by_c = 1.0 / g, a / size, c / size
    for i in range(n):
        for k in range(n):
            B = r.by_place[i, k] if k < s.n_v else 0.0
            real[i, k] = -r.by_rate[i, k] - B * by_g
            pair[i, k] = complex(-r.by_rate[i, k] - B * by_a, B * by_c)
        real[i, i] += g
        pair[i, i] += complex(a, c)
    if not factorise_real(real, r.pivot[0], n):
        return False
    if not factorise_complex(pair, r.pivot[1], n):
        return False
    r.factored_h = h
    return True


@internal
def guess(s, r, b, h):
    """Start Newton from the polynomial of the step before, drawn on, or from that of a longer
    trial of this one; W = T^-1 Z."""
    K, n = b.K, r.y.size
    if r.history != NO_HISTORY:
        ahead = 1.0 if r.history == AHEAD else 0.0
        for i in range(3):
            theta = C[i] * h / r.past_h - ahead
            for c in range(n):
                K[Z + i, c] = ahead * r.past[3, c] + polynomial(r.past, c, theta)
    else:
        for i in range(3):
            clear(K[Z + i])
    for i in range(3):
        copy_to(K[W + i], K[Z + i])
    transformed(K, W, n)


@internal
def at_stage(r, b, i):
    """b.y1 <- the state at the i-th stage."""
    for k in range(r.y.size):
        b.y1[k] = r.y[k] + b.K[Z + i, k]


@internal
def transformed(K, row, n):
    """The three rows from that one on <- T^-1 times them."""
    for k in range(n):
        p, q, u = K[row, k], K[row + 1, k], K[row + 2, k]
        for i in range(3):
            K[row + i, k] = T_INVERSE[i, 0] * p + T_INVERSE[i, 1] * q + T_INVERSE[i, 2] * u


@internal
def moved_on(K, n):
    """Add the increments in F to W; Z = T W."""
    for i in range(3):
        for k in range(n):
            K[W + i, k] += K[F + i, k]
    for i in range(3):
        for k in range(n):
            K[Z + i, k] = T[i, 0] * K[W, k] + T[i, 1] * K[W + 1, k] + T[i, 2] * K[W + 2, k]


@internal
def newton(s, r, b, setting, t, h):
    """Simplified Newton on the stages.  1: converged, 0: not, -1: a value is not finite."""
    K, n, weight = b.K, r.y.size, b.weight
    g, a, c = GAMMA / h, ALPHA / h, BETA / h
    floor = resolution(r, weight, h)
    kappa, before = max(KAPPA, floor), 0.0
    # once measured, a contraction is trusted less with every use              [HairerWanner1996]
    expected = max(r.contraction, SHARPEST) ** 0.8
    r.contraction = expected
    told, changed = settles(s), 0.0
    quiet, near = RATES * setting.tolerance * r.top_acceleration, False
    for iteration in range(MOST_ITERATIONS):
        r.iterations += 1
        for i in range(3):
            at_stage(r, b, i)
            evaluate(s, t + C[i] * h, b.y1, K[F + i])
            if not all_finite(K[F + i]):
                return -1
        transformed(K, F, n)
        for k in range(n):  # F <- right-hand sides
            w1, w2 = K[W + 1, k], K[W + 2, k]
            K[F, k] -= g * K[W, k]
            K[F + 1, k] -= a * w1 - c * w2
            K[F + 2, k] -= c * w1 + a * w2
        corrected(s, r, K[F], K[DW], g)
        corrected_pair(s, r, K[F + 1], K[F + 2], b.pair, complex(a, c))
        moved = size_of_change(s, K, F, weight)
        if told:  # rates of what is stiff, which errors of places and speeds say little of
            changed = g * largest(s, K[F], largest(s, K[F + 1], largest(s, K[F + 2], 0.0)))
        moved_on(K, n)
        if not isfinite(moved):
            return -1
        verdict, rate = judged(moved, before, iteration, MOST_ITERATIONS, kappa)
        if iteration > 0:
            r.contraction = rate
        believed = iteration == 0 and expected < 1.0
        if believed and moved * expected / (1.0 - expected) < kappa:
            verdict, rate = CONVERGED, expected
        elif verdict == FAILS:
            break
        else:
            r.newton_rate = min(rate, 1e-4) if verdict == NEXT_TO_NOTHING else rate
        if verdict != GOES_ON:
            if changed * min(rate, 1.0) <= quiet or moved <= floor:
                return 1
            near = True
        before = moved
    return int(near and rustles(s, r, b, setting, changed, g))


@internal
def rustles(s, r, b, setting, changed, g):
    """Whether rates that change so much do so by rounding of places and rates."""
    K = b.K
    jitter(s, r, b, setting, K[F], K[F + 1])
    corrected(s, r, K[F], K[DW], g)
    return changed <= MARGIN * g * largest(s, K[F], 0.0)


@internal
def corrected(s, r, f, w, mu):
    """f <- (mu - J)^-1 f with the real factors; w: scratch."""
    n = active(s)
    for i in range(n):
        w[i] = f[w_index(s, i)]
    for k in range(s.n_v):
        x = twisted(s, r, k, f) / mu
        for i in range(n):
            w[i] += r.by_place[i, k] * x
    solve_real(r.lu, r.pivot[0], w, n)
    for q in range(s.n_q):
        f[q] = (f[q] + moved_by(s, r.y, q, w)) / mu
    for i in range(n):
        f[w_index(s, i)] = w[i]
    for k in range(N_BOOK):
        f[s.n_q + s.n_v + k] /= mu


@internal
def corrected_pair(s, r, f, g, w, mu):
    """f + i g <- (mu - J)^-1 (f + i g) with the complex factors; w: scratch."""
    n = active(s)
    for i in range(n):
        w[i] = complex(f[w_index(s, i)], g[w_index(s, i)])
    for k in range(s.n_v):
        x = quotient(complex(twisted(s, r, k, f), twisted(s, r, k, g)), mu)
        for i in range(n):
            w[i] += complex(r.by_place[i, k] * x.real, r.by_place[i, k] * x.imag)
    solve_complex(r.lu_pair, r.pivot[1], w, n)
    for q in range(s.n_q):
        x = quotient(complex(f[q], g[q]) + moved_by(s, r.y, q, w), mu)
        f[q], g[q] = x.real, x.imag
    for i in range(n):
        f[w_index(s, i)], g[w_index(s, i)] = w[i].real, w[i].imag
    divide(f, g, mu, s.n_q + s.n_v, s.n_q + s.n_v + N_BOOK)


@internal
def estimate(s, r, b, setting, t, h):
    """Error of order 3: (GAMMA/h - J)^-1 (f(y) + sum E_i Z_i / h), filtered once more if large."""
    K, n, weight = b.K, r.y.size, b.weight
    e = K[F]
    for c in range(n):
        e[c] = (E[0] * K[Z, c] + E[1] * K[Z + 1, c] + E[2] * K[Z + 2, c]) / h
        K[F + 1, c] = e[c]
        e[c] += r.yd[c]
    copy_to(K[F + 2], e)
    corrected(s, r, e, K[DW], GAMMA / h)
    off = apart(s, K[F + 2], GAMMA / h, e) if settles(s) else 0.0
    booked = of_works(s, r, b, setting, h)
    error = norm(e, weight)
    if booked >= 1.0 or (error >= 1.0 and (r.history != BEHIND or r.after_rejection > 0)):
        for c in range(n):
            K[F + 2, c] = r.y[c] + e[c]
        evaluate(s, t, K[F + 2], e)
        for c in range(n):
            e[c] += K[F + 1, c]
        corrected(s, r, e, K[DW], GAMMA / h)
        booked, error = of_works(s, r, b, setting, h), norm(e, weight)
    if held(s, r, h):
        error = max(error, of_accelerations(s, r, b, setting, h))
    jumped(s, r, setting, off)
    return max(error, booked, 1e-10)


@internal
def of_accelerations(s, r, b, setting, h):
    """The error of accelerations that the estimate in K[F] makes, by body.

    What it consists of turns by w^2 = |D v'| / |D x|, D the second difference over the stages.  In
    a first step, of the run or behind an event, which may be of any length, the filter of the
    estimate may have left nothing of it: there what was filtered counts as well.
    """
    K, weight, tolerance = b.K, b.weight, setting.step_error
    most = r.top_acceleration
    for c in range(s.n_q + s.n_v):
        K[F + 1, c] = BENT[0] * K[Z, c] + BENT[1] * K[Z + 1, c] + BENT[2] * K[Z + 2, c]
        K[F + 2, c] = TURNED[0] * K[Z, c] + TURNED[1] * K[Z + 1, c] + TURNED[2] * K[Z + 2, c]
        if c >= s.n_q:  # at the end of the step
            rate = LEAVING[0] * K[Z, c] + LEAVING[1] * K[Z + 1, c] + LEAVING[2] * K[Z + 2, c]
            most = max(most, s.scale[c] * abs(rate) / h)
    length, speed = (tolerance * r.length) ** 2, (tolerance * r.speed) ** 2
    q, v, of_q, of_v = 0, s.n_q, 3 if s.d == 3 else 7, s.d
    off = of_squares = bent = 0.0
    moved, begins = 1e-300, r.history != BEHIND and r.past_error == 0.0
    for _ in range(1, s.n_r):
        x = squares(K[F], weight, q, q + of_q)
        placed = squares(K[F + 1], weight, q, q + of_q)
        w = squares(K[F], weight, v, v + of_v)
        turned = squares(K[F + 2], weight, v, v + of_v)
        bare = 0.0
        for c in range(v, v + of_v if begins else v):
            rate = (E[0] * K[Z, c] + E[1] * K[Z + 1, c] + E[2] * K[Z + 2, c]) / h
            bare += ((r.yd[c] + rate) * weight[c]) ** 2
        q, v = q + of_q, v + of_v
        if turned > 0.0:
            ww = frequency(speed * turned / h**2, length * placed, h)
            by = ww * length * x + speed * w
            moved, bent = moved + by, bent + ww * by
            by = ww * by + speed * bare * min(1.0, ww * (h / GAMMA) ** 2)
            off, of_squares = off + by, of_squares + by * by
    off, mean = together(off, of_squares, FEW), bent / moved
    doubted(s, r, setting, h, (LIKELY * off, most, mean))
    return in_units(s, r, setting, h, (off, most, mean), share(s, setting, h, ONE))


@internal
def of_works(s, r, b, setting, h):
    """The error of the works, by the estimate in K[F]: no matrix has a part in it."""
    worst = size = 0.0
    for c in range(first_work(s), first_work(s) + N_BOOK):
        worst = max(worst, abs(b.K[F, c]))
        for i in range(3):
            size = max(size, abs(b.K[Z + i, c]))
    return works(r, setting, h, worst, size)


@internal
def norm(e, weight):
    """Root mean square of the weighed entries."""
    total, counted = 0.0, 0
    for c in range(e.size):
        if weight[c] > 0.0:
            counted += 1
            total += (e[c] * weight[c]) ** 2
    return sqrt(total / max(counted, 1))


@compiled(DENSE)
def dense(scene, K, t, h, ends, P):
    collocation(K, ends[0], ends[1], P)


@internal
def collocation(K, y, y1, P):
    """Divided differences of the collocation polynomial, through the end as accepted."""
    for c in range(y.size):
        z0, z1, z2 = K[Z, c], K[Z + 1, c], y1[c] - y[c]
        P[0, c] = (z1 - z2) / (C[1] - 1.0)
        slope = (z0 - z1) / (C[0] - C[1])
        P[1, c] = (slope - P[0, c]) / (C[0] - 1.0)
        P[2, c] = P[1, c] - (slope - z0 / C[0]) / C[1]
        P[3, c] = z2


@internal
def polynomial(P, c, s):
    """Entry c of the solution at t + h + s h, from that at t + h."""
    return s * (P[0, c] + (s - C[1] + 1.0) * (P[1, c] + (s - C[0] + 1.0) * P[2, c]))


@compiled(RATE)
def rate(K, P, h, theta, out):
    """Of the collocation polynomial: by the stages at the end of a step, by P inside it."""
    if theta == AT_END:
        for c in range(out.size):
            z = LEAVING[0] * K[Z, c] + LEAVING[1] * K[Z + 1, c] + LEAVING[2] * K[Z + 2, c]
            out[c] = z / h
        return
    s, p, q = theta - 1.0, theta - C[1], theta - C[0]
    for c in range(out.size):
        rest = P[1, c] + q * P[2, c]
        out[c] = (P[0, c] + p * rest + s * (rest + p * P[2, c])) / h


@compiled(SOFTEN)
def soften(s, r, b, c):
    """c <- (mu - J)^-1 c with the real factors of the last step."""
    if r.factored_h == 0.0:
        return 0.0
    mu = GAMMA / r.factored_h
    corrected(s, r, c, b.K[DW], mu)
    return mu


@compiled(INTERPOLATE)
def interpolate(P, y, theta, out):
    for c in range(y.size):
        out[c] = y[c] + P[3, c] + polynomial(P, c, theta - 1.0)
