"""Sparse LU on a pattern found once (assemble/elimination.py), real and complex, row by row.

The order is fixed, pivots are not looked for.  A pivot that cancels to TINY of what it is made of
belongs to a constraint that depends on the others here and now, as at a dead centre; it is replaced
by SHIFT of that, with the sign such pivots have.  What this changes is left to the iteration that
the solution is a step of.

`work` is scratch of one row.
"""

import numpy as np

from trsim.kernels.lazy import internal
from trsim.solve.methods.dense_lu import quotient

TINY = 1e-10  # of the terms of a pivot
SHIFT = 1e-9  # of the same


@internal
def size_of(z):
    """|Re z| + |Im z|."""
    return abs(z.real) + abs(z.imag)


def _elimination(taken, over):
    """`factorise` of what is taken of complex values, with the division of such numbers."""

    @internal
    def factorise(p, value, lower, upper, inverse, work):
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
                work[p.entry_column[q]] = taken(value[q])
            made_of = size_of(work[i])
            for q in range(lower_start[i], lower_start[i + 1]):
                k = below[q]
                l = work[k] * inverse[k]
                lower[q] = l
                if l != 0.0:
                    made_of += size_of(l) * size_of(work[k])
                    for u in range(start[k], start[k + 1]):
                        work[column[u]] -= l * upper[u]
            for q in range(start[i], start[i + 1]):
                upper[q] = work[column[q]]
            if not size_of(work[i]) > TINY * made_of:
                if not made_of > 0.0:
                    return -1
                small += 1
                work[i] = -SHIFT * made_of
            inverse[i] = over(1.0, work[i])
        return small

    return factorise


factorise_sparse = _elimination(np.real, np.divide)
factorise_sparse_complex = _elimination(complex, quotient)


@internal
def solve_sparse(p, lower, upper, inverse, x):
    """x <- A^-1 x, real or complex, x in the order of elimination."""
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
