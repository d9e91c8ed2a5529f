"""Points of Poincare sections: where inside a step the motion passes a surface.

    crossing  when(t) = 0: the root of a channel on the dense output of the step
    strobe    t = after + k every
    touch     the end of a step that a contact ends by touching

A crossing lies between two neighbours of different sign among the ends of the step and points
inside it (sampled.py).  These are looked at where the sign changed, where bodies or waves turn far,
or where the cubic through values and rates of the channel at both ends comes near zero.  Where
three neighbours of one sign dip towards zero the bottom is looked for too: so two crossings in one
step are two points, however close.  Channels are of every kind, forces among them,
so this is sampled, not bounded as events are.
The root is found to the resolution of the time.

Like the phase of a contact the side `when` is on is a discrete state: zero is on the side it came
from, so a start at zero is no crossing, and neither is a touch of zero that turns back.  What a
channel jumps over at an event, or between two neighbouring doubles of the time, it does not cross.

A channel that rests at zero crosses it wherever rounding takes it.  That is not for a kernel to
judge: how far swings between two crossings go is counted by decades, and the run tells of those
below what its tolerance resolves (diagnose/swings.py).

Nothing here has a part in the motion: a run makes the same steps with its sections and without.
"""

from math import isfinite, log10

from trsim.assemble.equations import call_one, set_poses
from trsim.assemble.outputs import measure
from trsim.assemble.sections import (
    AFTER,
    ALONE,
    CROSSING,
    DIRECTION,
    EVERY,
    KIND,
    STROBE,
    TOUCH,
    WAVES,
    WHEN,
    X,
    Y,
)
from trsim.elements.contract import FLIGHT, Memory, compiled
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import LAST_AT, SECTIONS
from trsim.solve.march.dense_output import fill, measure_inside
from trsim.solve.march.events import NONE, SAME
from trsim.solve.march.land import evaluate_to_measure
from trsim.solve.march.record import (
    DECADES,
    END_RATE,
    FAR,
    KNOWN,
    LAST,
    LEAST,
    NEXT,
    ON,
    POINT_SECTION,
    POINT_TIME,
    POINT_X,
    POINT_Y,
    RATE,
    SWINGS,
)
from trsim.solve.march.sampled import (
    NEAR,
    PARTS,
    SHORT,
    TURN,
    as_interpolated,
    dip,
    parts_for,
    resolution,
    root,
    turn_of,
    value,
    waves_of,
)

AHEAD = 1e-4  # of a step: how far the rate of a channel looks
SMOOTHLY, BY_EVENT, BY_CORNER = range(3)  # how a step ends
VALUE = 2.0  # of KNOWN: the value at the start, not its rate
JUMP = 1e-6  # of how far a channel swung before: more than that is not done in one ulp
AT_START = 1e-9  # of a channel's next value: so small, a run starts on zero and rounding is left


@compiled(SECTIONS)
def sections(s, r, b, method, event):
    """Write the points of the step at hand into b.points; it is about to be accepted.

    Its end, measured, is in b.out.  event: how it ends.  What places and rates tell goes on
    smoothly up to a corner of a law, and its rate may have another one behind it.  Counters are
    left as they were.
    """
    last, built, t1 = method[LAST_AT], b.built, b.t1
    counted = (s.status[0], s.status[1], s.status[2], s.status[3])
    turn = turn_of(s, r, b, last)
    b.alone = int(as_interpolated(s, r, b, turn))
    if event == BY_CORNER and not all_alone(s):
        event = BY_EVENT
    for j in range(b.looked.size):
        b.looked[j] = 0
    ends_known(s, r, b, last, event)
    still = parts_for(r, turn / TURN)
    swinging = waves_of(s, r, b)
    for k in range(s.section.shape[0]):
        kind = s.section[k, KIND]
        parts = max(still, swinging) if s.section[k, WAVES] > 0 else still
        if kind == TOUCH:
            if event == BY_EVENT and touches(s, r, b, s.section[k, WHEN]):
                point(s, r, b, k, t1, b.out)
        elif (kind == STROBE and instant(s, r, k) <= latest(t1)) or (
            crosses_after(s, k, t1) and may_cross(s, r, b, k, event, parts)
        ):
            if built == 0:
                fill(s, r, b, method)
                built = 1
            if kind == STROBE:
                strobes(s, r, b, k)
            else:
                crossings(s, r, b, k, parts)
        keep_end(s, r, b, k, event)
    s.status[0], s.status[1], s.status[2], s.status[3] = counted


@internal
def point(s, r, b, k, t, values):
    """A line of b.points, unless a value is not finite or it is too early."""
    x, y = values[s.section[k, X]], values[s.section[k, Y]]
    if t < s.section_at[k, AFTER] or not (isfinite(x) and isfinite(y)):
        return
    line = b.points[r.point_rows]
    line[POINT_TIME], line[POINT_SECTION], line[POINT_X], line[POINT_Y] = t, k, x, y
    r.point_rows += 1


