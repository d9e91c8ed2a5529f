"""Profiles: corners rounded, what is refused, the largest ball that fits."""

from math import inf

import numpy as np
import pytest

from trsim.laws.profiles import Flaw, profile, smooth
from trsim.laws.surfaces import beside

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


def ellipse(n):
    u = np.arange(n) * 2 * np.pi / n
    return np.column_stack([2.0 * np.cos(u), np.sin(u)])


@pytest.mark.parametrize("turn", [1, -1])
def test_a_smooth_profile_is_its_spline(turn):
    """An ellipse: its places, normals, and least radii of curvature b^2/a and, inside, the same."""
    q = smooth(ellipse(200)[::turn], True, 1, 1e-7)
    tab = np.array(q.numbers)
    for u in np.random.default_rng(3).uniform(0, 2 * np.pi, 100):
        p, normal = np.array([2 * np.cos(u), np.sin(u)]), np.array([np.cos(u), 2 * np.sin(u)])
        normal /= np.linalg.norm(normal)
        for off in (0.3, -0.1, 1e-3):
            s, n = beside(tab, 0, 1, *(p + off * normal))
            assert s == pytest.approx(off, abs=1e-6)
            assert n == pytest.approx(normal, abs=1e-3)
    assert q.sharp == pytest.approx(0.5, rel=0.02)
    assert q.reach == inf
    assert smooth(ellipse(200), True, -1, 1e-7).reach == pytest.approx(0.5, rel=0.02)


def test_groups_leave_nothing_out():
    """The nearest piece is found however many there are: against all of them one by one."""
    rng = np.random.default_rng(5)
    u = np.arange(60) * 2 * np.pi / 60
    R = 1 + 0.3 * np.cos(5 * u) + 0.05 * rng.normal(size=60)
    q = smooth(np.column_stack([R * np.cos(u), R * np.sin(u)]), True, 1, 1e-6)
    assert q.numbers[0] > 5
    first = int(q.numbers[4])
    many = (len(q.numbers) - first) // 7
    alone = np.array([1.0, 0.0, 0.0, inf, 6.0, float(many), *q.numbers[first:]])
    for x, y in rng.uniform(-2, 2, size=(500, 2)):
        one, other = beside(np.array(q.numbers), 0, 1, x, y), beside(alone, 0, 1, x, y)
        assert one == other


def test_a_smooth_profile_that_crosses_itself():
    u = np.arange(40) * 2 * np.pi / 40
    with pytest.raises(Flaw, match="crosses itself"):
        smooth(np.column_stack([np.cos(u), np.sin(2 * u)]), True, 1, 1e-6)
