"""Steps that may have gone past a place where branches of the motion meet, or nearly meet.

sigma, the root of the smallest pivot of S, is how far the rows of J are from depending on each
other.  Where branches meet it goes to zero and up again, and has a sign that changes there; steps
see |sigma| at their ends only.  A step is noted where sigma, continued along a line from the step
before or back from the step after, would have lost most of itself in it.  What became of the
branch in it is found out later, by crossed.py.  Where branches are known to meet nothing is noted.
"""

from math import cos, sqrt

from trsim.assemble.equations import constraints, poses
from trsim.assemble.linear import diagonal, eliminate, factorise, smallest_pivot
from trsim.assemble.projection import move_all, project_positions
from trsim.assemble.schur import rows
from trsim.elements import signatures as types
from trsim.elements.calls import caller
from trsim.elements.contract import SCENE, compiled
from trsim.elements.packed import A1, f8, i8
from trsim.elements.vectors import copy_to, internal
from trsim.solve.record import (
    BUFFERS,
    FALLING,
    LAST_H,
    MEETINGS,
    NOTED,
    PASSED,
    PIVOT,
    RECORD,
    SIGMA,
    SIGMAS,
    T,
)

LEFT = 0.3  # of sigma: a line that comes below that is looked at
PART = 0.7  # rad, or of the mechanism's size: inside longer steps sigma is looked at too
FINE = 0.2  # the same with redundant rows, where those of the solve come close to others too
STEEP, STEEPER = 1.5, 4.0  # by how much sigma changes per radian, at most, without and with these
MANY = 16  # parts of a step, at most
MEET = 3e-6  # sigma: rounding leaves some 1e-8 of one that is zero
APART = 1e-2  # pivots that do not take part
NEARER, GAIN = 12, 0.6  # how often; what is left of sigma each time, at most
SLOWEST = 1e-3  # 1/rad: how fast sigma goes to zero, at least
FINEST = 1e-15  # of the diagonal: rounding of a pivot
NEWTON, CLOSED, REACHED = 12, 1e-14, 1e-12  # steps; of the mechanism's size
NEAR_ENOUGH = 1e-3  # of the square of sigma: it is not felt
AROUND = 1.5  # of the square of a way: how far from its middle a known place is next to it

#                   scene  record  buffers end of the step
PASSES = types.void(SCENE, RECORD, BUFFERS, f8, i8)
call_passes = caller(PASSES)


@compiled(PASSES)
def note_passes(s, r, b, t1, last):
    """Look at the step to b.y1, which is about to be accepted; notes it, or the one before it.

    last: the row of b.K with its derivative.
    """
    if not s.near_rows > 0.0:
        return
    t, pivot = r.clock[T], r.clock[PIVOT]
    h = t1 - t
    if not h > 0.0:
        return
    if r.count[SIGMAS] == 0:
        r.clock[SIGMA], r.count[SIGMAS] = sigma(s, t, r.y), 1
        copy_to(r.seen, r.y)
    parts = 1
    way = h * fastest(s, b.y1)
    longest = PART if s.redundant.shape[0] == 0 else FINE
    steepest = STEEP if s.redundant.shape[0] == 0 else STEEPER
    if way > longest and r.clock[SIGMA] + sqrt(max(pivot, 0.0)) < steepest * way:
        parts = min(int(way / longest) + 1, MANY)
        for k in range(1, parts):
            x = k / parts
            inside(r.y, r.yd, b.y1, b.K[last], h, x, b.y2)
            look(s, r, b, t + (k - 1) / parts * h, t + x * h, b.y2, sigma(s, t + x * h, b.y2))
    look(s, r, b, t + (parts - 1) / parts * h, t1, b.y1, sqrt(max(pivot, 0.0)))


@internal
def look(s, r, b, t, t1, y, now):
    """Whether sigma seems to go through zero on the way to y, or did on the way before it."""
    h, before, noted = t1 - t, r.clock[SIGMA], 0
    falling = (before - now) / h
    if r.count[SIGMAS] == 2:
        if before - r.clock[FALLING] * h < LEFT * before:
            note(s, r, b, t, t1, r.seen, y, before / (before + now + 1e-300))
            noted = 1
        if r.count[NOTED] == 0 and before + falling * r.clock[LAST_H] < LEFT * before:
            last = before + max(r.clock[FALLING], 0.0) * r.clock[LAST_H]
            note(s, r, b, t - r.clock[LAST_H], t, r.behind, r.seen, last / (last + before + 1e-300))
    r.clock[SIGMA], r.clock[FALLING], r.clock[LAST_H] = now, falling, h
    r.count[SIGMAS], r.count[NOTED] = 2, noted
    copy_to(r.behind, r.seen)
    copy_to(r.seen, y)


@internal
def sigma(s, t, y):
    """The root of the smallest pivot of S."""
    counted = s.status[2]
    poses(s, y)
    constraints(s, t)
    rows(s)
    factorise(s)
    s.status[2] = counted
    return sqrt(max(smallest_pivot(s), 0.0))


@internal
def fastest(s, y):
    """The fastest rate of a body or a node, rad/s or sizes/s."""
    along = turning = 0.0
    first = 2 if s.d == 3 else 3
    for f in range(s.n_r - 1):
        o = s.n_q + s.d * f
        for c in range(first):
            along = max(along, abs(y[o + c]))
        for c in range(first, s.d):
            turning = max(turning, abs(y[o + c]))
    for k in range(s.v_node, s.n_v):
        along = max(along, abs(y[s.n_q + k]))
    return max(along / s.size, turning)


