"""Profiles: corners rounded, what is refused, the largest ball that fits."""

from math import inf

import numpy as np
import pytest

from trsim.laws.profiles import Flaw, beginning, profile, smooth
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


def wavy(rng, n, waves, high, closed=True):
    """Points round the origin, or along x, that a spline goes through."""
    u = np.arange(n) * 2 * np.pi / n
    high = high * (1 + 0.1 * rng.normal(size=n)) * np.cos(waves * u)
    if not closed:
        return np.column_stack([u, high])
    return np.column_stack([(1 + high) * np.cos(u), (1 + high) * np.sin(u)])


def drawn(kind, rng):
    """A profile with many pieces, and whether it is closed."""
    side = int(rng.choice([1, -1]))
    if kind == "wavy":
        return smooth(wavy(rng, 60, 5, 0.3), True, side, 1e-6), True
    if kind == "circle":
        return smooth(wavy(rng, 40, 2, 1e-4), True, side, 1e-7), True
    if kind == "open":
        return smooth(wavy(rng, 50, 4, 0.4, closed=False), False, side, 1e-6), False
    teeth = np.arange(2 * rng.integers(12, 30))
    if kind == "rack":
        points = np.column_stack([0.3 * teeth, 0.4 * (teeth % 2)])
        return profile(points, 0.02, False, side), False
    turns, R = teeth * 2 * np.pi / len(teeth), 1 + 0.3 * (teeth % 2)
    star = np.column_stack([R * np.cos(turns), R * np.sin(turns)])
    radius = 0.01 if kind == "star" else 0.0  # edges, and corners without an arc
    return profile(star, radius, True, side, inward=kind == "edges"), True


KINDS = ("wavy", "circle", "open", "rack", "star", "edges")


def one_by_one(tab, closed, p):
    """How far a point is from each piece, and s and n of the nearest: without the tree."""
    pieces = tab[int(tab[2]) :].reshape(-1, 7)
    kind, d = pieces[:, 0], p - pieces[:, 1:3]
    along = pieces[:, 3] * d[:, 0] + pieces[:, 4] * d[:, 1]
    aside = pieces[:, 3] * d[:, 1] - pieces[:, 4] * d[:, 0]
    length, far = pieces[:, 5], np.sqrt(d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1])
    seen = d[:, 0] * pieces[:, 4] + d[:, 1] * pieces[:, 5] >= (pieces[:, 6] - 1e-12) * far
    arc, straight = (kind == 1) | (kind == 2), kind == 0
    near = np.where(arc & seen & (far > 0), np.abs(far - pieces[:, 3]), np.inf)
    on = (along >= -1e-12 * length) & (along <= (1.0 + 1e-12) * length)
    near = np.where(straight & on, np.abs(aside), near)
    near = np.where((kind == 3) & (far > 0), far, near)
    k = int(np.argmin(near))
    side = float(aside[k]) if straight[k] else float(far[k])
    out = -1.0 if kind[k] == 2 else 1.0
    if arc[k]:
        side = out * (side - float(pieces[k, 3]))
    flip = -1.0 if not closed and side < 0.0 and kind[k] != 3 else 1.0
    n = pieces[k, [4, 3]] * [-1.0, 1.0] if straight[k] else out * d[k] / far[k]
    return near, flip * side, flip * n


@pytest.mark.parametrize("kind", KINDS)
def test_a_tree_leaves_nothing_out(kind):
    """The nearest piece is found however many there are, to the last bit."""
    rng = np.random.default_rng(KINDS.index(kind))
    for _ in range(2):
        q, closed = drawn(kind, rng)
        assert q.numbers[0] > 16 and q.numbers[1] > 2  # the tree has inner nodes
        tab, line = np.array(q.numbers), q.outline
        middle, size = line.mean(axis=0), np.ptp(line, axis=0).max()
        beside_it = line[rng.integers(len(line), size=150)]
        places = [
            *(middle + size * rng.uniform(-1, 1, size=(150, 2))),
            *(beside_it + 10 ** rng.uniform(-7, -1, (150, 1)) * size * rng.normal(size=(150, 2))),
            *(middle + 10 ** rng.uniform(1, 5, (50, 1)) * size * rng.normal(size=(50, 2))),
        ]
        for p in places:
            near, s, n = one_by_one(tab, closed, p)
            assert beside(tab, 0, int(closed), *p) == (s, tuple(n)), p
            assert abs(s) == near.min()


@pytest.mark.parametrize("kind", KINDS)
def test_a_tree_where_several_pieces_are_equally_near(kind):
    """Where two pieces meet, on centres of arcs and in the middle: one of the nearest is found."""
    rng = np.random.default_rng(50 + KINDS.index(kind))
    q, closed = drawn(kind, rng)
    tab, size = np.array(q.numbers), np.ptp(q.outline, axis=0).max()
    places = [q.outline.mean(axis=0)]
    for k in rng.choice(len(q.pieces), size=60):
        piece = q.pieces[k]
        start, way = beginning(piece)
        off = rng.choice([-1, 1]) * 10 ** rng.uniform(-4, 0) * size
        places += [start, start + off * np.array([-way[1], way[0]])]
        if piece[0] in (1, 2):
            places += [np.array(piece[1:3]), np.array(piece[1:3]) * (1 + 1e-9)]
    for p in places:
        s, n = beside(tab, 0, int(closed), *p)
        near = one_by_one(tab, closed, p)[0]
        assert abs(s) == pytest.approx(near.min(), abs=1e-11 * size), p
        foot = one_by_one(tab, closed, p - s * np.array(n))[0]
        assert foot.min() == pytest.approx(0.0, abs=1e-9 * size)


def test_a_smooth_profile_that_crosses_itself():
    u = np.arange(40) * 2 * np.pi / 40
    with pytest.raises(Flaw, match="crosses itself"):
        smooth(np.column_stack([np.cos(u), np.sin(2 * u)]), True, 1, 1e-6)
