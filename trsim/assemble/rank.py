"""Which rows depend on each other, told from their numbers.

Most mechanisms have no such rows, and that is cheap to prove.  With R the rows at length one and
G = R R^T, which is as sparse as the mechanism,

    least singular value of R  >=  1 / sqrt(trace(G^-1))

and what is left of a row after any others are taken out is 1 / sqrt((G^-1)_kk) at least.  The
diagonal of G^-1 follows from G = L D L^T with the entries of L alone [Takahashi1973], so the proof
costs as much as factorising: for a chain in proportion to its length.  Rounding moves the
eigenvalues of G by some 1e-15, far below what is asked for.  Only where the proof fails the rows
are looked at one by one, or by singular values, at a cost that grows with the cube of their number.
"""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.pattern import eliminate, minimum_degree

Array = NDArray[np.float64]

DEPENDENT = 1e-8  # of a row left after the rows before it are taken out
FEW = 250  # rows up to which a dense matrix is cheaper
PLAIN = 1e-4  # least singular value of rows that are independent beyond doubt


def of_length_one(J: Array, scale: Array) -> Array:
    """The rows of J, weighed, at length one; zero where they vanish."""
    rows = J * scale
    length = np.linalg.norm(rows, axis=1)
    return np.asarray(rows / np.where(length > 0.0, length, 1.0)[:, None])


def neighbours_of(rows: Array) -> list[set[int]]:
    """For each row the others it shares a column with."""
    found: list[set[int]] = [set() for _ in rows]
    k, column = np.nonzero(rows)
    by_column = k[np.argsort(column, kind="stable")]
    starts = np.cumsum(np.bincount(column, minlength=rows.shape[1]))
    # the columns of a body are mostly touched by the same rows
    for together in {tuple(part.tolist()) for part in np.split(by_column, starts[:-1])}:
        for row in together:
            found[row].update(together)
    for row, near in enumerate(found):
        near.discard(row)
    return found


def plainly_independent(rows: Array) -> bool:
    """Whether rows of length one have no singular value below PLAIN; True is a proof."""
    return dense_proof(rows) if len(rows) <= FEW else sparse_proof(rows)


def sparse_proof(rows: Array) -> bool:
    """The proof of `plainly_independent` by L D L^T of rows rows^T along its zeros."""
    m = len(rows)
    near = neighbours_of(rows)
    order = minimum_degree(near)
    columns = list(zip(order, eliminate(near, order), strict=True))
    G, factors = np.zeros((m, m)), []  # of G only the entries of L are filled
    for k, others in enumerate(near):
        at = [k, *others]
        G[k, at] = rows[at] @ rows[k]
    for k, under in columns:
        D = G[k, k]
        if not D > PLAIN * PLAIN:
            return False
        L = G[under, k] / D
        G[np.ix_(under, under)] -= np.outer(L, G[under, k])
        factors.append((k, under, D, L))
    trace, inverse = 0.0, G  # its entries take the place of those they need no longer
    for k, under, D, L in reversed(factors):
        across = -inverse[np.ix_(under, under)] @ L
        inverse[under, k] = inverse[k, under] = across
        inverse[k, k] = 1.0 / D - L @ across
        trace += inverse[k, k]
    return bool(trace * PLAIN * PLAIN < 1.0)


def dense_proof(rows: Array) -> bool:
    """That proof by dense factors, where it is cheaper not to look for zeros."""
    try:
        inverse = np.linalg.inv(np.linalg.cholesky(rows @ rows.T))
    except np.linalg.LinAlgError:
        return False
    return bool(np.sum(inverse * inverse) * PLAIN * PLAIN < 1.0)


def dependent_rows(J: Array, scale: Array, order: list[int], least: float = DEPENDENT) -> set[int]:
    """Rows that depend on the rows before them in `order` (Gram-Schmidt, twice)."""
    rows = of_length_one(J, scale)
    if least < PLAIN and plainly_independent(rows[order]):
        return set()
    return one_by_one(rows, order, least)


def one_by_one(rows: Array, order: list[int], least: float = DEPENDENT) -> set[int]:
    """The same of rows of length one, without a look at whether there are any."""
    basis, rank = np.zeros((len(order), rows.shape[1])), 0
    found = set()
    for k in order:
        row = rows[k]
        for _ in range(2):
            row = row - (basis[:rank] @ row) @ basis[:rank]
        left = sqrt(row.dot(row))
        if left < least:
            found.add(k)
        else:
            basis[rank] = row / left
            rank += 1
    return found


def unique_reactions(J: Array, scale: Array) -> NDArray[np.bool_]:
    """Which rows have a multiplier that the motion determines: no part in the null space of J^T."""
    rows = of_length_one(J, scale)
    if plainly_independent(rows):
        return np.ones(len(rows), bool)
    u, s, _ = np.linalg.svd(rows, full_matrices=True)
    rank = int(np.sum(s > DEPENDENT * max(1.0, s.max(initial=1.0))))
    return np.asarray(np.linalg.norm(u[:, rank:], axis=1) < 1e-7)
