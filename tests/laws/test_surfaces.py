"""Surfaces: distance, side and normal, against places sampled all over them."""

from typing import NamedTuple

import numpy as np
import pytest

from trsim.laws.profiles import profile
from trsim.laws.surfaces import CYLINDER, PLANE, PROFILE, SPHERE, away

L = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
STEPS = [[0, 0], [1, 0.2], [2, -0.3], [3, 0.1]]


class Own(NamedTuple):
    """The numbers of a surface."""

    shape: int
    radius: float = 0.0
    free: float = 1.0
    profile: int = 0
    closed: int = 0


def surface(shape, radius=0.0, free=1.0, closed=0):
    return Own(shape, radius, free, 0, closed)


def at(own, p, tab=(0.0,)):
    s, n = away(np.array(tab, float), own, tuple(map(float, p)))
    return float(s), np.array(n, float)


@pytest.mark.parametrize("own, distance", [
    (surface(PLANE), lambda p: p[1]),
    (surface(SPHERE, 0.7), lambda p: np.linalg.norm(p) - 0.7),
    (surface(SPHERE, 0.7, -1.0), lambda p: 0.7 - np.linalg.norm(p)),
    (surface(CYLINDER, 0.4), lambda p: np.hypot(p[0], p[1]) - 0.4),
    (surface(CYLINDER, 0.4, -1.0), lambda p: 0.4 - np.hypot(p[0], p[1])),
])  # fmt: skip
def test_simple_shapes(own, distance):
    for p in np.random.default_rng(1).normal(size=(50, 3)):
        s, n = at(own, p)
        assert s == pytest.approx(distance(p), abs=1e-15 * 100)
        gradient = [(distance(p + h) - distance(p - h)) / 2e-6 for h in 1e-6 * np.eye(3)]
        assert n == pytest.approx(gradient, abs=1e-8)


def nearest(places, closed, p):
    """The distance from the broken line through places on a profile."""
    line = np.vstack([places, places[:1]]) if closed else places
    a, d = line[:-1], np.diff(line, axis=0)
    square = np.maximum(np.sum(d * d, axis=1), 1e-300)
    along = np.clip(np.sum((p - a) * d, axis=1) / square, 0.0, 1.0)
    return float(np.linalg.norm(p - a - along[:, None] * d, axis=1).min())


@pytest.mark.parametrize("closed, radius", [(True, 0.1), (True, 0.3), (False, 0.3), (False, 0.05)])
@pytest.mark.parametrize("backwards", [False, True])
def test_distance_from_a_profile_is_that_from_its_places(closed, radius, backwards):
    points = (L if closed else STEPS)[:: -1 if backwards else 1]
    own, q = surface(PROFILE, closed=int(closed)), profile(points, radius, closed, 1)
    for p in np.random.default_rng(2).uniform(-1, 3, size=(200, 2)):
        s, n = at(own, (*p, 0.3), q.numbers)
        # places are up to 8 mm apart, and h^2 / 8 R off an arc
        assert abs(s) == pytest.approx(nearest(q.outline, closed, p), abs=1e-5 / radius)
        assert np.linalg.norm(n) == pytest.approx(1.0)
        # s n leads back to the surface
        back, _ = at(own, (*(p - s * n[:2]), 0.0), q.numbers)
        assert back == pytest.approx(0.0, abs=1e-12)


def test_which_side_of_a_closed_profile_is_inside():
    own = surface(PROFILE, closed=1)
    for points in (L, L[::-1]):
        numbers = profile(points, 0.05, True, 1).numbers
        assert at(own, (0.5, 0.5, 0), numbers)[0] == pytest.approx(-0.5)
        assert at(own, (1.5, 1.3, 0), numbers)[0] == pytest.approx(0.3)
        hollow = surface(PROFILE, free=-1.0, closed=1)
        s, n = at(hollow, (0.5, 0.6, 0), numbers)
        assert s == pytest.approx(0.5)
        assert n == pytest.approx([1, 0, 0])


def test_an_edge_is_met_from_all_round():
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    q = profile(square, 0.0, True, 1)
    assert q.sharp == 0.0
    own = surface(PROFILE, closed=1)
    for angle in np.linspace(0.01, np.pi / 2 - 0.01, 7):
        ray = np.array([np.cos(angle), np.sin(angle)])
        s, n = at(own, (*(1 + 0.2 * ray), 0), q.numbers)
        assert s == pytest.approx(0.2)
        assert n[:2] == pytest.approx(ray)


def test_an_open_profile_is_met_from_both_sides():
    q = profile([[0, 0], [1, 0]], 0.0, False, 1)
    own = surface(PROFILE)
    assert at(own, (0.5, 0.2, 0), q.numbers) == (pytest.approx(0.2), pytest.approx([0, 1, 0]))
    assert at(own, (0.5, -0.2, 0), q.numbers) == (pytest.approx(0.2), pytest.approx([0, -1, 0]))
    assert at(own, (1.3, -0.4, 0), q.numbers)[0] == pytest.approx(0.5)


@pytest.mark.parametrize("seed", range(4))
def test_the_distance_bends_no_more_than_is_said(seed):
    """Second differences along random lines, within what `sharp` and `reach` allow, where the ball
    that touches is smaller than `reach`."""
    rng = np.random.default_rng(seed)
    q = profile(L, 0.2, True, 1)
    own, h, seen = surface(PROFILE, closed=1), 1e-4, 0
    assert q.sharp == 0.2
    assert q.reach == pytest.approx(0.2)
    for _ in range(3000):
        p, turn = rng.uniform(-0.5, 2.5, 2), rng.uniform(0, 2 * np.pi)
        w = h * np.array([np.cos(turn), np.sin(turn)])
        s0, s1, s2 = (at(own, (*(p + k * w), 0), q.numbers)[0] for k in (-1, 0, 1))
        assert abs(s2 - s0) <= 2 * h * (1 + 1e-9)
        if not -0.15 < s1 < 0.15:
            continue
        bend, seen = (s2 - 2 * s1 + s0) / h**2, seen + 1
        assert -1.0 / (q.reach - s1 - h) - 1e-6 <= bend <= 1.0 / (q.sharp + s1 - h) + 1e-6
    assert seen > 300


def test_a_search_for_the_nearest_piece_looks_at_a_node_once(monkeypatch):
    """A tree of n leaves has 2 n - 1 nodes; a search that looked at more would never end."""
    from trsim.laws import surfaces

    round_it = np.linspace(0.0, 2 * np.pi, 40, endpoint=False)
    waves = (1.0 + 0.2 * np.sin(5 * round_it)) * np.array([np.cos(round_it), np.sin(round_it)])
    tab = np.array(profile(waves.T.tolist(), 0.01, True, 1).numbers)
    leaves, looked = 1 << int(tab[1]), []

    def off_node(tab, place, x, y):
        looked.append(place)
        assert len(looked) < 2 * leaves
        return 0.0

    monkeypatch.setattr(surfaces, "off_node", off_node)
    surfaces.elsewhere.python(tab, 0, leaves, 0.7, 0.8, (np.inf, -1))
    assert len(set(looked)) == len(looked) > leaves > 8
