"""Extremes of forces that are chance are told, and only those."""

from types import SimpleNamespace

import numpy as np
import pytest

from trsim.solve.diagnose.chance import astray
from trsim.solve.diagnose.doubts import doubts

from ..runs import run
from ..sizes import size
from ..truth.trial import made

FLAT = """
bodies:
  left: {{mass: 1, inertia: 0.02, at: [0, 0.25]}}
  right: {{mass: 1, inertia: 0.02, at: [1, 0.25]}}
  coupler: {{mass: 2, inertia: 0.1, at: [0.5, 0.5], velocity: [-2, 0]}}
joints:
  A: {{type: revolute, bodies: [ground, left], at: [0, 0]}}
  B: {{type: revolute, bodies: [ground, right], at: [1, 0]}}
  C: {{type: revolute, bodies: [left, coupler], at: [0, 0.5]}}
  D: {{type: revolute, bodies: [right, coupler], at: [1, 0.5]}}
forces:
  load: {{type: applied_load, body: left, direction: [0, 1], at: [0, 0.25], force: 12}}
solver: {{end: {end}, tolerance: 1e-6}}
output: {{every: {end}}}
"""


def told(r):
    return [text for text in doubts(r.scenario, r.mechanism, r.outcome) if "are chance" in text]


def test_past_a_flat_place_reactions_have_no_extreme():
    """The load on one crank cannot reach the other one there; branches of the motion meet."""
    r = run(FLAT.format(end=1.5))
    (text,) = told(r)
    largest = max(
        np.abs(r.outcome.peaks[r.place[f"{j}.reaction"][0], [0, 2]]).max() for j in "ABCD"
    )
    assert largest > 1e3  # N, of bodies of 1 kg with 12 N
    assert text.startswith("joints.")
    assert "A.reaction" in text
    assert "at t = " in text.replace("that of t = ", "at t = ")


UNEVEN = """
gravity: [0, -9.81]
bodies:
  left: {mass: 1, inertia: 0.01, at: [0, 0.1]}
  coupler: {mass: 0, inertia: 0, at: [0.2, 0.2]}
  right: {mass: 3, inertia: 0.08, at: [0.4, 0.1]}
joints:
  A: {type: revolute, bodies: [ground, left], at: [0, 0]}
  C: {type: revolute, bodies: [left, coupler], at: [0, 0.2]}
  D: {type: revolute, bodies: [coupler, right], at: [0.4, 0.2]}
  B: {type: revolute, bodies: [ground, right], at: [0.4, 0]}
initial: {A.rate: 10}
solver: {end: 0.4, tolerance: 1e-9}
output: {every: 0.1}
"""


@pytest.mark.parametrize("mass", [0, 0.5])
def test_bodies_without_mass_or_inertia_pass_flat_places_too(mass):
    """What links cranks that would turn apart has no mass to tell by; energy says how fast they
    turn: of both about their pins and of the coupler, which goes round without turning."""
    r = run(UNEVEN.replace("coupler: {mass: 0", f"coupler: {{mass: {mass}"))
    (text,) = told(r)
    assert "The motion is right" in text
    inertia = 0.01 + 1 * 0.1**2 + 0.08 + 3 * 0.1**2 + mass * 0.2**2
    work = 9.81 * (1 + 3 + 2 * mass) * (0.1 - r["left.position"][:, 1])
    rate = np.sqrt(100 + 2 * work / inertia)
    np.testing.assert_allclose(r["left.angular_velocity"][:, 2], rate, rtol=1e-7)


def test_on_the_way_there_they_have():
    r = run(FLAT.format(end=0.3))
    assert not told(r)


@pytest.mark.parametrize(("family", "seed"), [("loop", 6), ("loop", 39), ("redundant", 0)])
def test_moments_that_are_zero_to_rounding_are_no_doubt(family, seed):
    """With a first step of which none comes so near that rounding is felt in them."""
    said = told(run(made(family, seed).scene.text(), "solver.first_step=1e-6"))
    assert not any("moment" in text for text in said)


def test_moments_that_are_rounding_next_to_such_a_place_are_told():
    """0.005 N*m where there is none: there are steps with which a sample lies that close to it."""
    for first in (None, *np.geomspace(1e-3, 0.02, size(3, 60))):
        sets = [f"solver.first_step={first}"] if first else []
        r = run(made("loop", 39).scene.text(), *sets)
        of = {
            word: max(np.abs(r.outcome.peaks[r.place[f"j{k}.{word}"][0], [0, 2]]).max()
                      for k in range(4))
            for word in ("reaction", "reaction_moment")
        }  # fmt: skip
        zero = 100.0 * r.scenario.solver.tolerance * of["reaction"] * r.mechanism.model.size
        assert of["reaction_moment"] < zero or any("reaction_moment" in text for text in told(r))


def test_redundant_rows_share_a_force_by_no_chance():
    """Two welds: rows of one and the other hold the body, and at an instant they cannot.

    What each carries is of least norm, as long as all of them together hold it.
    """
    r = run(made("redundant", 57).scene.text())
    assert told(r) == []
    first = r.place["again.reaction"][0]
    assert np.abs(r.outcome.peaks[first : first + 3, [0, 2]]).max() < 20


def test_unequal_masses_are_no_such_place():
    """A light coupler makes pivots small everywhere."""
    text = FLAT.format(end=0.3).replace("mass: 2, inertia: 0.1", "mass: 1e-7, inertia: 1e-8")
    assert not told(run(text))


@pytest.mark.parametrize("crossings, given, expected", [
    (0, 0.0, False), (1, 0.0, True), (0, 0.5, True), (0, 1e-9, False),
])  # fmt: skip
def test_a_motion_that_kept_its_branch_and_its_energy_is_right(crossings, given, expected):
    scenario = SimpleNamespace(solver=SimpleNamespace(tolerance=1e-6, step=None))
    outcome = SimpleNamespace(
        statistics={"work_of_projection_relative": given} if given else {},
        record=SimpleNamespace(crossings=crossings),
    )
    assert astray(scenario, outcome) == expected
