"""Kinematic analysis: where all freedoms are driven, positions follow from the time alone.

    Phi(q, t) = 0            Newton, from where velocities and accelerations of the last place lead
    J v = -Phi_t             velocities
    J a = gamma              accelerations and, with the forces, multipliers:  M a + J^T lam = F

Nothing is integrated but works, and the places of drives with a prescribed velocity: their time
integrals, by quadrature.  A step of length h is taken to its middle and from there to its end:

    middle      q + h/2 v + h^2/8 a, of order 3; the end by the cubic of velocities through both
    works       the quartic through the powers at the start, in the middle and at the end, and the
                two before these; at the start and behind a corner of a load Simpson
    places      five points of Gauss in each half; their error by five in the whole step
    inside      the quintic through three states and their rates, then brought to the rows

Steps end at output rows.  One is made again, shorter, where

    * Newton's method does not converge, or goes further than CORRECTED from the prediction,
    * a body moves further than FAR,
    * rows may depend on each other inside: the root of the least pivot is about the way to where
      they do, and half a step goes no further than PAST of both,
    * places are not those that velocities lead to: another branch has others,
    * det J has another sign than at the start.  It is zero only where rows depend on each other:
      at a turning point of the mechanism and where branches of its motion meet.  What goes from one
      branch to another, or past such a place, changes it, unless two depend at once.

Steps shrink towards such a place, and the run ends there.
"""

from math import inf, sqrt

import numpy as np

from trsim.assemble.equations import constraints, evaluate, forces, set_poses
from trsim.assemble.linear import SINGULAR, smallest_pivot
from trsim.assemble.outputs import measure
from trsim.assemble.projection import NEWTON, newton_step, project_velocities
from trsim.elements.contract import N_BOOK, compiled
from trsim.elements.scene import N_STORED
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import all_finite, copy_to
from trsim.solve.march.calls import BOOK, DENSE, INTERPOLATE, NO_STEP, STEP
from trsim.solve.march.samples import firmness, firmness_of_extremes
from trsim.solve.march.sides import side
from trsim.solve.march.works import BEGAN, DONE, LONG, POWERS, SAME_TIME
from trsim.solve.methods.displacements import turn

STAGES = 5  # rows of K: rates at start, middle and end, scratch of the march, state in the middle
MIDDLE, LAST, STATE = 2, 3, 4
DENSE_ROWS = DENSE_DEGREE = 5
ESTIMATE = 3  # what is predicted for the middle errs by h^3
IMPLICIT = False

FAR = 0.5  # rad, or of the mechanism's size: what a body moves in a step at most
CORRECTED = 0.02  # the same: how far from its prediction a place is found
PAST = 0.5  # times the roots of the least pivots at both ends of half a step: what a body moves
ASTRAY, BESIDE = 0.01, 1e-3  # of what a body moves, and the same as FAR: another branch is further
SQUARED = 1e-16  # what the next step of Newton's method would leave, squares of parts of the size
# places and weights of Gauss in a step as long as one
NODE, WEIGHT = (part / 2.0 for part in np.polynomial.legendre.leggauss(5))
NODE = NODE + 0.5
SETTLED = 1e-2  # of the difference between five points and ten: the error of the ten, and more


@compiled(STEP)
def step(s, r, b, setting, t, h):
    K, y, y1 = b.K, r.y, b.y1
    middle, half = K[STATE], 0.5 * h
    predict(s, y, K[0], half, middle)
    copy_to(y1, y)
    error = follow(s, b, y, t, h) if s.n_z > N_BOOK else 0.0
    nearly = close(s, t + half, middle, b.y2)
    if nearly < 0.0:
        return NO_STEP
    evaluate(s, t + half, middle, K[MIDDLE])
    b.firm[2] = firmness_of_extremes(s)
    if s.sought.size > 0:  # extremes: with these channels there is less to look for
        measure(s, t + half, middle, r.work_projection, r.energy_0)
        copy_to(b.middle, s.out)
        b.halved = 1
    inside = sqrt(firmness(s))
    go_on(s, (y, K[0]), (middle, K[MIDDLE]), half, y1)
    corrected = close(s, t + h, y1, b.y2)
    if corrected < 0.0:
        return NO_STEP
    if not (all_finite(K[MIDDLE]) and all_finite(y1)):
        return inf
    if side(s, b) != r.side:
        return NO_STEP
    far = way(s, y, y1)
    past = max(
        way(s, y, middle) / (sqrt(r.least_pivot) + inside),
        way(s, middle, y1) / (inside + sqrt(firmness(s))),
    )
    astray = beside(s, y, middle, y1, h) / (ASTRAY * far + BESIDE)
    corrected = max(nearly, corrected) / CORRECTED
    # ways go with h, and the next step takes what it is told to go with h^ESTIMATE
    return max(max(error, astray), corrected, max(far / FAR, past / PAST) ** ESTIMATE)