# --- touches and instants --------------------------------------------------------------------


@internal
def touches(s, r, b, e):
    """Whether the event at the end of the step is the touch of contact e; see change_phases."""
    first, root = NONE, NONE
    for c in range(b.root.size):
        first = min(first, b.root[c])
    for c in range(s.contact.size):
        first = min(first, b.corner_root[c])
        if s.contact[c] == e:
            root = b.root[c]
    return Memory(r, e).phase == FLIGHT and root <= first + SAME


@internal
def instant(s, r, k):
    """The next instant of a stroboscopic section."""
    return s.section_at[k, AFTER] + s.section_at[k, EVERY] * r.section[k, NEXT]


@internal
def latest(t1):
    """t1, and what rounding makes of it."""
    return t1 * (1.0 + 1e-15)


@internal
def strobes(s, r, b, k):
    """The points of a stroboscopic section; a step longer than the buffer is none, see room."""
    while r.point_rows < b.points.shape[0]:
        at = instant(s, r, k)
        if at > latest(b.t1):
            break
        if at >= b.t1:
            point(s, r, b, k, at, b.out)
        else:
            theta = max((at - b.t) / b.h, 0.0)
            measure_inside(s, r, b, b.t + theta * b.h, theta)
            point(s, r, b, k, at, s.out)
        r.section[k, NEXT] += 1.0


# --- crossings -------------------------------------------------------------------------------


@internal
def crosses_after(s, k, t1):
    """Whether section k is of crossings, and there may be points at t1."""
    return s.section[k, KIND] == CROSSING and t1 >= s.section_at[k, AFTER]


@internal
def ends_known(s, r, b, last, event):
    """Values of `when` at the start of the step, where an event changed them, and its end's rates.

    b.P is free for scratch where it holds no dense output yet.
    """
    lost = asked = begun = False
    t, t1 = b.t, b.t1
    for k in range(s.section.shape[0]):
        if crosses_after(s, k, t1):
            asked = event != BY_EVENT
            lost = lost or r.section[k, KNOWN] == 0.0
            begun = begun or r.section[k, KNOWN] == VALUE
    scratch, done, energy_0 = b.P[0], r.work_projection, r.energy_0
    if b.built > 0:
        scratch = b.K[1]
    if lost:
        evaluate_to_measure(s, t, r.y, scratch)
        measure(s, t, r.y, done, energy_0)
        for k in range(s.section.shape[0]):
            if crosses_after(s, k, t1) and r.section[k, KNOWN] == 0.0:
                first = s.out[s.section[k, WHEN]]
                if abs(first - r.section[k, LAST]) > JUMP * r.section[k, FAR]:  # not rounding alone
                    r.section[k, ON] = side_of(first, r.section[k, ON])
                r.section[k, LAST] = first
    ahead = AHEAD * (t1 - t)
    if begun and asked:
        ahead_of(r.y, r.yd, ahead, b.y2)
        set_poses(s, b.y2)
        for k in range(s.section.shape[0]):
            if s.section[k, KIND] == CROSSING and r.section[k, KNOWN] == VALUE:
                call_one(s, s.measure, t + ahead, s.section[k, ALONE])
                change = s.out[s.section[k, WHEN]] - r.section[k, LAST]
                r.section[k, RATE] = change / ahead
    if asked:
        ahead_of(b.y1, b.K[last], ahead, b.y2)
        if all_alone(s):
            set_poses(s, b.y2)
            for k in range(s.section.shape[0]):
                if s.section[k, KIND] == CROSSING:
                    call_one(s, s.measure, t1 + ahead, s.section[k, ALONE])
        else:
            evaluate_to_measure(s, t1 + ahead, b.y2, scratch)
            measure(s, t1 + ahead, b.y2, done, energy_0)
        for k in range(s.section.shape[0]):
            if s.section[k, KIND] == CROSSING:
                o = s.section[k, WHEN]
                r.section[k, END_RATE] = (s.out[o] - b.out[o]) / ahead


@internal
def ahead_of(y, yd, ahead, out):
    """out <- y + ahead y'."""
    for c in range(out.size):
        out[c] = y[c] + ahead * yd[c]


@internal
def all_alone(s):
    """Whether places and rates alone tell `when` of every crossing."""
    for k in range(s.section.shape[0]):
        if s.section[k, KIND] == CROSSING and s.section[k, ALONE] < 0:
            return False
    return True


@internal
def what_of(s, k):
    """What section k looks at, see sampled.py."""
    return s.section[k, WHEN], 0.0, s.section[k, ALONE]


@internal
def side_of(value, before):
    """The side of zero a value is on: 1, -1, or for zero the side it was on before."""
    return 1.0 if value > 0.0 else (-1.0 if value < 0.0 else before)


