"""Numeric L D L^T of S = J M^-1 J^T on the pattern of assemble/pattern.py.

A pivot that falls below TINY of its diagonal before elimination belongs to a row that depends on
the others here and now: a dead centre, a parallelogram lying flat.  Then, and only then, S is
shifted by a small multiple of its diagonal and the solution refined (the proximal point iteration),
which converges to the minimum-norm multipliers of the consistent system.  What it leaves over tells
a row that depends on the others from one that the arithmetic cannot tell from them: see
`contradictory`.

Near such a position, delta away, S has an eigenvalue of delta^2 and multipliers grow like
1/delta, so that the rounding of S itself is felt in the accelerations as eps/delta^2.  Residuals
are therefore taken with the bodies' own accelerations, b - J (M^-1 J^T x), not with S; refined
with them the accelerations are right to eps/delta.

Unknowns after the rows are the motions of hubs (pattern.py), with negative pivots and nothing on
the right-hand side.  The pivot of a row before them is small too where the row depends on others
with the hubs held only, as those of a crank and a rod in line do.  It tells nothing of S, so it is
delayed: with its diagonal d_k added the elimination goes on, of what is now K + U D U^T, and the
rest is a small system [Hager1989],

    K^-1 = Z' + Z G^-1 Z^T        Z' = (K + U D U^T)^-1,  Z = Z' U,  G = D^-1 - U^T Z

Such a row counts with its pivot behind all others, 1 / (S^-1)_kk.
"""

from math import sqrt

from trsim.assemble.on_beams import RESIDUAL, call_beams
from trsim.assemble.schur import rows
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear_table, copy_to

SOUND, POOR, SINGULAR = 0, 1, 2  # how a factorisation went, in s.status[0]
TINY = 1e-10  # of the diagonal: a smaller pivot is a dependent row
WEAK = 1e-2  # of the diagonal: accelerations feel by what a state is off its rows
SMALL = 1e-4  # of the diagonal: with a smaller pivot solutions are refined
ENOUGH = 1e-7  # of the solution: what follows a smaller correction is below rounding
PLAIN = 1e-6  # the same, of J J^T: whether the rows depend on each other, whatever the masses
SHIFT = 1e-9  # of the diagonal, added to a singular S
REFINEMENTS = 6
LEFT_OVER = 1e-3  # of the right-hand side: more shows that the rows ask for different things
ROUNDING = 1e-15  # of a diagonal of G: a smaller pivot is none


@internal
def factorise(s):
    """Factorise s.value in place, just filled by `rows`; s.status[0] tells how it went."""
    factorise_delaying(s, s.delayed.size - 1)


@internal
def factorise_alone(s):
    """`factorise` for who keeps the factors alone: no pivot is delayed."""
    factorise_delaying(s, 0)


@internal
def factorise_delaying(s, most):
    """`factorise` with so many delayed pivots at most."""
    s.status[2] += 1
    s.status[0] = SOUND
    diagonal(s)
    smallest = eliminate_delaying(s, TINY, most)
    if smallest < WEAK:
        s.status[6] += 1
    if smallest <= TINY:
        s.status[0] = SINGULAR
        rows(s)
        for k in range(s.first.size):
            if s.row[s.column_start[k]] < s.m:
                s.value[s.column_start[k]] += SHIFT * s.first[k]
        eliminate_delaying(s, TINY, most)
    elif smallest < SMALL:
        s.status[0] = POOR


@internal
def refactorise(s):
    """S of the J of the last evaluation, factorised."""
    rows(s)
    factorise(s)


@internal
def diagonal(s):
    """first <- the diagonal of S; of a hub it is known when its turn comes."""
    first, row, value, through, m = s.first, s.row, s.value, s.through, s.m
    column_start = s.column_start
    for k in range(first.size):
        place = column_start[k]
        own = value[place]
        if row[place] < m:
            own += through[row[place]]
        first[k] = own


