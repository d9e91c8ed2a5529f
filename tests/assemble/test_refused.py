"""Models that read well but cannot be: refused with exit code 4, the place and what to do."""

import pytest

from trsim.errors import ModelError, ScenarioError

from ..linkages import four_bar, slider_crank
from ..runs import built, run

LOCKED = """
joints:
  weld: {type: fixed, bodies: [ground, a], at: [0, 0]}
  hinge: {type: revolute, bodies: [ground, a], at: [0, 0]}
drives: {motor: {joint: hinge, velocity: 1}}
bodies: {a: {mass: 1, inertia: 1}}
solver: {end: 1}
"""
TWO_DRIVES = "drives: {one: {joint: A, velocity: 1}, two: {joint: track, velocity: 1}}"


@pytest.mark.parametrize("planar", ["true", "false"])
def test_two_drives_on_one_degree_of_freedom(planar):
    with pytest.raises(ModelError) as caught:
        built(slider_crank(planar, TWO_DRIVES))
    assert caught.value.exit_code == 4
    assert caught.value.path == ("drives", "two")
    assert "compliance" in caught.value.hint


def test_a_compliant_second_drive_is_fine():
    text = TWO_DRIVES.replace("velocity: 1}}", "velocity: 1, compliance: {stiffness: 1e3}}}")
    assert built(slider_crank("true", text)).mobility == 0


def test_drive_on_a_locked_coordinate():
    with pytest.raises(ModelError) as caught:
        built(LOCKED)
    assert caught.value.path == ("drives", "motor")


@pytest.mark.parametrize(
    "old, new, path, hint",
    [
        ("[0.01, 0.02, 0.03], at: [0, 0.5]", "0.03, at: [0, 0.5]",
         ("bodies", "crank", "inertia"), "three principal"),
        ("[0.01, 0.02, 0.03], at: [0, 0.5]", "[0.01, 0.02, 0.01, 0.1, 0, 0], at: [0, 0.5]",
         ("bodies", "crank", "inertia"), "check the moments"),
        ("[0.01, 0.02, 0.03], at: [0, 0.5]", "[1, 1, 1, 2, 0, 0], at: [0, 0.5]",
         ("bodies", "crank", "inertia"), "check the moments"),
        ("mass: 1, inertia: [0.01, 0.02, 0.03], at: [0, 0.5]",
         "mass: 1e-160, inertia: [0.01, 0.02, 0.03], at: [0, 0.5]",
         ("bodies", "crank", "mass"), "check its unit"),
        ("[0.01, 0.02, 0.03], at: [0, 0.5]", "[1e-30, 1e-30, 1e-30], at: [0, 0.5]",
         ("bodies", "crank", "inertia"), "check mass and inertia"),
        ("0.03], at: [0, 0.5]", "0.03], at: [0, 1e40]", ("bodies", "crank"), "check the units"),
    ],
)  # fmt: skip
def test_bad_bodies(old, new, path, hint):
    assert old in four_bar()
    with pytest.raises(ModelError) as caught:
        built(four_bar().replace(old, new))
    assert caught.value.path == path and hint in caught.value.hint


@pytest.mark.parametrize(
    "old, new, path, hint",
    [
        ("[crank, coupler]", "[cranck, coupler]", ("joints", "B", "bodies", 0), "'crank'"),
        ("[crank, coupler]", "[crank, crank]", ("joints", "B", "bodies"), "two different"),
    ],
)
def test_bad_joints(old, new, path, hint):
    with pytest.raises(ScenarioError) as caught:
        built(four_bar().replace(old, new))
    assert caught.value.exit_code == 3
    assert caught.value.path == path and hint in caught.value.hint


def test_unknown_joint_in_an_equilibrium():
    with pytest.raises(ScenarioError) as caught:
        built(four_bar("true", "initial: {equilibrium: [A, E]}"))
    assert caught.value.exit_code == 3
    assert caught.value.path == ("initial", "equilibrium", 1)


def test_unknown_sensor_in_a_load():
    more = """sensors: {turn: {joint: A}}
forces: {push: {type: applied_load, body: crank, direction: [1, 0], force: "3*trun"}}"""
    with pytest.raises(ScenarioError) as caught:
        built(four_bar("true", more))
    assert caught.value.path == ("forces", "push", "force")
    assert "'turn'" in caught.value.hint


def test_a_loop_that_cannot_be_closed():
    with pytest.raises(ModelError) as caught:
        run(slider_crank("true", "drives: {motor: {joint: track, position: 0.5 + t}}"))
    assert caught.value.exit_code == 4
    assert "cannot be closed" in str(caught.value)


@pytest.mark.parametrize(
    "initial, more, path",
    [
        ("{A: 0.3, D: -0.1}", "", ("initial", "D")),
        ("{A: 0.3}", "drives: {motor: {joint: A, position: t}}", ("initial", "A")),
        ("{A: 0.3}", "drives: {motor: {joint: D, position: t}}", ("initial", "A")),
    ],
)
def test_contradictory_starts(initial, more, path):
    with pytest.raises(ModelError) as caught:
        run(four_bar("true", f"{more}\ninitial: {initial}"))
    assert caught.value.exit_code == 4
    assert caught.value.path == path


def test_position_beyond_reach():
    with pytest.raises(ModelError) as caught:
        run(slider_crank("true", "initial: {track: 0.5}"))
    assert caught.value.path == ("initial",)
    assert "within reach" in caught.value.hint
