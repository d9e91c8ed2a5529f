"""Steps and Akima tables, against independent vectors and scipy."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator, CubicSpline

from trsim.expressions import parse, substitute
from trsim.laws.functions import expression, motion
from trsim.laws.tables import (
    akima,
    akima_coefficients,
    cubics,
    quintic,
    quintic_rates,
    smoothstep,
    smoothstep_rates,
    spline_coefficients,
)

VECTORS = json.loads((Path(__file__).parents[1] / "data" / "step_and_akima.json").read_text())


def lookup(x, y, at, ends="hold", interpolation="akima"):
    """Rows of f, f', f'' at the places `at`, from a table that does not start at 0."""
    tab = np.array([7.0, 7.0, *cubics(x, y, ends, interpolation)])
    return np.array([akima(tab, 2, len(x), s) for s in at])


def stepped(name, x, *rest):
    """The words `step` and `step5` of expressions, and their first two derivatives."""
    tree = substitute(parse(f"{name.lower()}(t, {', '.join(map(str, rest))})"), {})
    return motion(np.array(expression(tree, {})), 0, x)


@pytest.mark.parametrize("name, args, expected", VECTORS["steps"])
def test_step_vectors(name, args, expected):
    assert stepped(name, *args)[0] == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("rates, f", [(smoothstep_rates, smoothstep), (quintic_rates, quintic)])
def test_unit_steps(rates, f):
    assert [f(x) for x in (-1.0, 0.0, 0.5, 1.0, 2.0)] == [0.0, 0.0, 0.5, 1.0, 1.0]
    assert rates(-0.5) == (0.0, 0.0, 0.0) and rates(1.5) == (1.0, 0.0, 0.0)
    h = 1e-5
    for x in (0.1, 0.37, 0.8):
        assert rates(x)[0] == f(x)
        assert rates(x)[1] == pytest.approx((f(x + h) - f(x - h)) / (2 * h), rel=1e-8)
        slope = (rates(x + h)[1] - rates(x - h)[1]) / (2 * h)
        assert rates(x)[2] == pytest.approx(slope, rel=1e-8)


@pytest.mark.parametrize("name", ["STEP", "STEP5", "HAVSIN"])
def test_step_derivatives(name):
    h, rest = 1e-5, (0.5, 3.0, 2.5, -4.0)
    for x in (0.2, 0.7, 1.4, 2.2, 3.0):
        high, low = stepped(name, x + h, *rest), stepped(name, x - h, *rest)
        assert stepped(name, x, *rest)[1] == pytest.approx((high[0] - low[0]) / (2 * h), abs=1e-8)
        assert stepped(name, x, *rest)[2] == pytest.approx((high[1] - low[1]) / (2 * h), abs=1e-8)


def test_akima_vectors():
    data = VECTORS["akima"]
    assert lookup(data["x"], data["y"], data["query"])[:, 0] == pytest.approx(
        data["value"], rel=1e-14
    )


@pytest.mark.parametrize("n", [2, 3, 4, 5, 12, 40])
def test_akima_against_scipy(n):
    rng = np.random.default_rng(n)
    for _ in range(20):
        x = np.cumsum(rng.uniform(0.1, 2.0, n)) - 3.0
        y = rng.normal(size=n)
        scipy = Akima1DInterpolator(x, y)
        at = np.concatenate((x, rng.uniform(x[0], x[-1], 50)))
        found = lookup(x, y, at)
        for order in range(3):
            expected = scipy(at, nu=order)
            # at the last point scipy and we both evaluate the last interval
            scale = np.abs(expected).max() + 1e-3
            assert np.abs(found[:, order] - expected).max() < 1e-13 * max(scale, 1.0) * 10**order


def test_akima_of_two_and_three_points():
    assert lookup([0, 2], [1, 5], [0.5]) == pytest.approx(np.array([[2.0, 2.0, 0.0]]))
    x = np.array([0.0, 1.0, 3.0])
    assert akima_coefficients(x, np.array([0.0, 2.0, 5.0])).shape == (2, 4)
    # equal steps of a parabola: quadratic extrapolation of the slopes reproduces it
    found = lookup([0, 1, 2], [0, 1, 4], [0.25, 1.5])
    assert found == pytest.approx(np.array([[0.0625, 0.5, 2.0], [2.25, 3.0, 2.0]]))


def test_akima_takes_the_mean_slope_where_two_straight_lines_meet():
    x, y = np.arange(7.0), [0, 1, 2, 3, 5, 7, 9]
    assert lookup(x, y, [1.0, 3.0, 5.0])[:, 1] == pytest.approx([1.0, 1.5, 2.0])
    assert akima_coefficients(x, y) == pytest.approx(Akima1DInterpolator(x, y).c[::-1].T)


