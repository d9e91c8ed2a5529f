"""A gap that closes and opens again between two places of a static path."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.march.record import ONSET, SEPARATION
from trsim.solve.path.changes import CONTACT, Change, turns_through
from trsim.solve.path.log import Log


@pytest.mark.parametrize("rate", [0.0, 1e-320, 1e-17, 1e-3, 1.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("top", [1e-3, -1.0])
def test_a_touch_inside_a_step_is_seen(top, side, rate):
    """g = g0 + rate x + 27/4 (x^2 - x^3): its arch is 1 high, and it begins almost level."""
    arch = np.polynomial.Polynomial([0.0, rate, 6.75, -6.75])
    x = np.linspace(0.0, 1.0, 100001)
    begin = top - arch(x).max()
    slope = arch.deriv()
    first, last = (begin + arch(0.0), slope(0.0)), (begin + arch(1.0), slope(1.0))
    seen = top > 0.0 and rate > 0.0 and last[0] <= 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = turns_through(
            tuple(side * v for v in first), tuple(side * v for v in last), 1.0, side, 1.0
        )
    assert found == seen


def test_what_closes_and_opens_at_one_place_is_told_as_it_stays():
    """Of two contacts that close at once one may open again before both do."""
    log = Log.__new__(Log)
    log.looks, log.events, log.count = SimpleNamespace(closed={}), [], 0
    for t, to in (
        (1.0, 1.0),
        (1.0, 1.0),
        (2.0, -1.0),
        (3.0, 1.0),
        (3.0 + 4e-14, -1.0),
        (3.0 + 8e-14, 1.0),
    ):
        log.note(SimpleNamespace(t=t), Change(CONTACT, 3, to))
    told = [(round(line[0], 6), line[1]) for line in log.events]
    assert told == [(1.0, ONSET), (2.0, SEPARATION), (3.0, ONSET)]
    assert log.count == 3 and log.looks.closed == {3: True}
