"""Sobol indices: which share of the variance of an output each swept number is to blame for.

    S_i = Var(E(f | x_i)) / Var(f)          alone
    T_i = E(Var(f | x_~i)) / Var(f)         with all its interactions

by scipy.stats.sobol_indices, from the blocks A, B and AB_i (A with column i of B) of Saltelli's
design [Saltelli2010].  Intervals are 95 % by bootstrap; to see whether there are enough cases the
indices are also taken of the first 8, 16, 32 ... rows of the blocks.  S_i <= T_i and sum S_i <= 1;
estimates that are not so by more than their intervals are of too few rows.

An output of a chaotic motion is a number with noise: whatever is changed, however little, changes
it.  That raises every T_i.  A number that ought to have no influence (a parameter named `dummy`, or
one of `solver.*`) shows by how much: its indices are those of the noise.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.interval import LEVEL
from trsim.arrays import Array
from trsim.errors import UsageError
from trsim.statuses import NOT_NEEDED

RESAMPLES = 500
CASE = "case"  # the key of named cases
FIRST = 8  # rows of the smallest estimate


NOISE = ("dummy", "noise")  # last words of keys that are varied only to show it


class Index(NamedTuple):
    """The indices of one key, and their intervals."""

    key: str
    first: float
    first_low: float
    first_high: float
    total: float
    total_low: float
    total_high: float
    noise: bool  # ought to have no influence


class Indices(NamedTuple):
    """The indices of one output."""

    word: str
    unit: str
    rows: int  # of each block
    left_out: int  # rows with a case that has no number
    mean: float
    deviation: float
    indices: tuple[Index, ...]
    convergence: tuple[tuple[int, Array, Array], ...]  # rows, S (d), T (d)
    sum_low: float  # of the first orders, the lower end of its interval


class Blocks(NamedTuple):
    """The values of an output in the blocks of a design."""

    a: Array  # (n)
    b: Array  # (n)
    ab: Array  # (d, n)


def named(study: Any) -> dict[str, list[Any]]:
    """The cases of a study by the name they have in `cases:`, "" where it has none."""
    found: dict[str, list[Any]] = {}
    for case in study.cases:
        found.setdefault(str(case.values.get(CASE, "")), []).append(case)
    return found


def places(study: Any, cases: Sequence[Any]) -> Any:
    """The cases of one design by block: A (n), B (n), AB_i (n), as (d + 2, n).

    Raises UsageError where they are no such design.
    """
    keys, n = factors(study, cases), study.samples
    if study.method != "sobol":
        what = f"the study was made by `{study.method}`, not by `sobol`"
        raise UsageError(what, "Sobol indices need the cases of `sweep: {method: sobol}`.")
    if not keys:
        raise UsageError("nothing is sampled", "Give the case a key under `sweep`.")
    if len(cases) != n * (len(keys) + 2):
        what = f"{len(cases)} cases; {n} samples of {len(keys)} keys take {n * (len(keys) + 2)}"
        raise UsageError(what, "Make the study anew with `method: sobol`.")
    table = np.array([*cases, None], dtype=object)[:-1].reshape(len(keys) + 2, n)
    for i, key in enumerate(keys):
        for a, b, ab in zip(table[0], table[1], table[2 + i], strict=True):
            if any(ab.values[k] != (b if k == key else a).values[k] for k in keys):
                what = f"case {ab.name} is not {a.name} with the {key} of {b.name}"
                raise UsageError(what, "Make the study anew with `method: sobol`.")
    # rows of which no case was asked for are no part of the design
    return table[:, [any(case.status != NOT_NEEDED for case in row) for row in table.T]]


def factors(study: Any, cases: Sequence[Any]) -> tuple[str, ...]:
    """The keys that are sampled in the cases of one design."""
    own = {key for case in cases for key in case.values} - {CASE}
    return tuple(key for key in study.keys if key in own)


def blocks(table: Any, number: Callable[[Any], float]) -> tuple[Blocks, int]:
    """The values of the complete rows, as many as the largest power of two; how many were not."""
    every = np.array([[number(case) for case in block] for block in table])
    whole = np.isfinite(every).all(axis=0)
    kept = every[:, whole]
    size = 1 << (max(kept.shape[1], 1).bit_length() - 1)
    if kept.shape[1] < FIRST:
        what = f"{kept.shape[1]} complete rows of the design are too few, {FIRST} are needed"
        raise UsageError(what, "Run the missing cases, or more samples.")
    return Blocks(kept[0, :size], kept[1, :size], kept[2:, :size]), int(np.sum(~whole))


def indices(keys: Sequence[str], values: Blocks, word: str = "", unit: str = "-",
            left_out: int = 0) -> Indices:  # fmt: skip
    """First and total indices of d keys with intervals, and their convergence."""
    n = len(values.a)
    every = np.concatenate([values.a, values.b])
    deviation = float(np.std(every))
    if deviation <= 1e-12 * float(np.max(np.abs(every))):
        raise UsageError(f"{word} is the same in all cases", "Nothing has an influence on it.")
    first, total = _indices(values)
    drawn = np.random.default_rng(1).integers(0, n, (RESAMPLES, n))
    again = np.array([_indices(taken(values, rows)) for rows in drawn])  # (resamples, 2, d)
    (first_low, total_low), (first_high, total_high) = np.quantile(
        again, [0.5 - LEVEL / 2, 0.5 + LEVEL / 2], axis=0
    )
    table = np.transpose([first, first_low, first_high, total, total_low, total_high]).tolist()
    steps = [1 << k for k in range(FIRST.bit_length() - 1, n.bit_length())]
    return Indices(
        word, unit, n, left_out, float(np.mean(every)), deviation,
        tuple(Index._make((key, *row, noisy(key))) for key, row in zip(keys, table, strict=True)),
        tuple((m, *_indices(taken(values, slice(m)))) for m in steps),
        float(np.quantile(again[:, 0].sum(axis=1), 0.5 - LEVEL / 2)),
    )  # fmt: skip


def impossible(of: Indices) -> list[str]:
    """What the indices say beyond their intervals that cannot be: S_i > T_i, or sum of S_i > 1."""
    found = [
        f"first {one.first:.3f} of {one.key} is more than its total {one.total:.3f}"
        for one in of.indices
        if one.first_low > one.total_high
    ]
    if of.sum_low > 1.0:
        total = sum(one.first for one in of.indices)
        found.append(f"the first orders add up to {total:.3f}, more than 1")
    return found


def taken(values: Blocks, rows: Any) -> Blocks:
    """Some rows of the blocks."""
    return Blocks(values.a[rows], values.b[rows], values.ab[:, rows])


def _indices(values: Blocks) -> tuple[Array, Array]:
    from scipy.stats import sobol_indices

    a, b = values.a[None], values.b[None]
    found = sobol_indices(func={"f_A": a, "f_B": b, "f_AB": values.ab[:, None]}, n=a.shape[1])
    return np.atleast_1d(found.first_order), np.atleast_1d(found.total_order)


def noisy(key: str) -> bool:
    """Whether a key ought to have no influence on a motion."""
    return key.startswith("solver.") or key.rsplit(".", 1)[-1] in NOISE
