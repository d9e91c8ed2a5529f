"""Steps that may have gone past a place where branches of the motion meet, or nearly meet.

Where branches meet, sigma_k, the size of what a row has of its own (d_k, see own_rows.py), goes to
zero and up again as the size of what changes its sign there.  Steps see sizes only, but behind such
a place d_k has turned round.  On its branch, which bends away before it, it turns by a right angle
at most.  So a step is noted where

    d_k(0) M^-1 d_k(1)^T <= PLAINLY |d_k(0)| |d_k(1)|

for a row that may have: one whose sigma, with the sign changed, is about as far from a straight
line through the ends of this step and the last one as it is without.  What became of the branch is
found out later, by crossed.py.  Where branches are known to meet nothing is noted.
"""

from trsim.assemble.projection import close_positions
from trsim.elements.contract import SCENE, compiled
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import i8
from trsim.kernels.vectors import copy_table, copy_to
from trsim.solve.march.meetings import inside, known, meet
from trsim.solve.march.openings import CLOSED, NEWTON
from trsim.solve.march.own_rows import (
    begun_in,
    ends_in,
    keep,
    keep_roots,
    keep_rows,
    look_at,
    turned_round,
)
from trsim.solve.march.record import BUFFERS, RECORD
from trsim.solve.march.turns import fastest_in_loops

LONGEST = 0.2  # rad, or of the mechanism's size: of a part of a step
MANY = 32  # parts, at most
STEEPEST = 10.0  # 1/rad: by how much sigma changes
PLAINER, BENT = 4.0, 8.0  # times as far; 1/rad^2, by how much sigma bends
SHARE = 0.75  # of sigma at both ends: the most of that

#                   scene  record  buffers  row of the derivative at the end of the step
PASSES = types.void(SCENE, RECORD, BUFFERS, i8)
call_passes = caller(PASSES)


@compiled(PASSES)
def note_passes(s, r, b, last):
    """Look at the step to b.y1, which is about to be accepted; notes it, or parts of it.

    last: the row of b.K with its derivative.
    """
    h = b.t1 - b.t
    if not h > 0.0:
        return
    if r.kept == 0:
        keep(s, b.t, r.y, begun_in(r), s.root[1])
        r.last_way, r.kept = 0.0, 1
    way = h * max(fastest_in_loops(s, r.y), fastest_in_loops(s, b.y1))
    if may_turn(s, s.root, way, r.last_way):
        look_at_parts(s, r, b, last, way)
    copy_to(s.root[0], s.root[1])
    copy_to(s.root[1], s.root[2])
    r.last_way, r.kept = way, 3 - r.kept


@internal
def look_at_parts(s, r, b, last, way):
    """Note the parts of a step in which a row turned round: of those that may have, to look closer.

    Places inside are those of the cubic; where one of both ends of a part, on the constraints.
    """
    y0, y1, t, h = b.part[0], b.part[1], b.t, b.t1 - b.t
    n, roots, before = min(int(way / LONGEST) + 1, MANY), s.part_root, r.last_way
    copy_table(roots, s.root)
    one, other = begun_in(r), ends_in(r)
    for k in range(1, n + 1):
        if k < n:
            other = k % 2
            keep_inside(s, r, b, last, k / n, other)
            keep_roots(s, roots[2])
        else:
            other = ends_in(r)
            copy_to(roots[2], s.root[2])
        if may_turn(s, roots, way / n, before):
            inside(r, b, last, (k - 1) / n, y0)
            inside(r, b, last, k / n, y1)
            start, end = t + (k - 1) / n * h, t + k / n * h
            if known(s, r, y0, y1) == 0:
                ways = (way / n, before)
                if turned(s, roots, ways, one, other) >= 0:
                    close_positions(s, start, y0, CLOSED * s.size, NEWTON)
                    close_positions(s, end, y1, CLOSED * s.size, NEWTON)
                    note_turned(s, r, b, last, ((k - 1) / n, k / n), ways)
                    if k < n:  # others took their place
                        keep_inside(s, r, b, last, k / n, other)
        copy_to(roots[0], roots[1])
        copy_to(roots[1], roots[2])
        before, one = way / n, other


@internal
def keep_inside(s, r, b, last, x, place):
    """Keep the rows at the part x of the step, on the cubic."""
    inside(r, b, last, x, b.part[1])
    look_at(s, b.t + x * (b.t1 - b.t), b.part[1])
    keep_rows(s, place)


@internal
def may_turn(s, roots, way, last):
    """Whether a row may have turned round on the second of two ways, by sigma at their ends.

    last: the length of the first one; 0: there is none.
    """
    for k in range(s.first.size):  # noqa: SIM110 - a generator does not compile
        if row_may_turn(s, roots, way, last, k):
            return True
    return False


@internal
def row_may_turn(s, roots, way, last, k):
    """Whether that one may have, which is eliminated k-th."""
    before, now = roots[1, k], roots[2, k]
    if before + now >= STEEPEST * way or s.row[s.column_start[k]] >= s.m:
        return False
    if not last > 0.0:
        return True
    along = before - (roots[0, k] - before) * way / last
    bent = min(BENT * way * (way + last), SHARE * (before + now))
    return abs(now + along) <= PLAINER * abs(now - along) + bent


@internal
def turned(s, roots, ways, one, other):
    """Which row turned round between the states whose rows are kept in two places, in the order of
    elimination; -1 if none did.

    Of those that may have on the second of two ways, which ends there: `row_may_turn`.
    """
    for k in range(s.first.size):
        if row_may_turn(s, roots, ways[0], ways[1], k) and turned_round(s, k, one, other):
            return k
    return -1


@internal
def note_turned(s, r, b, last, part, ways):
    """Note a part of a step in which a row turned round, by the states at its ends, in b.part.

    Where that is because branches meet, the place is kept instead.
    """
    y0, y1, h = b.part[0], b.part[1], b.t1 - b.t
    start, end = b.t + part[0] * h, b.t + part[1] * h
    keep(s, start, y0, 0, s.kept_roots[0])
    keep(s, end, y1, 1, s.kept_roots[1])
    k = turned(s, s.part_root, ways, 0, 1)
    if k < 0:
        return
    if s.redundant.shape[0] == 0 and meet(s, r, b, last, part, k):
        copy_to(r.meeting[r.n_meetings % r.meeting.shape[0]], b.rough[0])
        r.n_meetings += 1
        return
    note(r, start, end, y0, y1)


@internal
def note(r, t0, t1, y0, y1):
    """A line in r.passed: times, states and branches of angles."""
    if r.n_passed == r.passed.shape[0]:
        return
    line, n = r.passed[r.n_passed], y0.size
    line[0], line[1] = t0, t1
    for k in range(n):
        line[2 + k], line[2 + n + k] = y0[k], y1[k]
    for k in range(r.branch.size):
        line[2 + 2 * n + k] = r.branch[k]
    r.n_passed += 1
