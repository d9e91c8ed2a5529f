"""Constrained sparse systems on a pattern found once, against numpy."""

from typing import NamedTuple

import numpy as np
import pytest
from numba import njit

from trsim.assemble.elimination import elimination
from trsim.solve.methods import sparse_lu

from ..assemble.test_elimination import CASES, chain, dense_pattern


class Pattern(NamedTuple):
    entry_start: np.ndarray
    entry_column: np.ndarray
    start: np.ndarray
    column: np.ndarray
    lower_start: np.ndarray
    lower: np.ndarray


@njit
def real(p, value, lower, upper, inverse, work, x):
    small = sparse_lu.factorise_sparse(p, value, lower, upper, inverse, work)
    if small >= 0:
        sparse_lu.solve_sparse(p, lower, upper, inverse, x)
    return small


@njit
def complex_(p, value, lower, upper, inverse, work, x):
    small = sparse_lu.factorise_sparse_complex(p, value, lower, upper, inverse, work)
    if small >= 0:
        sparse_lu.solve_sparse(p, lower, upper, inverse, x)
    return small


def system(case, seed=0, turn=1.0, double=False):
    """A constrained matrix [[H, B^T], [B, 0]] of a case; H turned in the complex plane.

    double: the last constraint row repeats the one before.
    """
    near, size, free = case
    n, n_h = sum(size), sum(size[:free])
    rng = np.random.default_rng(seed)
    A = np.where(dense_pattern(near, size), rng.normal(size=(n, n)), 0.0)
    A[n_h:, n_h:] = 0.0
    A[:n_h, n_h:] = A[n_h:, :n_h].T
    A[:n_h, :n_h] += 20.0 * np.eye(n_h)
    if double:
        A[-1] = A[-2]
        A[:, -1] = A[:, -2]
    full = A.astype(complex)
    full[:n_h, :n_h] *= turn
    return full


def solved(case, A, b):
    """Number of small pivots and the solution, as complex numbers, by both codes where A is real"""
    near, size, free = case
    found = elimination(near, size, free)
    n, l = len(found.rank), len(found.lower)
    ordered = np.zeros_like(A)
    ordered[np.ix_(found.rank, found.rank)] = A
    pattern = np.zeros((n, n), bool)
    pattern[np.ix_(found.rank, found.rank)] = dense_pattern(near, size)
    rows, columns = np.nonzero(pattern)
    p = Pattern(np.searchsorted(rows, np.arange(n + 1)), columns, *found[1:])
    value, x = ordered[rows, columns], np.zeros(n, complex)
    x[found.rank] = b
    only = x.real.copy()
    small = complex_(p, value, *np.zeros((2, l), complex), *np.zeros((2, n), complex), x)
    if np.all(A.imag == 0.0) and np.all(b.imag == 0.0):
        assert small == real(p, value, *np.zeros((2, l)), *np.zeros((2, n)), only)
        assert only == pytest.approx(x, rel=1e-9, abs=1e-6 if small else 1e-12)
    return small, x[found.rank]


# in CASES some joints repeat each other: there are fewer independent rows than rows
SOUND = {"chain": chain(7), "long chain": chain(40)}


@pytest.mark.parametrize("turn", [1.0, np.exp(1j), np.exp(2.6j)], ids=["real", "turned", "far"])
@pytest.mark.parametrize("case", SOUND.values(), ids=SOUND)
def test_against_numpy(case, turn):
    A = system(case, turn=turn)
    b = np.random.default_rng(1).normal(size=len(A)).astype(complex)
    small, x = solved(case, A, b)
    assert small == 0
    assert x == pytest.approx(np.linalg.solve(A, b), rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("turn", [1.0, np.exp(1j)], ids=["real", "turned"])
def test_a_dependent_row_is_met_and_its_system_still_solved(turn):
    case = chain(7)
    A = system(case, turn=turn, double=True)
    b = A @ np.random.default_rng(1).normal(size=len(A))  # it has solutions
    small, x = solved(case, A, b)
    assert small == 1
    assert A @ x == pytest.approx(b, abs=1e-6)


def test_what_is_not_finite_is_told():
    case = CASES["chain"]
    A = system(case)
    A[0, 0] = np.nan
    assert solved(case, A, np.ones(len(A), complex))[0] == -1