def test_akima_does_not_overshoot_beside_a_flat_part():
    y = [0, 0, 0, 0, 1, 1, 1, 1]
    f = lookup(range(8), y, np.linspace(0, 7, 141))[:, 0]
    assert f.min() == 0.0 and f.max() == 1.0


def test_akima_is_smooth_across_points():
    x, y = np.arange(6.0), np.array([0.0, 1.0, -1.0, 2.0, 2.5, 0.0])
    for at in x[1:-1]:
        left, right = lookup(x, y, [at - 1e-9, at + 1e-9])
        assert left[:2] == pytest.approx(right[:2], abs=1e-7)


def test_ends():
    x, y = [0.0, 1.0, 2.0, 3.0], [1.0, 2.0, 4.0, 3.0]
    first, last = lookup(x, y, [0.0, 3.0])
    assert (first[0], last[0]) == (1.0, 3.0)
    assert lookup(x, y, [-5.0, 9.0]).tolist() == [[1, 0, 0], [3, 0, 0]]
    low, high = lookup(x, y, [-2.0, 5.0], "extrapolate")
    assert low == pytest.approx([1.0 - 2.0 * first[1], first[1], 0.0])
    assert high == pytest.approx([3.0 + 2.0 * last[1], last[1], 0.0])
    assert np.isnan(lookup(x, y, [-0.01, 3.01], "refuse")).all()
    assert np.isfinite(lookup(x, y, [0.0, 3.0], "refuse")).all()


@pytest.mark.parametrize(
    "x, y, message",
    [
        ([0, 1, 1, 2], [0, 0, 0, 0], "row 3: 1 does not exceed 1 of the row before"),
        ([0, 2, 1], [0, 0, 0], "row 3: 1 does not exceed 2"),
        ([0], [1], "2 rows or more"),
        ([0, 1], [1, 2, 3], "same length"),
        ([0, 1, 2], [1, np.nan, 3], "row 2: the second column is nan"),
        ([0, np.inf], [1, 2], "row 2: the first column is inf"),
    ],
)
def test_bad_tables_are_refused_with_their_row(x, y, message):
    with pytest.raises(ValueError, match=message):
        cubics(x, y)


def test_unknown_end_is_refused():
    with pytest.raises(ValueError, match="Known: hold, extrapolate, refuse"):
        cubics([0, 1], [0, 1], "wrap")


@pytest.mark.parametrize("n", [2, 3, 4, 5, 6, 40, 800])
def test_a_spline_is_the_one_without_knots_next_to_its_ends(n):
    rng = np.random.default_rng(n)
    x, y = np.cumsum(rng.uniform(0.1, 2.0, n)), rng.normal(size=n)
    expected = CubicSpline(x, y)
    scale = np.abs(expected.c).max()
    found = spline_coefficients(x, y)
    assert np.abs(found - expected.c[::-1].T).max() < 1e-11 * scale
    at = rng.uniform(x[0], x[-1], 50)
    for order in (0, 1, 2):
        rows = lookup(x, y, at, interpolation="spline")[:, order]
        np.testing.assert_allclose(rows, expected(at, order), atol=1e-11 * scale)


def test_a_spline_follows_a_cubic_and_goes_straight_on():
    x = np.array([0.0, 0.3, 1.0, 1.1, 2.0])
    y = 1 - 2 * x + x**2 - 0.5 * x**3
    at = np.linspace(0, 2, 9)
    rows = lookup(x, y, at, interpolation="spline")
    np.testing.assert_allclose(rows[:, 0], 1 - 2 * at + at**2 - 0.5 * at**3, atol=1e-13)
    np.testing.assert_allclose(rows[:, 2], 2 - 3 * at, atol=1e-12)
    [beyond] = lookup(x, y, [3.0], "extrapolate", "spline")
    np.testing.assert_allclose(beyond, [-3 + 1 * (-2 + 4 - 6), -4, 0], atol=1e-12)


def test_straight_lines():
    x, y = [0.0, 1.0, 3.0], [2.0, 4.0, 3.0]
    rows = lookup(x, y, [0.25, 2.0, 4.0, -1.0], "extrapolate", "linear")
    expected = [[2.5, 2, 0], [3.5, -0.5, 0], [2.5, -0.5, 0], [0, 2, 0]]
    np.testing.assert_allclose(rows, expected, atol=1e-15)
    with pytest.raises(ValueError, match="Known: akima, linear, spline"):
        cubics(x, y, "hold", "quadratic")
