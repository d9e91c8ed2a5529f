"""Reactions that are not unique: of all that carry the same, those of least norm.

    J^T lam = f        f: what the rows of the solve carry;  J, lam of all rows, redundant ones too
    lam = D A y,       A = D J U,   A^T A y = U f,   D and U with moments over the size

Where rows are as many as velocities A^T A is regular, and its factors need no pivots.
"""

from math import sqrt

from trsim.assemble.equations import DERIVATIVE
from trsim.elements.contract import compiled
from trsim.kernels.lazy import internal

AGAIN = 2  # the second solution takes away what rounding of A^T A left of the first


@compiled(DERIVATIVE)
def least_norm(s, t, y, yd):
    """lam of the last evaluation; one that was made so is left as it is."""
    n, G = s.n_v, s.gram
    carried, left, x, done = G[n], G[n + 1], G[n + 2], G[n + 3]
    if done[0] == s.status[1] + 1.0:
        return
    done[0] = s.status[1] + 1.0
    for i in range(n):
        carried[i] = left[i] = 0.0
        for j in range(n):
            G[i, j] = 0.0
    for k in range(s.m):
        for l in range(s.row_start[k], s.row_start[k + 1]):
            add(s, carried, l, s.lam[k])
    rows = s.m + s.redundant.shape[0]
    for k in range(rows):
        square(s, k)
    factorise(G, n)
    for k in range(rows):
        s.lam[k] = 0.0
    for i in range(n):
        left[i] = carried[i]
    for _ in range(AGAIN):
        for i in range(n):
            x[i] = left[i]
        solve(G, x, n)
        for k in range(rows):
            s.lam[k] += unit(s, k) ** 2 * across(s, x, k)
        for i in range(n):
            left[i] = carried[i]
        for k in range(rows):
            for l in range(s.row_start[k], s.row_start[k + 1]):
                add(s, left, l, -s.lam[k])


@internal
def unit(s, k):
    """What a unit of a row's multiplier is: a force, or a moment over the size."""
    return s.size / s.row_unit[k]


@internal
def part(s, l, c):
    """An entry of a line of J in the axes of the world, turns over the size."""
    if s.d == 3:
        return s.J[l, 5] / s.size if c == 2 else s.J[l, c]
    return s.J[l, c] / s.size if c > 2 else s.J[l, c]


@internal
def add(s, sum, l, by):
    """Add a line of J times a number to a vector of all velocities."""
    f = s.line_frame[l]
    if f > 0:
        for c in range(s.d):
            sum[s.d * (f - 1) + c] += by * part(s, l, c)


@internal
def across(s, x, k):
    """A row of J times a vector of all velocities."""
    total = 0.0
    for l in range(s.row_start[k], s.row_start[k + 1]):
        f = s.line_frame[l]
        if f > 0:
            for c in range(s.d):
                total += part(s, l, c) * x[s.d * (f - 1) + c]
    return total


@internal
def square(s, k):
    """Add what a row makes of A^T A."""
    G, weight = s.gram, unit(s, k) ** 2
    for l in range(s.row_start[k], s.row_start[k + 1]):
        f = s.line_frame[l]
        if f == 0:
            continue
        for c in range(s.d):
            by = weight * part(s, l, c)
            if by != 0.0:
                for o in range(s.row_start[k], s.row_start[k + 1]):
                    add(s, G[s.d * (f - 1) + c], o, by)


@internal
def factorise(G, n):
    """G <- L of L L^T, below its diagonal and on it."""
    for j in range(n):
        for k in range(j):
            for i in range(j, n):
                G[i, j] -= G[i, k] * G[j, k]
        root = sqrt(max(G[j, j], 1e-300))
        for i in range(j, n):
            G[i, j] /= root


@internal
def solve(G, x, n):
    """x <- (L L^T)^-1 x."""
    for i in range(n):
        for k in range(i):
            x[i] -= G[i, k] * x[k]
        x[i] /= G[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            x[i] -= G[k, i] * x[k]
        x[i] /= G[i, i]
