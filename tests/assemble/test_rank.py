"""Dependent rows: a cheap proof that there are none, and what is found where there are some."""

import numpy as np
import pytest

from benchmarks.problems import chain
from trsim.assemble import rank
from trsim.assemble import rows as choosing
from trsim.assemble.rank import (
    PLAIN,
    dense_proof,
    dependent_rows,
    of_length_one,
    sparse_proof,
    unique_reactions,
)
from trsim.scenario.load import loads

from ..runs import assemble


def linked(rng, m=24, width=3):
    """Rows of a random tree of bodies, each row on two of them, at length one (m, columns)."""
    J = np.zeros((m, width * (m + 1)))
    for k in range(m):
        for body in (k + 1, rng.integers(0, k + 1)):
            J[k, width * body : width * (body + 1)] = rng.normal(size=width)
    return of_length_one(J, np.ones(J.shape[1]))


PROOFS = pytest.mark.parametrize("plainly_independent", [sparse_proof, dense_proof])


@PROOFS
@pytest.mark.parametrize("seed", range(8))
def test_proof_is_true_and_does_not_ask_for_too_much(seed, plainly_independent):
    rng = np.random.default_rng(seed)
    rows = linked(rng)
    for shrunk in (1.0, 1e-3, 3e-5, 1e-9, 0.0):
        near = rows.copy()
        # the last row becomes a combination of others, but for a small part
        near[-1] = rng.normal(size=len(rows) - 1) @ rows[:-1] / 10 + shrunk * rows[-1]
        near = of_length_one(near, np.ones(near.shape[1]))
        least = np.linalg.svd(near, compute_uv=False).min()
        said = plainly_independent(near)
        assert said <= (least > PLAIN)
        assert said or least < PLAIN * np.sqrt(len(near))


@PROOFS
def test_trace_of_the_inverse(monkeypatch, plainly_independent):
    """The bound is where trace(G^-1) says, to rounding."""
    rows = linked(np.random.default_rng(1), 40)
    bound = 1.0 / np.sqrt(np.trace(np.linalg.inv(rows @ rows.T)))
    for factor, expected in ((1 - 1e-9, True), (1 + 1e-9, False)):
        monkeypatch.setattr(rank, "PLAIN", factor * bound)
        assert plainly_independent(rows) is expected


@pytest.mark.parametrize("part, found", [(0.0, {9}), (1e-9, {9}), (1e-7, set()), (1.0, set())])
def test_dependent_rows(part, found):
    """The last of three rows in `order` is found, whichever of them it is."""
    rows = linked(np.random.default_rng(2))
    apart = np.zeros(rows.shape[1])
    apart[0] = part
    rows[9] = 0.6 * rows[3] - 0.8 * rows[20] + apart * np.linalg.norm(rows[3])
    ones = np.ones(rows.shape[1])
    order = [k for k in range(len(rows)) if k != 9]
    assert dependent_rows(rows, ones, [*order, 9]) == found
    first = [9, *reversed(order)]
    assert dependent_rows(rows, ones, first) == ({3} if found else set())
    assert dependent_rows(rows, ones, order) == set()
    assert unique_reactions(rows, ones).sum() == (len(rows) - 3 if found else len(rows))


def test_a_row_of_zeros_depends():
    rows = linked(np.random.default_rng(3))
    rows[4] = 0.0
    assert dependent_rows(rows, np.ones(rows.shape[1]), list(range(len(rows)))) == {4}


def test_a_long_chain_is_judged_by_the_proof(monkeypatch):
    """No Gram-Schmidt, no singular values: their cost grows with the cube of the length."""
    monkeypatch.setattr(rank.np.linalg, "svd", None)
    proofs = []
    monkeypatch.setattr(
        choosing, "plainly_independent", lambda rows: proofs.append(sparse_proof(rows)) or True
    )
    mechanism = assemble(loads(chain(40)))
    assert proofs and all(proofs)
    assert (mechanism.mobility, mechanism.redundant, mechanism.not_unique) == (120, (), ())
