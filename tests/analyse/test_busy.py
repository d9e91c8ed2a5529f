"""Where most of a curve happens, on curves of which it is known."""

import numpy as np
import pytest

from trsim.analyse.busy import BESIDE, FEW, busy, common

X = np.linspace(0.0, 10.0, 4001)


@pytest.mark.parametrize("scale, origin", [(1.0, 0.0), (-1e6, 3.0), (1e-9, -5e4)])
def test_an_impact_is_found(scale, origin):
    """A bump of half a sine between 4 and 4.1: 80 % of its change is in 0.9273 / (pi/2) of that,
    the middle of the two flanks left out is 20 % of the change."""
    bump = np.where(np.abs(X - 4.05) < 0.05, np.sin(np.pi * (X - 4.0) / 0.1), 0.0)
    low, high = busy(X + origin, scale * bump)
    assert 3.9 < low - origin < 4.02 and 4.08 < high - origin < 4.2


def test_a_ramp_has_the_share_of_its_length():
    """A ramp from 2 to 2.5 alone: 80 % of it are 0.4, and 30 % of that on either side."""
    low, high = busy(X, np.clip(X, 2.0, 2.5))
    assert high - low == pytest.approx(0.4 * (1.0 + 2.0 * BESIDE), abs=0.01)
    assert low > 2.0 - 0.13 and high < 2.5 + 0.13


@pytest.mark.parametrize(
    "x, y",
    [
        (X, np.sin(X)),
        (X, np.random.default_rng(1).normal(size=X.size)),
        (X, np.full(X.size, 3.0)),
        (X, np.where(X < 5.0, 0.0, 1.0)),  # a leap between two rows: there is nothing to enlarge
        (X, np.where(np.abs(X - 2) < 0.05, 1.0, 0.0) + np.where(np.abs(X - 8) < 0.05, 1.0, 0.0)),
        (np.sin(X), np.cos(X)),  # turns back
        (X[:4], X[:4]),
        (X, np.where(X < 5.0, np.nan, 1.0)),
    ],
)
def test_nothing_to_enlarge(x, y):
    assert busy(x, y) is None


def test_several_curves():
    assert common([], 10.0) is None
    assert common([(1.0, 1.2), (1.1, 1.3)], 10.0) == (1.0, 1.3)
    assert common([(1.0, 1.2), (1.0 + 2.0 * FEW * 10.0, 3.0)], 10.0) is None
