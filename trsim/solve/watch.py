"""User events inside a step: where a sensor crosses the value a scenario watches it for.

What is watched, less its value, is g; like a phase of a contact the side it is on (below, above, or
AT the value) is a discrete state.  An event happens where g goes to the other side in the direction
asked for, and leaves the state AT; a side is taken again once g has left the value by more than its
band.  So an event does not happen at a start on the value, not twice at once where its own action
turns the motion round or stops it there, and not where g touches the value and turns back.

In the tables of gaps and of roots the watched sensors follow the contacts.
"""

from trsim.assemble.equations import call_one
from trsim.assemble.switches import LIMITS
from trsim.elements.vectors import internal
from trsim.solve.events import NONE, SAME, bracketed_root, inside, turning_value
from trsim.solve.record import EVENTS, FIRED, JUST_NOW, SIDE, TIMES

BELOW, AT, ABOVE = -1.0, 0.0, 1.0
ENTRY, DIRECTION, MOST = range(3)  # columns of s.watch
VALUE, BAND = range(2)  # of s.watch_at
HALVINGS = 60  # of a step, in the search for a point that has left the value


@internal
def watch(s, t, gap):
    """Put g and its rate into the last rows of a table of gaps, at the poses of the scene."""
    first = s.contact.size
    for k in range(s.watch.shape[0]):
        entry = s.watch[k, ENTRY]
        if entry <= LIMITS:
            call_one(s, s.gaps, t, LIMITS - entry)
            gap[first + k, 0] = s.gap[LIMITS - entry, 0]
            gap[first + k, 1] = s.gap[LIMITS - entry, 1]
        elif entry < 0:
            gap[first + k, 0], gap[first + k, 1] = t - s.watch_at[k, VALUE], 1.0
        else:
            gap[first + k, 0] = s.S[entry, 0] - s.watch_at[k, VALUE]
            gap[first + k, 1] = s.S[entry, 1]


@internal
def side_of(s, k, g, before):
    """The side of g; the one it had before while it lies within the band."""
    if abs(g) <= s.watch_at[k, BAND]:
        return before
    return ABOVE if g > 0.0 else BELOW


@internal
def take_sides(s, r):
    """The state of what is watched, after an accepted step."""
    for k in range(s.watch.shape[0]):
        r.watch[k, SIDE] = side_of(s, k, r.gap[s.contact.size + k, 0], r.watch[k, SIDE])


@internal
def starting_side(r, c, k):
    """The side a step begins on; from AT the value the rate leads to one."""
    if r.watch[k, SIDE] != AT:
        return r.watch[k, SIDE]
    return ABOVE if r.gap[c, 1] > 0.0 else BELOW


@internal
def may_cross(s, r, b, k, h):
    """Whether the step must be searched for event k: g is on the other side, or turned inside."""
    c = s.contact.size + k
    if r.watch[k, TIMES] >= s.watch[k, MOST]:
        return False
    side, g1 = starting_side(r, c, k), b.gap1[c, 0]
    if side * g1 < 0.0 or (g1 == 0.0 and side * b.gap1[c, 1] < 0.0):
        return r.watch[k, SIDE] != AT or abs(g1) > s.watch_at[k, BAND]
    g0, r0, r1 = -side * r.gap[c, 0], -side * r.gap[c, 1], -side * b.gap1[c, 1]
    return r0 > 0.0 > r1 and turning_value(g0, r0, -side * g1, r1, h) > 0.0


@internal
def crossing(s, r, b, t, h, k, interpolate):
    """Where event k first happens in the step, as theta in (0, 1]; NONE if it does not."""
    if not may_cross(s, r, b, k, h):
        return NONE
    c, P, y, scratch = s.contact.size + k, b.P, r.y, b.y2
    side, want = starting_side(r, c, k), s.watch[k, DIRECTION]
    low, high, away = 0.0, 1.0, want == 0 or want == -side
    g1, r1 = b.gap1[c, 0], b.gap1[c, 1]
    if side * g1 > 0.0 or (g1 == 0.0 and side * r1 >= 0.0):
        # turned inside: through the value and back, or not as far
        turn = bracketed_root(s, P, y, t, h, c, scratch, interpolate, 0.0, 1.0, 1, r1 > 0.0)
        reached = inside(s, P, y, t, h, turn, c, scratch, interpolate)[0]
        if side * reached >= -s.watch_at[k, BAND]:
            return NONE
        if not away:
            return bracketed_root(s, P, y, t, h, c, scratch, interpolate, turn, 1.0, 0, side > 0.0)
        high = turn
    if not away:
        return NONE
    if g1 == 0.0:
        return 1.0
    if side * r.gap[c, 0] <= 0.0:
        low = left_value(s, r, b, t, h, c, side, high, interpolate)
        if low == 0.0:
            return NONE if r.watch[k, SIDE] == AT else SAME
    return bracketed_root(s, P, y, t, h, c, scratch, interpolate, low, high, 0, side < 0.0)


@internal
def left_value(s, r, b, t, h, c, side, high, interpolate):
    """A place of a step that begins at the value where g lies on its side; 0 if there is none."""
    part = high
    for _ in range(HALVINGS):
        part *= 0.5
        if side * inside(s, b.P, r.y, t, h, part, c, b.y2, interpolate)[0] > 0.0:
            return part
    return 0.0


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
    r.count[EVENTS] += fired
    r.count[FIRED] = fired
    return fired
