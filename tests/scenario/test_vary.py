"""Which values are axes of a sweep, and which are values like any other."""

import pytest

from trsim.scenario.vary import Axis, axis, varies


@pytest.mark.parametrize(
    "value, is_axis",
    [
        ([1, 2], True), ([], True), ("lin(0, 1 mm, 3)", True), ("log(1, 10, 3)", True),
        (" uniform(1, 2) ", True), ("same as joints.A.clearance", True),
        (3, False), (0.5, False), (True, False), (None, False), ({"a": 1}, False), ("", False),
        ("3 mm", False), ("sin(2)", False), ("linear(0, 1, 3)", False), ("same as", False),
    ],
)  # fmt: skip
def test_what_is_an_axis(value, is_axis):
    assert varies(value) is is_axis


def test_values_are_spaced():
    assert axis("a.b", "lin(0, 1 mm, 3)") == Axis("a.b", ("0 mm", "0.5 mm", "1 mm"))
    assert axis("a.b", "log(1, 100, 3)") == Axis("a.b", (1.0, 10.0, 100.0))
    assert axis("a.b", "lin(2, 5, 1)") == Axis("a.b", (2.0,))
    assert axis("a.b", [3, "x"]) == Axis("a.b", (3, "x"))
    assert axis("a.b", "same as c.d") == Axis("a.b", same_as="c.d")