@internal
def predict(s, y, yd, h, y1):
    """y1 <- y after a time h, by its velocities and accelerations."""
    copy_to(y1, y)
    for f in range(1, s.n_r):
        v = s.n_q + s.d * (f - 1)
        if s.d == 3:
            for c in range(3):
                y1[3 * (f - 1) + c] += h * (y[v + c] + 0.5 * h * yd[v + c])
        else:
            q = 7 * (f - 1)
            for c in range(3):
                y1[q + c] += h * (y[v + c] + 0.5 * h * yd[v + c])
            turned = (
                h * (y[v + 3] + 0.5 * h * yd[v + 3]),
                h * (y[v + 4] + 0.5 * h * yd[v + 4]),
                h * (y[v + 5] + 0.5 * h * yd[v + 5]),
            )
            turn(y, y1, q + 3, turned[0], turned[1], turned[2])
        for c in range(s.d):
            y1[v + c] += h * yd[v + c]


@internal
def ahead(y0, yd0, y, yd, h, v):
    """How far one velocity leads in a time h from y, by the cubic through it at h before and there:
    its integral from 1 to 2 times h."""
    return h * (
        1.5 * y0[v] - 0.5 * y[v] + h * (0.5833333333333334 * yd0[v] + 1.4166666666666667 * yd[v])
    )


@internal
def go_on(s, before, now, h, y1):
    """Places and velocities of y1 <- those a time h after y, which is as much after y0.

    before, now: these states, each with its derivative.
    """
    (y0, yd0), (y, yd) = before, now
    for f in range(1, s.n_r):
        v = s.n_q + s.d * (f - 1)
        if s.d == 3:
            for c in range(3):
                y1[3 * (f - 1) + c] = y[3 * (f - 1) + c] + ahead(y0, yd0, y, yd, h, v + c)
        else:
            q = 7 * (f - 1)
            for c in range(3):
                y1[q + c] = y[q + c] + ahead(y0, yd0, y, yd, h, v + c)
            turned = (
                ahead(y0, yd0, y, yd, h, v + 3),
                ahead(y0, yd0, y, yd, h, v + 4),
                ahead(y0, yd0, y, yd, h, v + 5),
            )
            turn(y, y1, q + 3, turned[0], turned[1], turned[2])
        for c in range(s.d):
            y1[v + c] = y[v + c] + h * yd[v + c]


@internal
def follow(s, b, y, t, h):
    """The places of drives with a prescribed velocity in the middle and at the end; their error, in
    units of what is allowed.

    The rates of these states depend on the time alone: the poses at hand do.
    """
    first, half, error = s.n_q + s.n_v, 0.5 * h, 0.0
    whole, middle, y1 = b.y2, b.K[STATE], b.y1
    for k in range(N_BOOK, s.n_z):
        middle[first + k] = whole[first + k] = y[first + k]
    for n in range(NODE.size):
        forces(s, t + NODE[n] * h)
        for k in range(N_BOOK, s.n_z):
            whole[first + k] += WEIGHT[n] * h * s.zd[k]
        forces(s, t + NODE[n] * half)
        for k in range(N_BOOK, s.n_z):
            middle[first + k] += WEIGHT[n] * half * s.zd[k]
    for k in range(N_BOOK, s.n_z):
        y1[first + k] = middle[first + k]
    for n in range(NODE.size):
        forces(s, t + half + NODE[n] * half)
        for k in range(N_BOOK, s.n_z):
            y1[first + k] += WEIGHT[n] * half * s.zd[k]
    for k in range(N_BOOK, s.n_z):
        off = abs(y1[first + k] - whole[first + k])
        error = max(error, SETTLED * off * b.weight[first + k])
    return error


@internal
def close(s, t, y, before):
    """Bring y to the rows and its velocities to them; how far it went, less than 0 where Newton's
    method did not get there.  before: room for y."""
    copy_to(before, y)
    for _ in range(NEWTON):
        off = newton_step(s, t, y) / s.size
        if s.status[0] == SINGULAR:
            return -1.0
        if off * off <= SQUARED * smallest_pivot(s):
            set_poses(s, y)
            constraints(s, t)
            project_velocities(s, y)
            return way(s, before, y)
    return -1.0


