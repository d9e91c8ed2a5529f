"""DOP853: Dormand and Prince's explicit Runge-Kutta method of order 8 with error control.

Order 8, error estimate from embedded orders 5 and 3, dense output of order 7 from three further
stages, built only when asked for.    [HairerNorsettWanner1993]
"""

from math import comb, inf, sqrt

import numpy as np

from trsim.assemble.equations import evaluate
from trsim.elements.contract import N_BOOK, compiled
from trsim.kernels.lazy import internal
from trsim.solve.march.accelerations import (
    EACH,
    ROUNDED,
    doubted,
    exceeded,
    frequency,
    furthest,
    held,
    in_units,
    largest,
    share,
    squared,
    stiffness,
    together,
    unknown,
)
from trsim.solve.march.calls import CONTROL, DENSE, INTERPOLATE, STEP
from trsim.solve.march.land import evaluate_stage
from trsim.solve.march.norm import squares
from trsim.solve.march.works import first_work, works
from trsim.solve.methods import dop853_tableau as tableau

STAGES = 16  # 12 of a step, the new point, 3 of the dense output
LAST = 12  # K[LAST] = y' at the end of the step
ESTIMATE = 8  # the error estimate falls with h^8
DENSE_ROWS = 7
DENSE_DEGREE = 7
DEAR = 13  # rows of K with derivatives of a step; its dense output takes three more
IMPLICIT = False

A, C, D, E3, E5 = tableau.A, tableau.C, tableau.D, tableau.E3, tableau.E5


