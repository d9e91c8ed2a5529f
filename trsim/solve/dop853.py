"""DOP853: Dormand and Prince's explicit Runge-Kutta method of order 8 with error control.

Order 8, error estimate from embedded orders 5 and 3, dense output of order 7 from three further
stages, built only when asked for.    [HairerNorsettWanner1993]
"""

from math import comb

import numpy as np

from trsim.assemble.equations import equation, evaluate
from trsim.elements.contract import N_BOOK, compiled
from trsim.elements.vectors import internal
from trsim.solve import dop853_tableau as tableau
from trsim.solve.calls import CONTROL, DENSE, INTERPOLATE, STEP
from trsim.solve.works import first_work, works

ORDER = 8
STAGES = 16  # 12 of a step, the new point, 3 of the dense output
LAST = 12  # K[LAST] = y' at the end of the step
ESTIMATE = 8  # the error estimate falls with h^8
DENSE_ROWS = 7
DENSE_DEGREE = 7
DEAR = 13  # rows of K with derivatives of a step; its dense output takes three more
ADAPTIVE, IMPLICIT = True, False

A, C, D, E3, E5 = tableau.A, tableau.C, tableau.D, tableau.E3, tableau.E5


# of each stage: the columns of A that are not zero, in fours, and how many fours there are
IN_FOURS = np.zeros((16, 16), np.int64)
WEIGHTS = np.zeros((16, 16))
FOURS = np.zeros(16, np.int64)
for _s in range(16):
    _columns = np.flatnonzero(A[_s, :_s])
    FOURS[_s] = -(-_columns.size // 4)
    IN_FOURS[_s, : _columns.size], WEIGHTS[_s, : _columns.size] = _columns, A[_s, _columns]
IN_ERROR = np.flatnonzero((E3 != 0.0) | (E5 != 0.0))  # stages that an error estimate sees


IN_DENSE = np.flatnonzero(np.any(D != 0.0, axis=0))  # and those that the dense output does


@equation
def stage(K, y, h, s, out):
    """out = y + h sum_j A[s, j] K[j].

    Four stages at a time, in their order: each pass over y is one through memory.  What fills up
    the last four has the weight zero.
    """
    n = y.size
    for g in range(FOURS[s]):
        j0, j1, j2, j3 = (IN_FOURS[s, 4 * g], IN_FOURS[s, 4 * g + 1], IN_FOURS[s, 4 * g + 2],
                          IN_FOURS[s, 4 * g + 3])  # fmt: skip
        a0, a1, a2, a3 = (WEIGHTS[s, 4 * g], WEIGHTS[s, 4 * g + 1], WEIGHTS[s, 4 * g + 2],
                          WEIGHTS[s, 4 * g + 3])  # fmt: skip
        if g == 0:
            for c in range(n):
                out[c] = a0 * K[j0, c] + a1 * K[j1, c] + a2 * K[j2, c] + a3 * K[j3, c]
        else:
            for c in range(n):
                out[c] = out[c] + a0 * K[j0, c] + a1 * K[j1, c] + a2 * K[j2, c] + a3 * K[j3, c]
    for c in range(n):
        out[c] = y[c] + h * out[c]


@compiled(STEP)
def step(scene, r, b, setting, t, h):
    K, y, y1, weight = b.K, r.y, b.y1, b.weight
    for s in range(1, 12):
        stage(K, y, h, s, y1)
        evaluate(scene, t + C[s] * h, y1, K[s])
    error5 = error3 = 0.0
    counted = 0
    for c in range(y.size):
        if weight[c] == 0.0:
            continue
        counted += 1
        e5 = e3 = 0.0
        for i in range(IN_ERROR.size):
            s = IN_ERROR[i]
            e5 += E5[s] * K[s, c]
            e3 += E3[s] * K[s, c]
        error5 += (e5 * weight[c]) ** 2
        error3 += (e3 * weight[c]) ** 2
    stage(K, y, h, 12, y1)
    bottom = error5 + 0.01 * error3
    error = abs(h) * error5 / np.sqrt(bottom * max(counted, 1)) if bottom > 0.0 else 0.0
    return max(error, of_works(scene, r, b, setting, h))


@internal
def of_works(scene, r, b, setting, h):
    """The error of the works: the two estimates of the step itself, entry by entry."""
    K, worst, size = b.K, 0.0, 0.0
    for c in range(first_work(scene), first_work(scene) + N_BOOK):
        e5 = e3 = moved = 0.0
        for i in range(IN_ERROR.size):
            s = IN_ERROR[i]
            e5 += E5[s] * K[s, c]
            e3 += E3[s] * K[s, c]
            moved += abs(K[s, c])
        if moved == 0.0:
            continue
        bottom = e5 * e5 + 0.01 * e3 * e3
        if bottom > 0.0:
            worst = max(worst, abs(h) * e5 * e5 / np.sqrt(bottom))
        size = max(size, abs(h) * moved / IN_ERROR.size)
    return works(r, setting, h, worst, size)


@compiled(DENSE)
def dense(scene, K, t, y, h, y1, P):
    scratch = P[0]
    for s in range(13, 16):
        stage(K, y, h, s, scratch)
        evaluate(scene, t + C[s] * h, scratch, K[s])
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
