"""What changes during a run, in one record: a checkpoint is a copy of it."""

from collections.abc import Mapping
from functools import cache
from math import nan
from typing import Any

import numpy as np

from trsim.assemble.travel import RATE_OF
from trsim.elements.scene import N_STORED, Model
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, A2, C1, C2, F8, I1, I2, I8, T14, Packed, f8, i8
from trsim.solve.march.works import N_WORKED

NO_JACOBIAN, OLD, FRESH, NO_RATES = 0, 1, 2, 3
NO_HISTORY, BEHIND, AHEAD = 0, 1, 2
# why a trial step was rejected: its error, a value that is not finite, or it is to end at a row
REJECTED, DIVERGED, TO_ROW = 1, 2, 3

# why the march returned
DONE, FULL, STEP_TOO_SMALL, NOT_FINITE, CHATTER, PAUSE = 0, 1, 2, 3, 4, 5
LOAD = 6  # a method is wanted whose row in `methods` is still empty
CRAWL = 8  # so many steps so short that the end will not be reached
TOO_FAST = 7  # a body is faster than FASTEST
CRAWLING, CRAWLED_MOST = 1e-11, 50_000  # of the run; trial steps in a row as short as that
FASTEST = 3e8  # m/s or rad/s: what gets there has run away, and would be followed for hours
ADRIFT = 13  # without projection, where branches of the motion meet
OPEN = 10  # a row that was dropped as redundant is not
WINDS = 12  # a fixed step turns a joint by more than is sure to be counted, see turns.py
LEAPT = 11  # the place of a rigid drive jumps, see TORN
POLE = 15  # a load or a motion has no value, or grows without bound, within the next step
SLIDES = 14  # a load jumps where a rate passes a value, and drives it back from both sides
ACT = 9  # a user event happened: the caller does what it says

JOLTS_KEPT = 8
PASSES_KEPT, MEETINGS_KEPT = 32, 8
PARTS = 8  # in which the top of a polynomial is looked for
LOOKS = 8  # parts of a step in which channels of any kind are looked at, at least  sampled.py
CHANGES_KEPT = 6  # of states tried, that are learned from                          settle.py
FOUND = 200  # places between two samples where extremes are looked for

# columns of the event buffer
(
    EVENT_TIME, EVENT_KIND, EVENT_ROW, EVENT_SPEED, EVENT_ANGLE, EVENT_WORK, EVENT_IMPULSE, N_EVENT
) = range(8)  # fmt: skip
ONSET, SEPARATION, TO_IMPLICIT, TO_EXPLICIT, USER, JOLT = 1.0, 2.0, 3.0, 4.0, 5.0, 6.0
CORNER, TURNS = 7.0, 8.0  # of a static path
IMPACT = 9.0
MOST_BLOWS = 1000  # impacts at one instant


# samples of every channel that are kept, see peaks.py; where those inside steps are exact, too
POINTS, EXACT_POINTS = 6, 14
PEAK_MAX, PEAK_MAX_T, PEAK_MIN, PEAK_MIN_T, N_PEAK = range(5)


# SLOPE: at its root, of a channel; DUE: s, when the clock of a phase comes to its end; AT_ONCE: 1
# if it ended its phase as that began; LOOKED: looks in a row at which nothing moved
SIDE, TIMES, JUST_NOW, SLOPE, DUE, AT_ONCE, LOOKED, N_WATCH = range(8)
# side of zero `when` was on last; its value and rate at y, and whether they hold; its rate at the
# end of the step; number of the next instant
ON, LAST, RATE, KNOWN, END_RATE, NEXT, FAR, SWINGS = range(8)
# SWINGS and what follows: how many swings between two crossings went as far as 10^(k - 1) LEAST
LEAST, DECADES = 1e-24, 40
N_SECTION = SWINGS + DECADES
# columns of the buffer of points
POINT_TIME, POINT_SECTION, POINT_X, POINT_Y, N_POINT = range(5)


class Shape(tuple[int | str, ...]):
    """Of an array of a record: numbers, or names of sizes; see `zeros`."""


