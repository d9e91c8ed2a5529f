"""User events inside a step: where a sensor crosses the value a scenario watches it for.

What is watched, less its value, is g; like a phase of a contact the side it is on (below, above, or
AT the value) is a discrete state.  An event happens where g goes to the other side in the direction
asked for, and leaves the state AT; a side is taken again once g has left the value by more than its
band.  So an event does not happen at a start on the value, not twice at once where its own action
turns the motion round or stops it there, and not where g touches the value and turns back.

In the tables of gaps and of roots the watched sensors follow the contacts.
"""

from trsim.assemble.equations import gaps
from trsim.assemble.outputs import call_hear
from trsim.assemble.travel import CLOCK
from trsim.kernels.lazy import internal
from trsim.solve.march.events import NONE, SAME, fall, inside, leaves, stays, watched, way_of
from trsim.solve.march.record import JUST_NOW, PEAK_MAX, PEAK_MIN, SIDE, TIMES
from trsim.solve.march.spread import spread_at_stages

BELOW, AT, ABOVE = -1.0, 0.0, 1.0
ENTRY, DIRECTION, MOST = range(3)  # columns of s.watch
VALUE, BAND = range(2)  # of s.watch_at
PASSED = 1000  # crossings in the other direction that one step may have


@internal
def see(s, t, y, gap, branch, turning):
    """Gaps of contacts, what is watched, and angles, each with its rate, at y, which was evaluated
    last: into a table of gaps, and into two of angles."""
    if s.hear != 0:
        call_hear(s.hear, s, t, y)
    if s.contact.size > 0:
        gaps(s, t)
    for c in range(s.contact.size):
        gap[c, 0], gap[c, 1] = s.gap[s.contact[c], 0], s.gap[s.contact[c], 1]
    for k in range(s.watch.shape[0]):
        gap[s.contact.size + k, 0], gap[s.contact.size + k, 1] = watched(s, t, k)
    for k in range(s.n_s):
        branch[k], turning[k] = s.S[k, 0], s.S[k, 1]


@internal
def heard(s, k):
    """Whether event k watches a channel, see heard.py."""
    return s.hear != 0 and s.heard[k] >= 0


@internal
def band_of(s, r, k):
    """How far event k's value must be left to be on a side of it; of a channel the tolerance, of
    the largest it has been."""
    if not heard(s, k):
        return s.watch_at[k, BAND]
    column, size = s.heard[k], abs(s.watch_at[k, VALUE])
    high, low = r.peak[PEAK_MAX, column], r.peak[PEAK_MIN, column]
    if high >= low:
        size = max(size, abs(high), abs(low))
    return s.tolerance * size


@internal
def take_sides(s, r):
    """The state of what is watched, after an accepted step: the side it is on, or the one it had
    before while it lies within the band."""
    for k in range(s.watch.shape[0]):
        g = r.gap[s.contact.size + k, 0]
        if not abs(g) <= band_of(s, r, k):
            r.watch[k, SIDE] = ABOVE if g > 0.0 else BELOW


@internal
def starting_side(r, c, k):
    """The side a step begins on; from AT the value the rate leads to one."""
    if r.watch[k, SIDE] != AT:
        return r.watch[k, SIDE]
    return ABOVE if r.gap[c, 1] > 0.0 else BELOW


@internal
def may_cross(s, r, b, k, stages):
    """Whether the step must be searched for event k, as far as is known without looking."""
    c = s.contact.size + k
    if r.watch[k, TIMES] >= s.watch[k, MOST]:
        return False
    if heard(s, k):
        return True
    side, band = starting_side(r, c, k), s.watch_at[k, BAND]
    f0, r0 = side * r.gap[c, 0], side * r.gap[c, 1]
    f1, r1 = side * b.gap1[c, 0], side * b.gap1[c, 1]
    if f1 < 0.0 or (f1 == 0.0 and r1 < 0.0):
        return r.watch[k, SIDE] != AT or -f1 > band
    if s.travel[c, 0] == CLOCK:
        return False
    if stages == 0:
        return True
    bounds = spread_at_stages(s, r, b, s.travel[c], side)
    return not stays((f0 + band, r0), (f1 + band, r1), bounds, b.h, s.kink[c])


@internal
def departure(s, r, b, way, end):
    """The side on which g first leaves the band it is in, and a place in the step beyond it.

    way: see `way_of`, with the side it is on and the band.  What rested on the value has a rate
    that is rounding, so no side is to be taken from it.  The place is less than 0 where g stays in
    the band.
    """
    c, side, band, depth = way
    g, rate = side * r.gap[c, 0], side * r.gap[c, 1]
    one = leaves(s, r, b, way, (0.0, g, rate), end)
    other = leaves(s, r, b, (c, -side, band, depth), (0.0, -g, -rate), end)
    return (side, one) if other < 0.0 or 0.0 <= one <= other else (-side, other)


@internal
def crossing(s, r, b, setting, k, end):
    """Where event k first happens in the step, as theta in (0, end]; NONE if it does not.

    A crossing in the direction that is not asked for is passed, and the next one looked for.
    """
    if r.watch[k, TIMES] >= s.watch[k, MOST]:
        return NONE
    c, want, band = s.contact.size + k, s.watch[k, DIRECTION], s.watch_at[k, BAND]
    side, low = starting_side(r, c, k), 0.0
    g, rate = r.gap[c, 0], r.gap[c, 1]
    if r.watch[k, SIDE] == AT and abs(g) <= band:
        side, low = departure(s, r, b, way_of(s, r, setting, c, side, band), end)
        if low < 0.0 or low >= end:
            return NONE
        g, rate = inside(s, r, b, c, low)
    for passed in range(PASSED):
        if side * g <= 0.0:
            at = r.watch[k, SIDE] == AT or passed > 0
            left = -1.0
            if at or side * rate >= 0.0:
                way = way_of(s, r, setting, c, side, band if at else 0.0)
                left = leaves(s, r, b, way, (low, side * g, side * rate), end)
            if left < 0.0:
                # on the value, or inside its band, and on to the other side
                ahead, _ = inside(s, r, b, c, end)
                if at or (side * rate >= 0.0 and side * ahead >= -band):
                    return NONE
                if want == 0 or want == -side:
                    return SAME
                side, g = -side, 0.0
                continue
            low = left
            g, rate = inside(s, r, b, c, low)
        if low >= end:
            break
        way = way_of(s, r, setting, c, side, band)
        root = fall(s, r, b, way, (low, side * g, side * rate), end)
        if root > end or want == 0 or want == -side:
            return root
        side, low = -side, root
        g, rate = inside(s, r, b, c, low)
        if side * g > 0.0:
            g = 0.0  # on the value, whatever rounding says
    return NONE


@internal
def fire(s, r, b, first):
    """Mark the events whose root is the one just stepped to; how many there are."""
    fired = 0
    for k in range(s.watch.shape[0]):
        if b.root[s.contact.size + k] <= first + SAME:
            r.watch[k, SIDE] = AT
            r.watch[k, TIMES] += 1.0
            r.watch[k, JUST_NOW] = 1.0
            fired += 1
    r.events += fired
    r.fired = fired
    return fired
