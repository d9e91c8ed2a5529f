"""Constant-velocity joint: shafts turn equally fast, bent as drawn and while the bend changes."""

import numpy as np
import pytest

from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, energy_error, run

BEND = np.pi / 6
C, S = np.cos(BEND), np.sin(BEND)
SHAFTS = f"""
planar: false
bodies:
  driver: {{mass: 1, inertia: [0.02, 0.01, 0.01], at: [-0.3, 0, 0], angular_velocity: [20, 0, 0]}}
  driven: {{mass: 1, inertia: [0.04, 0.04, 0.04], at: [{0.3 * C}, {0.3 * S}, 0], angle: 0.7}}
joints:
  one: {{type: revolute, bodies: [ground, driver], at: [-0.5, 0, 0], axis: [1, 0, 0]}}
  two: {{type: revolute, bodies: [ground, driven], at: [{0.5 * C}, {0.5 * S}, 0],
        axis: [{C}, {S}, 0]}}
  between: {{type: constant_velocity, bodies: [driver, driven], at: [0, 0, 0], axis: [2, 0, 0],
            second_axis: [{3 * C}, {3 * S}, 0]}}
sensors: {{turn_in: {{joint: one}}, turn_out: {{joint: two}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01}}
"""
LOAD = f"""
forces: {{brake: {{type: applied_load, body: driven, frame: world, direction: [{C}, {S}, 0],
                torque: -3}}}}
drives: {{motor: {{joint: one, velocity: "15*smoothstep(t)"}}}}
"""


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_both_turn_equally_fast(method):
    r = run(SHAFTS.replace("1e-10", f"1e-10, method: {method}"))
    # half the angular momentum goes over, by the inertias, in the start's plastic impact
    assert r["turn_in"][-1] > 2 * 2 * np.pi
    assert r["turn_out"] == pytest.approx(r["turn_in"], abs=1e-8)
    assert r["turn_out.rate"] == pytest.approx(r["turn_in.rate"], abs=1e-8)
    assert r["turn_in.rate"] == pytest.approx(r["turn_in.rate"][0], abs=1e-8)
    assert energy_error(r) < 1e-9


def test_the_torque_goes_over():
    """Along the line that halves the bend; what turns one shaft turns the other."""
    r = run(SHAFTS + LOAD)
    torque = 3 + 0.04 * r["turn_out.acceleration"]
    m = r["between.reaction_moment"]
    assert m @ [C, S, 0] == pytest.approx(torque, abs=1e-7)
    assert -m @ [1, 0, 0] == pytest.approx(-torque, abs=1e-7)
    half = np.array([np.cos(BEND / 2), np.sin(BEND / 2), 0])
    assert np.abs(np.cross(m, half)).max() < 1e-7
    assert r["motor.force"] == pytest.approx(0.02 * r["turn_in.acceleration"] + torque, abs=1e-7)
    assert energy_error(r) < 1e-9


SWINGING = """
planar: false
bodies:
  driver: {mass: 1, inertia: [0.02, 0.01, 0.01], at: [-0.3, 0, 0]}
  fork: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.2, 0, 0]}
  driven: {mass: 1, inertia: [0.04, 0.04, 0.04], at: [0.3, 0, 0]}
joints:
  one: {type: revolute, bodies: [ground, driver], at: [-0.5, 0, 0], axis: [1, 0, 0]}
  swing: {type: revolute, bodies: [ground, fork], at: [0, 0, 0], axis: [0, 3, 4]}
  two: {type: revolute, bodies: [fork, driven], at: [0.3, 0, 0], axis: [1, 0, 0]}
  between: {type: constant_velocity, bodies: [driver, driven], at: [0, 0, 0], axis: [1, 0, 0]}
drives:
  motor: {joint: one, velocity: 20}
  bend: {joint: swing, position: 1.2*sin(3*t)}
sensors: {turn_in: {joint: one}, turn_out: {joint: two}}
solver: {end: 2, tolerance: 1e-10}
output: {every: 0.01}
"""


def test_while_the_bend_changes():
    """Up to 69 degrees to either side, six turns; drawn straight, without `second_axis`."""
    r = run(SWINGING)
    assert r["turn_in"] == pytest.approx(20 * r.t, abs=1e-8)
    assert r["turn_out"] == pytest.approx(r["turn_in"], abs=1e-8)
    # the axis of the fork is across the shaft: the bend is how far the fork has swung
    assert r["between.bend"] == pytest.approx(np.abs(1.2 * np.sin(3 * r.t)), abs=1e-7)
    assert energy_error(r) < 1e-9


