"""What changes at a contact event: the phase of the contact, its memory, the next step."""

import numpy as np

from trsim.assemble.equations import corners, evaluate, gaps, poses
from trsim.assemble.features import call_hold
from trsim.elements.contract import (
    BRANCH,
    CONTACT,
    IMPACT_SPEED,
    PHASE,
    SCENE,
    ContactNumbers,
    Pair,
    compiled,
)
from trsim.kernels.signatures import void
from trsim.kernels.vectors import internal
from trsim.laws.functions import BY_SENSORS, BY_TIME
from trsim.solve.march.corners import look
from trsim.solve.march.events import NONE, SAME, flip, hertz_step
from trsim.solve.march.features import keep
from trsim.solve.march.record import (
    BUFFERS,
    EVENT_ANGLE,
    EVENT_IMPULSE,
    EVENT_KIND,
    EVENT_ROW,
    EVENT_SPEED,
    EVENT_TIME,
    EVENT_WORK,
    NO_HISTORY,
    NO_JACOBIAN,
    NO_RATES,
    ONSET,
    RECORD,
    SEPARATION,
    SETTINGS,
)
from trsim.solve.march.samples import behind
from trsim.solve.march.watch import fire, watch

TINY = 1e-300
AS_LONG = 4.0  # times the last free motion: the first step of the next one at most


@internal
def change_phases(s, r, b, setting, t1):
    """Switch every contact whose event is the one just stepped to; latch impact speeds.

    Returns whether a contact opened or closed or a user event happened; otherwise a law met a
    corner.
    """
    first = NONE
    for c in range(b.root.size):
        first = min(first, b.root[c])
    for c in range(s.contact.size):
        first = min(first, b.corner_root[c])
    poses(s, r.y)
    corners(s, t1)
    for c in range(s.contact.size):
        if b.corner_root[c] <= first + SAME:
            e = s.contact[c]
            s.mem[e, BRANCH] = s.corner[e, 1]
            pair = Pair(s, e)
            r.stale[pair.i] = r.stale[pair.j] = 1
            r.corners_met += 1
    touched = fire(s, r, b, first) > 0
    h, were_closed = 1e300, closed(s, r)
    for c in range(s.contact.size):
        if b.root[c] > first + SAME:
            continue
        touched = True
        e = s.contact[c]
        r.mem[e, PHASE] = flip(r.mem[e, PHASE])
        r.events += 1
        line = b.events[r.event_rows]
        r.event_rows += 1
        onset = r.mem[e, PHASE] == CONTACT
        line[EVENT_TIME], line[EVENT_ROW] = t1, e
        line[EVENT_WORK] = line[EVENT_IMPULSE] = 0.0
        line[EVENT_KIND] = ONSET if onset else SEPARATION
        line[EVENT_SPEED] = r.gap[c, 1]
        line[EVENT_ANGLE] = np.nan  # a stop has no angle
        o = s.wanted[e] + s.contact_angle[c]
        if s.contact_angle[c] >= 0 and s.wanted[e] >= 0:
            line[EVENT_ANGLE] = np.arctan2(b.out[o + 1], b.out[o])
        if onset:
            own = ContactNumbers(s, c)
            speed = max(r.gap[c, 1], own.slowest_impact)
            r.mem[e, IMPACT_SPEED] = speed
            look(s, c)
            if s.contact_state[c] >= 0:
                r.y[s.n_q + s.n_v + s.contact_state[c]] = 0.0
            speed = max(speed, 1e-12)
            h = min(h, hertz_step(own.stiffness, own.exponent, own.mass, speed, setting.step_error))
        else:
            r.mem[e, IMPACT_SPEED] = 0.0
    are_closed = closed(s, r)
    if were_closed == 0 and are_closed > 0:
        r.free_h = min(r.h, AS_LONG * (t1 - r.free_since))
    r.freed = int(were_closed > 0 and are_closed == 0)
    if r.freed > 0:
        r.free_since = t1
    if touched:
        r.last_event = t1
        r.history, r.jacobian = NO_HISTORY, NO_JACOBIAN
    elif r.jacobian != NO_JACOBIAN:
        r.jacobian = NO_RATES  # the force itself has no jump: a kink in its slope
    evaluate(s, t1, r.y, r.yd)
    corners(s, t1)
    for c in range(s.contact.size):
        # inside its new branch, whatever rounding says
        r.corner[c] = min(s.corner[s.contact[c], 0], -TINY)
    behind(s, r, b, t1)
    if h < 1e300:
        r.h = min(r.h, h)
    if r.freed > 0:  # steps are again as they were before all this
        r.h = max(r.h, r.free_h)
    return touched


@internal
def closed(s, r):
    """How many contacts are closed."""
    many = 0
    for c in range(s.contact.size):
        many += int(r.mem[s.contact[c], PHASE] == CONTACT)
    return many


@internal
def latch(s, r):
    """Methods that locate nothing: remember the approach speed of a running contact."""
    for c in range(s.contact.size):
        e = s.contact[c]
        if r.gap[c, 0] <= 0.0:
            r.mem[e, IMPACT_SPEED] = 0.0
        elif r.mem[e, IMPACT_SPEED] == 0.0:
            r.mem[e, IMPACT_SPEED] = max(r.gap[c, 1], ContactNumbers(s, c).slowest_impact)


@internal
def evaluate_all(s, r, setting, t):
    """What the record holds besides the state, at its state: y', gaps, angles, branches of laws."""
    evaluate(s, t, r.y, r.yd)
    if s.feature.shape[0] > 0:
        call_hold(s.on_features[0], s, t, BY_TIME)
        call_hold(s.on_features[0], s, t, BY_SENSORS)
        keep(s, r)
        for k in range(s.sensed.shape[0]):
            r.sight[k] = s.S[s.sensed[k, 0], 0]
        evaluate(s, t, r.y, r.yd)
    gaps(s, t)
    for c in range(s.contact.size):
        r.gap[c, 0] = s.gap[s.contact[c], 0]
        r.gap[c, 1] = s.gap[s.contact[c], 1]
    watch(s, t, r.gap)
    for k in range(s.n_s):
        r.branch[k], r.turning[k] = s.S[k, 0], s.S[k, 1]
    if setting.locate > 0:
        for c in range(s.contact.size):
            look(s, c)
        evaluate(s, t, r.y, r.yd)
        corners(s, t)
        for c in range(s.contact.size):
            r.corner[c] = s.corner[s.contact[c], 0]


@compiled(void(SCENE, RECORD, BUFFERS, SETTINGS))
def settle(s, r, b, setting):
    """Go on with other equations: nothing that was learnt from the old ones counts any more."""
    evaluate_all(s, r, setting, r.t)
    r.history, r.jacobian = NO_HISTORY, NO_JACOBIAN
    r.stiff, r.not_stiff = 0, 0
    r.past_error, r.factored_h = 0.0, 0.0
    behind(s, r, b, r.t)
