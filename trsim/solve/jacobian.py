"""Derivatives of the accelerations, for implicit methods.

The equations of motion are of second order in the places x and of first order in w = (v, states of
elements), so what an implicit method needs of them is small:

    w' = g(t, x, w)        by_place = dg/dx (n_w, n_v),        by_rate = dg/dw (n_w, n_w)

Displacements dx are counted in the axes of the velocities: three (planar) or six numbers a body.
Forward differences, each step a small part of the unit of its entry in the error norm: the stiff
part comes from contacts, and the unit is the smallest penetration that matters.
"""

from trsim.assemble.equations import evaluate
from trsim.elements.contract import N_BOOK
from trsim.elements.vectors import copy_to, internal
from trsim.solve.record import FRESH, JACOBIAN, JACOBIANS, TOLERANCE

PART = 3e-4  # of an entry's unit: the step of a difference


@internal
def active(s):
    """n_w: velocities and states of elements; the energy book feeds nothing."""
    return s.n_v + s.n_z - N_BOOK


@internal
def w_index(s, k):
    """Where the k-th entry of w stands in y."""
    return s.n_q + k if k < s.n_v else s.n_q + k + N_BOOK


@internal
def displace(s, y, k, part):
    """Move y by `part` along the k-th displacement.  Returns nothing; y changes in place."""
    if s.d == 3:
        y[k] += part
        return
    f, a = k // 6, k % 6
    q = 7 * f
    if a < 3:
        y[q + a] += part
        return
    e0, e1, e2, e3 = y[q + 3], y[q + 4], y[q + 5], y[q + 6]
    half = 0.5 * part
    if a == 3:
        y[q + 3] -= e1 * half
        y[q + 4] += e0 * half
        y[q + 5] += e3 * half
        y[q + 6] -= e2 * half
    elif a == 4:
        y[q + 3] -= e2 * half
        y[q + 4] -= e3 * half
        y[q + 5] += e0 * half
        y[q + 6] += e1 * half
    else:
        y[q + 3] -= e3 * half
        y[q + 4] += e2 * half
        y[q + 5] -= e1 * half
        y[q + 6] += e0 * half


@internal
def jacobian(s, r, b, setting, t, trial, rates):
    """Fill by_place and by_rate at (t, r.y), where y' is r.yd.  trial, rates: scratch (n_y)."""
    n_w, tolerance = active(s), setting[TOLERANCE]
    for k in range(s.n_v):
        # the unit of a displacement is that of the velocity's partner: same arm, length for speed
        unit = 1.0 / (b.weight[place_of(s, k)] * tolerance)
        if s.d == 6 and k % 6 > 2:
            unit *= 2.0  # half a turn vector makes a quaternion
        copy_to(trial, r.y)
        displace(s, trial, k, PART * unit)
        evaluate(s, t, trial, rates)
        for row in range(n_w):
            i = w_index(s, row)
            r.by_place[row, k] = (rates[i] - r.yd[i]) / (PART * unit)
    for k in range(n_w):
        i = w_index(s, k)
        unit = 1.0 / (b.weight[i] * tolerance) if b.weight[i] > 0.0 else 1.0
        copy_to(trial, r.y)
        trial[i] += PART * unit
        part = trial[i] - r.y[i]
        evaluate(s, t, trial, rates)
        for row in range(n_w):
            i = w_index(s, row)
            r.by_rate[row, k] = (rates[i] - r.yd[i]) / part
    r.count[JACOBIAN] = FRESH
    r.count[JACOBIANS] += 1


@internal
def place_of(s, k):
    """Entry of y whose weight goes with the k-th displacement."""
    return k if s.d == 3 else 7 * (k // 6) + k % 6
