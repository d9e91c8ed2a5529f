"""Where a polynomial through places of a path promises an extreme, and when no more."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.path.between import Between, Known
from trsim.solve.path.extremes import LOOKS, promised

INSIDE = np.array([0.4, 0.6, 0.0, 0.2, 0.8, 1.0])  # both ends of a step first
MISSED = 1e-3


def limits(values, least=-np.inf):
    high, low = values.max(axis=0), values.min(axis=0)
    enough = np.full_like(high, MISSED)
    return np.array([high, low, enough, np.full_like(high, least)])


def asked(values, least=-np.inf, times=INSIDE, inside=0.0):
    return promised(times, values, limits(values, least), np.zeros((4, LOOKS + 1)), inside)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_top_of_a_parabola_beside_a_line(side):
    top = 0.5321  # between two looks
    values = np.stack([INSIDE, -side * (INSIDE - top) ** 2], axis=1)
    assert asked(values) == pytest.approx(top, abs=1e-12)
    if side < 0.0:  # what is never below its least is not looked for there
        assert np.isnan(asked(values, least=values[:, 1].min()))


def test_what_keeps_within_what_may_be_missed_is_not_asked_for():
    values = np.stack([INSIDE, 0.09 * MISSED * np.sin(60.0 * INSIDE)], axis=1)
    assert np.isnan(asked(values))


def test_next_to_a_known_place_there_is_nothing_new():
    top = 0.5321
    times = np.array([0.4, 0.6, top, 0.2, 0.8, 1.0])
    values = np.stack([1.0 - (times - top) ** 2], axis=1)
    ends = limits(values)
    ends[0] -= 0.5  # as if its height were not known
    room = np.zeros((4, LOOKS + 1))
    found = promised(times, values, ends, room, 1.0)
    assert 1e-4 * 0.2 < abs(found - top) < 0.02
    assert promised(times, values, ends, room, 0.0) == pytest.approx(top, abs=1e-12)


def test_a_place_between_counts_with_its_own_channels():
    """It was looked for ten times where it took those of the place kept before."""
    asks = []

    def out(place, _):
        return np.array([1.0 - (place.t - 0.53) ** 2])

    def take(t, channels, *_):
        kept.full[:] = channels
        kept.peak[0] = np.maximum(kept.peak[0], channels)
        kept.peak[2] = np.minimum(kept.peak[2], channels)

    def solved(first, last, t):
        asks.append(t)
        return SimpleNamespace(t=t, v=np.zeros(1))

    w = SimpleNamespace(sought=np.array([0]), kin=np.array([0]), lever=np.ones(1),
                        least=np.array([-np.inf]))  # fmt: skip
    kept = SimpleNamespace(
        w=w, rates=np.zeros(1, bool), energies=np.zeros(1, bool), full=np.zeros(1), works=0.0,
        peak=np.array([[-1e300], [0.0], [1e300], [0.0]]), out=out, take=take,
        relative=lambda channels: channels, works_between=lambda *_: 0.0,
    )  # fmt: skip
    between = Between(kept, MISSED)
    between.solve = solved
    for t in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0):
        place = SimpleNamespace(t=t, v=np.zeros(1))
        take(t, out(place, None))
        between.known.append(Known(place, between.wanted(), 0.0, False))
    between.search(2)
    assert asks == [pytest.approx(0.53, abs=1e-9)]
    assert kept.peak[0, 0] == pytest.approx(1.0, abs=1e-12)
