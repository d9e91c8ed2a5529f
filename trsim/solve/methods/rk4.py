"""Classical Runge-Kutta, order 4, fixed step: the method of the published reverser studies.

    0   |
    1/2 | 1/2
    1/2 | 0    1/2
    1   | 0    0    1
    ----+---------------------
        | 1/6  1/3  1/3  1/6                      [HairerNorsettWanner1993]

Unless `locate_events: true` says otherwise, contact onset is not located: a contact acts in every
stage in which the bodies overlap, and its impact speed is latched at the end of the first step that
finds them overlapping.  Between the ends of a step the solution is the cubic Hermite polynomial
(order 3).
"""

from trsim.assemble.equations import evaluate
from trsim.elements.contract import compiled
from trsim.solve.march.calls import DENSE, STEP
from trsim.solve.march.turns import fastest
from trsim.solve.march.works import note_error
from trsim.solve.methods import hermite

STAGES = 5
LAST = 4
REAL, IMAGINARY = 2.785, 2.828  # where its stability region ends: h lambda on either axis
PER_RADIAN = 120.0  # a step that turns by x leaves x^5/120 of it: x^4/120 of each radian
DENSE_ROWS = hermite.ROWS
DENSE_DEGREE = 3
ESTIMATE = 4  # of no use: the step is fixed
IMPLICIT = False
interpolate = hermite.value


@compiled(STEP)
def step(scene, r, b, setting, t, h):
    K, y, y1 = b.K, r.y, b.y1
    for s in range(1, 4):
        part = h if s == 3 else 0.5 * h
        for c in range(y.size):
            y1[c] = y[c] + part * K[s - 1, c]
        evaluate(scene, t + part, y1, K[s])
    for c in range(y.size):
        y1[c] = y[c] + h / 6.0 * (K[0, c] + 2.0 * K[1, c] + 2.0 * K[2, c] + K[3, c])
    r.step_turn = max(r.step_turn, h * fastest(scene, y, K[0]))
    note_error(scene, r, b, t, h, 2)
    return 0.0


@compiled(DENSE)
def dense(scene, K, t, h, ends, P):
    hermite.build(K[0], K[LAST], h, ends, P)
