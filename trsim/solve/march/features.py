"""Corners of functions in a run: steps end where one is met, and what follows is another piece.

Between its corners a function is held on the piece it is on (assemble/features.py), so every trial
step sees smooth functions.  Corners that the time alone meets are known before the run: no step is
longer than the time to the next.
"""

from trsim.assemble.equations import evaluate, kinetic, set_poses, stored_energy
from trsim.assemble.features import (
    BEHIND,
    DRIVE,
    FIRST,
    OFFSET,
    PISTON,
    RATE_JUMP,
    call_hold,
    passed,
)
from trsim.assemble.projection import newton_step, project_velocities
from trsim.elements.contract import SCENE, compiled
from trsim.elements.prescribed import AnyDrive, began
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import f8
from trsim.kernels.vectors import copy_to
from trsim.laws.functions import BY_TIME
from trsim.solve.march.land import call_land
from trsim.solve.march.record import (
    BUFFERS,
    EVENT_IMPULSE,
    EVENT_ROW,
    EVENT_SPEED,
    EVENT_TIME,
    EVENT_WORK,
    JOLT,
    JOLTS_KEPT,
    NO_HISTORY,
    NO_JACOBIAN,
    RECORD,
    note_event,
)
from trsim.solve.march.samples import behind
from trsim.solve.march.works import LONG

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
            since = began(s, s.feature[n, DRIVE], s.feature[n, OFFSET])
            first = min(first, since + s.instant[at])
    return first


@compiled(types.float64(SCENE, f8, f8))
def next_time(s, t, end):
    """`next_instant`, for Python."""
    return next_instant(s, t, end)


@compiled(MEET)
def meet(s, r, b, t, t1):
    """Go on from t1 on the pieces that follow, if the time met corners after t; whether it did.

    A drive whose rate jumps there takes the mechanism along: velocities are projected.  One whose
    place jumps ends the run.
    """
    met = False
    for n in range(s.feature.shape[0]):
        met = met or passed(s, n, t1) > passed(s, n, t)
    if not met:
        return 0
    jumped = looked_at(s, r, t, t1)
    set_poses(s, r.y)
    before = kinetic(s, r.y) + stored_energy(s, t1) if jumped else 0.0
    call_hold(s.on_features[0], s, t1, BY_TIME)
    keep(s, r)
    if r.torn > 0:
        return 1
    copy_to(b.y1, r.y)
    first = r.event_rows
    if jumped:
        jolt(s, r, b, t, t1)
    done = call_land(b.land, s, r, b, t1, r.yd, 0)
    copy_to(r.y, b.y1)
    if jumped and s.jumps >= 0:
        set_poses(s, r.y)
        done = kinetic(s, r.y) + stored_energy(s, t1) - before
        r.y[s.n_q + s.n_v + s.jumps] += done
        evaluate(s, t1, r.y, r.yd)
        tell(r, b, first, done)
    else:
        r.work_projection += done
    for c in range(r.gap.shape[0]):
        r.gap[c, 1] = b.gap1[c, 1]
    other_side(s, r, b, t1)
    return 1


@internal
def looked_at(s, r, t, t1):
    """Whether a motion that a drive follows jumps between t and t1; the place of a rigid one must
    not, see TORN."""
    jumped = False
    for n in range(s.feature.shape[0]):
        e = s.feature[n, DRIVE]
        if e < 0:
            continue
        for k in range(passed(s, n, t), passed(s, n, t1)):
            place, rate = s.jump[s.feature[n, FIRST] + k]
            jumped = jumped or place != 0.0 or rate != 0.0
            if place != 0.0 and AnyDrive(s, e).row >= 0:
                r.torn, r.torn_by = 1 + e, place
    return jumped


@internal
def jolt(s, r, b, t, t1):
    """The impulses of drives whose rates jump: b.y1 gets the velocities after them.

    J M^-1 J^T P = J v + Phi_t, and a drive gives -P.  A line of events for each.  The piston of an
    actuator with a supply keeps its velocity.
    """
    for n in range(s.feature.shape[0]):
        if s.feature[n, DRIVE] >= 0 and s.feature[n, PISTON] >= 0:
            for k in range(passed(s, n, t), passed(s, n, t1)):
                rate = s.jump[s.feature[n, FIRST] + k, RATE_JUMP]
                b.y1[s.n_q + s.n_v + s.feature[n, PISTON]] -= rate
    if s.m > 0:
        newton_step(s, t1, b.y1)
        set_poses(s, b.y1)
        project_velocities(s, b.y1)
    for n in range(s.feature.shape[0]):
        e, rate = s.feature[n, DRIVE], 0.0
        if e < 0 or AnyDrive(s, e).row < 0:
            continue
        for k in range(passed(s, n, t), passed(s, n, t1)):
            rate += s.jump[s.feature[n, FIRST] + k, RATE_JUMP]
        if rate != 0.0 and r.event_rows < b.events.shape[0]:
            note_event(r, b, t1, JOLT, e, rate)
            b.events[r.event_rows - 1, EVENT_IMPULSE] = -s.x[AnyDrive(s, e).row]


@internal
def tell(r, b, first, done):
    """The work of the jumps of one instant into their lines, the first ones kept for the end."""
    for k in range(first, r.event_rows):
        line = b.events[k]
        line[EVENT_WORK] = done
        if r.n_jolts < JOLTS_KEPT:
            kept = r.jolt[r.n_jolts]
            kept[0], kept[1], kept[2] = line[EVENT_TIME], line[EVENT_ROW], line[EVENT_SPEED]
            kept[3], kept[4] = line[EVENT_IMPULSE], done
        r.n_jolts += 1


@internal
def other_side(s, r, b, t1):
    """What the end of a step leaves behind does not hold across a corner."""
    behind(s, r, b, t1)
    r.history, r.jacobian = NO_HISTORY, NO_JACOBIAN
    r.past_error = 0.0
    r.worked[0, LONG] = 0.0


@internal
def keep(s, r):
    """What functions are held on, into the record."""
    for k in range(s.held.size):
        r.held[k] = s.tab[s.held[k]]