@internal
def hub_diagonal(s, k):
    """first <- the diagonal of a hub whose first unknown is eliminated k-th: its mass and all that
    hangs on it, of which what is held in common cancels."""
    if (s.row[s.column_start[k]] - s.m) % s.d == 0:
        for c in range(s.d):
            s.first[k + c] = -s.value[s.column_start[k + c]]


@internal
def eliminate(s, tiny):
    """Right-looking elimination; returns the smallest pivot if WEAK, as a share of its diagonal."""
    return eliminate_delaying(s, tiny, s.delayed.size - 1)


@internal
def eliminate_delaying(s, tiny, most):
    """`eliminate` with so many delayed pivots at most."""
    value, target, column_start = s.value, s.target, s.column_start
    first, row, m, delayed = s.first, s.row, s.m, s.delayed
    smallest, u, hubs_left, number = 1.0, 0, s.first.size - s.m, 0
    for k in range(first.size):
        start, end = column_start[k], column_start[k + 1]
        D, sign = value[start], 1.0
        if row[start] >= m:
            hub_diagonal(s, k)
            D, sign, hubs_left = -D, -1.0, hubs_left - 1
        if WEAK * first[k] >= D:
            if hubs_left > 0 and sign > 0.0 and first[k] > 0.0 and number < most:
                number += 1
                delayed[number] = k
                D += first[k]
                value[start] = D
            else:
                smallest = min(smallest, D / first[k] if first[k] > 0.0 else 0.0)
                if tiny * first[k] >= D:
                    D = tiny * first[k]
                    if D == 0.0:
                        D = 1.0
                    value[start] = sign * D
        inverse = sign / D
        # from the last row up: what is left of the column is still that of S
        for p in range(end - 1, start, -1):
            L = value[p] * inverse
            o = start + 1
            while o < p:  # two at a time: most columns have few entries, and a turn costs as much
                value[target[u]] -= L * value[o]
                value[target[u + 1]] -= L * value[o + 1]
                o, u = o + 2, u + 2
            if o == p:
                value[target[u]] -= L * value[o]
                u += 1
            value[p] = L
    delayed[0] = number
    return min(smallest, take_delayed(s)) if number > 0 else smallest


@internal
def take_delayed(s):
    """Z and G of the delayed rows, this as its Cholesky factor, and their pivots behind all other
    rows, as shares of their diagonals; returns the least of these."""
    Z, G, number, smallest = s.delayed_columns, s.delayed_factor, s.delayed[0], 1.0
    for j in range(number):
        z = Z[j]
        for k in range(z.size):
            z[k] = 0.0
        z[delayed_row(s, j)] = 1.0
        substitute(s, s.value, z)
    for i in range(number):
        own = 1.0 / s.first[s.delayed[1 + i]]
        for j in range(i + 1):
            total = (own if i == j else 0.0) - Z[j, delayed_row(s, i)]
            for k in range(j):
                total -= G[i, k] * G[j, k]
            G[i, j] = sqrt(max(total, ROUNDING * own)) if i == j else total / G[j, j]
    for i in range(number):
        w = s.delayed_room
        total = Z[i, delayed_row(s, i)]
        for j in range(number):
            w[j] = Z[i, delayed_row(s, j)]
            for k in range(j):
                w[j] -= G[j, k] * w[k]
            w[j] /= G[j, j]
            total += w[j] * w[j]
        s.delayed_pivot[i] = 1.0 / (total * s.first[s.delayed[1 + i]])
        smallest = min(smallest, s.delayed_pivot[i])
    return smallest


@internal
def delayed_row(s, j):
    """The j-th row whose pivot is delayed."""
    return s.row[s.column_start[s.delayed[1 + j]]]


@internal
def back(s, x):
    """x <- K^-1 x by the factors and, of delayed rows, by Z and G."""
    substitute(s, s.value, x)
    number = s.delayed[0]
    if number == 0:
        return
    Z, G, w = s.delayed_columns, s.delayed_factor, s.delayed_room
    for i in range(number):
        w[i] = x[delayed_row(s, i)]
        for k in range(i):
            w[i] -= G[i, k] * w[k]
        w[i] /= G[i, i]
    for i in range(number - 1, -1, -1):
        for k in range(i + 1, number):
            w[i] -= G[k, i] * w[k]
        w[i] /= G[i, i]
    for i in range(number):
        for k in range(x.size):
            x[k] += Z[i, k] * w[i]


