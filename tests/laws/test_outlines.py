"""Outlines: how far sides are from what is round, against many places of both."""

from math import pi
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import KDTree

from trsim.laws.outlines import beside_side, off_arc
from trsim.laws.profiles import smooth
from trsim.laws.surfaces import CYLINDER, PROFILE, SIZE


def egg(n=200):
    u = np.arange(n) * 2 * pi / n
    return np.column_stack([2.0 * np.cos(u) + 0.3 * np.cos(2 * u), 1.4 * np.sin(u)])


def sides(rng, many=60):
    """Sides of all lengths that are outside a circle around all of them, or reach past it."""
    for _ in range(many):
        turn, length = rng.uniform(0, 2 * pi), 10 ** rng.uniform(-2, 1)
        way = np.array([np.cos(turn), np.sin(turn)])
        middle = way * rng.uniform(2.4, 5.0)
        lean = turn + 0.5 * pi + rng.uniform(-0.4, 0.4)
        half = 0.5 * length * np.array([np.cos(lean), np.sin(lean)])
        yield middle - half, middle + half


def test_a_side_beside_a_profile():
    found = smooth(egg(), True, 1, 1e-7)
    own = SimpleNamespace(shape=PROFILE, profile=0, radius=0.0)
    tab, line = np.array(found.numbers), KDTree(found.outline)
    pieces = range(int(tab[2]), len(tab), SIZE)
    tried = 0
    for a, b in sides(np.random.default_rng(2)):
        u = np.linspace(0, 1, 2001)
        far, _ = line.query(a + u[:, None] * (b - a))
        if far[::50].min() < 0.1:
            continue
        tried += 1
        s, at = beside_side.python(tab, own, (*a, 0.0), (*b, 0.0))
        assert s == pytest.approx(far.min(), abs=2e-5)
        assert line.query(a + at * (b - a))[0] == pytest.approx(s, abs=2e-5)
        # the tree leaves nothing out; what is negative are arcs behind the side
        one_by_one = [off_arc.python(tab, place, tuple(a), tuple(b))[0] for place in pieces]
        assert s == min(far for far in one_by_one if far > 0.0)
    assert tried > 20


def test_a_side_beside_a_cylinder():
    rng, own = np.random.default_rng(4), SimpleNamespace(shape=CYLINDER, radius=0.5)
    for _ in range(100):
        a, b = rng.normal(np.array([2.0, 0.0, 0.0]), size=(2, 3))
        s, u = beside_side.python(None, own, tuple(a), tuple(b))
        places = a + np.linspace(0, 1, 20001)[:, None] * (b - a)
        far = np.linalg.norm(places[:, :2], axis=1)
        assert s == pytest.approx(far.min() - 0.5, abs=1e-6)
        assert u == pytest.approx(far.argmin() / 20000, abs=1e-4)
