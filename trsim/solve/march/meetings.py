"""Places where branches of the motion meet: searched for in a step, and known from then on."""

from math import cos

from trsim.assemble.projection import close_positions
from trsim.elements.contract import SCENE, compiled
from trsim.kernels import signatures as types
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1
from trsim.solve.march.illinois import between, narrowed
from trsim.solve.march.openings import CLOSED, NEWTON
from trsim.solve.march.own_rows import cosine, keep, own
from trsim.solve.march.record import RECORD

MEET = 3e-6  # sigma: rounding leaves some 1e-8 of one that is zero
APART = 1e-2  # pivots that do not take part
NEARER = 12  # places looked at, at most
REACHED = 1e-12  # of the mechanism's size
NEAR_ENOUGH = 1e-3  # of the square of sigma: it is not felt
# of the square of a way: the sum of those of both its ends from a known place next to it, which is
# 1.2 ways from its middle
AROUND = 3.5


@internal
def meet(s, r, b, last, part, k):
    """Whether branches meet in the part of a step where the row eliminated k-th turned round.

    Its sigma, negative behind that place, has a zero there along the cubic through both ends of
    the step and the rates there, brought to the constraints.  That place is left in b.rough[0];
    branches meet where no other pivot is small that is not zero too.
    """
    place, h = b.rough[0], b.t1 - b.t
    bracket = (part[0], s.kept_roots[0, k], part[1], -s.kept_roots[1, k], 0.0)
    about = min(s.kept_roots[0, k], s.kept_roots[1, k])
    for n in range(NEARER):
        x = between(bracket, n)
        inside(r, b, last, x, place)
        if not closed(s, b.t1 + (x - 1.0) * h, place, about):
            return False
        about = s.kept_roots[1, k]
        if about <= MEET:
            return closed(s, b.t1 + (x - 1.0) * h, place, 0.0) and alone(s, k)
        own(s, 1, k, 1)
        bracket = narrowed(bracket, x, about if cosine(s) > 0.0 else -about, False)
    return False


@internal
def closed(s, t, y, about):
    """Bring y to the constraints, and keep its rows; whether it gets there.

    about: how large sigma is next to it, which says how near to the constraints will do.
    """
    near = max(CLOSED, NEAR_ENOUGH * about * about)
    if not close_positions(s, t, y, near * s.size, NEWTON) < max(near, REACHED) * s.size:
        return False
    keep(s, t, y, 1, s.kept_roots[1])
    return True


@internal
def alone(s, k):
    """Whether the row eliminated k-th depends on others, and no row nearly does."""
    for j in range(s.first.size):
        sigma = s.kept_roots[1, j]
        if s.row[s.column_start[j]] < s.m and sigma > MEET and sigma * sigma < APART:
            return False
    return s.kept_roots[1, k] <= MEET


@internal
def inside(r, b, last, x, y):
    """y <- the cubic through both ends of the step at hand and their rates, at the part x of it."""
    y0, yd0, y1, yd1, h = r.y, r.yd, b.y1, b.K[last], b.t1 - b.t
    for k in range(y.size):
        by = y1[k] - y0[k]
        bent = (1.0 - x) * (h * yd0[k] - by) - x * (h * yd1[k] - by)
        y[k] = y0[k] + x * by + x * (1.0 - x) * bent


@compiled(types.int64(SCENE, RECORD, A1, A1))
def known(s, r, y0, y1):
    """Whether branches meet, as was found out before, between two states."""
    many = min(r.n_meetings, r.meeting.shape[0])
    most = AROUND * apart(s, y0, y1, 1e300) if many > 0 else 0.0
    for k in range(many):
        first = apart(s, r.meeting[k], y0, most)
        if first <= most and first + apart(s, r.meeting[k], y1, most - first) <= most:
            return 1
    return 0


@internal
def apart(s, y0, y1, most):
    """The square of the distance of two states, a turn taken times the mechanism's size.

    Where it is more than `most` a part of it that is more too.
    """
    total = 0.0
    for f in range(s.n_r - 1):
        if total > most:
            return total
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