def of(*shape: int | str) -> Any:
    """A field that begins as an array of zeros of this shape."""
    return Shape(shape)


@internal
def note_event(r, b, t, kind, row, speed):
    """The next line of events, with no angle, neither work nor impulse."""
    line = b.events[r.event_rows]
    r.event_rows += 1
    line[EVENT_TIME], line[EVENT_KIND], line[EVENT_ROW] = t, kind, row
    line[EVENT_SPEED], line[EVENT_ANGLE] = speed, nan
    line[EVENT_WORK] = line[EVENT_IMPULSE] = 0.0


class Settings(Packed):
    """The constants of the march."""

    t_end: f8
    step_error: f8  # what a step may err by, made of the tolerance: see `settings` of outcome.py
    h_max: f8
    every: f8  # s between output rows
    fixed_step: f8  # s, 0 where the method controls its step
    locate: i8  # 1: contact onset and separation are located
    chooses: i8  # 1: between two methods, by the fastest motion
    missed: f8  # what may be missed of an extreme, as a part of the range of its channel  peaks.py
    held_to: f8  # of the mechanism's size or rad: what redundant rows may be open by  openings.py
    tolerance: f8  # as it is written
    at_rows: i8  # 1: steps end at output rows


class Record(Packed):
    """The state of a run."""

    y: A1  # (n_y)
    yd: A1 = of("n_y")  # derivative at y, the first stage of the next step
    noise: A1 = of("n_y")  # what rounding makes of y in steps, per second  rounding.py
    mem: A2  # (N, n_mem) the scene's own
    branch: A1  # (n_s) turn every angle is on; the scene's own
    turning: A1 = of("branch")  # rates of S at y
    gap: A2 = of("gaps", 2)  # penetration and rate at y; what is watched less its value
    corner: A1 = of("contact")  # how far each has left the branch of its law at y
    peak: A2 = of(N_PEAK, "channels")  # extremes of channels and magnitudes
    firm: A2  # (2, n_c) the least pivot of rows where each was taken, 1 in open chains   samples.py
    book: A2 = of(1 + N_STORED, 2)  # least and largest of kinetic and stored energies  works.py
    sample: A2 = of(POINTS, "kin")  # last values of those that are sought inside steps
    sampled: A1 = of(POINTS)  # when those were taken
    slope: A2 = of(POINTS, "kin")  # their divided differences, newest first
    earlier: A2 = of("ends", "n_y")  # of the step before: both its ends, y' there  earlier.py
    stages: A2 = of("rows", "n_y")  # its stages, or its dense output
    largest: A1 = of("kin")  # size of the channels of one kind, see `kin` of the scene
    faint: A1 = of("kin")  # what rounding makes of channels of a kind
    impact: A1  # (n_contacts) largest penetration so far
    struck: I1 = of("contact")  # 1 of a contact whose touch takes no time and has just begun
    # what implicit methods carry from step to step; w = (v, states of elements)   jacobian.py
    by_place: A2 = of("n_w", "n_dx")  # w' against displacements
    by_rate: A2 = of("n_w", "n_w")  # w' against w
    stale: I1 = of("n")  # frames whose columns of `by_rate` a corner made old
    lu: A2 = of("n_w", "n_w")  # factors of the real system
    lu_pair: C2 = of("n_w", "n_w")  # and of the complex one
    pivot: I2 = of(2, "n_w")
    past: A2 = of("past_rows", "n_y")  # dense output of a step, see `history`
    watch: A2 = of("watch", N_WATCH)  # of every user event  watch.py
    held: A1 = of("held")  # what functions are held on  features.py
    sight: A1 = of("sensed")  # what the sensors that meet corners show at y
    chatter: A2 = of("feature", 3)  # last time a corner was met, how often in a row, how far
    stage: I1 = of("switches")  # what user events have switched  assemble/stages.py
    left_out: I1  # 1: a row of all there may be is not solved; empty where none can be redundant
    section: A2 = of("section", N_SECTION)  # of every Poincare section  sections.py
    jolt: A2 = of(JOLTS_KEPT, 5)  # the first jumps: time, row, of the rate, impulse, work
    passed: A2 = of("passes", "way")  # ways noted: times, states, branches of angles
    meeting: A2 = of("meetings", "n_y")  # where branches meet  crossed.py
    crossed: A1 = of("n_y")  # where the run first changed its branch
    swing: A2 = of(2, "n_x")  # how it vibrates, and how it decays  stiffness.py
    worked: A2 = of(2, N_WORKED)  # works of a fixed step and of the one before  works.py
    clock: A1  # the numbers that change
    t: F8  # s
    h: F8  # s, the step to try next
    length: F8  # m, unit of the error norm: the smallest gap or penetration that matters
    speed: F8  # m/s, its unit for velocities, of the next step
    top_speed: F8  # m/s, the largest speed so far  norm.py
    speed_cap: F8  # m/s, more is no unit for velocities
    work_projection: F8  # J, given to the mechanism by projecting back to the constraints
    energy_0: F8  # J, total energy at the start
    worst_phi: F8  # m or rad, largest constraint residual met at an accepted point
    worst_phi_dot: F8
    largest_energy: F8  # J, largest entry of the energy book so far: the scale of its residual
    largest_residual: F8  # J
    past_h: F8  # s, length of the step whose polynomial is in `past`
    past_error: F8  # error of the last step, for the controller; 0 after an event
    old_h: F8  # s, its length
    factored_h: F8  # s, the step size `lu` belongs to; 0 for none
    contraction: F8  # of the matrix at hand, as far as it was measured
    newton_rate: F8  # contraction of the last Newton iterations
    jacobian_rate: F8  # 1/s, largest eigenvalue of the Jacobian; negative: not known
    explicit_rate: F8  # 1/s, how much the derivative changes with the state; 0: not known  auto.py
    exchanged: F8  # J, largest work, or range of an energy, so far: the scale of works  works.py
    work_trial: F8  # J, error of the works in the last trial step, as estimated
    work_error: F8  # J, the sum of those accepted
    worst_open: F8  # of the mechanism's size or rad, of a redundant row  openings.py
    worst_open_rate: F8  # the same per second
    apart: F8  # the same of rows that are open by more than the rest is
    apart_t: F8  # s, when
    weakest: F8  # pivot of a row, of its diagonal: at the last look at which rows to solve
    torn_by: F8  # m or rad
    off: F8  # m or rad, largest constraint residual at the end of the last trial step
    off_rate: F8
    noisy: F8  # 1/s, rounding of steps in units of the tolerance  rounding.py
    noisy_at: F8  # the entry of y that has it
    passing: F8  # 1: it was seen where rows nearly depended on each other
    rounded: F8  # largest rounding of an accepted step in these units, and the entry that had it
    rounded_at: F8
    rounded_by: F8  # and how much it was, m, rad, m/s or rad/s
    longest: F8  # s, the longest step since then, see `looked`
    last_way: F8  # rad, or of the mechanism's size: how far the last step went, 0: none  passes.py
    crossed_t: F8  # s, when the run first changed its branch  crossed.py
    top_acceleration: F8  # m/s^2, the largest acceleration so far  loop.py
    blur: F8  # m/s^2, error of accelerations the last trial was not held for  accelerations.py
    excess: F8  # m/s^2, the same where it was more than its share, rounding or not
    blur_w: F8  # rad/s, how fast what it consists of turns, 0: not known
    blurred: F8  # m/s^2, the largest of accepted steps
    blurred_w: F8  # rad/s, of the longest of them, and its length
    blurred_h: F8
    blurred_sum: F8  # m/s^2, of all that were more than their share
    earlier_t: F8  # s, where the step began that is kept in `earlier`  earlier.py
    earlier_h: F8  # s, its length
    earlier_work: F8  # J, `work_projection` there, and what projection gave in it
    earlier_projected: F8
    free_h: F8  # s, the step to try next when a contact last closed while all were open  phases.py
    free_since: F8  # s, when they last opened
    chosen_t: F8  # s, when rows were last chosen anew  anew.py
    felt: F8  # of rows open where branches nearly meet, in accelerations  adrift.py
    felt_t: F8  # s, when
    vibration: F8  # 1/s^2, w^2 of the fastest vibration there could be; 0: not known  stiffness.py
    decay: F8  # 1/s, of the fastest decay
    step_turn: F8  # rad, the most a body turned by in a fixed step  rk4.py
    pole_t: F8  # s, when
    side: F8  # sign of det J where rows alone tell places  kinematic.py
    least_pivot: F8  # of rows at y, 1 in open chains  kinematic.py
    count: I1  # and the whole ones
    steps: I8
    rejected: I8
    events: I8
    corners_met: I8  # corners of laws, met
    next_row: I8  # index of the next output time
    rows: I8  # filled rows of the buffers
    step_rows: I8
    event_rows: I8
    dense_built: I8
    after_rejection: I8  # why the last trial was rejected, see REJECTED; 0: it was not
    same_time: I8  # events in a row without time passing
    method: I8  # which of the methods makes the steps
    method_switches: I8  # changes of method
    stiff: I8  # steps in a row that looked stiff to an explicit method, or not to an implicit one
    not_stiff: I8  # steps in a row that speak against it
    fading: I8  # explicit steps in a row that a decay alone may hold
    history: I8  # what `past` holds: NO_HISTORY, a step BEHIND the state, a trial AHEAD of it
    jacobian: I8  # state of `by_place` and `by_rate`: NO_JACOBIAN, NO_RATES, OLD, FRESH
    next_jacobian: I8  # its state once the last trial is accepted: OLD, or NO_JACOBIAN
    jacobians: I8  # made so far
    iterations: I8  # of Newton, so far
    crawled: I8  # trial steps in a row that were vanishingly short
    fired: I8  # user events at the end of the last step, not yet acted on
    point_rows: I8
    weak: I8  # 1: rows of the solve nearly depend on each other, others may not  openings.py
    opened: I8  # 1: a redundant row is open beyond its bound
    open_row: I8  # element row e and row of it that `apart` is of
    open_index: I8
    n_jolts: I8  # jumps of the rate of a rigid drive
    lost: I8  # 1: without projection, rows are open by as much as branches are apart  adrift.py
    torn: I8  # 1 + row of the rigid drive whose place has jumped: the run ends
    slid: I8  # 1 + offset in tab of a function that holds a rate at a jump, minus that of one that
    # holds a place: the run ends
    pole: I8  # 1 + row of `pole`, what of a function has no value at `pole_t`: the run ends
    unproved: I8  # searches for an event in a step that gave up
    unfollowed: I8  # looks into a step in which more happened than is followed   sampled.py
    degree: I8  # of the polynomials in `net`
    looked: I8  # steps when rounding was looked at last  rounding.py
    next_look: I8  # steps when stiffness is to be looked at again, and how far apart  stiffness.py
    apart_looks: I8
    of_rates: I8  # 1: it was rates that were looked at
    failed: I8  # and how many trials were rejected then
    newest: I8  # which of the last samples of the channels is the newest, and how many there are
    n_samples: I8
    kept: I8  # 0: no rows are known where the step begins; 1, 2: they are kept in one of two places
    n_passed: I8  # ways noted that are still to be examined
    n_meetings: I8  # places known where branches meet
    crossings: I8  # how often the run changed its branch
    unseen: I8  # 1: between the two newest samples no extremes were looked for yet
    freed: I8  # 1: the step ended where the last closed contact opened
    earlier_built: I8  # 1: `stages` holds the dense output of the earlier step, not its stages
    chosen: I8  # how often rows were chosen anew with next to no time between
    driven: I8  # 1: rows alone tell where everything is, and how fast


