"""Confidence intervals hold what they promise, whatever the memory of a series."""

import numpy as np
import pytest

from trsim.analyse.interval import LEVEL, Batches, batches, half_width, half_widths


def autoregressive(memory, n, repeats, seed):
    """Series (n, repeats) of mean zero: each value is `memory` times the one before, and noise."""
    noise = np.random.default_rng(seed).standard_normal((n + 1000, repeats))
    x = np.zeros_like(noise)
    for k in range(1, len(x)):
        x[k] = memory * x[k - 1] + noise[k]
    return x[1000:]


@pytest.mark.parametrize("memory", [0.0, 0.9, 0.97])
def test_interval_covers_the_true_mean(memory):
    series = autoregressive(memory, 4000, 400, seed=3)
    halves = np.array([half_width(x) for x in series.T])
    given = np.isfinite(halves)
    covered = np.mean(np.abs(series.mean(axis=0))[given] <= halves[given])
    print(f"memory {memory}: covers {covered:.3f} of {given.mean():.3f}, {LEVEL} expected")
    assert given.mean() > 0.95
    assert 0.90 <= covered <= 0.99


def test_interval_of_values_without_memory_is_the_textbook_one():
    x = np.random.default_rng(1).standard_normal((6400, 100))
    halves = [half_width(column) for column in x.T]
    assert np.median(halves) == pytest.approx(1.96 / 80.0, rel=0.1)


def test_a_drift_has_no_interval():
    assert np.isnan(half_width(np.linspace(0.0, 1.0, 1000)))


def test_few_values_have_no_interval():
    assert batches(31) == 0
    assert np.isnan(half_width(np.zeros(31)))
    assert np.isnan(half_widths(np.zeros((4, 2)))).all()


def test_a_constant_is_known():
    assert half_width(np.full(200, 7.0)) == 0.0


def test_pieces_make_no_difference():
    x = autoregressive(0.8, 1000, 3, seed=5)
    kept = Batches(len(x), 3)
    for begin, end in ((0, 1), (1, 20), (20, 333), (333, 333), (333, 1000)):
        kept.take(x[begin:end])
    np.testing.assert_allclose(kept.half, [half_width(column) for column in x.T], rtol=1e-12)
    np.testing.assert_allclose(kept.mean, x.mean(axis=0), rtol=1e-12)
