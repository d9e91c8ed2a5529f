"""Dense linear algebra without a BLAS, against numpy.linalg."""

import numpy as np
import pytest

from trsim.assemble import dense

EPS = np.finfo(float).eps


@pytest.mark.parametrize("seed", range(20))
def test_least_squares(seed):
    """Any shape and rank, consistent or not: error within the condition times rounding."""
    rng = np.random.default_rng(seed)
    m, n = rng.integers(1, 30, 2)
    r = int(rng.integers(1, min(m, n) + 1))
    A = rng.normal(size=(m, r)) @ rng.normal(size=(r, n))
    b = rng.normal(size=m)
    x, s = dense.least_squares(A, b, 1e-10), np.linalg.svd(A)[1][:r]
    exact = np.linalg.lstsq(A, b, rcond=1e-10)[0]
    # an inconsistent right-hand side feels the square of the condition [GolubVanLoan2013 5.3.7]
    bound = 10.0 * EPS * (s[0] / s[-1]) ** 2 * np.sqrt(m * n) * np.linalg.norm(b) / s[0]
    assert np.linalg.norm(x - exact) <= bound
    rows, none = dense.spaces(A, 1e-10)
    assert len(rows) == r and len(none) == n - r
    Q = np.vstack([rows, none])
    np.testing.assert_allclose(Q @ Q.T, np.eye(n), atol=20.0 * n * EPS)
    assert np.abs(A @ none.T).max(initial=0.0) <= 20.0 * n * EPS * s[0]


def test_nothing_to_solve():
    assert dense.least_squares(np.zeros((0, 3)), np.zeros(0), 1e-10).tolist() == [0.0] * 3
    assert dense.least_squares(np.zeros((2, 3)), np.ones(2), 1e-10).tolist() == [0.0] * 3
    assert dense.least_squares(np.zeros((2, 0)), np.ones(2), 1e-10).shape == (0,)
    rows, none = dense.spaces(np.zeros((0, 4)), 1e-10)
    assert rows.shape == (0, 4) and none.tolist() == np.eye(4).tolist()


@pytest.mark.parametrize("n", [1, 2, 3, 8, 40])
def test_symmetric_and_inverse(n):
    rng = np.random.default_rng(n)
    K = rng.normal(size=(n, n))
    K = K + K.T
    values, vectors = dense.symmetric(K)
    scale = np.abs(values).max()
    np.testing.assert_allclose(values, np.linalg.eigvalsh(K), atol=20 * n * EPS * scale)
    np.testing.assert_allclose(K @ vectors, vectors * values, atol=20 * n * EPS * scale)
    np.testing.assert_allclose(vectors.T @ vectors, np.eye(n), atol=20 * n * EPS)
    M = K @ K + np.eye(n)
    found = dense.inverse(M)
    bound = 20 * n * EPS * np.linalg.cond(M)
    assert np.abs(found @ M - np.eye(n)).max() <= bound


def test_equal_values_and_a_matrix_of_zeros():
    values, vectors = dense.symmetric(np.diag([2.0, 1.0, 2.0]))
    assert values.tolist() == [1.0, 2.0, 2.0]
    assert np.abs(vectors).sum() == 3.0
    assert dense.symmetric(np.zeros((3, 3)))[0].tolist() == [0.0] * 3


@pytest.mark.parametrize("seed", range(8))
def test_inverse(seed):
    """Also where a pivot is zero as it stands: error within the condition times rounding."""
    n, rng = 1 + seed, np.random.default_rng(seed)
    A = rng.normal(size=(n, n))
    A[0, 0] = A[n // 2, n // 2] = 0.0 if n > 1 else 3.0
    found = A.copy()
    sign = dense.invert.python(found, np.zeros(n, np.int64))
    assert sign == np.linalg.slogdet(A)[0]
    allowed = 10.0 * n * EPS * np.linalg.cond(A)
    assert np.abs(found @ A - np.eye(n)).max() <= allowed


def test_what_has_no_inverse_is_said_to_have_none():
    for A in (np.zeros((2, 2)), np.ones((3, 3)), np.full((2, 2), np.nan)):
        assert dense.invert.python(A, np.zeros(len(A), np.int64)) == 0.0
