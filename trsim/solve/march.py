"""The only time loop: step, project, look for events, write what was asked for, accept.

Everything the loop changes is in the Record; it returns to its caller when a buffer is full, when
it is done, or when it cannot go on, and can be called again with the same record.
"""

from math import isfinite

from numba import types

from trsim.assemble.equations import corners, evaluate, gaps
from trsim.assemble.outputs import measure
from trsim.elements.calls import caller
from trsim.elements.contract import FLIGHT, PHASE, SCENE, compiled
from trsim.elements.packed import A1, I1, I2, f8, i8
from trsim.elements.vectors import all_finite, clear_table, copy_table, copy_to, internal
from trsim.solve.auto import choose
from trsim.solve.calls import call_dense, call_interpolate, call_step
from trsim.solve.corners import look
from trsim.solve.events import any_suspicious, first_event
from trsim.solve.land import land
from trsim.solve.norm import grow, units, weights
from trsim.solve.peaks import near_peak, peaks_inside, refine
from trsim.solve.phases import change_phases, latch
from trsim.solve.record import (
    AFTER_REJECTION,
    BUFFERS,
    CHATTER,
    DENSE_BUILT,
    DONE,
    ENERGY_0,
    EVENT_ROWS,
    EVERY,
    FIXED_STEP,
    FULL,
    H_MAX,
    HISTORY,
    JACOBIAN,
    LARGEST_ENERGY,
    LARGEST_RESIDUAL,
    LENGTH,
    LOCATE,
    METHOD,
    NEXT_ROW,
    NOT_FINITE,
    OLD,
    OLD_H,
    PAST_ERROR,
    PAST_H,
    PAUSE,
    PEAK_MAX,
    PEAK_MIN,
    PEAK_V2,
    RECORD,
    REJECTED,
    ROWS,
    SAME_TIME,
    STEP_ROWS,
    STEP_TOO_SMALL,
    STEPS,
    T_END,
    TOLERANCE,
    WORK_PROJECTION,
    H,
    T,
)

# what `complete` made of a trial step
SMOOTH_STEP, WITH_EVENT, WITH_CORNER, WORTHLESS = 0, 1, 2, 3
# a row of `methods`: addresses of step, dense output, interpolation and of `complete`, which row
# of K holds the last derivative, the power of h its error estimate falls with, whether implicit
STEP_AT, DENSE_AT, INTERPOLATE_AT, COMPLETE_AT, LAST_AT, ESTIMATE_AT, IMPLICIT_AT = range(7)
MAX_SAME_TIME = 1000  # events without progress: chatter
SMALLEST = 16.0  # ulp of t: a smaller step is no step
EXACT = 5  # Newton steps to the end of a step that an event cuts
PRECISE = 1e-6  # of the error allowed: what is left of a gap there


#                       scene   record  buffers  settings method h built
COMPLETE = types.int64(SCENE, RECORD, BUFFERS, A1, I1, f8, i8)
call_complete = caller(COMPLETE)


def method_table(method):
    """What the march must know of a method, a file of this folder.

    `complete` stands there too: called by its address it is compiled once, not into the march.
    """
    called = (method.step.address(), method.dense.address(), method.interpolate.address())
    return (*called, complete.address(), method.LAST, method.ESTIMATE, int(method.IMPLICIT))


@compiled(types.int64(SCENE, RECORD, BUFFERS, A1, I2, i8))
def march(s, r, b, setting, methods, most):
    """Advance the record until it is done, a buffer is full, or `most` steps were accepted.

    methods: rows as `method_table` makes them; with two, an explicit and an implicit one, the
    march changes between them.  Returns DONE, FULL, PAUSE, STEP_TOO_SMALL, NOT_FINITE or CHATTER.
    """
    accepted = 0
    while r.clock[T] < setting[T_END]:
        if full(s, r, b):
            return FULL
        if accepted >= most:
            return PAUSE
        t, method = r.clock[T], methods[r.count[METHOD]]
        h = next_step(r, b, setting)
        if h < SMALLEST * 2.2e-16 * max(abs(t), setting[T_END] * 1e-3):
            return NOT_FINITE if r.count[AFTER_REJECTION] == 2 else STEP_TOO_SMALL
        weights(s, r, b, setting)
        copy_to(b.K[0], r.yd)
        for c in range(s.contact.size):
            s.left[s.contact[c]] = -1.0
        error = call_step(method[STEP_AT], s, r, b, setting, t, h)
        if not (error <= 1.0):
            r.count[REJECTED] += 1
            r.count[AFTER_REJECTION] = 1 if isfinite(error) else 2
            if setting[FIXED_STEP] > 0.0:
                return NOT_FINITE
            shorter = max(0.2, 0.9 * error ** (-1.0 / method[ESTIMATE_AT]))
            r.clock[H] = h * (shorter if isfinite(error) else 0.1)
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
        control(r, setting, method, h, error, outcome != SMOOTH_STEP)
        if methods.shape[0] > 1:
            choose(s, r, b, h, outcome == WITH_EVENT)
        if r.count[SAME_TIME] > MAX_SAME_TIME:
            return CHATTER
    return DONE


