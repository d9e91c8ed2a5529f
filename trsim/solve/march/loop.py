"""The only time loop: step, accept (complete.py), choose the next step and its method.

Everything the loop changes is in the Record; it returns to its caller when a buffer is full, when
it is done, or when it cannot go on, and can be called again with the same record.
"""

from math import isfinite

from trsim.assemble.outputs import measure
from trsim.elements.contract import SCENE, compiled
from trsim.kernels import signatures as types
from trsim.kernels.lazy import internal
from trsim.kernels.packed import I2, i8
from trsim.kernels.vectors import clear_table, copy_to
from trsim.solve.march.accelerations import blurred, largest
from trsim.solve.march.calls import (
    COMPLETE_AT,
    ESTIMATE_AT,
    FINISH_AT,
    IMPLICIT_AT,
    NO_STEP,
    ROUNDING_AT,
    STAGES_AT,
    STEP_AT,
    STIFF_AT,
    call_step,
    method_row,
)
from trsim.solve.march.complete import (
    AT_POLE,
    AT_ROW,
    LOOSE,
    OF_LIMITS,
    SMALLEST,
    STRAYED,
    WITH_CORNER,
    WITH_EVENT,
    WORTHLESS,
    WOUND,
    call_complete,
    complete,
)
from trsim.solve.march.corners import begin_sliding
from trsim.solve.march.dense_output import measure_in
from trsim.solve.march.features import next_instant
from trsim.solve.march.land import land, limits_to_measure
from trsim.solve.march.norm import units, weights
from trsim.solve.march.peaks import between, call_finish, finish, sample
from trsim.solve.march.phases import evaluate_all
from trsim.solve.march.record import (
    ACT,
    ADRIFT,
    BUFFERS,
    CHATTER,
    CRAWL,
    CRAWLED_MOST,
    CRAWLING,
    DIVERGED,
    DONE,
    FASTEST,
    FULL,
    LEAPT,
    LOAD,
    MOST_BLOWS,
    NOT_FINITE,
    OLD,
    OPEN,
    PAUSE,
    PEAK_MAX,
    PEAK_MIN,
    POLE,
    RECORD,
    REJECTED,
    SETTINGS,
    SLIDES,
    STEP_TOO_SMALL,
    TO_ROW,
    TOO_FAST,
    WINDS,
)
from trsim.solve.march.rounding import (
    blunted,
    call_look_closer,
    look_closer,
    overdue,
    remember,
    to_look,
)
from trsim.solve.march.samples import firmness, restart
from trsim.solve.march.stiffness import (
    call_look_stiff,
    longest_calm,
    look_stiff,
    smooth,
    stiffness_due,
    still,
)
from trsim.solve.march.turns import BRIEF, before_pulses, longest_turn, pulse
from trsim.solve.march.watch import take_sides
from trsim.solve.methods.auto import calm, choose

MAX_SAME_TIME = 1000  # events without progress: chatter
LONGER = 6.0  # times the step before: the next one at most
CRAWLED_SOON = 1000  # vanishing steps towards a singular position: there is no way on
AIM = 0.9  # times the step that would just meet the error allowed
STRETCH = 1.05  # times the step as controlled: what may be added to end where it is to end
TIGHTER = 0.7  # of a step whose inside is not right, and whose end is
TURNED_BACK, SHORTEN = 1e-6, 0.2  # of a step: ends at a corner it began on; see `shorten`


def method_table(method, **called):
    """What the march must know of a method, a file of this folder.

    `complete` stands there too: called by its address it is compiled once, not into the march;
    so do `look_closer` and `sample`, and what only some runs need: `called`, see calls.py.
    """
    searched = called.get("search", 0) > 0 or called.get("corners", 0) > 0
    if searched and hasattr(method, "control"):
        called["control"] = method.control.address()
    if hasattr(method, "soften"):
        called["rate"], called["soften"] = method.rate.address(), method.soften.address()
    if hasattr(method, "book"):
        called["book"] = method.book.address()
    if hasattr(method, "inside"):
        called["inside"] = method.inside.address()
        called["stiff"] = look_stiff.address()
    return method_row(
        step=method.step.address(),
        dense=method.dense.address(),
        interpolate=method.interpolate.address(),
        complete=complete.address(),
        last=method.LAST,
        estimate=method.ESTIMATE,
        implicit=int(method.IMPLICIT),
        stages=getattr(method, "DEAR", 0),
        degree=method.DENSE_DEGREE,
        rounding=look_closer.address(),
        sample=sample.address(),
        finish=finish.address(),
        between=between.address(),
        land=land.address(),
        measure_in=measure_in.address(),
        **called,
    )


