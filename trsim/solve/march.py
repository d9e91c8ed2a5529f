"""The only time loop: step, project, look for events, write what was asked for, accept.

Everything the loop changes is in the Record; it returns to its caller when a buffer is full, when
it is done, or when it cannot go on, and can be called again with the same record.
"""

from math import isfinite

import numpy as np
from numba import types

from trsim.assemble.equations import (
    call_all,
    evaluate,
    gaps,
    kinetic,
    normalise,
    poses,
    project_positions,
    project_velocities,
)
from trsim.assemble.outputs import measure
from trsim.elements.calls import caller
from trsim.elements.contract import CONTACT, FLIGHT, IMPACT_SPEED, PHASE, SCENE, compiled
from trsim.elements.packed import A1, I1, f8, i8
from trsim.elements.scene import ANGLE, MAGNITUDE, PROJECTION, RATE
from trsim.elements.scene import LENGTH as LENGTH_SCALE
from trsim.elements.scene import SPEED as SPEED_SCALE
from trsim.elements.vectors import all_finite, clear_table, copy_table, copy_to, internal
from trsim.solve.calls import call_dense, call_interpolate, call_step
from trsim.solve.events import NONE as NO_EVENT
from trsim.solve.events import SAME, any_suspicious, first_event, flip, hertz_step
from trsim.solve.record import (
    AFTER_REJECTION,
    BUFFERS,
    CHATTER,
    DENSE_BUILT,
    DONE,
    ENERGY_0,
    EVENT_ANGLE,
    EVENT_KIND,
    EVENT_ROW,
    EVENT_ROWS,
    EVENT_SPEED,
    EVENT_TIME,
    EVENTS,
    EVERY,
    FIXED_STEP,
    FULL,
    H_MAX,
    LARGEST_ENERGY,
    LARGEST_RESIDUAL,
    LAST_EVENT,
    LENGTH,
    LOCATE,
    NEXT_ROW,
    NOT_FINITE,
    ONSET,
    PAUSE,
    PEAK_MAX,
    PEAK_MAX_T,
    PEAK_MIN,
    PEAK_MIN_T,
    PEAK_T1,
    PEAK_T2,
    PEAK_V1,
    PEAK_V2,
    RECORD,
    REJECTED,
    ROWS,
    SAME_TIME,
    SEPARATION,
    SPEED,
    STEP_ROWS,
    STEP_TOO_SMALL,
    STEPS,
    T_END,
    TOLERANCE,
    WORK_PROJECTION,
    WORST_PHI,
    WORST_PHI_DOT,
    H,
    T,
)

SMOOTH_STEP, WITH_EVENT, WORTHLESS = 0, 1, 2  # what `complete` made of a trial step
LAST_AT, COMPLETE_AT = 3, 4  # in `method`, after the addresses of step, dense, interpolate
MAX_SAME_TIME = 1000  # events without progress: chatter
SMOOTH = 0.05  # of a channel's value: three points closer than this carry a parabola
NEAR = 0.5  # of the largest contact force so far: a maximum above this is searched for
INSIDE = 16  # parts a searched step is cut into
BISECTIONS = 16  # of a step, to the maximum of a contact force: flat there, so this is plenty
AHEAD = 1e-4  # of a step: how far the rate of a contact force looks
SMALLEST = 16.0  # ulp of t: a smaller step is no step
PHI_SMALL = 1e-10  # of the mechanism's size: the next Newton step would be below rounding


#                       scene   record  buffers  settings method h built
COMPLETE = types.int64(SCENE, RECORD, BUFFERS, A1, I1, f8, i8)
call_complete = caller(COMPLETE)


def method_table(step, dense, interpolate, last):
    """What the march must know of a method: addresses of its functions, the last row of its K.

    `complete` stands there too: called by its address it is compiled once, not into the march.
    """
    return np.array([step, dense, interpolate, last, complete.address()], np.int64)


