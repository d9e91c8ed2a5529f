"""Friction made by the reactions of joints, solved for together with these.

The multipliers are affine in the friction forces F, and so are the reactions r of their joints:

    r_k = r_k0 + sum_l D_kl F_l
    F_k = f_k (n_k(r_k) + c_k)            n_k: how the reaction presses, a norm or a sum of norms

with f_k and c_k known at a state.  D is found by one solve, with the factors at hand, for each
friction force, and F by Newton's method, which norms make a semi-smooth one [QiSun1993].  A step
that does not halve what is left is followed by one of the iteration F_k <- f_k (n_k + c_k).  With

    A_kl = |f_k| n_k(D_kl)

that iteration is a contraction where the spectral radius of A is below one, which is where the
pivots of I - A are positive: then there is one F, and it is found.  Of a single friction force
beyond that there are two or none [Painleve1895].  Several are solved for from several starts there,
and what they do not agree on is no solution.  The scene's status then says whose friction it is,
and the accelerations are no numbers.
"""

from math import nan

from trsim.assemble.equations import (
    DERIVATIVE,
    call_all,
    call_one,
    free_accelerations,
    right_hand_side,
)
from trsim.assemble.linear import solve
from trsim.assemble.on_beams import FREE, call_beams
from trsim.assemble.reaction import reaction_of
from trsim.elements.contract import FIRST_ROW, FRICTION, Load, Pair, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear, copy_table

ITERATIONS = 200
EXACT = 1e-15  # of the largest friction force: what may be left of F_k - f_k (n_k + c_k)
SETTLED = 1e-12  # the same, where it gets no less
ALIKE = 1e-9  # of the largest force: solutions that are one
FAR = 100.0  # times the largest reaction: where other starts are
FORCE, LEFT, STEP, FOUND, MATRIX = range(5)  # rows of s.rub_room


def table(instances):
    """What rubs in joints: its row, that of the joint, where rows of that begin in con, how many;
    where its law is in con and the numbers of that in par."""
    place = {i.name: e for e, i in enumerate(instances) if i.section == "joints"}
    return [
        (
            e,
            place[i.row.rubs],
            FIRST_ROW,
            len(instances[place[i.row.rubs]].element.rows),
            *i.element.slides,
        )
        for e, i in enumerate(instances)
        if i.row.rubs
    ]


@compiled(DERIVATIVE)
def rubbing(s, t, y, yd):
    """Add the friction in joints to the forces of the evaluation at hand, of which all is known but
    the multipliers: J, S and its factors, F without friction."""
    copy_table(s.before_rubbing, s.F)
    solved(s, y, yd)
    size = reactions_now(s, t)
    if not size < 1e300:
        return  # no state of the mechanism
    largest = size if size > 0.0 else 1.0
    slopes(s, t, y, yd, largest)
    s.status[7] = undecided(s, t, largest)
    copy_table(s.F, s.before_rubbing)
    if s.status[7] > 0:
        pair = Pair(s, s.status[7] - 1)
        s.F[max(pair.i, pair.j), 0] = nan
    else:
        apply(s, t)
    free_accelerations(s)
    if s.n_r < s.n:
        call_beams(s.on_beams[FREE], s, y, yd, 0)


@compiled(DERIVATIVE)
def rubs_with(s, t, lam, _):
    """Add the friction that goes with the multipliers lam to the forces."""
    for k in range(s.rubbing.shape[0]):
        reaction_of(s, joint(s, k), lam, s.pressed[s.rubbing[k, 0]], 0)
    call_all(s, s.load, t)
    for k in range(s.rubbing.shape[0]):
        s.rub_room[FORCE, k] = wanted(s, k)
    apply(s, t)


@internal
def joint(s, k):
    """The joint of the k-th friction, as `reaction_of` takes it."""
    return s.rubbing[k, 1], s.rubbing[k, 2], s.rubbing[k, 3]


@internal
def holds(s, k):
    """Whether its joint is together: one that an event took apart has no row left."""
    e, first, number = joint(s, k)
    for r in range(first, first + number):  # noqa: SIM110 - a generator does not compile
        if s.con[e, r] >= 0:
            return True
    return False


@internal
def wanted(s, k):
    """The friction force that goes with the load last found."""
    load = Load(s, s.rubbing[k, 0])
    return load.per_load * (load.normal + load.preload) if holds(s, k) else 0.0


@internal
def apply(s, t):
    """Friction forces as wrenches and in the energy book."""
    for k in range(s.rubbing.shape[0]):
        e = s.rubbing[k, 0]
        s.rubbed[e] = s.rub_room[FORCE, k]
        s.zd[FRICTION] += s.rubbed[e] * Load(s, e).slip
    call_all(s, s.rub, t)


@internal
def solved(s, y, yd):
    """Multipliers of the forces at hand, into s.x."""
    free_accelerations(s)
    if s.n_r < s.n:
        call_beams(s.on_beams[FREE], s, y, yd, 0)
    right_hand_side(s, False)
    solve(s, s.x)


@internal
def reactions_now(s, t):
    """The reactions without friction; the largest number of them, 1e300 where it is none."""
    size, n = 0.0, s.rubbing.shape[0]
    for k in range(n):
        e = s.rubbing[k, 0]
        reaction_of(s, joint(s, k), s.x, s.unpressed[e], 0)
        for c in range(6):
            if not abs(s.unpressed[e, c]) < 1e300:
                return 1e300
            size = max(size, abs(s.unpressed[e, c]))
            s.pressed[e, c] = s.unpressed[e, c]
    call_all(s, s.load, t)
    return size