@internal
def substitute(s, value, x):
    """x <- (L D L^T)^-1 x."""
    row, column_start = s.row, s.column_start
    for k in range(s.m, x.size):
        x[k] = 0.0
    for k in range(x.size):
        start = column_start[k]
        x_k, last = x[row[start]], column_start[k + 1] - 1
        p = start + 1
        while p < last:  # two at a time, as in `eliminate`
            x[row[p]] -= value[p] * x_k
            x[row[p + 1]] -= value[p + 1] * x_k
            p += 2
        if p == last:
            x[row[p]] -= value[p] * x_k
    for k in range(x.size - 1, -1, -1):
        start = column_start[k]
        total, last = x[row[start]] / value[start], column_start[k + 1] - 1
        p = start + 1
        while p < last:
            total -= value[p] * x[row[p]]
            total -= value[p + 1] * x[row[p + 1]]
            p += 2
        if p == last:
            total -= value[p] * x[row[p]]
        x[row[start]] = total


@internal
def solve(s, x):
    """x <- S^-1 x with the last factorisation, refined where S was nearly singular, or was."""
    if s.status[0] == SOUND:
        back(s, x)
        return
    copy_to(s.r, x)
    b = s.r
    back(s, x)
    for _ in range(REFINEMENTS):
        copy_to(s.r2, b)
        residual(s, x, s.r2)
        back(s, s.r2)
        change, size = 0.0, 0.0
        for k in range(s.m):
            x[k] += s.r2[k]
            change, size = max(change, abs(s.r2[k])), max(size, abs(x[k]))
        if s.status[0] == POOR and change <= ENOUGH * size:
            break


@internal
def residual(s, x, r):
    """r <- r - J M^-1 J^T x with the rows `rows` last made."""
    B, W, u, frame_start, slot_row = s.B, s.W, s.moved, s.frame_start, s.slot_row
    clear_table(u)
    for f in range(1, s.n_r):
        for p in range(frame_start[f], frame_start[f + 1]):
            for a in range(s.d):
                u[f, a] += W[p, a] * x[slot_row[p]]
        for p in range(frame_start[f], frame_start[f + 1]):
            for a in range(s.d):
                r[slot_row[p]] -= B[p, a] * u[f, a]
    if s.n_r < s.n:
        call_beams(s.on_beams[RESIDUAL], s, x, r, 0)


@internal
def contradictory(s, x):
    """Whether x, just found for a singular S, leaves a part of the right-hand side unmet."""
    if s.status[0] != SINGULAR:
        return False
    copy_to(s.r2, s.r)
    residual(s, x, s.r2)
    left, whole = 0.0, 0.0
    for k in range(s.first.size):
        row = s.row[s.column_start[k]]
        if row >= s.m:
            continue
        left = max(left, abs(s.r2[row]) / sqrt(s.first[k]))
        whole = max(whole, abs(s.r[row]) / sqrt(s.first[k]))
    return left > LEFT_OVER * whole


@internal
def smallest_pivot(s):
    """The least pivot of the rows of the last factorisation, as a share of its diagonal.

    The square of what is left of a row when those before it are taken out.
    """
    if s.status[0] == SINGULAR:
        return 0.0
    smallest = 1.0
    for k in range(s.first.size):
        place = s.column_start[k]
        if s.row[place] < s.m:
            smallest = min(smallest, s.value[place] / s.first[k])
    for j in range(s.delayed[0]):
        smallest = min(smallest, s.delayed_pivot[j])
    return smallest


@internal
def independent(s):
    """Whether the rows whose J J^T was just filled into s.value do not depend on each other."""
    diagonal(s)
    return eliminate(s, PLAIN) > PLAIN
