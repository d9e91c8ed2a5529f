"""Accelerations where branches of the motion meet: the limit along the motion.

With the rows of J dependent (w^T J = 0) the equations of motion leave some accelerations open:
cranks lying flat could go on as a parallelogram or fold.  Which of them is true follows from rows
that only appear as the motion goes on,

    w^T J(q + d v) / d  ->  w^T J'      J' = dJ/dt,      w^T J' a = what third derivatives ask for

and next to such a place, on the branch that the velocities are on, J has its full rank.  So the
motion is followed by d to both sides, brought to the constraints there, and the accelerations are
those between, of the polynomial in d^2 through the last pairs of places:

    a(d) = (a_ahead + a_behind) / 2,        a = a(d) + c_1 d^2 + ... + c_4 d^8 + O(d^10)

d is made smaller until that no longer changes.  Of a place at delta from where branches meet
rounding makes eps/delta^3 (below), so the order is high and d is large: with 0.08 to 0.02 rad what
is left out is 1e-13 of a motion that turns by a radian, and rounding 1e-10.  Pairs of which one
place is nearer to where branches meet than the place itself are passed over.  Forces are those of
the place itself, so stiff ones do not matter.  Reactions of the rows that depend on each other grow
like 1/d with another sign on the other side; what is given is the mean of both.  Where nothing
moves, or rows depend on each other beside the place too, nothing is changed.

Close to such a place, delta from it, the same is done where the limit is plainly another.  J has
its full rank there, but what a state is off the rows, as states inside a step are, is felt 1/delta
times and rounding 1/delta^2 times: steps would shrink towards the place and end at rounding.
Reactions are those of the state itself: they do grow like 1/delta; forces of drives do not, and are
limits too.  Of the stages of a step a difference of a few tolerances is left to its error estimate:
steps judged by their energy as well would be made again for it.  Rows that only unequal masses make
hard to tell apart are left alone.  States off the rows feel another derivative here than further
away, which the error estimate of a step need not see: solve/march/complete.py looks at the energy
of such steps.  Where nobody does (scipy's integrators) stages take the limit only where rows do
depend on each other, and what is measured inside steps takes it as elsewhere; in open chains, which
have no such places, all do.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

from trsim.assemble.equations import (
    DERIVATIVE,
    call_derivative,
    constraints,
    free_accelerations,
    in_world,
    right_hand_side,
    set_poses,
)
from trsim.assemble.instances import RowName
from trsim.assemble.linear import (
    SINGULAR,
    SMALL,
    TINY,
    diagonal,
    eliminate,
    refactorise,
    smallest_pivot,
    solve,
)
from trsim.assemble.projection import move_all, newton_step, project_velocities
from trsim.assemble.schur import plain_rows, pull
from trsim.elements.contract import DRIVES, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear
from trsim.scenario.methods import METHODS

# rad, or of the mechanism's size; from one pair of places to the next; pairs looked at
FARTHEST, NEARER, PAIRS = 0.08, 0.7, 18
TRIED = 4  # pairs that may be none: a mechanism locks there, or other rows depend on each other
MOST = 5  # pairs that a polynomial goes through
NEAR_TO = 0.25  # times the pivot of the place itself
THERE, NOT_THERE, TOO_NEAR = range(3)
# steps; of the mechanism's size: before the last one, which squares it, and where it is reached
NEWTON, CLOSED, REACHED = 8, 1e-9, 1e-9
SURE = 1e-3  # of the accelerations: more than that, and there is no limit
PLAINLY = 4.0  # times what is uncertain of a limit: an evaluation is not itself that
SEEN = 10.0  # times the tolerance: what is less of a stage is left to the error estimate
SETTLED = 1e-11  # of a limit: nothing smaller is asked for
ENOUGH = 0.025  # of what is seen of a stage
NOISE = 1e-13  # 500 times rounding, which is a 500th of the tolerance at NOISE / tolerance
PLACE, WAY, MEAN, LIMIT, FOUND, TABLE = range(6)  # rows of s.aside, TABLE of MOST rows


def near(solver: Any, rows: Sequence[RowName], bars: Iterable[tuple[int, int]]) -> float:
    """The pivot of S below which accelerations are compared with their limit; 0: never.

    A pivot is delta^2, and eps/delta^2 of an acceleration is rounding: further away it is below the
    tolerance.  bars: first frame and number of nodes of each.
    """
    if not METHODS[solver.method].marches or not closes_a_loop(rows, bars):
        return 0.0
    return min(SMALL, NOISE / solver.tolerance)


def near_rows(solver: Any, rows: Sequence[RowName], bars: Iterable[tuple[int, int]]) -> float:
    """The pivot of S below which what is measured is compared with limits; 0 in open chains.

    What is measured inside a step is brought to the rows, to rounding: off the branch by eps/delta,
    with a rate of eps/delta^2 and so an acceleration of eps/delta^3.
    """
    if not closes_a_loop(rows, bars):
        return 0.0
    return min(SMALL, (NOISE / solver.tolerance) ** (2.0 / 3.0))


def closes_a_loop(rows: Sequence[RowName], bars: Iterable[tuple[int, int]] = ()) -> bool:
    """Whether joints and drives join any two bodies in more than one way."""
    above: dict[int, int] = {}

    def top(f: int) -> int:
        while f in above:
            f = above[f]
        return f

    for first, nodes in bars:
        above.update((f, first) for f in range(first + 1, first + nodes))
    for _, frames in sorted({(row.instance, row.frames) for row in rows}):
        for i, j in pairwise(frames):
            if top(i) == top(j):
                return True
            above[top(i)] = top(j)
    return False


@compiled(DERIVATIVE)
def beside(s, t, y, yd):
    """Replace the accelerations and multipliers of a singular evaluation by their limits.

    Of one that is nearly singular the accelerations alone; s.status[4] counts those in a step.
    """
    fastest, went, counted = speed(s), s.status[0], s.status[2]
    if s.n_r < s.n or not fastest > 0.0:
        return
    own = smallest_pivot(s)
    if went != SINGULAR and own > (s.near_rows if s.status[5] > 0 else s.near):
        return
    best, scale = 1e300, 0.0
    if went == SINGULAR or plain_pivot(s) <= SMALL:
        best, scale = look_beside(s, t, y, yd, fastest, own)
        set_poses(s, y)
        constraints(s, t)
    refactorise(s)  # other factors have taken its place
    s.status[2] = counted
    if best <= SURE * scale:
        if went == SINGULAR or apart(s, yd) > max(PLAINLY * best, seen(s, scale)):
            if went != SINGULAR and s.near > 0.0:
                s.status[4] += 1
            take(s, y, yd, went == SINGULAR)
        drives(s)


@internal
def plain_pivot(s):
    """The smallest pivot of J J^T: how far rows are from depending on each other, whatever the
    masses.  Takes the place of the factors of S."""
    plain_rows(s)
    diagonal(s)
    return eliminate(s, TINY)


@internal
def apart(s, yd):
    """By how much the limit differs from accelerations in yd, rad/s^2 or sizes/s^2."""
    most = 0.0
    for i in range(s.n_v):
        most = max(most, abs(s.aside[FOUND, i] - yd[s.n_q + i]) / unit(s, i))
    return most


@internal
def seen(s, scale):
    """The difference from the limit below which it is left to the error estimate."""
    return 0.0 if s.status[5] > 0 else SEEN * s.tolerance * scale


@internal
def idle(s, yd, best, scale):
    """Whether a limit known to `best` is known well enough not to be taken for what is in yd."""
    for k in range(s.m):
        if s.phi_t[k] != 0.0:
            return False  # that of drives is taken
    return apart(s, yd) + PLAINLY * best <= seen(s, scale)


@internal
def unit(s, i):
    """The unit of the i-th velocity: the mechanism's size or 1."""
    return s.size if i % s.d < s.d // 2 + s.d % 2 else 1.0