@internal
def slopes(s, t, y, yd, probe):
    """What the reactions change by with each friction force; probe: how large a change is tried."""
    n = s.rubbing.shape[0]
    clear(s.rubbed)
    for l in range(n):
        e = s.rubbing[l, 0]
        if Load(s, e).per_load == 0.0 or not holds(s, l):
            for k in range(n):
                for c in range(6):
                    s.by_rubbing[k, 6 * l + c] = 0.0
            continue
        copy_table(s.F, s.before_rubbing)
        s.rubbed[e] = probe
        call_one(s, s.rub, t, e)
        s.rubbed[e] = 0.0
        solved(s, y, yd)
        for k in range(n):
            own, changed = s.unpressed[s.rubbing[k, 0]], s.rub_room[FOUND]
            reaction_of(s, joint(s, k), s.x, changed, 0)
            for c in range(6):
                s.by_rubbing[k, 6 * l + c] = (changed[c] - own[c]) / probe


@internal
def press(s, t):
    """Reactions with the friction forces in s.rub_room, and how they press."""
    n = s.rubbing.shape[0]
    for k in range(n):
        e = s.rubbing[k, 0]
        for c in range(6):
            total = s.unpressed[e, c]
            for l in range(n):
                total += s.by_rubbing[k, 6 * l + c] * s.rub_room[FORCE, l]
            s.pressed[e, c] = total
    call_all(s, s.load, t)


@internal
def undecided(s, t, largest):
    """Find the friction forces.  0, or 1 + the row of a friction that has none, or several."""
    n = s.rubbing.shape[0]
    culprit = proved(s, t)
    if culprit == 0:
        clear(s.rub_room[FORCE])
        return 0 if newton(s, t) else 1 + s.rubbing[0, 0]
    if n == 1:
        return culprit
    for start in range(2 * n + 1):
        clear(s.rub_room[FORCE])
        if start > 0:
            sign = 1.0 if start % 2 == 1 else -1.0
            s.rub_room[FORCE, (start - 1) // 2] = sign * FAR * largest
        if not newton(s, t):
            return culprit
        for k in range(n):
            if start == 0:
                s.rub_room[FOUND, k] = s.rub_room[FORCE, k]
            elif abs(s.rub_room[FORCE, k] - s.rub_room[FOUND, k]) > ALIKE * largest:
                return culprit
    s.status[8] += 1
    return 0


@internal
def proved(s, t):
    """0 where there is one solution for sure; else 1 + the row of the friction that prevents it."""
    n, A = s.rubbing.shape[0], s.rub_room
    for k in range(n):
        e = s.rubbing[k, 0]
        for l in range(n):
            for c in range(6):
                s.pressed[e, c] = s.by_rubbing[k, 6 * l + c]
            call_one(s, s.load, t, e)
            A[MATRIX + k, l] = -abs(Load(s, e).per_load) * Load(s, e).normal
        A[MATRIX + k, k] += 1.0
    for k in range(n):
        if not A[MATRIX + k, k] > 0.0:
            return 1 + s.rubbing[k, 0]
        for i in range(k + 1, n):
            part = A[MATRIX + i, k] / A[MATRIX + k, k]
            for l in range(k, n):
                A[MATRIX + i, l] -= part * A[MATRIX + k, l]
    return 0


@internal
def newton(s, t):
    """Solve for the friction forces in s.rub_room from those there.  Whether they are found."""
    n, room = s.rubbing.shape[0], s.rub_room
    before, still = 1e300, 0
    for _ in range(ITERATIONS):
        press(s, t)
        left, most = 0.0, 0.0
        for k in range(n):
            room[LEFT, k] = wanted(s, k) - room[FORCE, k]
            left, most = max(left, abs(room[LEFT, k])), max(most, abs(wanted(s, k)))
        if not left < 1e300:
            return False
        still = still + 1 if left >= 0.5 * before else 0
        if left <= EXACT * most or (still > 2 and left <= SETTLED * most):
            return True
        if left < 0.5 * before:
            direction(s)
        else:  # the contraction alone
            for k in range(n):
                room[STEP, k] = room[LEFT, k]
        before = left
        for k in range(n):
            room[FORCE, k] += room[STEP, k]
    return False


@internal
def direction(s):
    """Newton's step from what is left, by elimination with exchange of rows."""
    n, room = s.rubbing.shape[0], s.rub_room
    for k in range(n):
        load = Load(s, s.rubbing[k, 0])
        f, m = load.by_force, load.by_moment
        for l in range(n):
            by = 0.0
            for c in range(3):
                by += f[c] * s.by_rubbing[k, 6 * l + c] + m[c] * s.by_rubbing[k, 6 * l + 3 + c]
            room[MATRIX + k, l] = -load.per_load * by
        room[MATRIX + k, k] += 1.0
        room[STEP, k] = room[LEFT, k]
    for k in range(n):
        best = k
        for i in range(k, n):
            if abs(room[MATRIX + i, k]) > abs(room[MATRIX + best, k]):
                best = i
        for l in range(n):
            room[MATRIX + k, l], room[MATRIX + best, l] = (
                room[MATRIX + best, l],
                room[MATRIX + k, l],
            )
        room[STEP, k], room[STEP, best] = room[STEP, best], room[STEP, k]
        for i in range(k + 1, n):
            part = room[MATRIX + i, k] / room[MATRIX + k, k]
            for l in range(k, n):
                room[MATRIX + i, l] -= part * room[MATRIX + k, l]
            room[STEP, i] -= part * room[STEP, k]
    for k in range(n - 1, -1, -1):
        for l in range(k + 1, n):
            room[STEP, k] -= room[MATRIX + k, l] * room[STEP, l]
        room[STEP, k] /= room[MATRIX + k, k]
