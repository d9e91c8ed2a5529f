"""The small dense systems of implicit methods, against numpy."""

import numpy as np
import pytest
from numba import njit

from trsim.solve.methods import dense_lu


@njit
def real(A, pivot, x):
    ok = dense_lu.factorise_real(A, pivot, x.size)
    if ok:
        dense_lu.solve_real(A, pivot, x, x.size)
    return ok


@njit
def complex_(A, pivot, x):
    ok = dense_lu.factorise_complex(A, pivot, x.size)
    if ok:
        dense_lu.solve_complex(A, pivot, x, x.size)
    return ok


@pytest.mark.parametrize("n", [1, 2, 7, 30])
def test_against_numpy(n):
    rng = np.random.default_rng(n)
    A, b = rng.normal(size=(n, n)), rng.normal(size=n)
    A[0, 0] = 0.0 if n > 1 else A[0, 0]  # needs a pivot
    x = b.copy()
    assert real(A.copy(), np.zeros(n, np.int64), x)
    assert x == pytest.approx(np.linalg.solve(A, b), rel=1e-9)
    A, b = A + 1j * rng.normal(size=(n, n)), b + 1j * rng.normal(size=n)
    x = b.copy()
    assert complex_(A.copy(), np.zeros(n, np.int64), x)
    assert x == pytest.approx(np.linalg.solve(A, b), rel=1e-9)


@pytest.mark.parametrize("A", [np.zeros((2, 2)), np.ones((3, 3)), np.full((2, 2), np.nan)])
def test_singular_is_told(A):
    n = len(A)
    assert not real(A.copy(), np.zeros(n, np.int64), np.ones(n))
    assert not complex_(A.astype(complex), np.zeros(n, np.int64), np.ones(n, complex))