@internal
def speed(s):
    """The fastest rate of a body, rad/s or sizes/s."""
    fastest = 0.0
    for f in range(1, s.n_r):
        for c in range(3):
            fastest = max(fastest, abs(s.V[f, c]) / s.size, abs(s.V[f, 3 + c]))
    return fastest


@internal
def look_beside(s, t, y, yd, fastest, own):
    """The limit into s.aside[FOUND]; by how much it changed at last, and the size of it.

    yd: the evaluation at y, own: its pivot, 0 where rows depend on each other there.
    """
    found, limit, n = s.aside[FOUND], s.aside[LIMIT], s.n_v + s.m
    best, scale, pairs, missed = 1e300, 0.0, 0, 0
    for k in range(PAIRS):
        d = FARTHEST * NEARER**k / fastest
        went = between(s, t, y, d, own)
        if went == NOT_THERE:  # those further away may be of another branch
            missed += 1
            if missed > TRIED:
                return 1e300, 0.0
            best, scale, pairs = 1e300, 0.0, 0
        if went != THERE:
            continue
        for i in range(n):
            limit[i] = s.aside[TABLE + max(min(pairs, MOST) - 1, 0), i]
        newest = TABLE + min(pairs, MOST - 1)
        extrapolate(s, d, newest, n)
        pairs += 1
        if pairs == 1:
            continue
        change = largest = 0.0
        for i in range(s.n_v):
            change = max(change, abs(s.aside[newest, i] - limit[i]) / unit(s, i))
            largest = max(largest, abs(s.aside[newest, i]) / unit(s, i))
        if change < best:
            best, scale = change, max(largest, fastest * fastest)
            for i in range(n):
                found[i] = s.aside[newest, i]
        enough = 0.0 if own == 0.0 else ENOUGH * seen(s, scale)
        if best <= max(SETTLED * scale, enough) or change > 8.0 * best:
            break
        if own > 0.0 and idle(s, yd, best, scale):
            break
    return best, scale