class Buffers(Packed):
    """Room for results between two visits of the caller, and scratch of the march."""

    rows: A2 = of("rows", "row")  # time, channels
    steps: A2 = of("steps", "step")  # time, row e, contact channels
    events: A2 = of("events", N_EVENT)
    points: A2 = of("points", N_POINT)  # of Poincare sections; empty without any
    K: A2 = of("stages", "n_y")  # stages of the integrator
    ends: A2 = of(2, "n_y")  # both ends of a step whose dense output is made
    P: A2 = of("dense_rows", "n_y")  # dense output
    P_earlier: A2 = of("dense_rows", "n_y")  # that of the step before, while it is made
    y1: A1 = of("n_y")
    y2: A1 = of("n_y")
    weight: A1 = of("n_y")
    pair: C1 = of("n_y")  # right-hand side of the complex system of an implicit method
    rough: A2 = of(3, "n_y")  # a state and the end of a step from it, while it is made again
    out: A1  # (n_out) channels at the end of the step
    middle: A1 = of("n_out")  # and in its middle, of methods that evaluate there
    gap1: A2 = of("gaps", 2)
    corner1: A1 = of("contact")
    full: A1 = of("channels")  # all channels and magnitudes
    # (3) the least pivot of rows where channels were measured last, at the end of the step, in its
    # middle
    firm: A1
    row_firm: A1  # (n) the same of every output row
    inside: A2 = of(FOUND, "kin")  # channels where an extreme was looked for  peaks.py
    found: A1 = of(FOUND)  # when, see `n_found`
    node: A2 = of(5, POINTS)  # of polynomials: times, values, slopes, 1 / (t0 - tk), factors
    along: A1 = of(1 + PARTS)  # a polynomial at so many places  polynomials.py
    lattice: A2 = of(POINTS, 1 + PARTS)  # products of their distances from the nodes
    inverse: A2 = of(POINTS, POINTS)  # of the distances of nodes
    bound: A2 = of(2, "kin")  # of channels between two samples: see `bounds` of samples.py
    tried: A2 = of(5 + 2 * CHANGES_KEPT, "n_y")  # states tried  settle.py
    part: A2 = of(2, "n_y")  # both ends of a part of a step  passes.py
    mean: A2 = of(2, "n_out")  # channels where rows of the solve depend on each other
    unmoved: A2 = of(3, "n_y")  # its end and y' there before that, and scratch
    square: A2 = of(0, 0)  # J, and rows swapped in it, where it is square  kinematic.py
    swaps: I1 = of(0)
    looks: A2 = of(LOOKS, "section")  # `when` of all sections at places inside the step
    looked: I1 = of(LOOKS)  # which of these places were looked at                     sections.py
    root: A1 = of("gaps")  # where in the step its phase changes, 2 for nowhere
    corner_root: A1 = of("contact")  # and where it meets a corner
    branch1: A1 = of("angles")
    turning1: A1 = of("angles")
    at_ends: A2 = of(4, "angles")  # what sensors show at both ends of a stretch, and rates turns.py
    net: A2 = of(9, "watched")  # control points of q, or of q and v, over a step  spread.py
    curve: T14 = of(9, 14)  # those of two frames on a part of it
    seen: A2 = of("seen", 4)  # ranges of sensors and of their rates, where they meet corners
    shown: A2 = of("sensed", 2)  # what they show at both ends of a part of a step
    box: A2 = of("slots", 4)  # ranges of the parts of a function
    pole_box: A2 = of("pole_slots", 4)  # the same where a function may have no value
    pole_first: A2 = of("at_poles", 2)  # S at both ends of a part of a step
    pole_last: A2 = of("at_poles", 2)
    before: A1 = of("held")  # what functions were held on in the last step
    met: A2 = of("feature", 3)  # the first corner of a step: theta, place in tab, what follows
    clock: A1  # the numbers that change
    t: F8  # s, where the step at hand begins
    h: F8  # s, its length; what its dense output is made with
    t1: F8  # s, its end
    projected: F8  # J, what the projection there gave
    sampled_t: F8  # s, when the channels were measured that are sampled next     peaks.py
    until: F8  # s, after its start: the row that it is to end at, 0: none     output_rows.py
    doubt: F8  # what stands for the last divided difference in the error of a polynomial
    count: I1  # and the whole ones
    interpolate: I8  # address of what evaluates the dense output
    rate: I8  # of the rate of what is slow in it, 0: none                        settle.py
    soften: I8  # and of what takes away what is stiff
    land: I8  # of what brings an end to the rows                                 land.py
    measure_in: I8  # and of what measures channels inside a step        dense_output.py
    built: I8  # 1: P holds it
    parts: I8  # in how many parts events look at channels in it, 0: not asked yet         heard.py
    alone: I8  # 1: places inside it are taken as interpolated                sampled.py
    halved: I8  # 1: middle holds the channels of this step
    restless: I8  # 1: what is stiff did not come to rest
    moved: I8  # 1: the end of the step was moved on along its tangent
    torn: I8  # 1: what was measured last inside a step is off the rows     dense_output.py
    astray: I8  # 1: what lies between two samples says nothing of the motion    peaks.py
    n_found: I8  # places between two samples that were looked at                peaks.py
    laid: I8  # how many there were when a lattice was laid


