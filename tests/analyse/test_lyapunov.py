"""The largest Lyapunov exponent of series whose exponent is known, and of some that have none."""

import numpy as np
import pytest

from tests.analyse.series import LN2, henon, logistic, lorenz, roessler
from trsim.analyse.embedding import apart, delay, dimension, embedded, neighbours, period
from trsim.analyse.lyapunov import exponent
from trsim.analyse.scaling import line, straightest, weights

t = 0.01 * np.arange(5000)


@pytest.mark.parametrize(
    "series, known, dimensions",
    [
        (lambda: logistic(1000), LN2, 1),
        (lambda: logistic(5000), LN2, 1),
        (lambda: logistic(5000, 3.7), 0.354, 1),
        (lambda: henon(5000), 0.419, 2),
        (lambda: roessler(20000), 0.0714, 2),  # its attractor is flat but for a fold: 2.01
    ],
)
def test_known_exponents_lie_in_the_interval(series, known, dimensions):
    found = exponent(*series())
    print(f"{found.value:.4f} +- {found.half:.4f}, known {known:.4f}")
    assert found.verdict == "grows"
    assert found.dimension == dimensions
    assert abs(found.value - known) <= found.half < 0.2 * known


def test_lorenz_is_known_to_an_eighth():
    """Its finite distances grow a little faster than infinitesimal ones (docs/studies.md)."""
    found = exponent(*(part if k == 0 else part[0] for k, part in enumerate(lorenz(20000))))
    print(f"{found.value:.4f} +- {found.half:.4f}, known 0.906")
    assert found.value == pytest.approx(0.906, rel=0.125)
    assert found.value - found.half > 0.0


def test_time_has_a_unit():
    steps, x = logistic(2000)
    assert exponent(0.5 * steps, x).value == pytest.approx(2.0 * exponent(steps, x).value)


@pytest.mark.parametrize(
    "x",
    [
        np.sin(2 * np.pi * 1.03 * t),
        np.sin(2 * np.pi * 1.03 * t) + 0.5 * np.sin(2 * np.pi * 1.03 * np.sqrt(2.0) * t),
        logistic(3000, 3.2)[1],
        logistic(3000, 3.83)[1],
    ],
    ids=["sine", "quasi-periodic", "period 2", "period 3"],
)
def test_motion_that_repeats_itself_does_not_grow(x):
    found = exponent(t[: len(x)], x)
    assert found.verdict == "none"
    assert found.value == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize(
    "x, why",
    [
        (np.random.default_rng(1).standard_normal(5000), "noise"),
        (np.tanh(4.0 * (t - 20.0)) + 0.1 * np.sin(50.0 * t), "transient: its mean"),
        (np.exp(-0.1 * t) * np.sin(20.0 * t), "transient: its variance"),
        (np.sin(2 * np.pi * t / 5.0), "mean periods are too few"),
        (np.zeros(5000), "does not move"),
        (np.sin(t[:50]), "too few"),
    ],
)
def test_what_has_none_says_why(x, why):
    found = exponent(t[: len(x)], x)
    assert (found.verdict, np.isnan(found.value)) == ("undetermined", True)
    assert why in found.reason


def test_too_few_rows_for_a_flow():
    time, x = lorenz(3000)
    assert exponent(time, x[0]).verdict == "undetermined"


# --- its parts -------------------------------------------------------------------------------


def test_embedding():
    x = np.arange(10.0)
    points = embedded(x, 3, 2)
    np.testing.assert_array_equal(points[0], [0.0, 2.0, 4.0])
    np.testing.assert_array_equal(points[-1], [5.0, 7.0, 9.0])
    assert len(points) == 6


def test_period_and_delay_of_a_sine():
    x = np.sin(2 * np.pi * np.arange(4000) / 50.0)
    assert period(x) == pytest.approx(50.0, rel=0.01)
    assert delay(x) == pytest.approx(50.0 * np.arccos(1.0 - np.exp(-1.0)) / (2 * np.pi), abs=1.0)


def test_dimension_of_known_series():
    assert dimension(logistic(3000)[1], 1, 4) == 1
    assert dimension(henon(3000)[1], 1, 4) == 2
    assert dimension(np.random.default_rng(0).standard_normal(3000), 1, 4) == 0


def test_neighbours_are_nearest_of_those_that_are_away():
    points = np.random.default_rng(2).random((300, 2))
    i = np.arange(0, 300, 7)
    j, near = neighbours(points, i, 20)
    for a, b, distance in zip(i, j, near, strict=True):
        far = np.linalg.norm(points - points[a], axis=1)
        far[max(a - 20, 0) : a + 21] = np.inf
        assert (b, distance) == (far.argmin(), pytest.approx(far.min()))


def test_distance_across_the_path_of_a_flow():
    s = np.linspace(0.0, 1.0, 101)
    points = np.concatenate([np.stack([s, 0 * s], 1), np.stack([s + 0.003, 0 * s + 0.2], 1)])
    i, j = np.array([30]), np.array([131])
    assert apart(points, i, j)[0] == pytest.approx(np.log(np.hypot(0.2, 0.003)))
    assert apart(points, i, j, flow=True)[0] == pytest.approx(np.log(0.2))


def test_straightest_part_of_a_curve():
    x = np.linspace(0.0, 10.0, 101)
    y = np.where(x < 1.0, 3.0 - 3.0 * x, np.minimum(0.7 * (x - 1.0), 3.5))
    found = straightest(x, y)
    assert found.slope == pytest.approx(0.7, rel=0.06)
    assert x[found.begin] == pytest.approx(1.0, abs=0.5)
    assert x[found.end - 1] == pytest.approx(6.0, abs=1.0)
    assert straightest(x, -y[::-1] * 0.0) is None
    assert straightest(x, y, least=20.0) is None


def test_line_is_that_of_least_squares():
    rng = np.random.default_rng(3)
    x, y = np.sort(rng.random(40)), rng.random(40)
    slope, offset = np.polyfit(x[5:30], y[5:30], 1)
    found = line(x, y, 5, 30)
    assert (found.slope, found.offset) == (pytest.approx(slope), pytest.approx(offset))
    assert weights(x) @ np.ones(40) == pytest.approx(0.0, abs=1e-12)