@compiled(types.int64(SCENE, RECORD, BUFFERS, SETTINGS, I2, i8))
def march(s, r, b, setting, methods, most):
    """Advance the record until it is done, a buffer is full, or `most` steps were accepted, or
    twice as many tried.

    methods: rows as `method_table` makes them; with two, an explicit and an implicit one, the
    march changes between them; the implicit one is asked for (LOAD) when it is first needed.
    Returns DONE, FULL, PAUSE, LOAD, ACT, STEP_TOO_SMALL, NOT_FINITE, CHATTER, TOO_FAST, OPEN,
    ADRIFT, CRAWL, LEAPT, SLIDES, POLE or WINDS.
    """
    accepted = tried = 0
    while r.t < setting.t_end:
        if full(s, r, b):
            return FULL
        if accepted >= most or tried >= 2 * most:
            return PAUSE
        tried += 1
        t, method = r.t, methods[r.method]
        if method[STEP_AT] == 0:
            return LOAD
        if still(s, r):  # what was stiff before is held
            r.vibration = 0.0
        elif method[STIFF_AT] > 0 and stiffness_due(r) and smooth(s, r):
            call_look_stiff(method[STIFF_AT], s, r, b)
        h = next_step(s, r, b, setting, method)
        if h < SMALLEST * 2.2e-16 * max(abs(t), setting.t_end * 1e-3):
            return NOT_FINITE if r.after_rejection == DIVERGED else STEP_TOO_SMALL
        if crawls(r, setting, h):
            return CRAWL
        weights(s, r, b, setting, h)
        blunted(s, r, b, h)
        copy_to(b.K[0], r.yd)
        for c in range(s.contact.size):
            s.left[s.contact[c]] = -1.0
        if setting.locate > 0:
            begin_sliding(s, r)
        s.status[4] = s.status[6] = b.halved = 0
        r.blur = r.excess = 0.0
        r.top_acceleration = largest(s, r.yd, r.top_acceleration)
        error = call_step(method[STEP_AT], s, r, b, setting, t, h)
        if s.status[4] > 0 and error < NO_STEP:
            error *= min(1.0, setting.step_error / OF_LIMITS)
        if not (error <= 1.0):
            r.rejected += 1
            if error < NO_STEP and to_look(r, h):
                call_look_closer(method[ROUNDING_AT], s, r, b, setting, method, h)
            r.after_rejection = REJECTED if isfinite(error) else DIVERGED
            if setting.fixed_step > 0.0:
                return NOT_FINITE
            shorter = max(0.2, 0.9 * error ** (-1.0 / method[ESTIMATE_AT]))
            r.h = h * (shorter if isfinite(error) else 0.1)
            continue
        if setting.fixed_step == 0.0 and overdue(r, h):
            call_look_closer(method[ROUNDING_AT], s, r, b, setting, method, h)
            continue
        b.h, b.built = h, 0
        outcome = call_complete(method[COMPLETE_AT], s, r, b, setting, method)
        if outcome == WORTHLESS:
            if setting.fixed_step > 0.0:
                return NOT_FINITE
            r.rejected += 1
            r.after_rejection = DIVERGED
            r.h = 0.1 * h
            continue
        if outcome == WOUND and setting.fixed_step > 0.0:
            return WINDS
        if outcome == AT_POLE:
            return POLE
        if outcome == AT_ROW:
            r.rejected += 1
            r.after_rejection, r.h = TO_ROW, b.until
            continue
        if outcome in (STRAYED, WOUND, LOOSE):
            r.rejected += 1
            r.after_rejection = REJECTED
            r.h = (TIGHTER if outcome == LOOSE else 0.3) * h
            continue
        accepted += 1
        remember(s, r, setting, h)
        blurred(r, h)
        if r.torn > 0:
            return LEAPT
        if r.slid != 0:
            return SLIDES
        if too_fast(s, r):
            return TOO_FAST
        if r.opened > 0:
            return OPEN
        if r.lost > 0:
            return ADRIFT
        cut = outcome in (WITH_EVENT, WITH_CORNER)
        control(r, setting, method, h, error, cut)
        if outcome == WITH_CORNER and r.t - t < TURNED_BACK * h:
            shorten(r, setting, h)
        if methods.shape[0] > 1:
            choose(s, r, b, h, outcome == WITH_EVENT)
            if methods[r.method, STEP_AT] != method[STEP_AT]:  # another reads its own steps
                call_finish(method[FINISH_AT], s, r, b, setting, method)
        elif method[STAGES_AT] > 0 and s.contact.size > 0:  # dop853
            calm(s, r, b, h, outcome == WITH_EVENT)
        if r.same_time > MAX_SAME_TIME:
            return CHATTER
        if r.fired > 0:
            return ACT
    return DONE


@internal
def crawls(r, setting, h):
    """Whether step after step is so short that 10^11 of them would be needed."""
    short = setting.fixed_step == 0.0 and h < CRAWLING * setting.t_end
    r.crawled = r.crawled + 1 if short else 0
    return r.crawled > (CRAWLED_MOST if r.driven == 0 else CRAWLED_SOON)


@internal
def too_fast(s, r):
    """Whether a body moves faster than anything does."""
    fastest = 0.0
    for k in range(s.n_q, s.n_q + s.n_v):
        fastest = max(fastest, abs(r.y[k]))
    return fastest > FASTEST


