"""Channels looked at inside a step: dips between three places, and what is evaluated for it."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.elements.scene import NONE, PROJECTION
from trsim.solve.march import sampled
from trsim.solve.march.sampled import dip

from ..pieces import nothing, piece

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


@pytest.mark.parametrize(
    "given, pivot, turn, plain",
    [
        ({}, 0.04, 0.04, True),
        ({}, 0.04, 0.06, False),  # it may turn to where rows nearly depend on each other
        ({}, 0.009, 0.0, False),
        ({"m": 0}, 0.0, 9.0, True),
        ({"stabilisation": NONE}, 0.0, 0.0, True),
        ({"driven": 1}, 1.0, 0.0, False),  # on its rows, wherever the polynomial is
        ({"rate": 1}, 1.0, 0.0, False),  # brought to rest
        ({"redundant": 1}, 1.0, 0.0, False),
    ],
)
def test_whether_states_inside_a_step_are_taken_as_interpolated(given, pivot, turn, plain):
    of = {"m": 2, "stabilisation": PROJECTION, "driven": 0, "rate": 0, "redundant": 0} | given
    s = SimpleNamespace(m=of["m"], stabilisation=of["stabilisation"],
                        redundant=np.zeros((of["redundant"], 2)))  # fmt: skip
    alone = piece(sampled.as_interpolated, smallest_pivot=lambda _: pivot)
    r, b = SimpleNamespace(driven=of["driven"]), SimpleNamespace(rate=of["rate"])
    assert bool(alone(s, r, b, turn)) == plain


@pytest.mark.parametrize(
    "alone, plain, forces", [(5, 1, False), (5, 0, True), (-1, 1, True), (-1, 0, True)]
)
def test_forces_are_evaluated_for_what_needs_them_and_only_for_that(alone, plain, forces):
    s = SimpleNamespace(out=np.array([0.0, 3.0]), measure=None)
    b = SimpleNamespace(t=1.0, h=0.1, alone=plain, interpolate=0, P=None, y2=None)
    called = []
    look = piece(
        sampled.value, call_interpolate=nothing, set_poses=nothing,
        call_one=lambda s, kernels, t, e: called.append(e),
        measure_inside=lambda *_: called.append("forces"),
    )  # fmt: skip
    assert look(s, SimpleNamespace(y=None), b, (1, 2.0, alone), 0.5) == 1.0
    assert called == ["forces" if forces else 5]
