"""Load sets: which loads act, times what; and that a run carries it."""

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.scenario.load import loads
from trsim.scenario.load_sets import told

from ..runs import run

TEXT = """
bodies:
  arm: {{mass: 1 kg, inertia: 0.1, at: [0.5, 0]}}
joints:
  a: {{type: revolute, bodies: [ground, arm], at: [0, 0]}}
sensors: {{angle: {{joint: a}}}}
forces:
  wind: {{type: applied_load, body: arm, direction: [0, 1], force: "3 + angle"}}
  gusts: {{type: applied_load, body: arm, direction: [0, 1], torque: {{table: [[0, 1], [1, 5]]}}}}
  man: {{type: applied_load, body: arm, direction: [0, -1], force: 700 N}}
  spring: {{type: torsion_spring, joint: a, stiffness: 3}}
load_sets:
  gust: {{loads: [wind, gusts]}}
  step: {{loads: [man], limit: 1.15, ultimate: 2}}
{0}
solver: {{end: 10 ms}}
"""


@pytest.fixture(autouse=True)
def fake_elements():
    """Forces as they are."""


def scenario(text, sets=()):
    return loads(TEXT.format(text), sets)


def test_levels_and_factors():
    both = scenario("loads: {gust: ultimate, step: limit}").forces
    assert both["wind"].force.node[:3] == ("binary", "*", ("number", 1.5))
    assert both["gusts"].torque.y == (1.5, 7.5)
    assert both["man"].force.value == pytest.approx(1.15 * 700.0)
    assert scenario("loads: {step: 0.25}").forces["man"].force.value == 175.0
    assert scenario("loads: {step: -1}").forces["man"].force.value == -700.0  # both signs are run


def test_a_set_that_is_not_named_does_not_act():
    forces = scenario("loads: {step: ultimate}").forces
    for of in (forces["wind"].force, forces["gusts"].torque):
        assert (of.kind, of.value, of.sensors) == ("constant", 0.0, frozenset())
    assert forces["spring"].stiffness == 3.0
    assert scenario("loads: {}").forces["man"].force.value == 0.0


def test_it_is_told():
    assert told(scenario("loads: {gust: ultimate}")) == {
        "gust": "times 1.5: wind, gusts",
        "step": "does not act: man",
    }


def test_a_run_has_the_loads_of_its_sets():
    r = run(scenario("loads: {step: ultimate}"))
    np.testing.assert_allclose(r["man.magnitude"], 1400.0)
    np.testing.assert_array_equal(r["wind.magnitude"], 0.0)
    r = run(scenario("loads: {gust: 2}"))
    np.testing.assert_allclose(r["wind.magnitude"], 2.0 * (3.0 + r["angle"]), rtol=1e-12)


def test_a_wrench_is_a_load():
    text = TEXT.replace(
        "  man: {{type: applied_load, body: arm, direction: [0, -1], force: 700 N}}",
        "  man: {{type: wrench, body: arm, force: [0, -700 N], moment: [0, 0, 3*t]}}",
    )
    man = loads(text.format("loads: {step: ultimate}")).forces["man"]
    assert [f.value for f in man.force] == [0.0, -1400.0, 0.0]
    assert man.moment[2].node[:3] == ("binary", "*", ("number", 2.0))
    man = loads(text.format("loads: {}")).forces["man"]
    assert {f.kind for f in (*man.force, *man.moment)} == {"constant"}
    r = run(loads(text.format("loads: {}")))
    assert not r["man.force"].any()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "must say which of the load_sets act"),
        ("loads: {gast: limit}", "no load set named 'gast'"),
        ("loads: {gust: most}", "a number or one of the words"),
        ("loads: {gust: 3 N}", "3 N"),
    ],
)
def test_what_is_wrong_is_told_where_it_stands(text, said):
    with pytest.raises(TrsimError) as error:
        scenario(text)
    assert said in str(error.value)
    assert error.value.problems[0].place is not None


@pytest.mark.parametrize(
    ("sets", "said"),
    [
        ("load_sets.step.loads=[wind]", "in load set 'gust' already"),
        ("load_sets.step.loads=[mn]", "no force named 'mn'"),
        ("load_sets.step.loads=[spring]", "'spring' (torsion_spring) is no load"),
        ("load_sets.step.loads=[]", "loads"),
        ("load_sets.step.limit=0", "> 0"),
    ],
)
def test_sets_that_cannot_be(sets, said):
    with pytest.raises(TrsimError) as error:
        scenario("loads: {gust: limit}", [sets])
    assert said in str(error.value)


def test_a_limit_load_is_the_load_as_it_is_written():
    """Unless a set says otherwise, the largest load that is expected is that of the scenario."""
    forces = scenario("loads: {gust: limit}").forces
    assert forces["gusts"].torque.y == (1.0, 5.0)