@internal
def full(s, r, b):
    """Whether the next step may overflow a buffer."""
    contacts, watched = s.contact.size, s.watch.shape[0]
    room = b.events.shape[0]
    for c in range(contacts):
        if s.contact_impact[c] > 0:
            room = b.events.shape[0] - 3 * MOST_BLOWS
    return (
        r.rows > b.rows.shape[0] // 2
        or r.step_rows + contacts >= b.steps.shape[0]
        or r.event_rows + contacts + watched + s.feature.shape[0] >= room
        or r.point_rows > b.points.shape[0] // 2
        or (r.n_passed > 0 and 2 * r.n_passed > r.passed.shape[0])
    )


@internal
def next_step(s, r, b, setting, method):
    """The step to try: as controlled, not beyond the end, the last two evened out.

    It never spans more output times than the buffer has room for, and ends where the time meets a
    corner of a function, or at an output row where steps do.  Of an explicit method it stays where
    what is stiff dies out.
    """
    if r.after_rejection == TO_ROW:
        return r.h
    left = next_instant(s, r.t, setting.t_end) - r.t
    if setting.at_rows > 0:
        left = min(left, setting.every * r.next_row - r.t)
    most = min(setting.h_max, (b.rows.shape[0] // 2 - 2) * setting.every)
    if setting.fixed_step > 0.0:
        return left if left < setting.fixed_step * (1.0 + 1e-9) else setting.fixed_step
    looked_at = s.section.shape[0] + s.heard.size
    if s.wound.size + looked_at + s.looped.size + s.judged.shape[0] > 0:
        most = min(most, longest_turn(s, r, b))
    if method[STIFF_AT] > 0 and r.vibration > 0.0:
        most = min(most, longest_calm(r))
    if s.pulse.size > 0:
        ahead = min(min(STRETCH * r.h, most), left)
        seen, brief = pulse(method[IMPLICIT_AT]), BRIEF * setting.t_end
        most = before_pulses(s, r, b, ahead, seen, brief)
    h = min(r.h, most)
    if min(STRETCH * h, most) >= left * (1.0 - 1e-12):
        return left
    return 0.5 * left if 2.0 * h > left else h


@internal
def control(r, setting, method, h, error, event):
    """The next step from the error of this one."""
    if setting.fixed_step > 0.0:
        return
    power, error = 1.0 / method[ESTIMATE_AT], max(error, 1e-8)
    factor = min(LONGER, max(0.3, AIM * error**-power))
    # predictive: the error as it changed from the step before                  [Gustafsson1994]
    past = max(r.past_error, 1e-2)
    if r.past_error > 0.0 and not event:
        factor = min(factor, AIM * h / r.old_h * (past / error**2) ** power)
        factor = max(factor, 0.2)
    r.past_error, r.old_h = (0.0 if event else error), h
    if method[IMPLICIT_AT] > 0 and 1.0 <= factor <= 1.2 and r.jacobian == OLD:
        factor = 1.0  # its factors stay good
    if r.after_rejection > 0:
        factor = min(factor, 1.0)
    r.after_rejection = 0
    if event:
        # change_phases may have set a shorter first step after a touch, or that of free motion
        if r.freed == 0:
            r.h = min(r.h, h * factor)
        r.freed = 0
    elif h >= r.h or factor < 1.0:
        r.h = h * factor
    else:
        r.h = max(r.h, h * factor)


@internal
def shorten(r, setting, h):
    """A shorter step next, where a law came straight back to the corner it had just left.

    The dense output of an implicit step far longer than what dies out after a corner is wrong at
    the step's beginning.  Both branches could then send the motion back to the other for ever; in
    a step that resolves it one of them does not.
    """
    shortest = 100.0 * SMALLEST * 2.2e-16 * setting.t_end
    if setting.fixed_step == 0.0:
        r.h = min(r.h, max(SHORTEN * h, shortest))


@compiled(types.void(SCENE, RECORD, BUFFERS, SETTINGS))
def begin(s, r, b, setting):
    """First row, energy and gaps of a record whose y and mem were just set."""
    evaluate_all(s, r, setting, 0.0)
    take_sides(s, r)
    units(s, r)
    limits_to_measure(s, 0.0, r.y, firmness(s), b.rough[0])
    measure(s, 0.0, r.y, 0.0, 0.0)
    copy_to(b.out, s.out)
    r.energy_0 = b.out[s.n_out - 1]
    b.out[s.n_out - 1] = 0.0
    b.rows[0, 0] = 0.0
    copy_to(b.rows[0, 1:], b.out)
    r.rows = 1
    r.next_row = 1
    for k in range(r.book.shape[0]):
        r.book[k, 0] = r.book[k, 1] = b.out[s.column_energy + k]
    clear_table(r.peak)
    for c in range(r.peak.shape[1]):
        r.peak[PEAK_MAX, c], r.peak[PEAK_MIN, c] = -1e300, 1e300
    copy_to(s.out, b.out)
    restart(s, r, b, 0.0)
