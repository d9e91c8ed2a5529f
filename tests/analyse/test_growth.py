"""The rate at which two runs part."""

import numpy as np
import pytest

from tests import small
from tests.analyse.series import lorenz
from trsim.analyse.growth import distance, growth, motions, of_runs
from trsim.analyse.window import Window
from trsim.errors import UsageError
from trsim.store.read import read

t = np.linspace(0.0, 30.0, 3001)


def test_exponential_growth():
    d = 1e-10 * np.exp(0.8 * t) * np.exp(0.3 * np.sin(3.0 * t))
    found = growth(t, np.minimum(d, 0.3))
    assert found.verdict == "grows"
    assert found.value == pytest.approx(0.8, abs=0.02)
    assert abs(found.value - 0.8) <= found.half


def test_interval_covers_the_rate_of_growth_with_fluctuations():
    """ln d with a random walk of its own on top of the growth, 200 times."""
    rng, inside = np.random.default_rng(4), []
    for _ in range(200):
        wander = 0.9 ** np.arange(60)
        y = 0.8 * t - 23.0 + np.convolve(rng.normal(0, 0.2, t.size), wander)[: t.size]
        found = growth(t, np.exp(y))
        inside.append(abs(found.value - 0.8) <= found.half)
    print(f"covers {np.mean(inside):.3f}, 0.95 expected")
    assert np.mean(inside) >= 0.9


def test_two_lorenz_systems():
    start = lorenz(2, before=20.0)[1][:, 0]
    time, one = lorenz(3000, 0.01, tuple(start), 0.0)
    _, two = lorenz(3000, 0.01, tuple(start + 1e-6), 0.0)
    found = growth(time, np.sqrt(np.mean(((one - two) / np.ptp(one, axis=1)[:, None]) ** 2, 0)))
    print(f"{found.value:.3f} +- {found.half:.3f}, known 0.906")
    assert found.verdict == "grows"
    assert found.value == pytest.approx(0.906, rel=0.15)  # one stretch of 15 s


@pytest.mark.parametrize(
    "d, verdict, why",
    [
        (1e-9 * (1.0 + 0.3 * np.sin(t)), "none", "stay together"),
        (np.zeros_like(t), "undetermined", "same to the last bit"),
        (np.where(t < 15.0, 1e-9, 1e-2), "undetermined", "straight line"),
        (np.where(t < 0.2, 1e-9, 1.0), "undetermined", "too few rows"),
        (1e-9 * np.ones(50), "undetermined", "too few"),
    ],
)
def test_what_does_not_grow_says_so(d, verdict, why):
    found = growth(t[: len(d)], d)
    assert found.verdict == verdict
    assert why in found.reason


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("growth")
    for name, clearance in (("a", "0.5 mm"), ("b", "0.5000000005 mm"), ("c", "0.1 mm")):
        small.run(folder / f"{name}.h5", f"joints.B.clearance={clearance}")
    small.run(folder / "d.h5", "output.every=0.007 ms")
    return {name: read(folder / f"{name}.h5") for name in "abcd"}


def test_differences_are_of_ranges_of_what_moves(runs):
    time, off = motions(runs["a"], runs["c"])
    assert off.shape[0] == len(time) == runs["a"].rows
    stroke = runs["a"].channel("stroke")
    expected = (stroke - runs["c"].channel("stroke")) / np.ptp(stroke)
    assert any(np.allclose(column, expected) for column in off.T)
    assert np.isfinite(off).all()
    assert np.abs(off).max() < 10.0  # nothing at rest is divided by its rounding


def test_distance_of_two_runs(runs):
    time, d = distance(runs["a"], runs["b"], Window(1e-3, 2e-3))
    assert (time[0], time[-1]) == (pytest.approx(1e-3), pytest.approx(2e-3))
    assert 0.0 < d.max() < 1e-4
    assert of_runs(runs["a"], runs["a"]).reason == "the two runs are the same to the last bit"


def test_runs_without_common_rows_are_refused(runs):
    with pytest.raises(UsageError, match="no rows of motion in common"):
        distance(runs["a"], runs["d"], Window(1e-3, 2e-3))
