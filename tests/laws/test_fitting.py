"""The largest ball that fits, against all pairs of places."""

from math import inf

import numpy as np
import pytest

from trsim.laws import fitting


def by_all_pairs(places, normals):
    """The least  d.d / (2 d.n)  of all places p and q."""
    d = places - places[:, None]
    square = np.sum(d * d, axis=2)
    above = np.sum(d * normals[:, None], axis=2)
    size = np.linalg.norm(np.ptp(places, axis=0))
    seen = (above > fitting.LEVEL * np.sqrt(square)) & (square > (fitting.NEXT * size) ** 2)
    return (square[seen] / (2.0 * above[seen])).min(initial=inf)


def wave(n, waves, high, rng):
    """Places along a wavy round line, far from the origin, and normals across it."""
    u = np.sort(rng.uniform(0, 2 * np.pi, n))
    r = 1 + high * np.cos(waves * u)
    slope = -high * waves * np.sin(waves * u)
    c, s = np.cos(u), np.sin(u)
    normals = np.column_stack([r * c + slope * s, r * s - slope * c])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return np.column_stack([7 + r * c, r * s - 3]), normals


@pytest.mark.parametrize("runs", [1000, 3])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("seed", range(5))
def test_it_is_the_least_of_all_pairs(seed, side, runs, monkeypatch):
    monkeypatch.setattr(fitting, "RUNS", runs)
    monkeypatch.setattr(fitting, "AT_ONCE", 2000)  # many parts, the later ones left out
    rng = np.random.default_rng(seed)
    places, normals = wave(int(rng.integers(2, 300)), int(rng.integers(2, 6)), 0.3, rng)
    found = fitting.fits(places, side * normals)
    assert found == pytest.approx(by_all_pairs(places, side * normals), rel=1e-9)
    thrown = rng.normal(size=places.shape)
    thrown /= np.linalg.norm(thrown, axis=1)[:, None]
    assert fitting.fits(places, thrown) == pytest.approx(by_all_pairs(places, thrown), rel=1e-9)


def test_outside_of_what_is_convex_every_ball_fits():
    u = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    ring = np.column_stack([np.cos(u), np.sin(u)])
    assert fitting.fits(ring, ring) == inf
    assert fitting.fits(ring, -ring) == pytest.approx(1.0)
    assert fitting.fits(ring[:1], ring[:1]) == inf
