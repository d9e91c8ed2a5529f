"""A trial step made an accepted one: projected, searched for events, its results written.

What is found on the interpolant is made exact; only then the record changes.
"""

from math import sqrt

from trsim.assemble.equations import evaluate, kinetic
from trsim.assemble.outputs import measure
from trsim.elements.contract import FLIGHT, GRAVITY, SCENE, ContactNumbers, Memory, compiled
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import I1
from trsim.kernels.vectors import all_finite, copy_table, copy_to
from trsim.solve.march.accelerations import held
from trsim.solve.march.calls import (
    BEYOND_AT,
    BOOK_AT,
    CORNERS_AT,
    FINISH_AT,
    IMPLICIT_AT,
    INSIDE_AT,
    INTERPOLATE_AT,
    LAND_AT,
    LAST_AT,
    LOOK_AT,
    MEASURE_IN_AT,
    MEET_AT,
    NO_STEP,
    PASSES_AT,
    POLES_AT,
    RATE_AT,
    SAMPLE_AT,
    SEARCH_AT,
    SECTIONS_AT,
    SOFTEN_AT,
    STAGES_AT,
    STEP_AT,
    TURN_AT,
    call_book,
    call_interpolate,
    call_look,
    call_search,
    call_sections,
    call_step,
)
from trsim.solve.march.dense_output import build, measure_inside, move_end, torn_from_rows
from trsim.solve.march.earlier import keep_step
from trsim.solve.march.events import NONE, ROUNDING, SAME
from trsim.solve.march.features import call_meet, next_instant
from trsim.solve.march.land import call_land, limits_to_measure
from trsim.solve.march.norm import RAMPS, grow
from trsim.solve.march.output_rows import at_end, due, rows_until
from trsim.solve.march.passes import call_passes
from trsim.solve.march.peaks import call_finish, call_sample
from trsim.solve.march.phases import change_phases, latch
from trsim.solve.march.record import BEHIND, BUFFERS, RECORD, SETTINGS, SLOPE
from trsim.solve.march.samples import firmness_of_extremes
from trsim.solve.march.sections import BY_CORNER, BY_EVENT, SMOOTHLY
from trsim.solve.march.sensed import UNCERTAIN, call_beyond, call_turn
from trsim.solve.march.turns import BEYOND, BRIEF, beats_in, pulse, too_far, unseen
from trsim.solve.march.unseen import errs_unseen
from trsim.solve.march.watch import heard, take_sides
from trsim.solve.march.works import exchanged

# what `complete` made of a trial step
SMOOTH_STEP, WITH_EVENT, WITH_CORNER, WORTHLESS = range(4)
AT_INSTANT, STRAYED, WOUND, LOOSE, AT_ROW, AT_POLE = range(4, 10)
ORIGIN = 1e-6  # of the weight's potential: what counts though it does not change
SMALLEST = 16.0  # ulp of t: a smaller step is no step
FAR = 100.0  # times the error allowed: what a step that saw its motion does not leave
LONG, LOOKS = 0.1, 3  # of a run: parts that a step without a row inside is looked at in
MOST_LOOKS = 32.0  # in two parts for each rad of a pulse in a load
# what a step is held to at most where branches of the motion meet: limits (beside.py) are known to
# that, and shorter steps would only meet more of what they do not know
OF_LIMITS = 1e-10
LEAK = 0.1  # times the tolerance, of the kinetic energy
THROWN = 1e-3  # of the kinetic energy
FROM_REST = 0.01  # of the kinetic energy at the end of a step
SMALL = 1e-3  # of a step: how far a channel is brought nearer to its value
EXACT = 5  # Newton steps to the end of a step that an event cuts
PRECISE = 1e-6  # of the error allowed: what is left of a gap there
NEARER = 0.5  # of the gap before: what a step of Newton's method leaves at most
SETTLED = 100.0  # times these: what rounding of a step and of the time may leave of a gap
SLIDE = 0.03  # times the root of the tolerance, of a step: what its end may move along its tangent

#                      scene  record  buffers  settings method
COMPLETE = types.int64(SCENE, RECORD, BUFFERS, SETTINGS, I1)
call_complete = caller(COMPLETE)


