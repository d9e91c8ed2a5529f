"""Sobol indices of Ishigami's function, whose indices are known."""

import numpy as np
import pytest

from tests.analyse.studies import Case, Study, of_blocks
from trsim.analyse.sobol import Blocks, blocks, factors, impossible, indices, named, noisy, places
from trsim.errors import UsageError

KEYS = ("a.x", "a.y", "a.z", "parameters.dummy")
A, B = 7.0, 0.1
VARIANCE = A**2 / 8 + B * np.pi**4 / 5 + B**2 * np.pi**8 / 18 + 0.5
FIRST = np.array([0.5 * (1 + B * np.pi**4 / 5) ** 2, A**2 / 8, 0.0, 0.0]) / VARIANCE
MIXED = B**2 * np.pi**8 * (1 / 18 - 1 / 50) / VARIANCE  # of x and z
TOTAL = FIRST + np.array([MIXED, 0.0, MIXED, 0.0])


def ishigami(values):
    """sin x + a sin^2 y + b z^4 sin x, all in -pi..pi."""
    x, y, z = (-np.pi + 2 * np.pi * values[key] for key in KEYS[:3])
    return float(np.sin(x) + A * np.sin(y) ** 2 + B * z**4 * np.sin(x))


@pytest.fixture(scope="module")
def study():
    from scipy.stats import qmc

    both = qmc.Sobol(2 * len(KEYS), seed=np.random.default_rng(7)).random(1024)
    return of_blocks(both[:, : len(KEYS)], both[:, len(KEYS) :], KEYS, 1024)


def test_known_indices(study):
    values, left_out = blocks(places(study, study.cases), lambda case: ishigami(case.values))
    found = indices(KEYS, values, "ishigami")
    assert (found.rows, left_out) == (1024, 0)
    np.testing.assert_allclose([one.first for one in found.indices], FIRST, atol=0.03)
    np.testing.assert_allclose([one.total for one in found.indices], TOTAL, atol=0.03)
    for one, first, total in zip(found.indices, FIRST, TOTAL, strict=True):
        assert one.first_low - 1e-9 <= first <= one.first_high + 1e-9
        assert one.total_low - 1e-9 <= total <= one.total_high + 1e-9
    assert [one.noise for one in found.indices] == [False, False, False, True]
    assert found.deviation**2 == pytest.approx(VARIANCE, rel=0.03)


def test_convergence_is_that_of_the_first_rows(study):
    values, _ = blocks(places(study, study.cases), lambda case: ishigami(case.values))
    found = indices(KEYS, values)
    assert [n for n, *_ in found.convergence] == [8, 16, 32, 64, 128, 256, 512, 1024]
    errors = [np.max(np.abs(total - TOTAL)) for _, _, total in found.convergence]
    assert max(errors[-3:]) < 0.1 * max(errors[:2]) + 0.05
    first = [one.first for one in found.indices]
    np.testing.assert_array_equal(found.convergence[-1][1], first)


def test_the_same_every_time(study):
    values, _ = blocks(places(study, study.cases), lambda case: ishigami(case.values))
    assert indices(KEYS, values).indices == indices(KEYS, values).indices


def test_rows_without_a_number_are_left_out_of_all_blocks(study):
    lost = {study.cases[5].name, study.cases[3 * 1024 + 9].name}

    def number(case):
        return np.nan if case.name in lost else ishigami(case.values)

    values, left_out = blocks(places(study, study.cases), number)
    assert (left_out, len(values.a), values.ab.shape) == (2, 512, (4, 512))
    kept = [k for k in range(1024) if k not in (5, 9)][:512]
    expected = [ishigami(study.cases[1024 * 4 + k].values) for k in kept]
    np.testing.assert_array_equal(values.ab[2], expected)
    np.testing.assert_allclose([one.total for one in indices(KEYS, values).indices], TOTAL,
                               atol=0.1)  # fmt: skip


def test_noise_shows_in_the_index_of_a_number_without_influence(study):
    rng = np.random.default_rng(0)
    values, _ = blocks(places(study, study.cases), lambda c: ishigami(c.values) + rng.normal())
    dummy = indices(KEYS, values).indices[3]
    assert dummy.total == pytest.approx(1.0 / (VARIANCE + 1.0), rel=0.2)
    assert noisy("solver.tolerance")
    assert not noisy("joints.B.clearance")


def test_named_cases_are_designs_of_their_own():
    rng = np.random.default_rng(1)
    one = of_blocks(rng.random((8, 1)), rng.random((8, 1)), ("a",), 8)
    cases = tuple(
        Case(f"{name}_{c.name}", {"case": name, **c.values}, c.file)
        for name in ("rigid", "flexible")
        for c in one.cases
    )
    both = Study(cases, ("case", "a"), {}, "sobol", 8)
    assert factors(both, both.cases) == ("a",)
    assert {name: len(found) for name, found in named(both).items()} == {
        "rigid": 24,
        "flexible": 24,
    }
    assert places(both, named(both)["flexible"]).shape == (3, 8)


def test_named_cases_sample_keys_of_their_own():
    rng = np.random.default_rng(1)
    fast = of_blocks(rng.random((8, 2)), rng.random((8, 2)), ("a", "b"), 8).cases
    slow = of_blocks(rng.random((8, 1)), rng.random((8, 1)), ("a",), 8).cases
    study = Study((*fast, *slow), ("case", "a", "b"), {}, "sobol", 8)
    assert (factors(study, fast), factors(study, slow)) == (("a", "b"), ("a",))
    assert (places(study, fast).shape, places(study, slow).shape) == ((4, 8), (3, 8))
    with pytest.raises(UsageError, match="nothing is sampled"):
        places(study, [Case("rigid", {"case": "rigid"}, fast[0].file)])


def test_what_is_no_design_is_refused(study):
    grid = Study(study.cases, KEYS, {}, "grid", 1024)
    with pytest.raises(UsageError, match="not by `sobol`"):
        places(grid, grid.cases)
    with pytest.raises(UsageError, match="take 6144"):
        places(study, study.cases[1:])
    shuffled = study.cases[::-1]
    with pytest.raises(UsageError, match="is not"):
        places(study, shuffled)
    with pytest.raises(UsageError, match="too few"):
        blocks(places(study, study.cases), lambda case: np.nan)
    same = Blocks(np.ones(8), np.ones(8), np.ones((2, 8)))
    with pytest.raises(UsageError, match="same in all cases"):
        indices(("a", "b"), same, "x")


def test_too_few_rows_are_told(study):
    """Random rows of a sum: eight of them give what no indices can be, a thousand do not."""

    def of(rows, seed):
        a, b = np.random.default_rng(seed).random((2, rows, 3))
        ab = np.array([np.where(np.arange(3) == i, b, a).sum(axis=1) for i in range(3)])
        return indices(("a", "b", "c"), Blocks(a.sum(axis=1), b.sum(axis=1), ab), "x")

    told = [text for seed in (13, 14, 15) for text in impossible(of(8, seed))]
    assert any("add up to" in text for text in told)
    values, _ = blocks(places(study, study.cases), lambda case: ishigami(case.values))
    good = indices(KEYS, values)
    assert impossible(good) == []
    odd = good.indices[0]._replace(first=0.8, first_low=0.7, total=0.5, total_high=0.6)
    [text] = impossible(good._replace(indices=(odd, *good.indices[1:])))
    assert text == f"first 0.800 of {odd.key} is more than its total 0.500"