def said(r):
    found = doubts(r.scenario, r.mechanism, r.outcome)
    return [sentence for sentence in found if sentence.startswith("joints.joint")]


def test_bent_by_half_a_turn_it_is_told():
    text = """
bodies: {rod: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.3, 0]}}
joints: {joint: {type: constant_velocity, bodies: [ground, rod], at: [0, 0], axis: [1, 0]},
         hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
drives: {swing: {joint: hinge, position: %s*smoothstep(t)}}
solver: {end: 1.2}
output: {every: 0.01}
"""
    bent, little = run(text % "3.1"), run(text % "2.9")
    told = said(bent)
    assert len(told) == 1 and "bent by 177.6 deg at 1" in told[0]
    assert not said(little)


FOLDING = """
planar: false
bodies: {rod: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0], angular_velocity: [0, 0.02, 4]}}
joints: {joint: {type: constant_velocity, bodies: [ground, rod], at: [0, 0, 0], axis: [1, 0, 0]}}
solver: {end: 3, method: METHOD}
output: {every: 0.01}
"""


@pytest.mark.parametrize("method", ["auto", "radau", "rk4, step: 1e-3", "scipy:RK45"])
def test_next_to_half_a_turn_a_run_fails(method):
    """The rod swings across half a turn, where its turn about itself could be anything."""
    r = run(FOLDING.replace("METHOD", method), fails=True)
    assert "joint is bent by half a turn" in r.outcome.reason
    assert r["joint.bend"].max() < 3.13 and r.outcome.time < 0.9
    less = FOLDING.replace("METHOD", method).replace("end: 3", "end: 0.7")
    assert run(less).outcome.status == "done"


def test_in_a_plane_and_released_it_may_fold():
    """Where its row is none any more, or is one that nothing could turn."""
    r = run(FOLDING.replace("METHOD", "auto").replace("[0, 0.02, 4]", "[0, 0, 4]")
            .replace("planar: false", "planar: true"))  # fmt: skip
    assert r["rod.angular_velocity"][-1] == pytest.approx([0, 0, 4], abs=1e-9)
    event = "events: {off: {when: t, value: 0.3, do: {release: [joint]}}}\n"
    r = run(FOLDING.replace("METHOD", "auto") + event)
    assert r["rod.angular_velocity"][-1] == pytest.approx(r["rod.angular_velocity"][40], abs=1e-6)


def test_a_start_that_is_folded_is_refused():
    text = (
        FOLDING.replace("METHOD", "auto")
        + """
drives: {d: {joint: hinge, position: 3.13}}
"""
    )
    hinge = "joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0, 0]}, "
    text = text.replace("joints: {", hinge).replace("0.02, 4", "0, 0")
    with pytest.raises(TrsimError, match=r"bent by half a turn.* before the run begins"):
        run(text)


PLANE = """
planar: true
bodies: {{rod: {{mass: 1, inertia: 0.1, at: [0.3, 0]}}}}
joints: {{joint: {{type: constant_velocity, bodies: [ground, rod], at: [0, 0], axis: {}{}}}}}
gravity: [0, -9.81, 0]
solver: {{end: 1}}
"""


@pytest.mark.parametrize(
    "axis, more, mobility",
    [
        ("[0, 0, 1]", "", 0),  # shafts across the plane: nothing turns
        ("[1, 0, 0]", "", 1),  # in the plane they bend freely
        ("[1, 0, 0]", ", second_axis: [1, 1]", 1),
    ],
)
def test_in_the_plane(axis, more, mobility):
    m = built(PLANE.format(axis, more))
    assert m.planar and m.mobility == mobility


@pytest.mark.parametrize(
    "axis, more, key, words",
    [
        ("[0, 0, 0]", "", "axis", "must not be zero"),
        ("[1, 0, 0]", ", second_axis: [0, 0, 0]", "second_axis", "must not be zero"),
        ("[1, 0, 0]", ", second_axis: [-1, 0, 0]", "second_axis", "points back"),
        ("[1, 0, 0]", ", second_axis: [0, 1, 0]", "second_axis", "points back"),
    ],
)
def test_refused(axis, more, key, words):
    with pytest.raises(TrsimError) as caught:
        built(PLANE.format(axis, more))
    assert caught.value.path == ("joints", "joint", key)
    assert words in caught.value.what and caught.value.hint