SETTINGS, RECORD, BUFFERS = Settings.kind, Record.kind, Buffers.kind


def fresh_buffers(
    model: Model, n_y: int, stages: int, dense_rows: int, step_rows: int = 0, points: int = 0
) -> Buffers:
    """Buffers for a model and a method.

    step_rows: output rows a fixed step may span; points: of sections, the most in one step.
    """
    contacts, watched = len(model.contact), len(model.watch)
    rows = max(1024, 2 * step_rows + 16)
    sizes = {
        "n_y": n_y,
        "rows": rows,
        "row": 1 + model.n_out,
        "steps": max(1024, 8 * contacts),
        "step": 2 + int(np.max(model.contact_width, initial=0)),
        "events": max(256, 8 * (contacts + watched)) + blows(model),
        "points": max(1024, 2 * points + 16) if points else 0,
        "stages": stages,
        "dense_rows": dense_rows,
        "gaps": contacts + watched,
        "channels": model.n_out + len(model.vector),
        "angles": max(model.n_s, 1),
        "watched": controlled(model),
        "at_poles": max(model.n_s, 1) if len(model.pole) else 0,
        "seen": max(model.n_s, 1) if len(model.sensed) else 0,
    }
    out = np.zeros(max(model.n_out, 1))
    return Buffers(**zeros(Buffers, model, sizes), out=out, firm=np.ones(3), row_firm=np.ones(rows))


