"""Extremes of every channel: at accepted points, and of contact forces inside the steps.

A contact force passes its maximum between two accepted points.  Its rate at both ends says so; the
step is then searched on its dense output, for all channels, since reactions and drive forces peak
with it.
"""

from trsim.assemble.equations import call_one, evaluate, poses
from trsim.assemble.outputs import measure
from trsim.elements.contract import FLIGHT, PHASE
from trsim.elements.vectors import copy_to, internal
from trsim.solve.calls import call_interpolate
from trsim.solve.illinois import between, narrowed
from trsim.solve.record import (
    ENERGY_0,
    PEAK_MAX,
    PEAK_MAX_T,
    PEAK_MIN,
    PEAK_MIN_T,
    PEAK_T1,
    PEAK_T2,
    PEAK_V1,
    PEAK_V2,
    WORK_PROJECTION,
)

AHEAD = 1e-4  # of a step: how far the rate of a contact force looks
TRIALS, FLAT = 12, 1e-3  # to the maximum of a contact force; of its rate: flat enough there
INSIDE = 16  # parts a searched step is cut into
NEAR = 0.9  # of the largest contact force so far: a maximum that may be above is searched for
SMOOTH = 0.05  # of a channel's value: three points closer than this carry a parabola


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
def ahead_of(s, y, yd, ahead):
    """Move y along y', and the poses with it."""
    for k in range(y.size):
        y[k] += ahead * yd[k]
    poses(s, y)


@internal
def force_rate(s, y, yd, t, ahead, c):
    """Rate of contact c's force at (t, y), by its channel a little before and after along y'.

    y is moved to and fro; it ends where the channel was looked at last.
    """
    ahead_of(s, y, yd, -ahead)
    before = force(s, t - ahead, c)
    ahead_of(s, y, yd, 2.0 * ahead)
    return (force(s, t + ahead, c) - before) / (2.0 * ahead)


@internal
def force(s, t, c):
    """The first channel of contact c, at the poses as they are."""
    call_one(s, s.measure, t, s.contact[c])
    return s.out[s.wanted[s.contact[c]]]


@internal
def near_peak(s, r, b, t, h, last):
    """Whether a contact force passes a maximum, one of its largest, inside the step just made.

    Fills b.slope1 with the rate of every contact force at the end of the step, all from one place
    a little ahead and from b.out.
    """
    rates, touching = b.slope1, False
    for c in range(s.contact.size):
        rates[c] = 0.0
        touching = touching or loaded(s, c)
    if not touching:
        return False
    ahead = AHEAD * h
    copy_to(b.y2, b.y1)
    ahead_of(s, b.y2, b.K[last], ahead)
    near = False
    for c in range(s.contact.size):
        if loaded(s, c):
            rates[c] = (force(s, t + ahead, c) - b.out[s.wanted[s.contact[c]]]) / ahead
            near = near or passes(s, r, b, c, h)
    return near


@internal
def loaded(s, c):
    """Whether contact c has a force, and a channel of it."""
    return s.mem[s.contact[c], PHASE] != FLIGHT and s.wanted[s.contact[c]] >= 0


@internal
def passes(s, r, b, c, h):
    """Whether the force of contact c has a maximum worth finding in the step of length h.

    It lies below the point where the tangents at both ends meet.
    """
    o, rise, fall = s.wanted[s.contact[c]], r.slope[c], b.slope1[c]
    if o < 0 or not (rise > 0.0 and fall < 0.0):
        return False
    start, end = r.peak[o, PEAK_V2], b.out[o]
    meet = min(max((end - start - fall * h) / (rise - fall), 0.0), h)
    return max(start + rise * meet, end) > NEAR * r.peak[o, PEAK_MAX]


@internal
def peaks_inside(s, r, b, interpolate, t, h, t1):
    """Extremes of all channels inside the step, from its dense output.

    The step is cut into parts, whose tops are refined by parabolas; and the maximum of every
    contact force is found as the root of its rate.
    """
    reach = (t1 - t) / h
    for c in range(s.contact.size):
        if loaded(s, c) and passes(s, r, b, c, t1 - t):
            top = summit(s, r, b, interpolate, t, h, reach, c)
            values_inside(s, r, b, interpolate, t, h, top)
            for o in range(s.n_out):
                extreme(r.peak[o], t + top * h, s.out[o])
    for k in range(1, INSIDE):
        values_inside(s, r, b, interpolate, t, h, reach * k / INSIDE)
        refine(s, r, s.out, t + reach * k / INSIDE * h)


@internal
def summit(s, r, b, interpolate, t, h, reach, c):
    """Where the force of contact c is largest, as theta: the root of its rate."""
    bracket = (0.0, r.slope[c], reach, b.slope1[c], 0.0)
    enough = FLAT * (r.slope[c] - b.slope1[c])
    for k in range(TRIALS):
        middle = between(bracket, k)
        values_inside(s, r, b, interpolate, t, h, middle)
        rate = force_rate(s, b.y2, b.K[1], t + middle * h, AHEAD * h, c)
        if abs(rate) < enough:
            return middle
        bracket = narrowed(bracket, middle, rate, False)
    return between(bracket, 3)


@internal
def values_inside(s, r, b, interpolate, t, h, theta):
    """All channels at t + theta h into s.out; the state in b.y2, its derivative in b.K[1]."""
    call_interpolate(interpolate, b.P, r.y, theta, b.y2)
    evaluate(s, t + theta * h, b.y2, b.K[1])
    measure(s, t + theta * h, b.y2, r.clock[WORK_PROJECTION], r.clock[ENERGY_0])
