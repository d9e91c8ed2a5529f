"""DOP853: Dormand and Prince's explicit Runge-Kutta method of order 8 with error control.

Order 8, error estimate from embedded orders 5 and 3, dense output of order 7 from three further
stages, built only when asked for.    [HairerNorsettWanner1993]
"""

import numpy as np

from trsim.assemble.equations import equation, evaluate
from trsim.elements.contract import N_BOOK, compiled
from trsim.elements.vectors import internal
from trsim.solve import dop853_tableau as tableau
from trsim.solve.calls import DENSE, INTERPOLATE, STEP
from trsim.solve.works import first_work, works

ORDER = 8
STAGES = 16  # 12 of a step, the new point, 3 of the dense output
LAST = 12  # K[LAST] = y' at the end of the step
ESTIMATE = 8  # the error estimate falls with h^8
DENSE_ROWS = 7
DENSE_DEGREE = 8  # it is 7; looked at as MOST of spread.py
DEAR = 13  # rows of K with derivatives of a step; its dense output takes three more
ADAPTIVE, IMPLICIT = True, False

A, C, D, E3, E5 = tableau.A, tableau.C, tableau.D, tableau.E3, tableau.E5


@equation
def stage(K, y, h, s, out):
    """out = y + h sum_j A[s, j] K[j]."""
    n = y.size
    for c in range(n):
        out[c] = 0.0
    for j in range(s):
        a = A[s, j]
        if a != 0.0:
            for c in range(n):
                out[c] += a * K[j, c]
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
        for s in range(12):
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
        for s in range(12):
            e5 += E5[s] * K[s, c]
            e3 += E3[s] * K[s, c]
            moved += abs(K[s, c])
        if moved == 0.0:
            continue
        bottom = e5 * e5 + 0.01 * e3 * e3
        if bottom > 0.0:
            worst = max(worst, abs(h) * e5 * e5 / np.sqrt(bottom))
        size = max(size, abs(h) * moved / 12.0)
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
            for s in range(16):
                p += D[r, s] * K[s, c]
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
