"""Sparse LU on a pattern found once (assemble/elimination.py), real and complex, row by row.

The order is fixed, pivots are not looked for.  A pivot that cancels to TINY of what it is made of
belongs to a constraint that depends on the others here and now, as at a dead centre; it is replaced
by SHIFT of that, with the sign such pivots have.  What this changes is left to the iteration that
the solution is a step of.

Complex matrices are two real ones.  `work` is scratch of one row.
"""

from trsim.kernels.vectors import internal

TINY = 1e-10  # of the terms of a pivot
SHIFT = 1e-9  # of the same


@internal
def factorise_sparse(p, value, lower, upper, inverse, work):
    """L, U and the inverse diagonal of the rows in p.entry_start; the number of small pivots.

    -1 where a value is not finite.
    """
    small = 0
    start, column, lower_start, below = p.start, p.column, p.lower_start, p.lower
    for i in range(start.size - 1):
        for q in range(lower_start[i], lower_start[i + 1]):
            work[below[q]] = 0.0
        for q in range(start[i], start[i + 1]):
            work[column[q]] = 0.0
        work[i] = 0.0
        for q in range(p.entry_start[i], p.entry_start[i + 1]):
            work[p.entry_column[q]] = value[q]
        made_of = abs(work[i])
        for q in range(lower_start[i], lower_start[i + 1]):
            k = below[q]
            l = work[k] * inverse[k]
            lower[q] = l
            if l != 0.0:
                made_of += abs(l * work[k])
                for u in range(start[k], start[k + 1]):
                    work[column[u]] -= l * upper[u]
        for q in range(start[i], start[i + 1]):
            upper[q] = work[column[q]]
        pivot = work[i]
        if not abs(pivot) > TINY * made_of:
            if not made_of > 0.0:
                return -1
            small += 1
            pivot = -SHIFT * made_of
        inverse[i] = 1.0 / pivot
    return small


@internal
def solve_sparse(p, lower, upper, inverse, x):
    """x <- A^-1 x, x in the order of elimination."""
    start, column, lower_start, below = p.start, p.column, p.lower_start, p.lower
    n = start.size - 1
    for i in range(n):
        total = x[i]
        for q in range(lower_start[i], lower_start[i + 1]):
            total -= lower[q] * x[below[q]]
        x[i] = total
    for i in range(n - 1, -1, -1):
        total = x[i]
        for q in range(start[i], start[i + 1]):
            total -= upper[q] * x[column[q]]
        x[i] = total * inverse[i]


@internal
def factorise_sparse_complex(p, value, lower, upper, inverse, work):
    """`factorise_sparse` of value[0] + i value[1]; every table has a row for each part."""
    small = 0
    start, column, lower_start, below = p.start, p.column, p.lower_start, p.lower
    for i in range(start.size - 1):
        for q in range(lower_start[i], lower_start[i + 1]):
            work[0, below[q]] = 0.0
            work[1, below[q]] = 0.0
        for q in range(start[i], start[i + 1]):
            work[0, column[q]] = 0.0
            work[1, column[q]] = 0.0
        work[0, i] = 0.0
        work[1, i] = 0.0
        for q in range(p.entry_start[i], p.entry_start[i + 1]):
            work[0, p.entry_column[q]] = value[0, q]
            work[1, p.entry_column[q]] = value[1, q]
        made_of = abs(work[0, i]) + abs(work[1, i])
        for q in range(lower_start[i], lower_start[i + 1]):
            k = below[q]
            x, y = work[0, k], work[1, k]
            l = x * inverse[0, k] - y * inverse[1, k]
            m = x * inverse[1, k] + y * inverse[0, k]
            lower[0, q], lower[1, q] = l, m
            if l != 0.0 or m != 0.0:
                made_of += (abs(l) + abs(m)) * (abs(x) + abs(y))
                for u in range(start[k], start[k + 1]):
                    c = column[u]
                    work[0, c] -= l * upper[0, u] - m * upper[1, u]
                    work[1, c] -= l * upper[1, u] + m * upper[0, u]
        for q in range(start[i], start[i + 1]):
            upper[0, q], upper[1, q] = work[0, column[q]], work[1, column[q]]
        x, y = work[0, i], work[1, i]
        if not abs(x) + abs(y) > TINY * made_of:
            if not made_of > 0.0:
                return -1
            small += 1
            x, y = -SHIFT * made_of, 0.0
        size = x * x + y * y
        inverse[0, i], inverse[1, i] = x / size, -y / size
    return small


@internal
def solve_sparse_complex(p, lower, upper, inverse, x, y):
    """x + i y <- A^-1 (x + i y), in the order of elimination."""
    start, column, lower_start, below = p.start, p.column, p.lower_start, p.lower
    n = start.size - 1
    for i in range(n):
        a, c = x[i], y[i]
        for q in range(lower_start[i], lower_start[i + 1]):
            k = below[q]
            a -= lower[0, q] * x[k] - lower[1, q] * y[k]
            c -= lower[0, q] * y[k] + lower[1, q] * x[k]
        x[i], y[i] = a, c
    for i in range(n - 1, -1, -1):
        a, c = x[i], y[i]
        for q in range(start[i], start[i + 1]):
            k = column[q]
            a -= upper[0, q] * x[k] - upper[1, q] * y[k]
            c -= upper[0, q] * y[k] + upper[1, q] * x[k]
        x[i] = a * inverse[0, i] - c * inverse[1, i]
        y[i] = a * inverse[1, i] + c * inverse[0, i]