# rows of sums: stages, then what the error estimates are made of, into these rows of K
OF_FIFTH, OF_THIRD, OF_PLACES, FROM_LAST_STAGE = 16, 17, 18, 19
FIFTH, THIRD, PLACES = 13, 14, 15
_sums = np.zeros((20, 16))
_sums[:16] = A
_sums[OF_FIFTH, :12], _sums[OF_THIRD, :12] = E5[:12], E3[:12]
_sums[OF_PLACES, :12] = E5[:12] @ A[:12, :12]  # h times that: places at the stages, by weights E5
_sums[FROM_LAST_STAGE, :12] = A[12, :12] - A[11, :12]  # to the end of the step
# of each: the columns that are not zero, in fours, and how many fours there are
IN_FOURS = np.zeros(_sums.shape, np.int64)
WEIGHTS = np.zeros(_sums.shape)
FOURS = np.zeros(len(_sums), np.int64)
for _s in range(len(_sums)):
    _columns = np.flatnonzero(_sums[_s])
    FOURS[_s] = -(-_columns.size // 4)
    IN_FOURS[_s, : _columns.size], WEIGHTS[_s, : _columns.size] = _columns, _sums[_s, _columns]
IN_ERROR = np.flatnonzero((E3 != 0.0) | (E5 != 0.0))  # stages that an error estimate sees
HUGE = 1e200  # squares of errors: such stages are no motion
FAR = 2.5  # rad: the dense output errs by three times the estimate, of longer steps by more
# of the last term of the dense output: what is missing.  1/1000 to 1/600 of vibrations w and forced
# motions W, wherever it is no more than rounding: w h from 0.1 to 4, W h from 0.1 to 1
LEFT = 1.0 / 700.0
# both estimates shrink each other, which is right where they see the same motion.  Where that of
# third order sees a slow motion and that of fifth order a vibration or decay at the limit of
# stability, w h of 5 to 5.6, the error is 0.9 to 5 times the estimate of fifth order itself
APART = 3.0  # the frequency of this one over that of the other: another motion
HOLDS = 6.0  # w h of that limit
SLOWER = 2.0  # times the frequency known from the steps before: by as much that may lag
# tolerances of accelerations that a step of many may leave: of a steady vibration all errors point
# the same way, and half a tolerance in 1,093 steps was 222
STEADY = 0.25
IN_DENSE = np.flatnonzero(np.any(D != 0.0, axis=0))  # and those that the dense output does


@internal
def stage(K, y, h, s, out):
    """out = y + h sum_j A[s, j] K[j]."""
    combined(K, s, 0, y.size, out)
    for c in range(y.size):
        out[c] = y[c] + h * out[c]


@internal
def combined(K, s, first, beyond, out):
    """out = sum_j (row s of the sums)[j] K[j] of these entries.

    Four stages at a time, in their order: each pass over y is one through memory.  What fills up
    the last four has the weight zero.
    """
    for g in range(FOURS[s]):
        j0, j1, j2, j3 = (IN_FOURS[s, 4 * g], IN_FOURS[s, 4 * g + 1], IN_FOURS[s, 4 * g + 2],
                          IN_FOURS[s, 4 * g + 3])  # fmt: skip
        a0, a1, a2, a3 = (WEIGHTS[s, 4 * g], WEIGHTS[s, 4 * g + 1], WEIGHTS[s, 4 * g + 2],
                          WEIGHTS[s, 4 * g + 3])  # fmt: skip
        if g == 0:
            for c in range(first, beyond):
                out[c] = a0 * K[j0, c] + a1 * K[j1, c] + a2 * K[j2, c] + a3 * K[j3, c]
        else:
            for c in range(first, beyond):
                out[c] = out[c] + a0 * K[j0, c] + a1 * K[j1, c] + a2 * K[j2, c] + a3 * K[j3, c]


@compiled(STEP)
def step(scene, r, b, setting, t, h):
    K, y, y1, weight = b.K, r.y, b.y1, b.weight
    for s in range(1, 12):
        stage(K, y, h, s, y1)
        evaluate(scene, t + C[s] * h, y1, K[s])
    combined(K, OF_FIFTH, 0, y.size, K[FIFTH])
    combined(K, OF_THIRD, 0, y.size, K[THIRD])
    error5 = error3 = 0.0
    counted = 0
    for c in range(y.size):
        if weight[c] != 0.0:
            counted += 1
            error5 += (K[FIFTH, c] * weight[c]) ** 2
            error3 += (K[THIRD, c] * weight[c]) ** 2
    stage(K, y, h, 12, y1)
    bottom = error5 + 0.01 * error3
    if not bottom < HUGE:  # nor is what is left of it by overflow
        return inf
    error = abs(h) * error5 / sqrt(bottom * max(counted, 1)) if bottom > 0.0 else 0.0
    if held(scene, r, h):
        error = max(error, of_accelerations(scene, r, b, setting, h))
    return max(error, of_works(scene, r, b, setting, h))


@internal
def of_accelerations(s, r, b, setting, h):
    """The error of accelerations: both estimates of places and velocities in one size, by body.

    Inside a step that holds more than FAR rad the dense output is off by more than its end.  What
    rounding makes of stages is told, and not held.
    """
    K, weight, tolerance = b.K, b.weight, setting.step_error
    combined(K, OF_PLACES, 0, s.n_q, K[PLACES])
    most = r.top_acceleration
    length, speed = (tolerance * r.length) ** 2, (tolerance * r.speed) ** 2
    q, v, of_q, of_v = 0, s.n_q, 3 if s.d == 3 else 7, s.d
    error5 = error3 = seen5 = seen3 = least = moved = turned = of_squares = 0.0
    stiff, rounding = stiffness(r, h), unknown(r, furthest(s, r.y, s.size)) ** 2
    for _ in range(1, s.n_r):
        x5 = squares(K[FIFTH], weight, q, q + of_q)
        x3 = squares(K[THIRD], weight, q, q + of_q)
        placed = squares(K[PLACES], weight, q, q + of_q)
        v5 = squares(K[FIFTH], weight, v, v + of_v)
        v3 = squares(K[THIRD], weight, v, v + of_v)
        q, v = q + of_q, v + of_v
        if v5 > 0.0:
            ww = max(frequency(speed * v5, h * h * length * placed, h), stiff)
            seen = speed * v5 > rounding
            far = max(1.0, ww * h * h / FAR**2) if seen else 1.0
            by = ww * length * x5 + speed * v5
            moved, turned = moved + by, turned + ww * by
            by5, by3 = far * far * ww * by, far * far * ww * (ww * length * x3 + speed * v3)
            error5, error3 = error5 + by5, error3 + by3
            of_squares += by5 * by5
            if seen:
                seen5, seen3 = seen5 + by5, seen3 + by3
                if v5 * x3 > APART**2 * v3 * x5:
                    turns = min(h * h * speed * v5 / (length * x5), SLOWER**2 * stiff * h * h)
                    least += by5 * min((turns / HOLDS**2) ** 3, 1.0)
    if of_squares == 0.0:  # or next to nothing: its square is no number
        return 0.0
    bodies = EACH * error5 * error5 / of_squares
    off = h * error5 / sqrt((error5 + 0.01 * error3) * bodies)
    # stages of a step too long may be anywhere: no more than the speeds so far may turn to
    mean = turned / moved
    inside = min(largest(s, K[11], largest(s, K[7], 0.0)), sqrt(mean) * r.top_speed)
    most = max(most, inside)
    doubted(s, r, setting, h, (off, most, mean))
    part = share(s, setting, h, STEADY)
    exceeded(r, setting, off, most, part)
    if seen5 == 0.0:
        return 0.0
    off = h * sqrt(max(seen5 / (seen5 + 0.01 * seen3) * seen5, least) / bodies)
    return in_units(s, r, setting, h, (off, most, mean), part)


@internal
def of_works(scene, r, b, setting, h):
    """The error of the works: the two estimates of the step itself, entry by entry."""
    K, worst, size = b.K, 0.0, 0.0
    for c in range(first_work(scene), first_work(scene) + N_BOOK):
        e5, e3, moved = K[FIFTH, c], K[THIRD, c], 0.0
        for i in range(IN_ERROR.size):
            moved += abs(K[IN_ERROR[i], c])
        if moved == 0.0:
            continue
        bottom = e5 * e5 + 0.01 * e3 * e3
        if bottom > 0.0:
            worst = max(worst, abs(h) * e5 * e5 / np.sqrt(bottom))
        size = max(size, abs(h) * moved / IN_ERROR.size)
    return works(r, setting, h, worst, size)


@compiled(DENSE)
def dense(scene, K, t, h, ends, P):
    y, y1, scratch = ends[0], ends[1], P[0]
    for s in range(13, 16):
        stage(K, y, h, s, scratch)
        evaluate_stage(scene, t + C[s] * h, scratch, K[s])
    for c in range(y.size):
        delta = y1[c] - y[c]
        P[0, c] = delta
        P[1, c] = h * K[0, c] - delta
        P[2, c] = 2.0 * delta - h * (K[12, c] + K[0, c])
        for r in range(4):
            p = 0.0
            for i in range(IN_DENSE.size):
                p += D[r, IN_DENSE[i]] * K[IN_DENSE[i], c]
            P[3 + r, c] = h * p


@compiled(STEP)
def inside(scene, r, b, setting, t, h):
    """The error of accelerations on the dense output in b.P, in units of what is allowed.

    Places and velocities are polynomials of degree 7 in theta, off by about LEFT of their last
    terms: the end of the step, and the estimate of that, may be better by far, also where rounding
    limits it.  No weights hide that here: LEFT of a last term has no more of rounding than the end.
    """
    ww = stiffness(r, h)
    of_places = (min(r.vibration, ww) * LEFT) ** 2
    of_rates = (min(r.decay, sqrt(ww)) * LEFT) ** 2
    q, v, of_q, of_v = 0, scene.n_q, 3 if scene.d == 3 else 7, scene.d
    moved = off = of_squares = 0.0
    for _ in range(1, scene.n_r):
        places = squared(scene, b.P[6], q, q + of_q)
        rates = squared(scene, b.P[6], v, v + of_v)
        q, v, moved = q + of_q, v + of_v, moved + places
        by = of_places * places + of_rates * rates
        off, of_squares = off + by, of_squares + by * by
    if LEFT * sqrt(moved) < ROUNDED * furthest(scene, r.y, scene.size) or off == 0.0:
        return 0.0
    off = together(off, of_squares, EACH)
    most = r.top_acceleration
    doubted(scene, r, setting, h, (off, most, ww))
    return in_units(scene, r, setting, h, (off, most, ww), share(scene, setting, h, STEADY))


@compiled(INTERPOLATE)
def interpolate(P, y, theta, out):
    rest = 1.0 - theta
    for c in range(y.size):
        p = P[6, c]
        p = P[5, c] + theta * p
        p = P[4, c] + rest * p
        p = P[3, c] + theta * p
        p = P[2, c] + rest * p
        p = P[1, c] + theta * p
        p = P[0, c] + rest * p
        out[c] = y[c] + theta * p


def _in_bernstein():
    """Control points of what each row of P stands with, theta^a (1 - theta)^b."""
    points, n = np.zeros((DENSE_DEGREE + 1, DENSE_ROWS)), DENSE_DEGREE
    for r in range(DENSE_ROWS):
        a, b = r // 2 + 1, (r + 1) // 2
        for i in range(n - a - b + 1):
            points[a + i, r] = comb(n - a - b, i) / comb(n, a + i)
    return points


IN_BERNSTEIN = _in_bernstein()


@compiled(CONTROL)
def control(P, net):
    for k in range(DENSE_DEGREE + 1):
        w = IN_BERNSTEIN[k]
        for c in range(net.shape[1]):
            net[k, c] = (
                w[0] * P[0, c] + w[1] * P[1, c] + w[2] * P[2, c] + w[3] * P[3, c]
                + (w[4] * P[4, c] + w[5] * P[5, c] + w[6] * P[6, c])
            )  # fmt: skip
