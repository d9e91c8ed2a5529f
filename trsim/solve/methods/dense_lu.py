"""Small dense systems, real and complex: LU with partial pivoting, in place.

Meant for some tens of unknowns.
Substitution goes column by column: no number waits for the one before it, as in a sum along a row.
"""

import numpy as np

from trsim.kernels.lazy import internal


@internal
def squared(z):
    """|z|^2."""
    return z.real * z.real + z.imag * z.imag


@internal
def quotient(x, z):
    """x / z, of complex numbers."""
    size = squared(z)
    real = (x.real * z.real + x.imag * z.imag) / size
    return complex(real, (x.imag * z.real - x.real * z.imag) / size)


@internal
def divide(x, y, mu, first, beyond):
    """x + i y <- (x + i y) / mu, of these entries."""
    for k in range(first, beyond):
        z = quotient(complex(x[k], y[k]), mu)
        x[k], y[k] = z.real, z.imag


def _systems(size, over):
    """`factorise` and `solve` of numbers with a size, the largest of which are pivots, and with a
    division of their own."""

    @internal
    def factorise(A, pivot, n):
        """A (n, n) <- L and U; pivot (n) <- rows swapped.  False where A is singular."""
        for k in range(n):
            top, p = size(A[k, k]), k
            for i in range(k + 1, n):
                if size(A[i, k]) > top:
                    top, p = size(A[i, k]), i
            if not top > 0.0:  # NaN as well
                return False
            pivot[k] = p
            if p != k:
                for j in range(n):
                    A[k, j], A[p, j] = A[p, j], A[k, j]
            inverse = over(1.0, A[k, k])
            for i in range(k + 1, n):
                if A[i, k] != 0.0:
                    l = A[i, k] * inverse
                    A[i, k] = l
                    for j in range(k + 1, n):
                        A[i, j] -= l * A[k, j]
        return True

    @internal
    def solve(A, pivot, x, n):
        """x <- A^-1 x with the factors of `factorise`."""
        for k in range(n):
            p = pivot[k]
            if p != k:
                x[k], x[p] = x[p], x[k]
        for j in range(n - 1):
            known = x[j]
            for i in range(j + 1, n):
                x[i] -= A[i, j] * known
        for j in range(n - 1, -1, -1):
            known = over(x[j], A[j, j])
            x[j] = known
            for i in range(j):
                x[i] -= A[i, j] * known

    return factorise, solve


factorise_real, solve_real = _systems(abs, np.divide)
factorise_complex, solve_complex = _systems(squared, quotient)
