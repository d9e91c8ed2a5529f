"""Lists that look like decimal commas: told, and nothing else is."""

import pytest

from trsim.errors import ScenarioError
from trsim.scenario.commas import commas
from trsim.scenario.load import loads

TEXT = """\
bodies:
  a: {{mass: 1, inertia: [1, 1, 1], at: {at}}}
solver: {{end: 1 s}}
gravity: {gravity}
"""


def told(at="[0, 0]", gravity="[0, 0, 0]"):
    return list(commas(loads(TEXT.format(at=at, gravity=gravity))))


@pytest.mark.parametrize(
    ("at", "point"),
    [
        ("[0, -0,5]", "-0.5"),
        ("[0,5, 1]", "0.5"),
        ("[1, 12,25]", "12.25"),
        ("[-0,5]", "-0.5"),
        ("[ 0,5 , 1 ]", "0.5"),
        ("[0,5 m, 0]", "0.5"),
        ("[0, -0,25mm]", "-0.25"),
    ],
)
def test_a_decimal_comma(at, point):
    (text,) = told(at)
    assert text.startswith(f"bodies.a.at: {at} is a list of {at.count(',') + 1} numbers")
    assert text.endswith(f"write {point}")


@pytest.mark.parametrize(
    "at", ["[0,5]", "[0,0,1]", "[0, 5]", "[0.5, 1,]", "[0.1,5, 1]", "[p, q]", "[0,p, 1]"]
)
def test_other_lists(at):
    text = TEXT.format(at=at, gravity="[0, 0, 0]") + "parameters: {p: 1, q: 2}\n"
    assert list(commas(loads(text))) == []


def test_lists_on_several_lines_and_of_sections():
    text = TEXT.format(at="\n    [0,\n    5]", gravity="[0, 0, 0]")
    assert list(commas(loads(text))) == []
    text = TEXT.format(at="[0, 0]", gravity="[0, 0, 0]").replace("gravity: [", "gravity: [1,")
    text = text.replace("[1,0, 0, 0]", "[1,0, 0]")
    (found,) = commas(loads(text))
    assert found == "gravity: [1,0, 0] is a list of 3 numbers; if 1,0 is one of them, write 1.0"


@pytest.mark.parametrize("at", ["[0,5, 1,2]", "[1, 2, 0,5]", "[0,5 m, 1,2]"])
def test_a_list_that_is_too_long_for_it(at):
    with pytest.raises(ScenarioError) as error:
        loads(TEXT.format(at=at, gravity="[0, 0, 0]"))
    assert "got a list of" in error.value.what
    assert error.value.hint.startswith("If 0,5 is one number, write 0.5.")
