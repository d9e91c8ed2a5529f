"""A dip between three places of a step: found where it goes beyond zero, and only there."""

import numpy as np
import pytest

from trsim.solve.march.sampled import dip

from ..pieces import piece

AT = 0.47  # of the step


def looked_for(side, function):
    """What is found between three places of a step at which `function` is on one side."""
    places = [(x, side * function(x)) for x in (0.25, 0.5, 0.75)]
    search = piece(dip, value=lambda s, r, b, what, x: side * function(x))
    return search(None, None, None, (0, 0.0), side, tuple(places))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_dip_beyond_zero_is_found(side):
    def narrow(x):
        return (x - AT) ** 2 + 0.1 * (x - AT) ** 3 - 1e-4

    found = looked_for(side, narrow)
    assert 0.25 < found < 0.75 and narrow(found) < 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(
    "stays",
    [
        lambda x: (x - AT) ** 2 + 0.1 * (x - AT) ** 3 + 1e-4,  # turns back before zero
        lambda x: 1.0 + (x - AT) ** 2,  # far from it
        lambda x: 2.0 - (x - AT) ** 2,  # has a top there
        lambda x: np.abs(x - AT) + 1e-9,  # a corner just short of it
    ],
    ids=["short", "far", "top", "corner"],
)
def test_what_stays_on_its_side_has_none(side, stays):
    assert looked_for(side, stays) == -1.0