@internal
def way(s, y, y1):
    """The furthest way of a body from y to y1, rad or of the mechanism's size."""
    furthest, width = 0.0, 3 if s.d == 3 else 7
    places = 2 if s.d == 3 else 3
    for k in range(s.n_q):
        moved = abs(y1[k] - y[k])
        if k % width < places:
            moved /= s.size
        elif s.d == 6:
            moved *= 2.0  # a quaternion turns half as fast
        furthest = max(furthest, moved)
    return furthest


@internal
def beside(s, y, middle, y1, h):
    """How far places at the end are from where velocities at start, middle and end lead."""
    furthest, width = 0.0, 3 if s.d == 3 else 7
    for f in range(1, s.n_r):
        q, v = width * (f - 1), s.n_q + s.d * (f - 1)
        for c in range(3):
            led = h / 6.0 * (y[v + c] + 4.0 * middle[v + c] + y1[v + c])
            off = abs(y1[q + c] - y[q + c] - led)
            furthest = max(furthest, off if s.d == 3 and c == 2 else off / s.size)
    return furthest


@compiled(BOOK)
def book(s, r, b, h):
    K, y, middle, y1, first = b.K, r.y, b.K[STATE], b.y1, s.n_q + s.n_v
    now, before = r.worked[0], r.worked[1]
    if now[BEGAN] != b.t:  # not the same step again
        copy_to(before, now)
    now[BEGAN], now[LONG] = b.t, h
    # no step of these powers ended here: at the start, and behind a corner
    alone = before[LONG] <= 0.0 or abs(before[BEGAN] + before[LONG] - b.t) > SAME_TIME * h
    for k in range(first, first + N_BOOK):
        at = k - first
        p0, p, p1 = K[0, k], K[MIDDLE, k], K[LAST, k]
        now[POWERS + at], now[DONE + at] = p0, p
        inside = whole = 0.0
        if not alone:
            powers = (p0, p, p1, before[DONE + at], before[POWERS + at])
            inside, whole = beyond_simpson(powers, 0.5 * before[LONG] / h)
        middle[k] = y[k] + h * ((5.0 * p0 + 8.0 * p - p1) / 24.0 + inside)
        y1[k] = y[k] + h * ((p0 + 4.0 * p + p1) / 6.0 + whole)
        s.z[k - first] = y1[k]  # for what is measured there
        if b.halved > 0:  # the middle was measured with works as they were at the start
            o = s.column_energy + 1 + N_STORED + k - first
            b.middle[s.n_out - 1] += b.middle[o] - middle[k]
            b.middle[o] = middle[k]


@internal
def beyond_simpson(powers, back):
    """What the quartic through five powers, at 0, 1/2, 1, -back and -2 back, adds to the integrals
    of the parabola through the first three, to 1/2 and to 1."""
    p0, p, p1, q, q0 = powers
    first, second = 2.0 * (p - p0), 2.0 * (p1 - p)
    third, fourth = (p1 - q) / (1.0 + back), (q - q0) / back
    a, b, c = second - first, (second - third) / (0.5 + back), (third - fourth) / (1.0 + 2.0 * back)
    d, e = (a - b) / back, (b - c) / (0.5 + 2.0 * back)
    last = (d - e) / (2.0 * back)
    return d / 64.0 + last * (0.0036458333333333334 + back / 64.0), last / -120.0


@compiled(DENSE)
def dense(s, K, t, h, ends, P):
    y, y1 = ends[0], ends[1]
    for c in range(y.size):
        first, there, last = h * K[0, c], h * K[MIDDLE, c], h * K[LAST, c]
        up, down = 2.0 * (K[STATE, c] - y[c]), 2.0 * (y1[c] - K[STATE, c])
        # divided differences over 0, 0, 1/2, 1/2, 1, 1
        a, b2 = 2.0 * (up - first), 2.0 * (there - up)
        c2, d = 2.0 * (down - there), 2.0 * (last - down)
        e, f, g = 2.0 * (b2 - a), c2 - b2, 2.0 * (d - c2)
        P[0, c], P[1, c], P[2, c] = first, a, e
        P[3, c] = f - e
        P[4, c] = (g - f) - (f - e)


@compiled(INTERPOLATE)
def interpolate(P, y, theta, out):
    past, left = theta - 0.5, theta - 1.0
    for c in range(y.size):
        rest = P[2, c] + past * (P[3, c] + left * P[4, c])
        out[c] = y[c] + theta * (P[0, c] + theta * (P[1, c] + past * rest))