@internal
def keep_end(s, r, b, k, event):
    """The end of the step is the start of the next."""
    if s.section[k, KIND] != CROSSING:
        return
    r.section[k, LAST] = b.out[s.section[k, WHEN]]
    r.section[k, FAR] = max(r.section[k, FAR], abs(r.section[k, LAST]))
    r.section[k, ON] = side_of(r.section[k, LAST], r.section[k, ON])
    r.section[k, RATE] = r.section[k, END_RATE]
    known = 1.0 if event == SMOOTHLY else (VALUE if event == BY_CORNER else 0.0)
    r.section[k, KNOWN] = known if b.t1 >= s.section_at[k, AFTER] else 0.0


@internal
def may_cross(s, r, b, k, event, parts):
    """Whether the step must be looked into: the sign changes, or the cubic comes near zero."""
    side, length = r.section[k, ON], b.t1 - b.t
    if event == BY_EVENT or r.section[k, KNOWN] == 0.0 or side == 0.0 or parts > PARTS:
        return True
    f0, f1 = side * r.section[k, LAST], side * b.out[s.section[k, WHEN]]
    rise = f1 - f0
    bend0 = side * r.section[k, RATE] * length - rise
    bend1 = rise - side * r.section[k, END_RATE] * length
    nearest, farthest = min(f0, f1), max(f0, f1)
    for j in range(1, PARTS):
        theta = j / PARTS
        inner = (1.0 - theta) * bend0 + theta * bend1
        f = f0 + theta * rise + theta * (1.0 - theta) * inner
        nearest, farthest = min(nearest, f), max(farthest, f)
    return not nearest > NEAR * (farthest - nearest)


@internal
def crossings(s, r, b, k, parts):
    """The points of all crossings in the step.  Places inside it are pairs: theta, value."""
    what, reach = what_of(s, k), (b.t1 - b.t) / b.h
    before = (-1.0, 0.0)  # the neighbour before the last, where both are on one side
    low, side = (0.0, r.section[k, LAST]), r.section[k, ON]
    if reach <= SHORT * resolution(b):
        parts = 1
    for j in range(1, parts + 1):
        theta = reach * j / parts
        high = (theta, inner(s, r, b, k, (j, parts, theta)) if j < parts else b.out[what[0]])
        if b.t == 0.0 and j == 1 and abs(low[1]) <= AT_START * abs(high[1]):
            side = 0.0
        new = side_of(high[1], side)
        if side * new < 0.0:
            crossed(s, r, b, k, (low, high), new)
            swung(r, k, abs(low[1]))
            r.section[k, FAR] = abs(high[1])
            before = (-1.0, 0.0)
        else:
            if before[0] >= 0.0 and side * low[1] < min(side * before[1], side * high[1]):
                theta = dip(s, r, b, what, side, (before, low, high))
                if theta >= 0.0:
                    bottom = (theta, value(s, r, b, what, theta))
                    crossed(s, r, b, k, (before, bottom), -side)
                    swung(r, k, before[1])
                    crossed(s, r, b, k, (bottom, high), side)
                    swung(r, k, bottom[1])
            r.section[k, FAR] = max(r.section[k, FAR], abs(high[1]))
            before = low
        low, side = high, new
    r.section[k, ON] = side  # the one it is on at an end that is zero


@internal
def inner(s, r, b, k, place):
    """`when` of section k at the j-th of so many places; where forces are evaluated for it all
    sections look at once."""
    j, parts, theta = place
    if parts != PARTS or (b.alone > 0 and s.section[k, ALONE] >= 0):
        return value(s, r, b, what_of(s, k), theta)
    if b.looked[j] == 0:
        measure_inside(s, r, b, b.t + theta * b.h, theta)
        for i in range(s.section.shape[0]):
            if s.section[i, KIND] == CROSSING:
                b.looks[j, i] = s.out[s.section[i, WHEN]]
        b.looked[j] = 1
    return b.looks[j, k]


@internal
def swung(r, k, f):
    """Count the swing of section k that ends here, and the value f is one of."""
    far = max(r.section[k, FAR], abs(f))
    decade = int(log10(far / LEAST)) + 1 if far > LEAST else 0
    r.section[k, SWINGS + min(decade, DECADES - 1)] += 1.0
    r.section[k, FAR] = 0.0


@internal
def crossed(s, r, b, k, places, to):
    """The point of a crossing to the side `to` between two places, if it is asked for.

    Whether it jumps is judged by its swing until here: of a step that lasts an ulp, such as those
    at a corner of a load, both places may be zero but for rounding.
    """
    want = s.section[k, DIRECTION]
    if want != 0 and want != to:
        return
    low, high = places
    theta, jump = root(s, r, b, what_of(s, k), low, high)
    if jump <= JUMP * max(r.section[k, FAR], abs(high[1] - low[1])):
        measure_inside(s, r, b, b.t + theta * b.h, theta)
        point(s, r, b, k, min(b.t + theta * b.h, b.t1), s.out)
