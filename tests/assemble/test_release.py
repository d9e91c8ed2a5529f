"""What to let go of a redundant mechanism: as many rows as are too many, and not one freedom."""

import numpy as np
import pytest

from trsim.assemble import release as releases
from trsim.assemble.assemble import assemble, pack
from trsim.assemble.build import Parts, build
from trsim.assemble.rank import unique_reactions
from trsim.assemble.reduce import jacobian, moves, weights
from trsim.assemble.redundant import dependences
from trsim.assemble.release import release
from trsim.assemble.rows import all_rows
from trsim.assemble.tables import drawn
from trsim.scenario.load import loads

from ..linkages import DOOR, flat_parallelogram, four_bar, slider_crank
from ..runs import built

MOTOR = "drives: {motor: {joint: A, velocity: 5}}"
# a parallelogram with a third crank: one row too many in the plane
FIVE_BAR = """
planar: true
bodies:
  crank: {mass: 1, inertia: 1, at: [0, 0.5]}
  middle: {mass: 1, inertia: 1, at: [1, 0.5]}
  rocker: {mass: 1, inertia: 1, at: [2, 0.5]}
  coupler: {mass: 1, inertia: 1, at: [1, 1]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  B: {type: revolute, bodies: [crank, coupler], at: [0, 1]}
  C: {type: revolute, bodies: [ground, middle], at: [1, 0]}
  D: {type: revolute, bodies: [middle, coupler], at: [1, 1]}
  E: {type: revolute, bodies: [ground, rocker], at: [2, 0]}
  F: {type: revolute, bodies: [rocker, coupler], at: [2, 1]}
"""
CASES = {
    "slider-crank": (slider_crank(), 3),
    "slider-crank, driven": (slider_crank(more=MOTOR), 3),
    "four-bar": (four_bar(), 3),
    "door": (DOOR, 5),
    "parallelogram lying flat": (flat_parallelogram("false"), 3),
    "three cranks": (FIVE_BAR, 1),
}


def released(text):
    """The scenario, its mechanism and the proposal."""
    scenario = loads(text)
    mechanism = assemble(scenario)
    return scenario, mechanism, release(scenario, mechanism)


def without(scenario, mechanism, gone):
    """Rows left dependent, mobility and uniqueness of a mechanism with some rows let go."""
    at, instances = pack(scenario, frozenset(), None, ())
    rows = [r for r in all_rows(instances) if f"{r.element}.{r.axis}" not in gone]
    full, y = build(Parts.of(at, instances), rows, 6), drawn(at, 6)
    keep = np.flatnonzero(moves(full, mechanism.planar))
    J = jacobian(full, 0.0, y)[2][:, keep]
    inside = np.flatnonzero(np.abs(J).max(axis=1) > 1e-9).tolist()
    geometric = [k for k in inside if rows[k].element in scenario.joints]
    found = dependences(full, y, moves(full, mechanism.planar), inside, geometric)
    unique = unique_reactions(J[inside], weights(full)[keep])
    return [f.row for f in found if f.everywhere], len(keep) - len(inside), unique.all()


@pytest.mark.parametrize("case", CASES)
def test_nothing_is_redundant_without_the_rows_let_go(case):
    text, number = CASES[case]
    scenario, mechanism, found = released(text)
    assert len(mechanism.redundant) == len(found.rows) == number
    assert found.proven
    dependent, mobility, unique = without(scenario, mechanism, found.rows)
    assert dependent == []
    assert mobility == mechanism.mobility
    assert unique == (not mechanism.singular)
    assert mechanism.mobility_by_count == mechanism.mobility - number


@pytest.mark.parametrize("case", CASES)
def test_one_row_less_is_not_enough(case):
    scenario, mechanism, found = released(CASES[case][0])
    for row in found.rows:
        assert without(scenario, mechanism, set(found.rows) - {row})[0]


def test_what_is_proposed():
    _, _, found = released(slider_crank())
    assert [(c.joint, c.becomes, c.type) for c in found.changes] == [
        ("B", "spherical", "spherical"),
        ("track", "cylindrical", "cylindrical"),
    ]
    assert found.rows == ("B.tilt 1", "B.tilt 2", "track.turn") and found.alternatives == 0
    _, _, found = released(DOOR)
    assert [(c.joint, c.type) for c in found.changes] == [
        ("top", "spherical"),
        ("bottom", "inline"),
    ]
    assert found.alternatives == 1  # the other way round
    _, _, found = released(four_bar())
    assert [(c.joint, c.becomes) for c in found.changes] == [
        ("B", "spherical"),
        ("C", "universal"),
    ]


def test_a_type_proposed_does_in_the_scenario_what_was_said():
    spherical = four_bar().replace(
        "type: revolute, bodies: [crank, coupler]", "type: spherical, bodies: [crank, coupler]"
    )
    m = built(spherical)
    assert (len(m.redundant), m.mobility, m.mobility_by_count) == (1, 1, 0)
    _, _, found = released(spherical)
    assert [(c.joint, c.type) for c in found.changes] == [("C", "universal")]
    # of the axes across the hinge, x and y, the row of y is left
    assert found.rows == ("C.tilt 1",)
    universal = spherical.replace(
        "type: revolute, bodies: [coupler, rocker]",
        "type: universal, axis: [0, 1], second_axis: [0, 0, 1], bodies: [coupler, rocker]",
    )
    m = built(universal)
    assert (m.redundant, m.mobility, m.mobility_by_count) == ((), 1, 1)


@pytest.mark.parametrize("turned", ["", ", angle: 90 deg"])
def test_a_hinge_along_x_is_released_along_x(turned):
    """However the axes of the first body lie."""
    text = f"""
planar: false
bodies:
  arm: {{mass: 1, inertia: [1, 1, 1], at: [0, 1, 0]{turned}}}
  door: {{mass: 1, inertia: [1, 1, 1], at: [1, 1, 0]}}
joints:
  base: {{type: revolute, bodies: [ground, arm], at: [0, 0, 0]}}
  left: {{type: revolute, bodies: [arm, door], at: [0, 1, 0], axis: [1, 0, 0]}}
  right: {{type: revolute, bodies: [arm, door], at: [2, 1, 0], axis: [1, 0, 0]}}
sensors: {{turn: {{joint: base}}}}
"""
    _, mechanism, found = released(text)
    assert len(mechanism.redundant) == 5 and found.proven
    assert [(c.joint, c.type) for c in found.changes] == [
        ("left", "spherical"),
        ("right", "inline"),
    ]
    assert "right.x" in found.rows


def test_joints_whose_angle_is_needed_stay():
    angles = f"{MOTOR}\nsensors: {{one: {{joint: B}}, two: {{joint: C}}}}"
    _, _, found = released(slider_crank(more=angles))
    # nothing but the track may change in kind: the rest is told row by row
    assert found.proven and len(found.rows) == 3


def test_nothing_to_let_go():
    scenario = loads(slider_crank("true"))
    assert release(scenario, assemble(scenario)) is None


def test_a_wrong_choice_is_not_called_proven():
    scenario = loads(slider_crank())
    at, instances = pack(scenario, frozenset(), None, ())
    stress = releases.self_stress(scenario, assemble(scenario), at, instances)
    names = [f"{r.element}.{r.axis}" for r in stress.rows]

    def gone(*rows):
        return [names.index(row) for row in rows]

    right, wrong = gone("B.tilt 1", "B.tilt 2", "track.turn"), gone("B.x", "B.y", "track.turn")
    assert releases.removable(right, stress) and releases.proven(right, stress)
    assert not releases.removable(wrong, stress) and not releases.proven(wrong, stress)