def blows(model: Model) -> int:
    """The lines of events that impacts of one instant may add: each one, and what begins and ends
    with it."""
    return 3 * MOST_BLOWS if model.contact_impact.any() else 0


def controlled(model: Model) -> int:
    """How many entries of y have control points: q where a step is searched, v too for rates."""
    if not len(model.contact) + len(model.watch) + len(model.sensed):
        return 0
    return model.n_q + (model.n_v if any(kind > RATE_OF for _, kind, _ in model.sensed) else 0)


def zeros(record: type[Packed], model: Model, sizes: Mapping[str, int]) -> dict[str, Any]:
    """Arrays for the fields that a record itself gives a shape.

    A name in it is one of `sizes`, or a number of the model, or a table of it, then its length.
    """

    known: dict[Any, int] = {**sizes}
    of_kind: Any = record
    shapes = shaped(of_kind)
    for k in {k for _, shape, _ in shapes for k in shape} - known.keys():
        found = k if isinstance(k, int) else getattr(model, k)
        known[k] = found if isinstance(found, int) else len(found)
    return {name: np.zeros([known[k] for k in shape], dtype) for name, shape, dtype in shapes}


@cache
def shaped(record: Any) -> list[tuple[str, Shape, Any]]:
    """The fields of a record that begin as zeros: their shapes and what they hold."""
    kinds = dict(record.kind.fields)
    found = [(name, shape) for name, shape in vars(record).items() if isinstance(shape, Shape)]
    return [(name, shape, np.dtype(kinds[name].dtype)) for name, shape in found]


def crowded(r: Record, b: Buffers) -> bool:
    """Whether a buffer is half full: time to empty them."""
    filled = (
        (r.rows, b.rows), (r.step_rows, b.steps), (r.event_rows, b.events), (r.point_rows, b.points)
    )  # fmt: skip
    return any(2 * number > len(buffer) for number, buffer in filled)
