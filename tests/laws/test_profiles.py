"""Profiles: corners rounded, what is refused, the largest ball that fits."""

from math import inf

import numpy as np
import pytest

from trsim.laws.profiles import Flaw, profile

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def length(q):
    places = np.vstack([q.outline, q.outline[:1]])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


@pytest.mark.parametrize("points", [SQUARE, SQUARE[::-1], [*SQUARE, SQUARE[0]]])
def test_corners_are_rounded(points):
    q = profile(points, 0.1, True, 1)
    assert q.sharp == pytest.approx(0.1)
    assert q.reach == inf  # convex
    assert length(q) == pytest.approx(4 * 0.8 + 2 * np.pi * 0.1, rel=1e-4)


def test_what_fits_inside():
    """A ball in a rounded slot: its corners are narrower than its sides are apart."""
    slot = [[0, 0], [3, 0], [3, 1], [0, 1]]
    assert profile(slot, 0.3, True, -1).reach == pytest.approx(0.3, rel=1e-3)
    # round ends: the largest ball is half as wide as the slot
    assert profile(slot, 0.5, True, -1).reach == pytest.approx(0.5, rel=1e-3)


def test_what_fits_between_two_teeth():
    """A notch 0.4 m wide, its corners rounded by 0.1 m: a ball of 0.2 m touches both of its sides,
    or, above the notch, both of its edges."""
    notch = [[0, 0], [3, 0], [3, 1], [1.9, 1], [1.9, 0.2], [1.5, 0.2], [1.5, 1], [0, 1]]
    assert profile(notch, 0.1, True, 1).reach == pytest.approx(0.1, rel=1e-3)
    assert profile(notch, 0.2, True, 1).reach == pytest.approx(0.2, rel=1e-3)


def test_an_open_one_is_round_on_one_side_and_hollow_on_the_other():
    bent = [[0, 0], [1, 0], [2, 1]]
    assert profile(bent, 0.2, False, 1).reach == pytest.approx(0.2, rel=1e-3)
    assert profile(bent, 0.2, False, -1).reach == inf
    assert profile(bent, 0.2, False, -1).sharp == 0.0  # its ends


@pytest.mark.parametrize("points, radius, closed, side, what, point", [
    ([[0, 0]], 0.0, False, 1, "no profile", None),
    ([[0, 0], [1, 0]], 0.0, True, 1, "no profile", None),
    ([[0, 0], [1, 0], [1, 0], [2, 1]], 0.0, False, -1, "one place", 1),
    ([[0, 0], [1, 1], [1, 0], [0, 1]], 0.0, True, 1, "crosses itself", None),
    ([[0, 0], [1, 0], [0.5, 0]], 0.0, False, 1, "turns back", 1),
    ([[0, 0], [1, 0], [2, 1]], 0.0, False, 1, "turns inwards", 1),
    (SQUARE, 0.0, True, -1, "turns inwards", 3),
    (SQUARE, 0.6, True, 1, "no side is left", None),
])  # fmt: skip
def test_what_is_refused(points, radius, closed, side, what, point):
    with pytest.raises(Flaw, match=what) as caught:
        profile(points, radius, closed, side)
    if point is not None:
        assert caught.value.point in (point, 0)
    assert caught.value.hint