@internal
def between(s, t, y, d, own):
    """The mean of accelerations and multipliers at d from y to both sides, into s.aside[MEAN].

    Returns THERE, NOT_THERE (one of the places is none, or rows depend on each other beside y as
    they do there) or TOO_NEAR (nearer than y to where they do).
    """
    clear(s.aside[MEAN])
    for side in (1.0, -1.0):
        pivot = at(s, t, y, side * d)
        if pivot < 0.0 or (pivot == 0.0 and own == 0.0):
            return NOT_THERE
        if pivot <= NEAR_TO * own:
            return TOO_NEAR
    return THERE


@internal
def extrapolate(s, d, newest, n):
    """Take the mean at d into the table: its row j becomes the value at y of the polynomial in d^2
    through the last j + 1 of them, up to the row `newest`; Neville's scheme.  Behind the values of
    a row is the largest d of it."""
    aside, mean = s.aside, s.aside[MEAN]
    for i in range(n):
        before, now = aside[TABLE, i], mean[i]
        aside[TABLE, i] = now
        for row in range(TABLE + 1, newest + 1):
            now += (now - before) / ((aside[row - 1, n] / d) ** 2 - 1.0)
            before, aside[row, i] = aside[row, i], now
    for row in range(newest, TABLE, -1):
        aside[row, n] = aside[row - 1, n]
    aside[TABLE, n] = d


@internal
def at(s, t, y, d):
    """Add half of the accelerations and multipliers at d from y along the motion to s.aside[MEAN].

    Returns the smallest pivot there; 0 where the rows depend on each other, less where it does not
    get there.
    """
    place, mean = s.aside[PLACE], s.aside[MEAN]
    for i in range(y.size):
        place[i] = y[i]
    for i in range(s.n_v):
        s.aside[WAY, i] = d * y[s.n_q + i]
    move_all(s, place, s.aside[WAY])
    for k in range(s.n_z):  # where drives are
        place[s.n_q + s.n_v + k] += d * s.zd[k]
    worst = 0.0
    for _ in range(NEWTON):
        worst = newton_step(s, t + d, place)
        if s.status[0] == SINGULAR:
            return 0.0
        if not worst > CLOSED * s.size:
            break
    if not worst <= REACHED * s.size:
        return -1.0  # the mechanism locks between
    set_poses(s, place)
    constraints(s, t + d)
    refactorise(s)
    if s.status[0] == SINGULAR:
        return 0.0
    pivot = smallest_pivot(s)
    project_velocities(s, place)
    set_poses(s, place)
    constraints(s, t + d)
    free_accelerations(s)
    right_hand_side(s, False)
    solve(s, s.x)
    if s.lightened != 0:
        without_what_is_light(s, t, place)
    else:
        for k in range(s.m):
            mean[s.n_v + k] += 0.5 * s.x[k]
        for f in range(1, s.n_r):
            pull(s, f, s.x)
    for f in range(1, s.n_r):
        for c in range(s.d):
            mean[s.d * (f - 1) + c] += 0.5 * s.free[f, c]
    return pivot


@internal
def without_what_is_light(s, t, place):
    """Accelerations of M in s.free, and half of their multipliers added to s.aside[MEAN], from x of
    M + E (light.py).  The multipliers and the power of the evaluation itself stay."""
    own, mean, power, failed = s.aside[WAY], s.aside[MEAN], s.zd[DRIVES], s.status[3]
    for k in range(s.m):
        own[k], s.lam[k] = s.lam[k], s.x[k]
    call_derivative(s.lightened, s, t, place, s.aside[WAY])
    for k in range(s.m):
        mean[s.n_v + k] += 0.5 * s.lam[k]
        s.lam[k] = own[k]
    s.zd[DRIVES], s.status[3] = power, failed


@internal
def drives(s):
    """The limit into the multipliers of what moves: the power of a drive is finite, so they do not
    grow like 1/delta, and rounding makes eps v^2/delta^3 of them."""
    for k in range(s.m):
        if s.phi_t[k] != 0.0:
            s.lam[k] = s.aside[FOUND, s.n_v + k]


@internal
def take(s, y, yd, reactions):
    """The limit into yd, A and the power of the drives; with `reactions` into lam too."""
    found = s.aside[FOUND]
    for k in range(s.m):
        s.zd[DRIVES] += (found[s.n_v + k] - s.lam[k]) * s.phi_t[k]
        if reactions:
            s.lam[k] = found[s.n_v + k]
    yd[s.n_q + s.n_v + DRIVES] = s.zd[DRIVES]
    for f in range(1, s.n_r):
        o = s.d * (f - 1)
        for c in range(s.d):
            yd[s.n_q + o + c] = s.free[f, c] = found[o + c]
        in_world(s, f)
