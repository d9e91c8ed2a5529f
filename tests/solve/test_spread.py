"""Bounds of how what is watched goes in a step, in cases that no motion is needed for."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.assemble.travel import CLOCK, UNKNOWN
from trsim.solve.march.spread import of_train, spread, spread_at_stages

from ..pieces import piece


def test_of_what_nothing_is_known_there_are_no_bounds():
    """Before the dense output is there and behind; of the time there are, and they are exact."""
    for whole in (spread, spread_at_stages):
        more = ((0.0, 1.0),) if whole is spread else ()
        assert np.all(np.array(piece(whole)(None, None, None, (UNKNOWN, 0), 1.0, *more)) < 0.0)
        assert piece(whole)(None, None, None, (CLOCK, 0), 1.0, *more) == (1.0, 0.0)


@pytest.mark.parametrize("c", [(2.0, 3.0), (-2.0, 3.0), (2.0, -3.0), (-2.0, -3.0)])
def test_a_train_goes_no_faster_than_its_angles_let_it(c):
    """g = c_1 p + c_2 q, with |p'| <= 5, |p''| <= 7, |q'| <= 11, |q''| <= 13: whatever the signs
    are, the bounds are met by rates that add up."""
    bounds = piece(of_train, TwoAngles=lambda s, e: SimpleNamespace(c_1=c[0], c_2=c[1]))
    assert bounds(None, 0, (5.0, 7.0), (11.0, 13.0)) == pytest.approx((2 * 5 + 33, 14 + 39))