@compiled(COMPLETE)
def complete(s, r, b, setting, method):
    """Turn a trial step of length b.h (end in b.y1) into an accepted one: project, locate, record.

    b.built: 1 where b.P already holds the dense output.  Returns SMOOTH_STEP, WITH_EVENT (the
    step was cut where a contact opens or closes), WITH_CORNER (where a law changes its branch),
    AT_INSTANT (as long as was planned, to where the time meets a corner of a function) or WORTHLESS
    (values not finite; nothing was changed) or STRAYED (so long that a motion or
    a corner may be passed over, or that the step to an event is not right; the same), or LOOSE
    (what lies inside it is not right, or its estimate saw too little; the same) or AT_ROW (to
    end b.until after its start) or AT_POLE (a function has no value at r.pole_t, within it; the
    same).
    """
    last, h = method[LAST_AT], b.h
    b.t, b.interpolate, b.moved = r.t, method[INTERPOLATE_AT], 0
    b.rate, b.soften, b.restless = method[RATE_AT], method[SOFTEN_AT], 0
    b.land, b.measure_in = method[LAND_AT], method[MEASURE_IN_AT]
    b.t1 = reached(setting, b.t + h)
    worst, worst_rate = r.worst_phi, r.worst_phi_dot
    b.projected = landed(s, r, b, method, b.t1, h)
    if not all_finite(b.y1) or not all_finite(b.K[last]):
        return WORTHLESS
    if restless(b, setting, h):
        return undone(r, worst, worst_rate, STRAYED)
    if unseen_error(s, r, b, setting, method, h):
        return undone(r, worst, worst_rate, LOOSE)
    if s.steep > 0 and strayed(s, r, setting, h):
        return undone(r, worst, worst_rate, STRAYED)
    if s.status[4] > 0 and leaked(s, r, b, setting):
        return undone(r, worst, worst_rate, STRAYED)
    if shorter_may(setting, h) and torn_from_rows(s, r, b, method):
        return undone(r, worst, worst_rate, LOOSE)
    watching = s.section.shape[0] + s.heard.size > 0
    if watching and shorter_may(setting, h) and unseen(s, r, b, last, h):
        return undone(r, worst, worst_rate, STRAYED)
    beat = beats_in(s, r, b) if s.pulse.size > 0 else 0.0
    if beat > BEYOND * pulse(method[IMPLICIT_AT]) and shorter_may(setting, b.h):
        return undone(r, worst, worst_rate, STRAYED)
    if s.wound.size > 0 and too_far(s, r, b, h):
        return undone(r, worst, worst_rate, WOUND)
    event = corner = False
    if method[SEARCH_AT] > 0 or method[CORNERS_AT] > 0:
        theta = other = NONE
        if method[CORNERS_AT] > 0:
            theta = call_search(method[CORNERS_AT], s, r, b, setting, method)
            if theta == UNCERTAIN:
                return undone(r, worst, worst_rate, STRAYED)
        if method[SEARCH_AT] > 0:
            other = call_search(method[SEARCH_AT], s, r, b, setting, method)
        event, corner = sooner(b, theta, other)
        theta = min(theta, other)
        if theta < 1.0:
            shorter, beyond, b.projected = exact(s, r, b, setting, method, theta)
            if shorter < 0.0:
                return undone(r, worst, worst_rate, STRAYED)
            if shorter > 0.0:
                b.h, b.built = shorter, 0
                b.t1 = reached(setting, b.t + b.h + beyond)
            else:
                b.halved = 0  # the middle was that of another step, perhaps behind this end
                call_interpolate(b.interpolate, b.P, r.y, theta, b.y2)
                copy_to(b.y1, b.y2)
                b.t1 = reached(setting, b.t + theta * h)
                b.projected = call_land(b.land, s, r, b, b.t1, b.K[last], 0)
    if method[POLES_AT] > 0 and call_search(method[POLES_AT], s, r, b, setting, method) < NONE:
        return undone(r, worst, worst_rate, AT_POLE if r.pole > 0 else STRAYED)
    t1 = b.t1
    b.firm[1] = firmness_of_extremes(s)
    limits_to_measure(s, t1, b.y1, b.firm[1], b.rough[0])
    measure(s, t1, b.y1, r.work_projection + b.projected, r.energy_0)
    copy_to(b.out, s.out)
    if method[LOOK_AT] > 0 and call_look(method[LOOK_AT], s, r, b, setting, t1, 1) > 0:
        evaluate(s, t1, b.y1, b.K[last])
    inside = due(r, setting, t1) and not at_end(setting.every * r.next_row, t1)
    parts = int(min(2.0 * beat, MOST_LOOKS)) if s.sought.size > 0 else 0
    if t1 - b.t > LONG * setting.t_end:
        parts = max(parts, LOOKS)
    looks = not inside and parts > 1
    if b.built == 0 and (inside or looks or b.halved > 0 or method[IMPLICIT_AT] > 0):
        build(s, r, b, method)
    if inside and loose(s, r, b, setting, method):
        return undone(r, worst, worst_rate, LOOSE)
    if b.halved > 0:
        b.firm[0], b.halved, b.sampled_t = b.firm[2], 0, b.t + 0.5 * b.h
        call_sample(method[SAMPLE_AT], s, r, b, setting, method, b.middle)
    if due(r, setting, t1):
        first = r.rows
        if not rows_until(s, r, b, setting, method):
            return undone(r, worst, worst_rate, AT_ROW) if b.until > 0.0 else WORTHLESS
        for k in range(first, r.rows):
            row = b.rows[k]
            b.firm[0], b.sampled_t = b.row_firm[k], row[0]
            call_sample(method[SAMPLE_AT], s, r, b, setting, method, row[1:])
    if looks:
        for k in range(1, parts):
            at = b.t + k / parts * (t1 - b.t)
            measure_inside(s, r, b, at, (at - b.t) / b.h)
            b.sampled_t = at
            call_sample(method[SAMPLE_AT], s, r, b, setting, method, s.out)
    b.firm[0], b.sampled_t = b.firm[1], t1
    call_sample(method[SAMPLE_AT], s, r, b, setting, method, b.out)
    if event or corner or last_of_its_kind(s, r, b, setting, method):
        call_finish(method[FINISH_AT], s, r, b, setting, method)
    if method[SECTIONS_AT] > 0:
        call_sections(method[SECTIONS_AT], s, r, b, method, how_it_ends(b, event, corner))
    if method[PASSES_AT] > 0 and s.near_rows > 0.0:  # there is a loop still
        call_passes(method[PASSES_AT], s, r, b, last)
    keep_step(r, b, method)
    accept(s, r, b, last)
    take_sides(s, r)
    if method[IMPLICIT_AT] > 0:
        copy_table(r.past, b.P)
        r.past_h, r.history = b.h, BEHIND
        r.jacobian = r.next_jacobian
    if setting.locate == 0:
        latch(s, r)
    outcome = SMOOTH_STEP
    if event:
        outcome = WITH_EVENT if change_phases(s, r, b, setting, t1) else WITH_CORNER
    if method[MEET_AT] > 0:
        copy_to(b.before, r.held)
        met = call_meet(method[MEET_AT], s, r, b, b.t, t1)
        outcome = AT_INSTANT if met > 0 and not event else outcome
        if method[TURN_AT] > 0:
            turned = call_turn(method[TURN_AT], s, r, b, setting, method, met + int(event))
            outcome = WITH_CORNER if turned > 0 and not event else outcome
    return outcome


