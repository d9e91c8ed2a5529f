"""Universal joint: the law of a Cardan shaft, the moment in the cross, and what is refused."""

import numpy as np
import pytest

from trsim.assemble.release import release
from trsim.elements.rows import Axes
from trsim.errors import TrsimError

from ..runs import built, energy_error, run, scenario

BEND = np.pi / 6
C, S = np.cos(BEND), np.sin(BEND)
SHAFTS = f"""
planar: false
bodies:
  driver: {{mass: 1, inertia: [0.02, 0.01, 0.01], at: [-0.3, 0, 0], angular_velocity: [20, 0, 0]}}
  driven: {{mass: 1, inertia: [0.04, 0.04, 0.04], at: [{0.3 * C}, {0.3 * S}, 0]}}
joints:
  one: {{type: revolute, bodies: [ground, driver], at: [-0.5, 0, 0], axis: [1, 0, 0]}}
  two: {{type: revolute, bodies: [ground, driven], at: [{0.5 * C}, {0.5 * S}, 0],
        axis: [{C}, {S}, 0]}}
  cross: {{type: universal, bodies: [driver, driven], at: [0, 0, 0], axis: [0, 0, 2],
          second_axis: [{-S}, {C}, 0]}}
sensors: {{turn_in: {{joint: one}}, turn_out: {{joint: two}}}}
solver: {{end: 1, tolerance: 1e-11}}
output: {{every: 0.005}}
"""
MOTOR = "drives: {motor: {joint: one, velocity: 10}}\n"


def cardan(turn):
    """tan(out) = tan(in) cos(bend), unwrapped."""
    return np.unwrap(np.arctan2(C * np.sin(turn), np.cos(turn)))


@pytest.mark.parametrize("more", ["", MOTOR])
def test_cardan_shaft(more):
    r = run(SHAFTS + more)
    assert r["turn_in"][-1] > 5.0
    assert r["turn_out"] == pytest.approx(cardan(r["turn_in"]), abs=1e-8)
    assert energy_error(r) < 1e-9
    if not more:
        assert r["energy.kinetic"] == pytest.approx(r["energy.kinetic"][0], rel=1e-9)


def test_moment_is_along_the_normal_of_the_cross():
    """And it is what turns the driven shaft: I alpha = m . axis."""
    r = run(SHAFTS + MOTOR)
    turn, out = r["turn_in"], r["turn_out"]
    a = np.stack([0 * turn, -np.sin(turn), np.cos(turn)], axis=1)
    b = np.stack([-S * np.cos(out), C * np.cos(out), np.sin(out)], axis=1)
    m = r["cross.reaction_moment"]
    assert np.abs(m).max() > 0.1
    assert np.abs(np.cross(m, np.cross(a, b))).max() < 1e-9
    assert np.abs(np.sum(a * b, axis=1)).max() < 1e-9
    along = 0.04 * r["driven.angular_acceleration"] @ [C, S, 0.0]
    # the bearing of the driven shaft takes no moment about its axis
    assert m @ [C, S, 0.0] == pytest.approx(along, abs=1e-8)


def test_redundancy():
    """Two shafts in four bearings: closed with three rows too many, one of them in the cross."""
    m = built(SHAFTS)
    assert (m.mobility, m.mobility_by_count, len(m.redundant)) == (1, -2, 3)
    found = scenario(SHAFTS)
    assert release(found, m).proven


def test_isostatic_chain():
    """A four-bar in space, closed by a universal and a spherical joint: nothing is redundant."""
    m = built("""
bodies:
  crank: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0.5]}
  coupler: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 1]}
  rocker: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [2, 0.5]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  B: {type: spherical, bodies: [crank, coupler], at: [0, 1]}
  C: {type: universal, bodies: [coupler, rocker], at: [2, 1], axis: [0, 1, 0],
      second_axis: [0, 0, 1]}
  D: {type: revolute, bodies: [ground, rocker], at: [2, 0.3]}
planar: false
""")
    assert (m.mobility, m.mobility_by_count, m.redundant) == (1, 1, ())


PLANE = """
bodies: {{rod: {{mass: 1, inertia: 0.1, at: [0.3, 0]}}}}
joints: {{cross: {{type: universal, bodies: [ground, rod], at: [0, 0], axis: {}, second_axis: {}}}}}
gravity: [0, -9.81, 0]
solver: {{end: 1}}
"""


@pytest.mark.parametrize(
    "axis, second, mobility",
    [
        ("[0, 0, 1]", "[1, 0, 0]", 1),  # a hinge
        ("[1, 0, 0]", "[0, 1, 0]", 0),  # a weld
    ],
)
def test_in_the_plane(axis, second, mobility):
    m = built("planar: true" + PLANE.format(axis, second))
    assert m.planar and m.mobility == mobility


def test_an_oblique_cross_is_not_planar():
    text = PLANE.format("[0, 1, 1]", "[0, 1, -1]").replace("inertia: 0.1", "inertia: [1, 1, 1]")
    assert not built(text).planar
    with pytest.raises(TrsimError, match="leave the x-y plane"):
        built("planar: true" + text)


@pytest.mark.parametrize(
    "axis, second, key, words, hint",
    [
        ("[0, 0, 0]", "[1, 0, 0]", "axis", "must not be zero", "for example"),
        ("[1, 0, 0]", "[0, 0]", "second_axis", "must not be zero", "for example"),
        ("[1, 0, 0]", "[1e-5, 1, 0]", "second_axis", "cosine is 1e-05", "is [0, 1, 0]"),
        ("[1, 0, 0]", "[-3, 0, 0]", "second_axis", "cosine is -1", "across `axis`"),
    ],
)
def test_refused(axis, second, key, words, hint):
    with pytest.raises(TrsimError) as caught:
        built(PLANE.format(axis, second))
    assert caught.value.path == ("joints", "cross", key)
    assert words in caught.value.what and hint in caught.value.hint


def test_nearly_perpendicular_is_made_so():
    m = built(PLANE.format("[1, 0, 0]", "[1e-7, 1, 0]"))
    [joint] = [i for i in m.instances if i.name == "cross"]
    assert Axes.of(joint.row).a_j == (0.0, 1.0, 0.0)
