"""Dense linear algebra that gives the same bits on every processor with the same operations.

The kernels of a BLAS differ between families of processors in the order of their sums, and so in
the last bit of what they give.  Where a run starts, and what its tables hold, must not hang on
that: what decides it is computed here.  Numbers for messages and bounds may come of numpy.linalg.

Householder's triangles with exchange of columns stand for singular values: the rank is that of the
diagonal, which falls [GolubVanLoan2013 5.4].  Sums of products are einsum's, which asks no BLAS.
"""

from collections.abc import Sequence
from math import copysign, sqrt

import numpy as np
from numpy.typing import NDArray

from trsim.elements.contract import compiled
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, A2, I1, int64, void

Array = NDArray[np.float64]

SWEEPS = 60  # of Jacobi's method: it takes 6 to 10


@compiled(void(A2, A2, A1, I1))
def triangle(B, Q, w, order):
    """B, its columns in an order of their own, becomes R with Q B = R; to Q the same is done.

    order: filled.  w: room for a row of the wider of B and Q.
    """
    p, q = B.shape[0], B.shape[1]
    for j in range(q):
        order[j] = j
    for k in range(min(p, q)):
        for j in range(k, q):
            w[j] = 0.0
        for i in range(k, p):
            for j in range(k, q):
                w[j] += B[i, j] * B[i, j]
        best = k
        for j in range(k + 1, q):
            if w[j] > w[best]:
                best = j
        square = w[best]
        if square == 0.0:
            return
        if best != k:
            order[k], order[best] = order[best], order[k]
            for i in range(p):
                B[i, k], B[i, best] = B[i, best], B[i, k]
        alpha = -copysign(sqrt(square), B[k, k])
        B[k, k] -= alpha
        scale = -1.0 / (alpha * B[k, k])
        reflect(B, k, scale, B, k + 1, w)
        reflect(B, k, scale, Q, 0, w)
        B[k, k] = alpha
        for i in range(k + 1, p):
            B[i, k] = 0.0


@internal
def reflect(B, k, scale, A, first, w):
    """A -= scale v v^T A in its columns from `first` on, v: column k of B from its diagonal on."""
    for j in range(first, A.shape[1]):
        w[j] = B[k, k] * A[k, j]
    for i in range(k + 1, B.shape[0]):
        for j in range(first, A.shape[1]):
            w[j] += B[i, k] * A[i, j]
    for j in range(first, A.shape[1]):
        w[j] *= scale
        A[k, j] -= B[k, k] * w[j]
    for i in range(k + 1, B.shape[0]):
        for j in range(first, A.shape[1]):
            A[i, j] -= B[i, k] * w[j]


@internal
def invert(A, order):
    """A becomes its inverse, by elimination with exchange of rows [GolubVanLoan2013 3.4].

    order (n) : filled with the rows exchanged.  Returns the sign of the determinant; 0 where A is
    singular, and then A is none.
    """
    n, sign = order.size, 1.0
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[best, k]):
                best = i
        if not abs(A[best, k]) > 0.0:  # NaN as well
            return 0.0
        order[k] = best
        if best != k:
            sign = -sign
            for j in range(n):
                A[k, j], A[best, j] = A[best, j], A[k, j]
        pivot = A[k, k]
        sign = sign if pivot > 0.0 else -sign
        A[k, k] = 1.0
        for j in range(n):
            A[k, j] /= pivot
        for i in range(n):
            part = A[i, k]
            if i != k and part != 0.0:
                A[i, k] = 0.0
                for j in range(n):
                    A[i, j] -= part * A[k, j]
    for k in range(n - 1, -1, -1):  # columns as rows went
        at = order[k]
        if at != k:
            for i in range(n):
                A[i, k], A[i, at] = A[i, at], A[i, k]
    return sign


@compiled(void(A2, A1))
def backwards(U, x):
    """x, the right side, becomes the solution of U x = b, U upper triangular."""
    for k in range(len(x) - 1, -1, -1):
        x[k] /= U[k, k]
        for i in range(k):
            x[i] -= U[i, k] * x[k]


