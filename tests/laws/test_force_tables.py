"""Forces by points: against scipy's monotone cubics, their integral, and what is refused."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from trsim.laws.force_tables import (
    beyond_piece,
    next_piece,
    on_piece,
    piece_at,
    rising,
    stored_in,
)

X, Y = [0.0, 1e-3, 1.5e-3, 4e-3, 5e-3], [0.0, 1.0, 6.0, 200.0, 210.0]


def table(x=X, y=Y, before=3):
    numbers, steepest = rising(x, y)
    return np.array([7.0] * before + numbers), before, steepest


def force(tab, o, d):
    return on_piece.python(tab, o, piece_at.python(tab, o, d), d)


@pytest.fixture(autouse=True)
def as_python(monkeypatch):
    """Laws call each other as Python here."""
    monkeypatch.setitem(stored_in.python.__globals__, "piece_at", piece_at.python)


def test_against_another_program():
    tab, o, steepest = table()
    other = PchipInterpolator(X, Y)
    at = np.linspace(0.0, X[-1], 997)
    assert [force(tab, o, d) for d in at] == pytest.approx(other(at).tolist(), abs=1e-10)
    assert steepest == pytest.approx(other.derivative()(at).max(), rel=1e-3)
    assert [stored_in.python(tab, o, d) for d in at] == pytest.approx(
        [float(other.integrate(0.0, d)) for d in at], abs=1e-13
    )


def test_it_rises_everywhere_and_goes_straight_on():
    rng = np.random.default_rng(2)
    for _ in range(50):
        x, y = (np.append(0.0, np.cumsum(rng.exponential(size=6) ** 3 + 1e-9)) for _ in range(2))
        tab, o, _ = table(x, y)
        F = np.array([force(tab, o, d) for d in np.linspace(0.0, 1.2 * x[-1], 2000)])
        assert np.all(np.diff(F) >= -1e-12 * y[-1])
    tab, o, _ = table()
    end = PchipInterpolator(X, Y).derivative()(X[-1])
    assert force(tab, o, 6e-3) == pytest.approx(Y[-1] + end * 1e-3)
    assert stored_in.python(tab, o, 6e-3) == pytest.approx(
        PchipInterpolator(X, Y).integrate(0.0, X[-1]) + Y[-1] * 1e-3 + end * 1e-6 / 2
    )


def test_two_rows_are_a_linear_spring():
    tab, o, steepest = table([0.0, 2e-3], [0.0, 10.0])
    assert steepest == pytest.approx(5e3)
    assert force(tab, o, 3e-3) == pytest.approx(15.0)
    assert stored_in.python(tab, o, 3e-3) == pytest.approx(0.5 * 5e3 * 9e-6)


def test_the_ends_of_pieces():
    tab, o, _ = table()
    for k, (low, high) in enumerate(zip(X, [*X[1:], 1.0], strict=True)):
        middle = 0.5 * (low + high)
        assert piece_at.python(tab, o, middle) == k
        assert beyond_piece.python(tab, o, k, middle) < 0.0
        if k < len(X) - 1:
            assert beyond_piece.python(tab, o, k, high + 1e-9) == pytest.approx(1e-9)
            assert next_piece.python(tab, o, k, high + 1e-9) == k + 1
        if k > 0:
            assert beyond_piece.python(tab, o, k, low - 1e-9) == pytest.approx(1e-9)
            assert next_piece.python(tab, o, k, low - 1e-9) == k - 1
    assert beyond_piece.python(tab, o, 0, -1.0) < 0.0, "a separation is an event of its own"


@pytest.mark.parametrize("x, y, said", [
    ([0.0], [0.0], "2 rows"), ([1e-3, 2e-3], [0.0, 1.0], "row 1"),
    ([0.0, 1e-3], [0.1, 1.0], "row 1"), ([0.0, 1e-3, 1e-3], [0.0, 1.0, 2.0], "row 3: the depth"),
    ([0.0, 1e-3, 2e-3], [0.0, 1.0, 0.5], "row 3: the force"),
])  # fmt: skip
def test_what_does_not_rise_from_nothing_is_refused(x, y, said):
    with pytest.raises(ValueError, match=said):
        rising(x, y)