@compiled(COMPLETE)
def complete(s, r, b, setting, method, h, built):
    """Turn a trial step of size h (end in b.y1) into an accepted one: project, locate, record.

    built: not 0 where b.P already holds the dense output.  Returns SMOOTH_STEP, WITH_EVENT (the
    step was cut where a contact opens or closes), WITH_CORNER (where a law changes its branch) or
    WORTHLESS (values not finite; nothing was changed).
    """
    last, t = method[LAST_AT], r.clock[T]
    t1 = setting[T_END] if t + h >= setting[T_END] else t + h
    projected = land(s, r, b, t1, b.y1, b.K[last])
    if not all_finite(b.y1) or not all_finite(b.K[last]):
        return WORTHLESS
    event = False
    if setting[LOCATE] > 0.0 and any_suspicious(s, r, b, h):
        if built == 0:
            build(s, r, b, method, t, h)
            built = 1
        theta = first_event(s, r, b, t, h, method[INTERPOLATE_AT])
        event = theta <= 1.0
        if event and theta < 1.0:
            shorter = exact(s, r, b, setting, method, t, h, theta)
            if shorter > 0.0:
                h, built = shorter, 0
                t1 = t + h
            else:
                call_interpolate(method[INTERPOLATE_AT], b.P, r.y, theta, b.y2)
                copy_to(b.y1, b.y2)
                t1 = t + theta * h
            projected = land(s, r, b, t1, b.y1, b.K[last])
        else:
            # the search left other poses in the workspace
            evaluate(s, t1, b.y1, b.K[last])
    measure(s, t1, b.y1, r.clock[WORK_PROJECTION] + projected, r.clock[ENERGY_0])
    copy_to(b.out, s.out)
    near = near_peak(s, r, b, t1, t1 - t, last)
    inside = due(r, setting, t1) and setting[EVERY] * r.count[NEXT_ROW] < t1
    if built == 0 and (near or inside or method[IMPLICIT_AT] > 0):
        build(s, r, b, method, t, h)
    if near or due(r, setting, t1):
        if not rows_until(s, r, b, setting, method[INTERPOLATE_AT], t, h, t1, projected):
            return WORTHLESS
        if near:
            peaks_inside(s, r, b, method[INTERPOLATE_AT], t, h, t1)
    accept(s, r, b, t1, projected, last)
    if method[IMPLICIT_AT] > 0:
        for k in range(r.past.shape[0]):
            copy_to(r.past[k], b.P[k])
        r.clock[PAST_H], r.count[HISTORY] = h, 1
    if event:
        return WITH_EVENT if change_phases(s, r, b, setting, t1) else WITH_CORNER
    if setting[LOCATE] == 0.0:
        latch(s, r)
    return SMOOTH_STEP


@internal
def build(s, r, b, method, t, h):
    """The dense output of the step, into b.P."""
    call_dense(method[DENSE_AT], s, b.K, t, r.y, h, b.y1, b.P)
    r.count[DENSE_BUILT] += 1


@internal
def exact(s, r, b, setting, method, t, h, theta):
    """The step that ends on the event found at theta, for methods with a poor interpolant.

    A gap at its end is brought to zero by Newton's method; a corner is good enough as found.
    Returns its length, its end in b.y1; 0 where the interpolant serves.
    """
    if method[STEP_AT] == 0:
        return 0.0
    gap_of = -1
    for c in range(s.contact.size):
        if b.root[c] <= theta:
            gap_of = c
    h1 = theta * h
    for _ in range(EXACT):
        if h1 <= SMALLEST * 2.2e-16 * abs(t) or h1 > h:
            return 0.0
        error = call_step(method[STEP_AT], s, r, b, setting, t, h1)
        if not isfinite(error):
            return 0.0
        if gap_of < 0:
            break
        land(s, r, b, t + h1, b.y1, b.K[method[LAST_AT]])
        gap, rate = b.gap1[gap_of, 0], b.gap1[gap_of, 1]
        if abs(gap) <= PRECISE * setting[TOLERANCE] * r.clock[LENGTH] or rate == 0.0:
            break
        h1 -= gap / rate
    return h1


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
    copy_to(r.corner, b.corner1)
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
def control(r, setting, method, h, error, event):
    """The next step from the error of this one."""
    if setting[FIXED_STEP] > 0.0:
        return
    power = 1.0 / method[ESTIMATE_AT]
    factor = 6.0 if error < 1e-8 else min(6.0, max(0.3, 0.9 * error**-power))
    if method[IMPLICIT_AT] > 0:
        # predictive: the error as it changed from the step before              [Gustafsson1994]
        past = max(r.clock[PAST_ERROR], 1e-2)
        if r.clock[PAST_ERROR] > 0.0 and not event:
            factor = min(factor, 0.9 * h / r.clock[OLD_H] * (past / error**2) ** power)
            factor = max(factor, 0.2)
        r.clock[PAST_ERROR], r.clock[OLD_H] = (0.0 if event else error), h
        if 1.0 <= factor <= 1.2 and r.count[JACOBIAN] == OLD:
            factor = 1.0  # its factors stay good
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
def begin(s, r, b, setting):
    """First row, energy and gaps of a record whose y and mem were just set."""
    evaluate(s, 0.0, r.y, r.yd)
    gaps(s, 0.0)
    for c in range(s.contact.size):
        r.gap[c, 0] = s.gap[s.contact[c], 0]
        r.gap[c, 1] = s.gap[s.contact[c], 1]
    for k in range(s.n_s):
        r.branch[k] = s.S[k, 0]
    if setting[LOCATE] > 0.0:
        for c in range(s.contact.size):
            look(s, c)
        evaluate(s, 0.0, r.y, r.yd)
        corners(s, 0.0)
        for c in range(s.contact.size):
            r.corner[c] = s.corner[s.contact[c], 0]
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