@compiled(int64(A2, A2))
def diagonalised(A, V):
    """A, symmetric, becomes diagonal by Jacobi's rotations; V, rows, turns along.  Sweeps taken."""
    n = A.shape[0]
    for sweep in range(SWEEPS):
        turned = False
        for p in range(n - 1):
            for q in range(p + 1, n):
                off = A[p, q]
                if abs(off) <= 1e-17 * sqrt(abs(A[p, p] * A[q, q])) or abs(off) < 1e-300:
                    continue
                turned = True
                theta = 0.5 * (A[q, q] - A[p, p]) / off
                t = copysign(1.0, theta) / (abs(theta) + sqrt(theta * theta + 1.0))
                c = 1.0 / sqrt(t * t + 1.0)
                s = t * c
                for k in range(n):
                    a, b = A[p, k], A[q, k]
                    A[p, k], A[q, k] = c * a - s * b, s * a + c * b
                for k in range(n):
                    a, b = A[k, p], A[k, q]
                    A[k, p], A[k, q] = c * a - s * b, s * a + c * b
                A[p, q] = 0.0
                A[q, p] = 0.0
                for k in range(n):
                    a, b = V[p, k], V[q, k]
                    V[p, k], V[q, k] = c * a - s * b, s * a + c * b
        if not turned:
            return sweep
    return SWEEPS


def length(v: Array) -> float:
    """The length of a vector."""
    return sqrt(float(np.sum(np.square(v))))


def product(A: Array, b: Array) -> Array:
    """A b, of a matrix with a vector or with a matrix."""
    return np.einsum("ij,j->i" if b.ndim == 1 else "ij,jk->ik", A, b)


def turned(R: Sequence[Sequence[float]], v: Sequence[float]) -> tuple[float, float, float]:
    """R v of a rotation, as rows of floats: to the bit what `product` gives, at a fifth of the time
    that asking numpy for three numbers takes."""
    x, y, z = v
    (a, b, c), (d, e, f), (g, h, i) = R
    # einsum begins with zero and adds the products of a row in pairs
    return (
        (0.0 + a * x + c * z) + b * y,
        (0.0 + d * x + f * z) + e * y,
        (0.0 + g * x + i * z) + h * y,
    )


def turned_back(R: Sequence[Sequence[float]], v: Sequence[float]) -> tuple[float, float, float]:
    """R^T v, as `product` of the transposed gives it: column by column, one row after the other."""
    x, y, z = v
    (a, b, c), (d, e, f), (g, h, i) = R
    return 0.0 + a * x + d * y + g * z, 0.0 + b * x + e * y + h * z, 0.0 + c * x + f * y + i * z


def _triangle(B: Array, Q: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    R, Q = np.array(B, float, order="C"), np.array(Q, float, order="C")
    order = np.zeros(R.shape[1], np.int64)
    if R.size:
        triangle(R, Q, np.zeros(max(R.shape[1], Q.shape[1])), order)
    return R, Q, order


def spaces(J: Array, least: float) -> tuple[Array, Array]:
    """Orthonormal rows that span the rows of J, and those that J maps to zero.

    least: of the largest row, what must be left of one that does not depend on the others.
    """
    R, Q, _ = _triangle(J.T, np.eye(J.shape[1]))
    rank = _rank(R, least)
    return Q[:rank], Q[rank:]


def least_squares(A: Array, b: Array, least: float) -> Array:
    """The shortest x with the least |A x - b|; least: as in `spaces`."""
    R, Q, order = _triangle(A.T, np.eye(A.shape[1]))
    rank = _rank(R, least)
    # A[order] = L Q[:rank], so that |L y - b[order]| is to be least
    L, c = R[:rank].T, b[order]
    U, turned, second = _triangle(L, c[:, None])
    y = np.zeros(rank)
    x = turned[:rank, 0].copy()
    backwards(U[:rank], x)
    y[second] = x
    return np.sum(Q[:rank] * y[:, None], axis=0)


def _rank(R: Array, least: float) -> int:
    diagonal = np.abs(np.diagonal(R))
    return int(np.sum(diagonal > least * max(diagonal.max(initial=0.0), 1e-300)))


def symmetric(K: Array) -> tuple[Array, Array]:
    """Eigenvalues of a symmetric matrix, rising, and their vectors as columns."""
    A, V = np.array(K, float, order="C"), np.eye(len(K))
    diagonalised(A, V)
    values = np.diagonal(A)
    rising = np.argsort(values, kind="stable")
    return values[rising].copy(), V[rising].T.copy()


def inverse(M: Array) -> Array:
    """The inverse of a small regular matrix, by Gauss and Jordan with exchange of rows."""
    n = len(M)
    A = np.hstack([M, np.eye(n)])
    for k in range(n):
        best = k + int(np.argmax(np.abs(A[k:, k])))
        A[[k, best]] = A[[best, k]]
        A[k] /= A[k, k]
        for i in range(n):
            if i != k:
                A[i] -= A[i, k] * A[k]
    return A[:, n:].copy()  # compiled code takes constants as they lie in memory