@internal
def how_it_ends(b, event, corner):
    """An accepted step, for sections: where a law has a corner no contact begins or ends."""
    if not event:
        return BY_CORNER if corner else SMOOTHLY
    first = NONE
    for c in range(b.corner_root.size):
        first = min(first, b.corner_root[c])
    for c in range(b.root.size):
        if b.root[c] <= first + SAME:
            return BY_EVENT
    return BY_CORNER


@internal
def landed(s, r, b, method, t, h):
    """`land` of the end of a step of length h that was just made."""
    done = call_land(b.land, s, r, b, t, b.K[method[LAST_AT]], b.rate)
    if method[BOOK_AT] > 0:
        call_book(method[BOOK_AT], s, r, b, h)
    return done


@internal
def restless(b, setting, h):
    """Whether what is stiff did not come to rest at the end of a step that may be shorter."""
    return b.restless > 0 and shorter_may(setting, h)


@internal
def unseen_error(s, r, b, setting, method, h):
    """Whether a step of DOP853 that may be shorter errs by what its estimate did not see."""
    explicit = method[STAGES_AT] > 0 and shorter_may(setting, h)
    return explicit and errs_unseen(s, r, b, h)


@internal
def strayed(s, r, setting, h):
    """Whether a smooth prescribed motion went on between the stages of a step as none of them saw:
    its end is far from the constraints."""
    if not shorter_may(setting, h):
        return False
    far = FAR * setting.step_error
    fastest = max(r.speed, r.speed_cap, s.size / setting.t_end)
    return r.off > far * s.size or r.off_rate > far * fastest


