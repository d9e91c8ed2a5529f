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
"""

from math import sqrt

from trsim.elements.vectors import clear_table, copy_to, internal

SOUND, POOR, SINGULAR = 0, 1, 2  # how a factorisation went, in s.status[0]
TINY = 1e-10  # of the diagonal: a smaller pivot is a dependent row
SMALL = 1e-4  # of the diagonal: with a smaller pivot solutions are refined
ENOUGH = 1e-7  # of the solution: what follows a smaller correction is below rounding
PLAIN = 1e-6  # the same, of J J^T: whether the rows depend on each other, whatever the masses
SHIFT = 1e-9  # of the diagonal, added to a singular S
REFINEMENTS = 6
LEFT_OVER = 1e-3  # of the right-hand side: more shows that the rows ask for different things


@internal
def factorise(s):
    """Factorise s.value in place; s.status[0] tells how it went.

    S must have just been filled by `rows`; its entries are kept in `original`.
    """
    s.status[2] += 1
    s.status[0] = SOUND
    for k in range(s.m):
        s.first[k] = s.value[s.diagonal[k]]
    copy_to(s.original, s.value)
    smallest = eliminate(s, TINY)
    if smallest <= TINY:
        s.status[0] = SINGULAR
        copy_to(s.value, s.original)
        for k in range(s.m):
            s.value[s.diagonal[k]] += SHIFT * s.first[k]
        eliminate(s, TINY)
    elif smallest < SMALL:
        s.status[0] = POOR


@internal
def eliminate(s, tiny):
    """Right-looking elimination; returns the smallest pivot, as a share of its diagonal."""
    value, smallest = s.value, 1.0
    diagonal, update, update_start = s.diagonal, s.update, s.update_start
    below, below_start = s.below, s.below_start
    for k in range(s.m):
        D = value[diagonal[k]]
        if SMALL * s.first[k] >= D:
            smallest = min(smallest, D / s.first[k] if s.first[k] > 0.0 else 0.0)
            if tiny * s.first[k] >= D:
                D = tiny * s.first[k]
                if D == 0.0:
                    D = 1.0
                value[diagonal[k]] = D
        inverse = 1.0 / D
        for u in range(update_start[k], update_start[k + 1]):
            value[update[u, 0]] -= value[update[u, 1]] * value[update[u, 2]] * inverse
        for p in range(below_start[k], below_start[k + 1]):
            value[below[p]] *= inverse
    return smallest


@internal
def substitute(s, value, x):
    """x <- (L D L^T)^-1 x."""
    order, diagonal = s.order, s.diagonal
    below, below_row, below_start = s.below, s.below_row, s.below_start
    for k in range(s.m):
        x_k = x[order[k]]
        for p in range(below_start[k], below_start[k + 1]):
            x[below_row[p]] -= value[below[p]] * x_k
    for k in range(s.m - 1, -1, -1):
        total = x[order[k]] / value[diagonal[k]]
        for p in range(below_start[k], below_start[k + 1]):
            total -= value[below[p]] * x[below_row[p]]
        x[order[k]] = total


@internal
def solve(s, x):
    """x <- S^-1 x with the last factorisation, refined where S was nearly singular, or was."""
    if s.status[0] == SOUND:
        substitute(s, s.value, x)
        return
    copy_to(s.r, x)
    b = s.r
    substitute(s, s.value, x)
    for _ in range(REFINEMENTS):
        copy_to(s.r2, b)
        residual(s, x, s.r2)
        substitute(s, s.value, s.r2)
        change, size = 0.0, 0.0
        for k in range(s.m):
            x[k] += s.r2[k]
            change, size = max(change, abs(s.r2[k])), max(size, abs(x[k]))
        if s.status[0] == POOR and change <= ENOUGH * size:
            break


@internal
def residual(s, x, r):
    """r <- r - J M^-1 J^T x with the rows `rows` last made."""
    B, W, u, row_start, slot_frame = s.B, s.W, s.moved, s.row_start, s.slot_frame
    clear_table(u)
    for k in range(s.m):
        for p in range(row_start[k], row_start[k + 1]):
            f = slot_frame[p]
            for a in range(s.d):
                u[f, a] += W[p, a] * x[k]
    for k in range(s.m):
        total = r[k]
        for p in range(row_start[k], row_start[k + 1]):
            f = slot_frame[p]
            for a in range(s.d):
                total -= B[p, a] * u[f, a]
        r[k] = total


@internal
def contradictory(s, x):
    """Whether x, just found for a singular S, leaves a part of the right-hand side unmet."""
    if s.status[0] != SINGULAR:
        return False
    copy_to(s.r2, s.r)
    residual(s, x, s.r2)
    left, whole = 0.0, 0.0
    for k in range(s.m):
        row = s.order[k]
        left = max(left, abs(s.r2[row]) / sqrt(s.first[k]))
        whole = max(whole, abs(s.r[row]) / sqrt(s.first[k]))
    return left > LEFT_OVER * whole


@internal
def independent(s):
    """Whether the rows whose J J^T was just filled into s.value do not depend on each other."""
    for k in range(s.m):
        s.first[k] = s.value[s.diagonal[k]]
    return eliminate(s, PLAIN) > PLAIN
