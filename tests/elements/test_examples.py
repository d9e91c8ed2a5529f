"""Short runs: the example of each element, and two that meet nearly all branches of the laws."""

import pytest

from trsim.elements import ELEMENTS, load
from trsim.elements.contract import FIRST_ROW
from trsim.scenario.event import EXAMPLE

from .. import small
from ..runs import built, energy_error, short_run

EXAMPLES = {word: load(word).example for word in ELEMENTS} | {"event": EXAMPLE}
CORNERS = """
bodies:
  slider: {mass: 2, inertia: 1, velocity: [1, 0]}
  disc: {mass: 2, inertia: 1, at: [0, 1], angular_velocity: [0, 0, 100]}
joints:
  guide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}
  bearing: {type: revolute, bodies: [ground, disc], at: [0, 1]}
sensors: {x: {joint: guide}, angle: {joint: bearing}}
forces:
  wall:
    type: applied_load
    body: slider
    direction: [1, 0]
    force: "max(0, 1000*x - 2) - min(x, 4e-3) + abs(x - 3e-3) + step(x, 1e-3, 0, 5e-3, 2)
            + (x > 6e-3) + (x <= 7e-3) - exp(-((x - 5e-3)/5e-4)**2) + sqrt(max(x - 4e-3, 0))
            + log(2 + x) + tan(x)/(2 - x) + max(sin(900*t), 0) + (t >= 2e-3)*(x < 1)"
  detent:
    type: applied_load
    body: slider
    direction: [1, 0]
    force: {table: [[1, 0], [2, 3], [3, 1], [5, 0]], of: x, units: [mm, N]}
  cam:
    type: applied_load
    body: disc
    direction: [0, 0, 1]
    torque: "atan2(sin(angle), cos(angle)) + smoothstep(angle - 0.2) + max(0, angle - 0.3)**1.5"
poincare: {turn: {when: wall.load.x, crosses: up, plot: [x, x.rate]}}
solver: {end: 8 ms, tolerance: 1e-6}
output: {every: 2 ms}
"""
FRICTION = small.SLIDER_CRANK.replace(
    "{law: none}", "{law: modified_coulomb, coefficient: 0.1, v0: 0.01, v1: 0.1}"
)


@pytest.mark.parametrize("word", EXAMPLES)
def test_the_example_runs(word):
    assert short_run(EXAMPLES[word]).outcome.status == "done"


@pytest.mark.parametrize("word", EXAMPLES)
def test_constraint_rows_stand_behind_the_coordinate(word):
    """Where the tables of a model put their indices; whatever else con tells stands behind."""
    for instance in built(EXAMPLES[word]).instances:
        rows = len(instance.element.rows)
        assert instance.row.con[FIRST_ROW : FIRST_ROW + rows] == (-1,) * rows


def test_corners_of_expressions_and_tables():
    assert energy_error(short_run(CORNERS)) < 1e-12


def test_corners_of_friction():
    assert energy_error(short_run(FRICTION, "solver.end=1 ms", "output.every=0.5 ms")) < 1e-7
