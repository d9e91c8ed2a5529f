"""Kinematic analysis: how often it evaluates, and that no extreme is missed for that."""

from pathlib import Path

import numpy as np
import pytest

from tests.linkages import UPRIGHT_CRANK
from tests.runs import run
from trsim.scenario.load import load

SCENARIOS = Path(__file__).parents[2] / "scenarios" / "validation"
EACH = 4  # evaluations: a row takes no more
ENOUGH = 16  # rows a turn of what turns fastest: with fewer it is the turn that takes them
TURNS = 3
RSSR = """
bodies:
  crank: {mass: 1 kg, inertia: [0.02, 0.03, 0.01], at: [0.03, 0, 0]}
  rod: {mass: 2 kg, inertia: [0.01, 0.04, 0.03], at: [0.13, 0.125, 0.05]}
  rocker: {mass: 1.5 kg, inertia: [0.02, 0.01, 0.02], at: [0.2, 0.25, -0.05]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1]}
  b: {type: spherical, bodies: [crank, rod], at: [0.06, 0, 0]}
  c: {type: universal, bodies: [rocker, rod], at: [0.2, 0.25, 0.1], axis: [1, 0, 0],
      second_axis: [0, 0, 1]}
  d: {type: revolute, bodies: [ground, rocker], at: [0.2, 0.25, -0.2], axis: [1, 0, 0]}
drives: {motor: {joint: a, position: "2*pi*t"}}
sensors: {swing: {joint: d}}
gravity: [0, 0, -9.81]
"""
FOUR_BAR = """
bodies:
  crank: {mass: 1 kg, inertia: 0.01, at: [0.05, 0]}
  rod: {mass: 2 kg, inertia: 0.03, at: [0.25, 0.1]}
  rocker: {mass: 1.5 kg, inertia: 0.02, at: [0.4, 0.1]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  b: {type: revolute, bodies: [crank, rod], at: [0.1, 0]}
  c: {type: revolute, bodies: [rocker, rod], at: [0.4, 0.2]}
  d: {type: revolute, bodies: [ground, rocker], at: [0.4, 0]}
drives: {motor: {joint: a, position: "2*pi*t"}}
sensors: {swing: {joint: d}}
gravity: [0, -9.81, 0]
"""
SLIDER_CRANK = (
    UPRIGHT_CRANK
    + """
drives: {motor: {joint: a, position: "2*pi*t"}}
sensors: {turn: {joint: a}}
gravity: [0, -9.81, 0]
"""
)
ARM = """
bodies:
  one: {mass: 3 kg, inertia: 0.05, at: [0.2, 0]}
  two: {mass: 2 kg, inertia: 0.03, at: [0.55, 0]}
  three: {mass: 1 kg, inertia: 0.01, at: [0.8, 0]}
joints:
  a: {type: revolute, bodies: [ground, one], at: [0, 0]}
  b: {type: revolute, bodies: [one, two], at: [0.4, 0]}
  c: {type: revolute, bodies: [two, three], at: [0.7, 0]}
drives:
  shoulder: {joint: a, position: "pi*t"}
  elbow: {joint: b, position: "0.8*sin(pi*t) + 0.5"}
  wrist: {joint: c, position: "0.6*cos(2*pi*t)"}
gravity: [0, -9.81, 0]
"""
MECHANISMS = {"rssr": RSSR, "four-bar": FOUR_BAR, "slider-crank": SLIDER_CRANK, "arm": ARM}


def turned(name, rows, tolerance=1e-6):
    """Three turns in one second each, in so many rows a turn."""
    solver = f"{{end: {TURNS}, method: kinematic, tolerance: {tolerance}}}"
    return run(f"{MECHANISMS[name]}\noutput: {{every: {1 / rows!r}}}\nsolver: {solver}\n")


@pytest.mark.parametrize("rows", [8, 16, 36, 160])
@pytest.mark.parametrize("name", MECHANISMS)
def test_evaluations_of_a_row(name, rows):
    """All channels are told, extremes between rows included.  These have so many harmonics that a
    turn takes a certain number of places, however few of them are rows."""
    taken = turned(name, rows).outcome.statistics["evaluations"]
    print(f"{taken / (TURNS * rows + 1):.2f} evaluations per row, {taken / TURNS:.0f} per turn")
    assert taken <= EACH * (TURNS * max(rows, ENOUGH) + 1)


@pytest.mark.parametrize("name, end", [("geneva", 0.7), ("cam_roller", 2.0)])
def test_evaluations_where_curves_are_followed(name, end):
    """Channels with corners between rows; nothing else evaluates more for these."""
    every = f"output.every={end / 100}"
    r = run(load(SCENARIOS / f"{name}.yaml", ["solver.method=kinematic", every]))
    print(f"{r.outcome.statistics['evaluations'] / len(r.t):.2f} evaluations per row")
    assert r.outcome.statistics["evaluations"] <= EACH * len(r.t)


@pytest.mark.parametrize("name", MECHANISMS)
def test_extremes_between_few_rows(name):
    """Of channels, and of magnitudes: those of vectors that pass zero have a kink there."""
    known = turned(name, 2000, 1e-8)
    model = known.mechanism.model
    high, low = known.outcome.peaks[model.sought][:, [0, 2]].T
    sizes = {kind: np.max((high - low)[model.kin == kind]) for kind in model.kin}
    size = np.array([sizes[kind] for kind in model.kin])
    steady = known.outcome.record.faint[model.kin] / model.lever  # rounding alone
    for tolerance in (1e-4, 1e-6):
        allowed = tolerance * np.maximum(high - low, 0.01 * size) + 100.0 * steady
        for rows in (8, 16):
            found = turned(name, rows, tolerance).outcome.peaks[model.sought]
            print(f"{tolerance:g}, {rows} rows: {np.max(np.abs(found[:, 0] - high) / allowed):.2g}")
            assert np.all(np.abs(found[:, 0] - high) <= allowed)
            assert np.all(np.abs(found[:, 2] - low) <= allowed)
