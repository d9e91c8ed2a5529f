"""Derivatives of the accelerations, for implicit methods.

The equations of motion are of second order in the places x and of first order in w = (v, states of
elements), so what an implicit method needs of them is small:

    w' = g(t, x, w)        by_place = dg/dx (n_w, n_v),        by_rate = dg/dw (n_w, n_w)

Displacements are those of displacements.py.  Forward differences, each step a small part of the
unit of its entry in the error norm: the stiff part comes from contacts, and the unit is the
smallest penetration that matters.
"""

from trsim.assemble.equations import evaluate
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_to
from trsim.solve.march.norm import weight_of
from trsim.solve.march.record import FRESH, NO_JACOBIAN, NO_RATES, OLD
from trsim.solve.methods.displacements import active, displace, frame_of, place_of, w_index

PART = 3e-4  # of an entry's unit: the step of a difference


@internal
def missing(r):
    """Whether a step needs `jacobian` first."""
    return r.jacobian == NO_JACOBIAN or r.jacobian == NO_RATES


@internal
def jacobian(s, r, setting, trial, rates):
    """Fill by_place and by_rate at the state of the record.  trial, rates: scratch (n_y).

    After a corner of friction only the columns of by_rate are new that belong to the bodies which
    rub there: the law has no jump, and what is left of the others is good enough.
    """
    n_w, t, tolerance = active(s), r.t, setting.step_error
    places = r.jacobian != NO_RATES
    for k in range(s.n_v if places else 0):
        # the unit of a displacement is that of the velocity's partner: same arm, length for speed
        unit = 1.0 / (weight_of(s, r, tolerance, place_of(s, k)) * tolerance)
        if s.d == 6 and k < s.v_node and k % 6 > 2:
            unit *= 2.0  # half a turn vector makes a quaternion
        copy_to(trial, r.y)
        displace(s, trial, k, PART * unit)
        evaluate(s, t, trial, rates)
        for row in range(n_w):
            i = w_index(s, row)
            r.by_place[row, k] = (rates[i] - r.yd[i]) / (PART * unit)
    for k in range(n_w):
        if not places and r.stale[frame_of(s, k)] == 0:
            continue
        i = w_index(s, k)
        weight = weight_of(s, r, tolerance, i)
        unit = 1.0 / (weight * tolerance) if weight > 0.0 else 1.0
        copy_to(trial, r.y)
        trial[i] += PART * unit
        part = trial[i] - r.y[i]
        evaluate(s, t, trial, rates)
        for row in range(n_w):
            i = w_index(s, row)
            r.by_rate[row, k] = (rates[i] - r.yd[i]) / part
    for f in range(s.n):
        r.stale[f] = 0
    r.jacobian = FRESH if places else OLD
    r.jacobians += 1
    if places:
        r.jacobian_rate = -1.0  # not known yet
