"""What changes at a contact event: the phase of the contact, its memory, the next step."""

import numpy as np

from trsim.assemble.equations import corners, evaluate, set_poses
from trsim.assemble.features import call_hold
from trsim.elements.contract import CONTACT, FLIGHT, SCENE, ContactNumbers, Memory, Pair, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import void
from trsim.laws.functions import BY_SENSORS, BY_TIME
from trsim.solve.march.corners import look
from trsim.solve.march.events import NONE, SAME, hertz_step
from trsim.solve.march.features import keep
from trsim.solve.march.record import (
    BUFFERS,
    EVENT_ANGLE,
    NO_HISTORY,
    NO_JACOBIAN,
    NO_RATES,
    ONSET,
    RECORD,
    SEPARATION,
    SETTINGS,
    note_event,
)
from trsim.solve.march.samples import behind
from trsim.solve.march.watch import fire, see

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
    set_poses(s, r.y)
    corners(s, t1)
    for c in range(s.contact.size):
        if b.corner_root[c] <= first + SAME:
            pair = Pair(s, s.contact[c])
            pair.branch = s.corner[s.contact[c], 1]
            r.stale[pair.i] = r.stale[pair.j] = 1
            r.corners_met += 1
    touched = fire(s, r, b, first) > 0
    h, were_closed = 1e300, closed(s, r)
    for c in range(s.contact.size):
        if b.root[c] > first + SAME:
            continue
        touched = True
        e = s.contact[c]
        memory = Memory(r, e)
        onset = memory.phase == FLIGHT
        memory.phase = CONTACT if onset else FLIGHT
        r.events += 1
        note_event(r, b, t1, ONSET if onset else SEPARATION, e, r.gap[c, 1])
        o = s.wanted[e] + s.contact_angle[c]
        if s.contact_angle[c] >= 0 and s.wanted[e] >= 0:
            b.events[r.event_rows - 1, EVENT_ANGLE] = np.arctan2(b.out[o + 1], b.out[o])
        if onset:
            own = ContactNumbers(s, c)
            speed = max(r.gap[c, 1], own.slowest_impact)
            memory.impact_speed = speed
            look(s, c)
            if s.contact_state[c] >= 0:
                for k in range(s.contact_states[c]):
                    r.y[s.n_q + s.n_v + s.contact_state[c] + k] = 0.0
            if s.contact_impact[c] > 0:  # impacts.py decides what follows, and how it begins
                r.struck[c] = 1
                r.fired += 1
                continue
            speed = max(speed, 1e-12)
            h = min(h, hertz_step(own.stiffness, own.exponent, own.mass, speed, setting.step_error))
    are_closed = closed(s, r)
    if were_closed == 0 and are_closed > 0:
        r.free_h = min(r.h, AS_LONG * (t1 - r.free_since))
    r.freed = int(were_closed > 0 and are_closed == 0)
    if r.freed > 0:
        r.free_since = t1
    if touched:
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
        many += int(Memory(r, s.contact[c]).phase == CONTACT)
    return many


@internal
def latch(s, r):
    """Methods that locate nothing: remember the approach speed of a running contact."""
    for c in range(s.contact.size):
        memory = Memory(r, s.contact[c])
        if r.gap[c, 0] <= 0.0:
            memory.impact_speed = 0.0
        elif memory.impact_speed == 0.0:
            memory.impact_speed = max(r.gap[c, 1], ContactNumbers(s, c).slowest_impact)


@internal
def evaluate_all(s, r, setting, t):
    """What the record holds besides the state, at its state: y', gaps, angles, branches of laws."""
    evaluate(s, t, r.y, r.yd)
    for k in range(s.rated.shape[0]):
        s.S[s.rated[k, 0], 1] = 0.0  # how rates change is known behind a step
    if s.feature.shape[0] > 0:
        call_hold(s.on_features[0], s, t, BY_TIME)
        call_hold(s.on_features[0], s, t, BY_SENSORS)
        keep(s, r)
        for k in range(s.sensed.shape[0]):
            r.sight[k] = s.S[s.sensed[k, 0], 0]
        evaluate(s, t, r.y, r.yd)
    see(s, t, r.y, r.gap, r.branch, r.turning)
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
    r.stiff, r.not_stiff, r.fading = 0, 0, 0
    r.past_error, r.factored_h = 0.0, 0.0
    behind(s, r, b, r.t)