@compiled(types.int64(SCENE, RECORD, BUFFERS, A1, I1, i8))
def march(s, r, b, setting, method, most):
    """Advance the record until it is done, a buffer is full, or `most` steps were accepted.

    method: see `method_table`.  Returns DONE, FULL, PAUSE, STEP_TOO_SMALL, NOT_FINITE or CHATTER.
    """
    accepted = 0
    while r.clock[T] < setting[T_END]:
        if full(s, r, b):
            return FULL
        if accepted >= most:
            return PAUSE
        t = r.clock[T]
        h = next_step(r, b, setting)
        if h < SMALLEST * 2.2e-16 * max(abs(t), setting[T_END] * 1e-3):
            return NOT_FINITE if r.count[AFTER_REJECTION] == 2 else STEP_TOO_SMALL
        weights(s, r, b, setting)
        copy_to(b.K[0], r.yd)
        error = call_step(method[0], s, b.K, t, r.y, h, b.y1, b.weight)
        if not (error <= 1.0):
            r.count[REJECTED] += 1
            r.count[AFTER_REJECTION] = 1 if isfinite(error) else 2
            if setting[FIXED_STEP] > 0.0:
                return NOT_FINITE
            r.clock[H] = h * (max(0.2, 0.9 * error ** (-1 / 8)) if isfinite(error) else 0.1)
            continue
        outcome = call_complete(method[COMPLETE_AT], s, r, b, setting, method, h, 0)
        if outcome == WORTHLESS:
            if setting[FIXED_STEP] > 0.0:
                return NOT_FINITE
            r.count[REJECTED] += 1
            r.count[AFTER_REJECTION] = 2
            r.clock[H] = 0.1 * h
            continue
        accepted += 1
        control(r, setting, h, error, outcome == WITH_EVENT)
        if r.count[SAME_TIME] > MAX_SAME_TIME:
            return CHATTER
    return DONE


@compiled(COMPLETE)
def complete(s, r, b, setting, method, h, built):
    """Turn a trial step of size h (end in b.y1) into an accepted one: project, locate, record.

    built: not 0 where b.P already holds the dense output.  Returns SMOOTH_STEP, WITH_EVENT (the
    step was cut at a contact event) or WORTHLESS (values not finite; nothing was changed).
    """
    last, t = method[LAST_AT], r.clock[T]
    t1 = setting[T_END] if t + h >= setting[T_END] else t + h
    projected = land(s, r, b, t1, b.y1, b.K[last])
    if not all_finite(b.y1) or not all_finite(b.K[last]):
        return WORTHLESS
    event = False
    if setting[LOCATE] > 0.0 and any_suspicious(s, r, b, h):
        if built == 0:
            call_dense(method[1], s, b.K, t, r.y, h, b.y1, b.P)
            r.count[DENSE_BUILT] += 1
            built = 1
        theta = first_event(s, r, b, t, h, method[2])
        event = theta <= 1.0
        if event and theta < 1.0:
            call_interpolate(method[2], b.P, r.y, theta, b.y2)
            copy_to(b.y1, b.y2)
            t1 = t + theta * h
            projected = land(s, r, b, t1, b.y1, b.K[last])
        else:
            # the search left other poses in the workspace
            evaluate(s, t1, b.y1, b.K[last])
    measure(s, t1, b.y1, r.clock[WORK_PROJECTION] + projected, r.clock[ENERGY_0])
    copy_to(b.out, s.out)
    near = near_peak(s, r, b, t1, t1 - t, last)
    if near or due(r, setting, t1):
        if built == 0 and (near or setting[EVERY] * r.count[NEXT_ROW] < t1):
            call_dense(method[1], s, b.K, t, r.y, h, b.y1, b.P)
            r.count[DENSE_BUILT] += 1
        if not rows_until(s, r, b, setting, method[2], t, h, t1, projected):
            return WORTHLESS
        if near:
            peaks_inside(s, r, b, method[2], t, h, t1)
    accept(s, r, b, t1, projected, last)
    if event:
        change_phases(s, r, b, setting, t, t1)
    elif setting[LOCATE] == 0.0:
        latch(s, r)
    return WITH_EVENT if event else SMOOTH_STEP


@internal
def full(s, r, b):
    """Hardly room for what the next step may add."""
    contacts = s.contact.size
    return (
        r.count[ROWS] > b.rows.shape[0] // 2
        or r.count[STEP_ROWS] + contacts >= b.steps.shape[0]
        or r.count[EVENT_ROWS] + contacts >= b.events.shape[0]
    )


