"""Cases of a process share specs, and each is what it would be alone."""

import json
import re
from pathlib import Path

import pytest

from trsim.errors import ScenarioError
from trsim.scenario import memory
from trsim.scenario.load import load, loads, of_case

from .test_templates import TEXT

SCENARIOS = Path(__file__).parents[1] / "scenarios"
FRAMED = """
parameters: {reach: 2 m, k: 3}
points:
  hook: {body: ground, at: [reach, 0], x_axis: [1, 1, 0], y_axis: [0, 1, 0]}
frame: {at: [1, 0], angle: 30 deg}
bodies:
  b: {mass: k, inertia: 1, at: [reach, 0]}
joints:
  j: {type: revolute, bodies: [ground, b], at: hook}
"""

NAMED_OUTSIDE = """
parameters: {x: 100 mm}
templates:
  arm:
    parameters: {L: 0.2}
    points: {tip: {body: bar, at: [L, 0]}}
    bodies: {bar: {mass: 1, inertia: 0.01, at: [L/2, 0]}}
    joints: {pin: {type: revolute, bodies: [ground, bar], at: [0, 0]}}
instances:
  left: {template: arm, frame: {at: [x, 0]}}
bodies:
  weight: {mass: 0.5, inertia: 1e-3, at: left_tip}
joints:
  hang: {type: revolute, bodies: [left_bar, weight], at: left_tip}
"""


def told(scenario):
    """All that a scenario says, and the frames its entries were drawn in."""
    sections = ("bodies", "joints", "drives", "forces", "sensors")
    drawn = {(s, n): one.drawn_in for s in sections for n, one in getattr(scenario, s).items()}
    return scenario.model_dump(warnings=False), drawn


def case(data, path, value):
    """A copy of data, as it comes from another process, with one number changed."""
    own = json.loads(json.dumps(data))
    at = own
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return own


@pytest.mark.parametrize("path", sorted(SCENARIOS.rglob("*.yaml")), ids=lambda p: p.stem)
def test_every_scenario_is_what_it_is_alone(path):
    alone = load(path)
    for _ in range(2):
        assert told(of_case(json.loads(json.dumps(alone.resolved)))) == told(alone)


@pytest.mark.parametrize(
    ("path", "values"),
    [
        (("parameters", "reach"), ("2 m", "3 m", 3, "2 m")),
        (("parameters", "k"), (3, "3 kg", "3 rad", 3)),
        (("points", "hook", "at"), ([1, 0], [0, 1], [1, 0])),
        (("points", "hook", "x_axis"), ([1, 1, 0], [1, 0, 0])),
        (("frame", "angle"), ("0 deg", "90 deg")),
        (("frame", "at"), ([0, 0], [0, 1])),
        (("bodies", "b", "mass"), (1, "k", "k kg")),
    ],
    ids=str,
)
def test_a_case_after_others(path, values):
    data = loads(FRAMED).resolved
    for value in values:
        own = case(data, path, value)
        try:
            alone = told(loads(json.dumps(own)))
        except ScenarioError as error:
            with pytest.raises(ScenarioError, match=re.escape(error.what)):
                of_case(own)
        else:
            assert told(of_case(own)) == alone


def test_instances_of_templates_after_others():
    data = loads(TEXT).resolved
    found = set()
    for mass in (3.0, 4.0, 3.0):
        own = case(data, ("templates", "chain", "bodies", "door", "mass"), mass)
        assert told(of_case(own)) == told(loads(json.dumps(own)))
        found.add(of_case(own).bodies["left_door"].mass)
    assert found == {3.0, 4.0}


@pytest.mark.parametrize(
    "path", [("parameters", "x"), ("templates", "arm", "parameters", "L")], ids=str
)
def test_a_point_of_an_instance_that_is_named_outside_of_it(path):
    data = loads(NAMED_OUTSIDE).resolved
    for value in (0.1, 0.3, 0.1):
        own = case(data, path, value)
        assert told(of_case(own)) == told(loads(json.dumps(own)))


@pytest.mark.parametrize("between", ["\n", "\t", "\r", "\u00a0", " ", "-2*", ".5*"], ids=repr)
def test_a_parameter_behind_any_letter(between):
    data = case(loads(FRAMED).resolved, ("bodies", "b", "mass"), f"9+{between}k")
    for k in (3, 4, 3):
        own = case(data, ("parameters", "k"), k)
        assert told(of_case(own)) == told(loads(json.dumps(own)))


@pytest.mark.parametrize(
    "path", [("parameters", "x"), ("instances", "left", "frame", "at", 1)], ids=str
)
def test_zeros_have_signs(path):
    data = case(loads(NAMED_OUTSIDE).resolved, ("bodies", "weight", "at"), ["x", 1.0, 0])
    for value in (0.0, -0.0, 0.0):
        own = case(data, path, value)
        assert repr(told(of_case(own))) == repr(told(loads(json.dumps(own))))


def test_a_named_point_has_the_signs_of_its_zeros():
    data = case(loads(FRAMED).resolved, ("frame",), {"at": [0, 0], "angle": 0})
    for value in (0.0, -0.0, 0.0):
        own = case(data, ("points", "hook", "at", 1), value)
        assert repr(told(of_case(own))) == repr(told(loads(json.dumps(own))))


def test_what_is_known_does_not_grow_for_ever(monkeypatch):
    monkeypatch.setattr(memory, "MOST", 20)
    data = loads(FRAMED).resolved
    for k in range(60):
        of_case(case(data, ("bodies", "b", "mass"), 1.0 + k))
    kept = memory.Memory.lasting()
    assert len(kept.made) <= 22 and not kept.pieces
