"""Corners of functions in a run: steps end where one is met, and what follows is another piece.

Between its corners a function is held on the piece it is on (assemble/features.py), so every trial
step sees smooth functions.  Corners that the time alone meets are known before the run: no step is
longer than the time to the next.
"""

from trsim.assemble.features import BEHIND, DRIVE, FIRST, call_hold, passed
from trsim.assemble.outputs import measure
from trsim.elements import signatures as types
from trsim.elements.calls import caller
from trsim.elements.contract import SCENE, SINCE, compiled
from trsim.elements.packed import f8
from trsim.elements.vectors import copy_to, internal
from trsim.laws.functions import BY_TIME
from trsim.solve.land import land
from trsim.solve.peaks import extreme
from trsim.solve.record import (
    BUFFERS,
    ENERGY_0,
    HISTORY,
    JACOBIAN,
    NO_HISTORY,
    NO_JACOBIAN,
    PAST_ERROR,
    PEAK_T1,
    RECORD,
    WORK_PROJECTION,
)
from trsim.solve.works import LONG

MEET = types.int64(SCENE, RECORD, BUFFERS, f8, f8)
call_meet = caller(MEET)


@internal
def next_instant(s, t, end):
    """The first instant after t at which the time alone meets a corner; `end` without any."""
    first = end
    for n in range(s.feature.shape[0]):
        k = passed(s, n, t)
        at = s.feature[n, FIRST] + k
        if k > 0 and at < s.feature[n, BEHIND]:
            since = s.mem[s.feature[n, DRIVE], SINCE] if s.feature[n, DRIVE] >= 0 else 0.0
            first = min(first, since + s.instant[at])
    return first


@compiled(types.float64(SCENE, f8, f8))
def next_time(s, t, end):
    """The same, for Python."""
    return next_instant(s, t, end)


@compiled(MEET)
def meet(s, r, b, t, t1):
    """Go on from t1 on the pieces that follow, if the time met corners after t; whether it did.

    A drive whose rate jumps there takes the mechanism along: velocities are projected.
    """
    met = False
    for n in range(s.feature.shape[0]):
        met = met or passed(s, n, t1) > passed(s, n, t)
    if not met:
        return 0
    call_hold(s.on_features[0], s, t1, BY_TIME)
    keep(s, r)
    copy_to(b.y1, r.y)
    r.clock[WORK_PROJECTION] += land(s, r, b, t1, b.y1, r.yd)
    copy_to(r.y, b.y1)
    for c in range(r.gap.shape[0]):
        r.gap[c, 1] = b.gap1[c, 1]
    other_side(s, r, t1)
    return 1


@internal
def other_side(s, r, t1):
    """What the end of a step leaves behind does not hold across a corner."""
    measure(s, t1, r.y, r.clock[WORK_PROJECTION], r.clock[ENERGY_0])
    for c in range(s.n_out):
        extreme(r.peak[c], t1, s.out[c])
        r.peak[c, PEAK_T1] = t1  # no parabola across it
    r.count[HISTORY], r.count[JACOBIAN] = NO_HISTORY, NO_JACOBIAN
    r.clock[PAST_ERROR] = 0.0
    r.worked[0, LONG] = 0.0


@internal
def keep(s, r):
    """What functions are held on, into the record."""
    for k in range(s.held.size):
        r.held[k] = s.tab[s.held[k]]


def put_back(s, r):
    """Hold the functions of a scene as its record says."""
    s.tab[s.held] = r.held