@internal
def next_step(r, b, setting):
    """The step to try: as controlled, not beyond the end, the last two evened out.

    It never spans more output times than the buffer has room for.
    """
    left = setting[T_END] - r.clock[T]
    h = min(r.clock[H], setting[H_MAX], (b.rows.shape[0] // 2 - 2) * setting[EVERY])
    if setting[FIXED_STEP] > 0.0:
        return left if left < setting[FIXED_STEP] * (1.0 + 1e-9) else setting[FIXED_STEP]
    if h >= left * (1.0 - 1e-12):
        return left
    return 0.5 * left if 2.0 * h > left else h


@internal
def weights(s, r, b, setting):
    """1 / (tolerance times unit) of every entry of y; zero outside the norm.

    Lengths are weighed by the smallest gap or penetration that matters, not by the distance from
    the origin; rotations by that length over the body's arm; velocities by the matching speed.
    """
    length, speed, tolerance = r.clock[LENGTH], r.clock[SPEED], setting[TOLERANCE]
    for c in range(b.weight.size):
        kind, scale = s.scale_kind[c], s.scale[c]
        if kind == LENGTH_SCALE:
            b.weight[c] = 1.0 / (tolerance * length)
        elif kind == ANGLE:
            b.weight[c] = scale / (tolerance * length)
        elif kind == SPEED_SCALE:
            b.weight[c] = 1.0 / (tolerance * speed)
        elif kind == RATE:
            b.weight[c] = scale / (tolerance * speed)
        elif kind == MAGNITUDE:
            b.weight[c] = 1.0 / (tolerance * scale)
        else:
            b.weight[c] = 0.0


@internal
def land(s, r, b, t, y, yd):
    """Bring y to the constraints and evaluate y' there; gaps into b.gap1.

    Returns the work done by the projection (J): the change of kinetic energy, and minus the work
    of the applied forces on the small displacement.
    """
    done = 0.0
    normalise(s, y)
    if s.stabilisation == PROJECTION and s.m > 0:
        for k in range(s.n_q):
            b.y2[k] = y[k]
        for k in range(8):
            worst = project_positions(s, t, y)
            if k == 0:
                r.clock[WORST_PHI] = max(r.clock[WORST_PHI], worst)
            if not worst > PHI_SMALL * s.size:
                break
        T0 = kinetic(s, y)
        poses(s, y)
        worst = project_velocities(s, y)
        r.clock[WORST_PHI_DOT] = max(r.clock[WORST_PHI_DOT], worst)
        done += kinetic(s, y) - T0
    evaluate(s, t, y, yd)
    if s.stabilisation == PROJECTION and s.m > 0:
        done += position_work(s, b.y2, y)
    if s.contact.size > 0:
        gaps(s, t)
        for c in range(s.contact.size):
            b.gap1[c, 0] = s.gap[s.contact[c], 0]
            b.gap1[c, 1] = s.gap[s.contact[c], 1]
    for k in range(s.n_s):
        b.branch1[k] = s.S[k, 0]
    return done


@internal
def position_work(s, before, after):
    """- F . dx of the displacement from one q to another, with the forces of the second, J."""
    work, F, X = 0.0, s.F, s.X
    for f in range(1, s.n):
        if s.d == 3:
            q = 3 * (f - 1)
            work -= F[f, 0] * (after[q] - before[q]) + F[f, 1] * (after[q + 1] - before[q + 1])
            work -= F[f, 5] * (after[q + 2] - before[q + 2])
            continue
        q = 7 * (f - 1)
        e0, e1, e2, e3 = after[q + 3], after[q + 4], after[q + 5], after[q + 6]
        d0, d1 = e0 - before[q + 3], e1 - before[q + 4]
        d2, d3 = e2 - before[q + 5], e3 - before[q + 6]
        # small rotation in body axes: 2 conj(p) o dp
        o0 = 2.0 * (e0 * d1 - e1 * d0 - e2 * d3 + e3 * d2)
        o1 = 2.0 * (e0 * d2 - e2 * d0 - e3 * d1 + e1 * d3)
        o2 = 2.0 * (e0 * d3 - e3 * d0 - e1 * d2 + e2 * d1)
        for c in range(3):
            turn = X[f, 3 + 3 * c] * o0 + X[f, 4 + 3 * c] * o1 + X[f, 5 + 3 * c] * o2
            work -= F[f, c] * (after[q + c] - before[q + c]) + F[f, 3 + c] * turn
    return work


@internal
def due(r, setting, t1):
    """Whether an output time lies at or before t1."""
    return setting[EVERY] * r.count[NEXT_ROW] <= t1 * (1.0 + 1e-15)


@internal
def rows_until(s, r, b, setting, interpolate, t, h, t1, projected):
    """Write the output rows of (t, t1]; the one at the end of the step is in b.out.

    Returns False, and writes none of them, where a value is not finite.
    """
    rows, next_row = r.count[ROWS], r.count[NEXT_ROW]
    while r.count[ROWS] < b.rows.shape[0]:
        t_o = setting[EVERY] * r.count[NEXT_ROW]
        if t_o > t1 * (1.0 + 1e-15):
            break
        row = b.rows[r.count[ROWS]]
        row[0] = t_o
        if abs(t_o - (t + h)) <= 1e-15 * abs(t_o) and t1 >= t + h:
            copy_to(row[1:], b.out)
        else:
            theta = (t_o - t) / h
            call_interpolate(interpolate, b.P, r.y, theta, b.y2)
            evaluate(s, t_o, b.y2, b.K[1])
            done = r.clock[WORK_PROJECTION] + theta * projected
            measure(s, t_o, b.y2, done, r.clock[ENERGY_0])
            copy_to(row[1:], s.out)
        if not all_finite(row):
            r.count[ROWS], r.count[NEXT_ROW] = rows, next_row
            return False
        r.count[ROWS] += 1
        r.count[NEXT_ROW] += 1
    return True


@internal
def accept(s, r, b, t1, projected, last):
    """The trial becomes the state; contacts in touch leave a line, peaks are updated."""
    r.count[SAME_TIME] = r.count[SAME_TIME] + 1 if t1 <= r.clock[T] else 0
    r.clock[T] = t1
    r.clock[WORK_PROJECTION] += projected
    copy_to(r.y, b.y1)
    copy_to(r.yd, b.K[last])
    copy_table(r.gap, b.gap1)
    copy_to(r.branch, b.branch1)
    r.count[STEPS] += 1
    for c in range(s.contact.size):
        e = s.contact[c]
        if r.mem[e, PHASE] != FLIGHT and r.gap[c, 0] > 0.0:
            grow(s, r, c)
            if s.wanted[e] >= 0 and b.steps.shape[1] > 2:
                line = b.steps[r.count[STEP_ROWS]]
                line[0], line[1] = t1, e
                for k in range(line.size - 2):
                    line[2 + k] = b.out[s.wanted[e] + k] if s.wanted[e] + k < s.n_out else 0.0
                r.count[STEP_ROWS] += 1
    if s.column_energy >= 0:
        for c in range(s.column_energy, s.n_out - 1):
            r.clock[LARGEST_ENERGY] = max(r.clock[LARGEST_ENERGY], abs(b.out[c]))
        residual = abs(b.out[s.n_out - 1])
        r.clock[LARGEST_RESIDUAL] = max(r.clock[LARGEST_RESIDUAL], residual)
    refine(s, r, b.out, t1)
    copy_to(r.slope, b.slope1)


@internal
def refine(s, r, values, t):
    """Take the channels at t into their extremes.

    A local extremum between the last three points, if they lie close together, is refined by the
    parabola through them.
    """
    for c in range(s.n_out):
        p, v2 = r.peak[c], values[c]
        t0, v0, t1, v1 = p[PEAK_T1], p[PEAK_V1], p[PEAK_T2], p[PEAK_V2]
        extreme(p, t, v2)
        turns = t0 < t1 < t and (v1 - v0) * (v2 - v1) < 0.0
        if turns and abs(v1 - v0) + abs(v2 - v1) < SMOOTH * abs(v1):
            slope = (v1 - v0) / (t1 - t0)
            bend = ((v2 - v1) / (t - t1) - slope) / (t - t0)
            turn = 0.5 * (t0 + t1) - 0.5 * slope / bend
            value = v0 + (turn - t0) * (slope + bend * (turn - t1))
            # a kink between unevenly spaced points is no parabola
            if abs(value - v1) < 0.25 * max(abs(v1 - v0), abs(v2 - v1)):
                extreme(p, turn, value)
        p[PEAK_T1], p[PEAK_V1], p[PEAK_T2], p[PEAK_V2] = t1, v1, t, v2


@internal
def extreme(p, t, value):
    """Take a value into a channel's extremes."""
    if value > p[PEAK_MAX]:
        p[PEAK_MAX], p[PEAK_MAX_T] = value, t
    if value < p[PEAK_MIN]:
        p[PEAK_MIN], p[PEAK_MIN_T] = value, t


@internal
def force_rate(s, y, yd, t, ahead, c):
    """Rate of contact c's force at (t, y), by its channel a little before and after along y'.

    y is moved and moved back.
    """
    o = s.wanted[s.contact[c]]
    for k in range(y.size):
        y[k] -= ahead * yd[k]
    poses(s, y)
    call_all(s, s.measure, t - ahead)
    before = s.out[o]
    for k in range(y.size):
        y[k] += 2.0 * ahead * yd[k]
    poses(s, y)
    call_all(s, s.measure, t + ahead)
    for k in range(y.size):
        y[k] -= ahead * yd[k]
    return (s.out[o] - before) / (2.0 * ahead)


@internal
def near_peak(s, r, b, t, h, last):
    """Whether a contact force passes a maximum, one of its largest, inside the step just made.

    Fills b.slope1 with the rate of every contact force at the end of the step.
    """
    near = False
    for c in range(s.contact.size):
        b.slope1[c] = 0.0
        o = s.wanted[s.contact[c]]
        if s.mem[s.contact[c], PHASE] == FLIGHT or o < 0:
            continue
        copy_to(b.y2, b.y1)
        b.slope1[c] = force_rate(s, b.y2, b.K[last], t, AHEAD * h, c)
        near = near or passes(s, r, b, c)
    return near


@internal
def passes(s, r, b, c):
    """Whether the force of contact c has a maximum worth finding between the step's ends."""
    o = s.wanted[s.contact[c]]
    if o < 0 or not (r.slope[c] > 0.0 and b.slope1[c] < 0.0):
        return False
    return max(b.out[o], r.peak[o, PEAK_V2]) > NEAR * r.peak[o, PEAK_MAX]


@internal
def peaks_inside(s, r, b, interpolate, t, h, t1):
    """Extremes of all channels inside the step, from its dense output.

    The step is cut into parts, whose tops are refined by parabolas; and the maximum of every
    contact force is found as the root of its rate.
    """
    reach = (t1 - t) / h
    for c in range(s.contact.size):
        if s.mem[s.contact[c], PHASE] == FLIGHT or not passes(s, r, b, c):
            continue
        low, high = 0.0, reach
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            values_inside(s, r, b, interpolate, t, h, middle)
            if force_rate(s, b.y2, b.K[1], t + middle * h, AHEAD * h, c) > 0.0:
                low = middle
            else:
                high = middle
        values_inside(s, r, b, interpolate, t, h, low)
        for o in range(s.n_out):
            extreme(r.peak[o], t + low * h, s.out[o])
    for k in range(1, INSIDE):
        values_inside(s, r, b, interpolate, t, h, reach * k / INSIDE)
        refine(s, r, s.out, t + reach * k / INSIDE * h)


@internal
def values_inside(s, r, b, interpolate, t, h, theta):
    """All channels at t + theta h into s.out; the state in b.y2, its derivative in b.K[1]."""
    call_interpolate(interpolate, b.P, r.y, theta, b.y2)
    evaluate(s, t + theta * h, b.y2, b.K[1])
    measure(s, t + theta * h, b.y2, r.clock[WORK_PROJECTION], r.clock[ENERGY_0])


@internal
def grow(s, r, c):
    """Let the unit of the error norm follow the deepest penetration met."""
    depth = r.gap[c, 0]
    if depth > r.impact[c]:
        r.impact[c] = depth
        units(s, r)


@internal
def units(s, r):
    """Length and speed of the error norm from the penetrations met so far."""
    length, speed = 1e300, 1e300
    for c in range(s.contact.size):
        K, n, mass = s.contact_par[c, 0], s.contact_par[c, 1], s.contact_par[c, 2]
        depth = min(r.impact[c], s.contact_par[c, 3])
        if depth <= 0.0:
            continue
        length = min(length, depth)
        # the frequency of the contact at that depth turns the length into a speed
        speed = min(speed, depth * np.sqrt(n * K * depth ** (n - 1.0) / mass))
    if length < 1e300:
        r.clock[LENGTH], r.clock[SPEED] = length, speed


@internal
def change_phases(s, r, b, setting, t, t1):
    """Switch every contact whose event is the one just stepped to; latch impact speeds."""
    first = NO_EVENT
    for c in range(s.contact.size):
        first = min(first, b.root[c])
    h = 1e300
    for c in range(s.contact.size):
        if b.root[c] > first + SAME:
            continue
        e = s.contact[c]
        r.mem[e, PHASE] = flip(r.mem[e, PHASE])
        r.count[EVENTS] += 1
        line = b.events[r.count[EVENT_ROWS]]
        r.count[EVENT_ROWS] += 1
        onset = r.mem[e, PHASE] == CONTACT
        line[EVENT_TIME], line[EVENT_ROW] = t1, e
        line[EVENT_KIND] = ONSET if onset else SEPARATION
        line[EVENT_SPEED] = r.gap[c, 1]
        line[EVENT_ANGLE] = 0.0
        if onset:
            speed = max(r.gap[c, 1], s.contact_par[c, 4])
            r.mem[e, IMPACT_SPEED] = speed
            if s.contact_state[c] >= 0:
                r.y[s.n_q + s.n_v + s.contact_state[c]] = 0.0
            speed = max(speed, 1e-12)
            h = min(h, hertz_step(s.contact_par[c, 0], s.contact_par[c, 1], s.contact_par[c, 2],
                                  speed, setting[TOLERANCE]))  # fmt: skip
        else:
            r.mem[e, IMPACT_SPEED] = 0.0
    r.clock[LAST_EVENT] = t1
    evaluate(s, t1, r.y, r.yd)
    for k in range(s.n_out):
        r.peak[k, PEAK_T1] = t1  # no parabola across an event
    for c in range(s.contact.size):
        if s.mem[s.contact[c], PHASE] == FLIGHT:
            r.slope[c] = 0.0
        elif b.root[c] <= first + SAME:
            r.slope[c] = 1.0  # a touch: the force grows from here
    if h < 1e300:
        r.clock[H] = min(r.clock[H], h)


@internal
def latch(s, r):
    """Methods that locate nothing: remember the approach speed of a running contact."""
    for c in range(s.contact.size):
        e = s.contact[c]
        if r.gap[c, 0] <= 0.0:
            r.mem[e, IMPACT_SPEED] = 0.0
        elif r.mem[e, IMPACT_SPEED] == 0.0:
            r.mem[e, IMPACT_SPEED] = max(r.gap[c, 1], s.contact_par[c, 4])


@internal
def control(r, setting, h, error, event):
    """The next step from the error of this one."""
    if setting[FIXED_STEP] > 0.0:
        return
    factor = 6.0 if error < 1e-8 else min(6.0, max(0.3, 0.9 * error ** (-1 / 8)))
    if r.count[AFTER_REJECTION] > 0:
        factor = min(factor, 1.0)
    r.count[AFTER_REJECTION] = 0
    if event:
        # change_phases may have set a shorter first step after a touch
        r.clock[H] = min(r.clock[H], h * factor)
    elif h >= r.clock[H] or factor < 1.0:
        r.clock[H] = h * factor
    else:
        r.clock[H] = max(r.clock[H], h * factor)


@compiled(types.void(SCENE, RECORD, BUFFERS, A1))
def weigh(s, r, b, setting):
    """`weights`, for solvers outside."""
    weights(s, r, b, setting)


@compiled(types.void(SCENE, RECORD, BUFFERS, A1))
def begin(s, r, b, setting):
    """First row, energy and gaps of a record whose y and mem were just set."""
    evaluate(s, 0.0, r.y, r.yd)
    gaps(s, 0.0)
    for c in range(s.contact.size):
        r.gap[c, 0] = s.gap[s.contact[c], 0]
        r.gap[c, 1] = s.gap[s.contact[c], 1]
    for k in range(s.n_s):
        r.branch[k] = s.S[k, 0]
    units(s, r)
    measure(s, 0.0, r.y, 0.0, 0.0)
    copy_to(b.out, s.out)
    r.clock[ENERGY_0] = b.out[s.n_out - 1]
    b.out[s.n_out - 1] = 0.0
    b.rows[0, 0] = 0.0
    copy_to(b.rows[0, 1:], b.out)
    r.count[ROWS] = 1
    r.count[NEXT_ROW] = 1
    clear_table(r.peak)
    for c in range(s.n_out):
        r.peak[c, PEAK_MAX] = b.out[c]
        r.peak[c, PEAK_MIN] = b.out[c]
        r.peak[c, PEAK_V2] = b.out[c]
