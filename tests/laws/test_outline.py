"""Outlines: areas in closed form, and sides that meet where they should not."""

import pytest

from trsim.laws.outline import area, crossed

L_SHAPE = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0))


def test_area_wherever_and_whichever_way_round():
    assert area(L_SHAPE) == area(L_SHAPE[::-1]) == 4.0
    assert area([(x + 1e6, y - 1e6) for x, y in L_SHAPE]) == pytest.approx(4.0, rel=1e-9)


def test_sides_that_cross_or_fold_back_are_found():
    assert crossed(L_SHAPE) is None
    assert crossed(((0, 0), (1, 0), (0.5, 0.5))) is None
    assert crossed(((0, 0), (1, 1), (1, 0), (0, 1))) == (0, 2)  # a bow tie
    assert crossed(((0, 0), (2, 0), (1, 0), (1, 1))) is not None  # back along itself
    assert crossed(((0, 0), (2, 0), (2, 2), (1, 0), (0, 2))) is not None  # touches a side
