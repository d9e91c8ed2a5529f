"""Small dense systems, real and complex: LU with partial pivoting, in place.

Complex matrices are two real ones: rows of `re` and `im`.  Meant for some tens of unknowns.
Substitution goes column by column: no number waits for the one before it, as in a sum along a row.
"""

from trsim.kernels.vectors import internal


@internal
def factorise_real(A, pivot, n):
    """A (n, n) <- L and U; pivot (n) <- rows swapped.  False where A is singular."""
    for k in range(n):
        top, p = abs(A[k, k]), k
        for i in range(k + 1, n):
            if abs(A[i, k]) > top:
                top, p = abs(A[i, k]), i
        if not top > 0.0:  # NaN as well
            return False
        pivot[k] = p
        if p != k:
            for j in range(n):
                A[k, j], A[p, j] = A[p, j], A[k, j]
        inverse = 1.0 / A[k, k]
        for i in range(k + 1, n):
            if A[i, k] != 0.0:
                l = A[i, k] * inverse
                A[i, k] = l
                for j in range(k + 1, n):
                    A[i, j] -= l * A[k, j]
    return True


@internal
def solve_real(A, pivot, x, n):
    """x <- A^-1 x with the factors of `factorise_real`."""
    for k in range(n):
        p = pivot[k]
        if p != k:
            x[k], x[p] = x[p], x[k]
    for j in range(n - 1):
        known = x[j]
        for i in range(j + 1, n):
            x[i] -= A[i, j] * known
    for j in range(n - 1, -1, -1):
        known = x[j] / A[j, j]
        x[j] = known
        for i in range(j):
            x[i] -= A[i, j] * known


@internal
def factorise_complex(re, im, pivot, n):
    """(re + i im) (n, n) <- L and U.  False where the matrix is singular."""
    for k in range(n):
        top, p = re[k, k] ** 2 + im[k, k] ** 2, k
        for i in range(k + 1, n):
            size = re[i, k] ** 2 + im[i, k] ** 2
            if size > top:
                top, p = size, i
        if not top > 0.0:
            return False
        pivot[k] = p
        if p != k:
            for j in range(n):
                re[k, j], re[p, j] = re[p, j], re[k, j]
                im[k, j], im[p, j] = im[p, j], im[k, j]
        a, c = re[k, k] / top, -im[k, k] / top
        for i in range(k + 1, n):
            x, y = re[i, k], im[i, k]
            if x != 0.0 or y != 0.0:
                l, m = x * a - y * c, x * c + y * a
                re[i, k], im[i, k] = l, m
                for j in range(k + 1, n):
                    re[i, j] -= l * re[k, j] - m * im[k, j]
                    im[i, j] -= l * im[k, j] + m * re[k, j]
    return True


@internal
def solve_complex(re, im, pivot, x, y, n):
    """x + i y <- (re + i im)^-1 (x + i y)."""
    for k in range(n):
        p = pivot[k]
        if p != k:
            x[k], x[p] = x[p], x[k]
            y[k], y[p] = y[p], y[k]
    for j in range(n - 1):
        a, c = x[j], y[j]
        for i in range(j + 1, n):
            x[i] -= re[i, j] * a - im[i, j] * c
            y[i] -= re[i, j] * c + im[i, j] * a
    for j in range(n - 1, -1, -1):
        p, q = re[j, j], im[j, j]
        size = p * p + q * q
        a, c = (x[j] * p + y[j] * q) / size, (y[j] * p - x[j] * q) / size
        x[j], y[j] = a, c
        for i in range(j):
            x[i] -= re[i, j] * a - im[i, j] * c
            y[i] -= re[i, j] * c + im[i, j] * a