@internal
def shorter_may(setting, h):
    """Whether a shorter step may be asked for."""
    return setting.fixed_step == 0.0 and h > BRIEF * setting.t_end


@internal
def loose(s, r, b, setting, method):
    """Whether accelerations inside the step are not right, though those at its end are."""
    if method[INSIDE_AT] == 0 or not shorter_may(setting, b.h):
        return False
    return held(s, r, b.h) and call_step(method[INSIDE_AT], s, r, b, setting, b.t, b.h) > 1.0


@internal
def leaked(s, r, b, setting):
    """Whether energy went astray in a step past a place where branches of the motion meet, or the
    projection took or gave much of it, as from one branch to the other."""
    if setting.fixed_step > 0.0:
        return False
    before, after = kinetic(s, r.y), kinetic(s, b.y1)
    if b.h > BRIEF * setting.t_end and abs(b.projected) > THROWN * max(before, after):
        return True
    measure(s, b.t1, b.y1, r.work_projection + b.projected, r.energy_0)
    lost = abs(s.out[s.n_out - 1] - b.out[s.n_out - 1])
    if before < FROM_REST * after:
        return False  # which way it goes from there is not decided by where it stands
    return lost > LEAK * max(setting.step_error, OF_LIMITS) * max(before, after)


@internal
def undone(r, worst, worst_rate, why):
    """`why` a trial step is not accepted; residuals met on it are none of the run."""
    r.worst_phi, r.worst_phi_dot = worst, worst_rate
    return why


@internal
def sooner(b, corner, event):
    """Whether an event, and whether a corner of a function, ends the step; of the later none."""
    if corner > event + SAME:
        for n in range(b.met.shape[0]):
            b.met[n, 0] = NONE
    elif event > corner + SAME:
        for c in range(b.root.size):
            b.root[c] = NONE
        for c in range(b.corner_root.size):
            b.corner_root[c] = NONE
    return event <= min(corner + SAME, 1.0), corner <= min(event + SAME, 1.0)


@internal
def reached(setting, t):
    """t, or the end of the run where no step would be left before it."""
    left = setting.t_end - t
    return t if left > 2.0 * SMALLEST * 2.2e-16 * setting.t_end else setting.t_end


@internal
def exact(s, r, b, setting, method, theta):
    """The step that ends on the event found at theta, for methods with a poor interpolant.

    A gap, what is watched, or u of a corner of a function is brought to zero at its end by Newton's
    method; a corner of friction by secants, where what was found is not good enough.
    Where it ends close to a contact's event it is not made again: its end moves on along its
    tangent, which is off by (late / h)^2 of what changes in it.  Its stages do not: its dense
    output is that of the end before.
    Returns the length of the step, how much further its end is, and the work of the projection
    there; a length of 0 where the interpolant serves: also where Newton's method does not come
    nearer, as where what is watched turns back close to its value; less than 0 where its error is
    more than is allowed, whatever that of the step was that went further: what lies behind the
    event was none of its business, and estimates of one step and the other differ by much.
    """
    if method[STEP_AT] == 0:
        return 0.0, 0.0, 0.0
    t, h, gap_of, last = b.t, b.h, -1, method[LAST_AT]
    for c in range(b.root.size):
        if b.root[c] <= theta:
            gap_of = c
    h1, before = theta * h, 1e300
    close = max(PRECISE * setting.step_error * r.length, ROUNDING * s.size)
    for k in range(EXACT):
        if h1 <= SMALLEST * 2.2e-16 * abs(t) or h1 > h:
            return 0.0, 0.0, 0.0
        error = call_step(method[STEP_AT], s, r, b, setting, t, h1)
        if setting.fixed_step == 0.0 and not error <= 1.0:
            return -1.0, 0.0, 0.0
        if not error < NO_STEP:
            return 0.0, 0.0, 0.0
        projected = landed(s, r, b, method, t + h1, h1)
        if restless(b, setting, h1) or unseen_error(s, r, b, setting, method, h1):
            return -1.0, 0.0, 0.0
        if gap_of < 0:
            ends = on_corner(s, r, b, setting, theta, h1)
            if 0.0 < ends <= h and ends != h1 and k < EXACT - 1:
                h1 = ends
                continue
            if method[BEYOND_AT] == 0:
                return h1, 0.0, projected
            late = call_beyond(method[BEYOND_AT], s, b, t + h1)
            if abs(late) <= SMALLEST * 2.2e-16 * max(abs(t), h1) or k == EXACT - 1:
                return h1, 0.0, projected
            h1 -= late
            continue
        gap, rate = b.gap1[gap_of, 0], b.gap1[gap_of, 1]
        if gap_of >= s.contact.size and heard(s, gap_of - s.contact.size):
            # a channel may be rough: one step of Newton's method, if it is a small one
            rate = r.watch[gap_of - s.contact.size, SLOPE]
            late = gap / rate if rate != 0.0 else 0.0
            if k > 0 or not abs(late) <= SMALL * h1 or h1 - late > h:
                return h1, 0.0, projected
            h1 -= late
            continue
        if abs(gap) <= close:
            return h1, 0.0, projected
        if rate == 0.0 or not abs(gap) < NEARER * before:
            return (h1, 0.0, projected) if abs(gap) <= SETTLED * close else (0.0, 0.0, 0.0)
        late, before = gap / rate, abs(gap)
        near = h1 - late <= h and abs(late) <= SLIDE * sqrt(setting.step_error) * h1
        if near and gap_of < s.contact.size:
            move_end(b, last, late)
            projected += call_land(b.land, s, r, b, t + h1 - late, b.K[last], 0)
            if abs(b.gap1[gap_of, 0]) <= close:
                return h1, -late, projected
            b.moved = 0
        h1 -= late
    return 0.0, 0.0, 0.0


