"""Totals: the remainder makes mass, centre and inertia of several bodies what they are to be."""

import numpy as np
import pytest

from trsim.elements.weighing import of_body
from trsim.errors import TrsimError
from trsim.laws.solids import together
from trsim.scenario.load import loads
from trsim.scenario.weights import weights

DOOR = """
planar: false
bodies:
  frame:
    {{mass: 8 kg, inertia: [0.6, 0.5, 1.0, 0.02, -0.01, 0.03], at: [0.4, 0.1, 1], angle: 0.3}}
  handle:
    density: 2700
    shape: [{{cylinder: 30 mm, length: 0.2, axis: [0, 1, 1], at: [0.7, 0, 1]}}]
  blade: {{mass: 1 kg, inertia: [1, 1, 1], at: [0.5, 0, 0.9], angle: -0.2}}
  other: {{mass: 50 kg, inertia: [9, 9, 9], at: [9, 9, 9]}}
totals:
  door: {{bodies: [frame, handle, blade], {0}}}
solver: {{end: 1}}
"""
WANTED = (
    "mass: 30 kg, at: [0.45, 20 mm, 0.95], inertia: [5, 4, 3, 0.1, 0.05, -0.2], remainder: blade"
)


@pytest.fixture(autouse=True)
def fake_elements():
    """Bodies as they are."""


def door(text=WANTED):
    return loads(DOOR.format(text))


def test_total_is_what_it_says():
    scenario = door()
    whole = together(of_body(scenario.bodies[name]) for name in ("frame", "handle", "blade"))
    assert whole.mass == pytest.approx(30.0, rel=1e-15)
    np.testing.assert_allclose(whole.centre, (0.45, 0.02, 0.95), rtol=1e-14)
    wanted = [[5, 0.1, 0.05], [0.1, 4, -0.2], [0.05, -0.2, 3]]
    np.testing.assert_allclose(whole.inertia, wanted, atol=1e-13)
    told = {one.body: one.origin for one in weights(scenario)}
    assert told["blade"] == "mass, centre, inertia left of total 'door'; given"
    assert told["handle"] == "of 1 solid"


def test_only_what_is_given_changes():
    blade = door("mass: 30 kg, remainder: blade").bodies["blade"]
    handle = door().bodies["handle"].mass
    assert blade.mass == pytest.approx(22.0 - handle)
    assert (blade.at, blade.inertia) == ((0.5, 0.0, 0.9), (1.0, 1.0, 1.0))


def test_in_the_plane_one_inertia_is_enough():
    text = """
bodies:
  a: {mass: 1, inertia: 0.1, at: [1, 0]}
  b: {mass: 1, inertia: 0.1}
totals:
  both: {mass: 4, at: [0, 0], inertia: 3, remainder: b}
solver: {end: 1}
"""
    b = loads(text).bodies["b"]
    assert (b.mass, b.at[0]) == (3.0, pytest.approx(-1 / 3))
    assert b.inertia == pytest.approx(3 - 0.1 - 1 - 3 / 9)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mass: 5 kg, remainder: blade", "no less than the total"),
        ("mass: 30 kg, remainder: hinge", "no body named 'hinge'"),
        ("mass: 30 kg, remainder: other", "none of its bodies"),
        ("mass: 30 kg, remainder: blade, inertia: [0.1, 0.1, 0.1]", "no body has the inertia"),
        ("mass: 30 m, remainder: blade", "kg"),
        ("remainder: blade", "field required: mass"),
    ],
)
def test_what_cannot_be_is_refused_where_it_stands(text, said):
    with pytest.raises(TrsimError) as error:
        door(text)
    assert said in str(error.value)
    assert error.value.problems[0].place is not None


CHAIN = """
planar: false
bodies:
  a: {mass: 1, inertia: [0.1, 0.1, 0.1]}
  b: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 0, 0]}
  c: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 1, 0]}
totals:
  all: {bodies: [a, b, c], mass: 9, at: [0.5, 0.5, 0], remainder: c}
  two: {bodies: [a, b], mass: 5, at: [0.7, 0.1, 0.05], remainder: b}
solver: {end: 1}
"""


def test_a_remainder_among_the_bodies_of_a_total_before_it():
    """Whichever of them stands first, both totals are what they say."""
    bodies = loads(CHAIN).bodies
    for names, mass, centre in (("ab", 5, (0.7, 0.1, 0.05)), ("abc", 9, (0.5, 0.5, 0))):
        whole = together(of_body(bodies[name]) for name in names)
        assert whole.mass == pytest.approx(mass)
        assert whole.centre == pytest.approx(centre, abs=1e-12)


@pytest.mark.parametrize(
    ("remainder", "said"),
    [("a", "all, two wait for the remainders of each other"), ("b", "another total already")],
)
def test_totals_that_depend_on_each_other(remainder, said):
    with pytest.raises(TrsimError, match=said) as error:
        loads(CHAIN.replace("remainder: c", f"remainder: {remainder}"))
    assert error.value.problems[0].place is not None
