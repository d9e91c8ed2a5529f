"""Turns of angles that are known up to full turns: no step is so long that one could be lost.

The angle of a joint in space is read off two axes, and unwrapped to the value next to that at the
last accepted point: right as long as it goes less than half a turn from there.  With r its rate,

    h |r| <= MOST                                at both ends of a step of length h
    |s_1 - s_0 - h (r_0 + r_1) / 2| <= ASIDE     between them

or the step is made again, shorter.  A turn that is lost puts the second one out by a full turn.
Angles of bodies in the plane are sums of coordinates and have no such bound.
"""

from math import sqrt

from trsim.assemble.waves import call_swings
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_to
from trsim.solve.march.spread import coordinates_of

MOST, ASIDE = 2.0, 1.0  # rad; half a turn is 3.14
WHOLE = 50.0  # rad: the most a body turns by in a step where points of sections are looked for
MOST_WAVES = 200.0  # rad: the same of waves in functions that make a section's channel swing
IN_LOOPS = 1.0  # rad, or of the mechanism's size: the most a body in a loop moves by
# rad of a pulse in a load, 1/(1 + u^2), that a step sees: of 12 stages, and of three
PULSE, PULSE_OF_FEW = 8.0, 4.0
BEYOND = 1.5  # times that in a step that was made
BRIEF = 1e-9  # of a run: no shorter step is asked for
NEXT = 0.9  # of MOST: what the next step may turn a joint by at its present rate


@internal
def too_far(s, r, b, h):
    """Whether some joint turns further in the step just landed than is sure to be counted."""
    for n in range(s.wound.size):
        k = s.wound[n]
        rate, rate1 = r.turning[k], b.turning1[k]
        if h * max(abs(rate), abs(rate1)) > MOST:
            return True
        if abs(b.branch1[k] - r.branch[k] - 0.5 * h * (rate + rate1)) > ASIDE:
            return True
    return False


@internal
def swings_in(address, s, b, stretch, before, behind):
    """The fastest wave or pulse, rad/s, in a stretch of time, (t, length).

    before, behind: what sensors show at its ends, and the rates of that.
    """
    copy_to(b.at_ends[0], before[0])
    copy_to(b.at_ends[1], before[1])
    copy_to(b.at_ends[2], behind[0])
    copy_to(b.at_ends[3], behind[1])
    return call_swings(address, s, stretch[0], stretch[1], b.at_ends)


@internal
def longest_turn(s, r, b):
    """The longest step that turns no joint by more than is sure to be counted, s.

    Nor is a turn passed over that is judged, as that of a bushing.  Where points of sections are
    looked for, or channels are watched, none turns a body by more than WHOLE, and no wave by more
    than MOST_WAVES, at the rates of its start; unseen() says so of its end.  In loops none moves a
    body further than passes.py can follow what becomes of its rows.
    """
    longest = 1e300
    if s.section.shape[0] + s.heard.size > 0:
        longest = WHOLE / max(fastest(s, r.y, r.yd), 1e-300)
    if s.wave.size > 0:
        now = (r.branch, r.turning)
        w = swings_in(s.swings_at, s, b, (r.t, 0.0), now, now)
        longest = min(longest, MOST_WAVES / max(w, 1e-300))
    if s.looped.size > 0:
        longest = min(longest, IN_LOOPS / max(fastest_in_loops(s, r.y), 1e-300))
    for n in range(s.judged.shape[0]):
        rate = turning(s, r.y, s.judged[n, 0]) + turning(s, r.y, s.judged[n, 1])
        longest = min(longest, NEXT * MOST / max(rate, 1e-300))
    for n in range(s.wound.size):
        longest = min(longest, NEXT * MOST / max(abs(r.turning[s.wound[n]]), 1e-300))
    return longest


@internal
def unseen(s, r, b, last, h):
    """Whether more happens in a step, just landed, than sections and events can follow."""
    if h * fastest(s, b.y1, b.K[last]) > 2.0 * WHOLE:
        return True
    return s.wave.size > 0 and h * waves_in(s, r, b, h) > 2.0 * MOST_WAVES


@internal
def before_pulses(s, r, b, h, most, brief):
    """How much of a step to try, so that it passes over no pulse of a load, going on as it does.

    Not less than `brief`, s: towards a pole that the rest of a function takes away, as in
    1/(1 + 1/u^2), pulses get ever shorter.
    """
    while h > brief:
        for k in range(r.branch.size):
            b.branch1[k] = r.branch[k] + h * r.turning[k]
        now, then = (r.branch, r.turning), (b.branch1, r.turning)
        w = swings_in(s.beats_at, s, b, (r.t, h), now, then)
        if h * w <= most:
            break
        h *= 0.5
    return h


@internal
def beats_in(s, r, b):
    """How much of a pulse of a load may lie in the step that just landed, rad."""
    now, then = (r.branch, r.turning), (b.branch1, b.turning1)
    return b.h * swings_in(s.beats_at, s, b, (b.t, b.h), now, then)


@internal
def pulse(implicit):
    """How much of a pulse the stages of a step see, rad."""
    return PULSE_OF_FEW if implicit > 0 else PULSE


@internal
def waves_in(s, r, b, h):
    """The fastest wave, rad/s, in what makes channels swing in such a step."""
    now, then = (r.branch, r.turning), (b.branch1, b.turning1)
    return swings_in(s.swings_at, s, b, (b.t, h), now, then)


@internal
def turning(s, y, f):
    """The angular velocity of a rigid body, rad/s; 0 of the ground and of nodes."""
    if f == 0 or f >= s.n_r:
        return 0.0
    o = s.n_q + s.d * (f - 1)
    if s.d == 3:
        return abs(y[o + 2])
    return sqrt(y[o + 3] ** 2 + y[o + 4] ** 2 + y[o + 5] ** 2)


@internal
def fastest_in_loops(s, y):
    """The fastest rate of a body in a loop, or of a node, rad/s or sizes/s."""
    along = turning = 0.0
    first = 2 if s.d == 3 else 3
    for f in s.looped:
        o = s.n_q + s.d * (f - 1)
        for c in range(first):
            along = max(along, abs(y[o + c]))
        for c in range(first, s.d):
            turning = max(turning, abs(y[o + c]))
    for k in range(s.v_node, s.n_v):
        along = max(along, abs(y[s.n_q + k]))
    return max(along / s.size, turning)


@internal
def fastest(s, y, yd):
    """The largest angular velocity of a frame, rad/s, from the rates of its attitude."""
    most = 0.0
    for f in range(1, s.n):
        q, places, attitude = coordinates_of(s, f)
        rate = size = 0.0
        for c in range(q + places, q + places + attitude):
            rate += yd[c] * yd[c]
            size += y[c] * y[c]
        if attitude > 1:  # of a direction, or of a quaternion, which turns half as fast
            rate *= (4.0 if attitude == 4 else 1.0) / max(size, 1e-300)
        most = max(most, rate)
    return sqrt(most)