@internal
def inside(y0, yd0, y1, yd1, h, x, y):
    """y <- the cubic through both ends of a step and their rates, at the part x of it."""
    for k in range(y.size):
        by = y1[k] - y0[k]
        bent = (1.0 - x) * (h * yd0[k] - by) - x * (h * yd1[k] - by)
        y[k] = y0[k] + x * by + x * (1.0 - x) * bent


@internal
def note(s, r, b, t0, t1, y0, y1, part):
    """A line in r.passed: times, states and branches of angles.

    part: of the way to where sigma is zero.  Where it is, the place is kept instead.
    """
    if r.count[PASSED] == r.passed.shape[0] or known(s, r, y0, y1) > 0:
        return
    if s.redundant.shape[0] == 0 and meet(s, b, t0, t1, y0, y1, part):
        copy_to(r.meeting[r.count[MEETINGS] % r.meeting.shape[0]], b.rough[0])
        r.count[MEETINGS] += 1
        return
    line, n = r.passed[r.count[PASSED]], y0.size
    line[0], line[1] = t0, t1
    for k in range(n):
        line[2 + k], line[2 + n + k] = y0[k], y1[k]
    for k in range(r.branch.size):
        line[2 + 2 * n + k] = r.branch[k]
    r.count[PASSED] += 1


@internal
def meet(s, b, t0, t1, y0, y1, part):
    """Whether sigma goes to zero next to a way, and then with no other pivot that does not.

    From the best place so far it looks where a line comes to zero, ahead and behind.  Leaves the
    place in b.rough[0].
    """
    best, trial = b.rough[0], b.rough[1]
    for k in range(best.size):
        best[k] = y0[k] + part * (y1[k] - y0[k])
    t, h, rate = t0 + part * (t1 - t0), t1 - t0, fastest(s, y0)
    now = least(s, t, best, 0.1)
    steep = 1.0  # 1/rad
    for _ in range(NEARER):
        if now <= MEET:  # of a place that is on the constraints for certain?
            now = least(s, t, best, 0.0)
        if now <= MEET or not rate > 0.0:
            break
        d, found, farther = now / (steep * rate), -1.0, now
        for side in range(2):
            x = d if side == 0 else -d
            copy_to(trial, best)
            for k in range(s.n_v):
                b.rough[2, k] = x * best[s.n_q + k]
            move_all(s, trial, b.rough[2])
            for k in range(s.n_z):
                at = s.n_q + s.n_v + k
                trial[at] += x / h * (y1[at] - y0[at])
            there = least(s, t + x, trial, now)
            farther = max(farther, there)
            if there < GAIN * now and (found < 0.0 or there < found):
                found, t_found = there, t + x
                copy_to(b.unmoved[2], trial)
        if found < 0.0:
            return False
        steep = max(steep * (farther - now) / now, SLOWEST)
        now, t = found, t_found
        copy_to(best, b.unmoved[2])
        rate = fastest(s, best)
    if not least(s, t, best, 0.0) <= MEET:
        return False
    for k in range(s.first.size):
        place = s.column_start[k]
        share = s.value[place] / s.first[k]
        if s.row[place] < s.m and MEET * MEET < share < APART:
            return False
    return True


@internal
def least(s, t, y, about):
    """sigma of y brought to the constraints; 1 where it does not get there.

    about: how large sigma is next to it, which says how near to the constraints will do.
    """
    near, worst = max(CLOSED, NEAR_ENOUGH * about * about), 1e300
    for _ in range(NEWTON):
        worst = project_positions(s, t, y)
        if not worst > near * s.size:
            break
    if not worst < max(near, REACHED) * s.size:
        return 1.0
    poses(s, y)
    constraints(s, t)
    rows(s)
    diagonal(s)
    eliminate(s, FINEST)
    smallest = 1.0
    for k in range(s.first.size):
        place = s.column_start[k]
        if s.row[place] < s.m:
            smallest = min(smallest, s.value[place] / s.first[k])
    return sqrt(max(smallest, 0.0))


@compiled(types.int64(SCENE, RECORD, A1, A1))
def known(s, r, y0, y1):
    """Whether branches meet, as was found out before, between two states."""
    for k in range(min(r.count[MEETINGS], r.meeting.shape[0])):
        place = r.meeting[k]
        if away(s, place, y0, y1) <= AROUND * apart(s, y0, y1):
            return 1
    return 0


@internal
def apart(s, y0, y1):
    """The square of the distance of two states, a turn taken times the mechanism's size."""
    total = 0.0
    for f in range(s.n_r - 1):
        if s.d == 3:
            q = 3 * f
            total += (y1[q] - y0[q]) ** 2 + (y1[q + 1] - y0[q + 1]) ** 2
            total += 2.0 * s.size**2 * (1.0 - cos(y1[q + 2] - y0[q + 2]))
            continue
        q, along = 7 * f, 0.0
        for a in range(3):
            total += (y1[q + a] - y0[q + a]) ** 2
        for a in range(3, 7):
            along += y1[q + a] * y0[q + a]
        total += 8.0 * s.size**2 * (1.0 - abs(along))
    for k in range(s.q_node, s.n_q):
        total += (y1[k] - y0[k]) ** 2
    return total


@internal
def away(s, place, y0, y1):
    """The square of the distance of a place from the middle of two states."""
    return 0.5 * (apart(s, place, y0) + apart(s, place, y1)) - 0.25 * apart(s, y0, y1)