@internal
def on_corner(s, r, b, setting, theta, h):
    """The step that ends on the corner of friction that was found at theta, by the secant through a
    step h; h itself where it is as near as errors of sliding speeds are allowed to be.

    The dense output of a step past the corner may be far off: some stages knew nothing of it.
    """
    for c in range(s.contact.size):
        allowed = RAMPS * setting.step_error * ContactNumbers(s, c).ramp
        if b.corner_root[c] <= theta and allowed > 0.0 and abs(b.corner1[c]) > allowed:
            gone = b.corner1[c] - r.corner[c]
            return h - h * b.corner1[c] / gone if gone > 0.0 else h
    return h


@internal
def last_of_its_kind(s, r, b, setting, method):
    """Whether what follows on this step has other equations, or nothing follows."""
    if b.t1 >= setting.t_end or r.weak > 0:
        return True
    if setting.locate == 0 and s.contact.size > 0:  # `latch` changes them in any step
        return True
    return method[MEET_AT] > 0 and b.t1 >= next_instant(s, b.t, setting.t_end)


@internal
def accept(s, r, b, last):
    """The trial becomes the state; contacts in touch leave a line, peaks are updated."""
    s.status[3] = 0
    stays = b.t1 - r.t <= SMALLEST * 2.2e-16 * b.t1
    r.same_time = r.same_time + 1 if stays else 0
    r.t, r.least_pivot = b.t1, b.firm[1] if s.near_rows > 0.0 else 1.0
    r.work_projection += b.projected
    copy_to(r.y, b.y1)
    copy_to(r.yd, b.K[last])
    copy_table(r.gap, b.gap1)
    copy_to(r.corner, b.corner1)
    copy_to(r.branch, b.branch1)
    copy_to(r.turning, b.turning1)
    r.steps += 1
    for c in range(s.contact.size):
        e = s.contact[c]
        if Memory(r, e).phase != FLIGHT and r.gap[c, 0] > 0.0:
            grow(s, r, c)
            if s.wanted[e] >= 0 and b.steps.shape[1] > 2:
                line = b.steps[r.step_rows]
                line[0], line[1] = b.t1, e
                for k in range(line.size - 2):
                    line[2 + k] = b.out[s.wanted[e] + k] if s.wanted[e] + k < s.n_out else 0.0
                r.step_rows += 1
    if s.column_energy >= 0:
        exchanged(s, r, b)
        for c in range(s.column_energy, s.n_out - 1):
            size = abs(b.out[c])
            if c == s.column_energy + 1 + GRAVITY:  # counted from the origin, wherever that is
                size = max(ORIGIN * size, r.book[1 + GRAVITY, 1] - r.book[1 + GRAVITY, 0])
            r.largest_energy = max(r.largest_energy, size)
        residual = abs(b.out[s.n_out - 1])
        r.largest_residual = max(r.largest_residual, residual)
