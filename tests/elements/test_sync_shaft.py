"""Synchronising shaft: torque by the difference of strokes, forces on pistons, losses, limits."""

import numpy as np
import pytest

from trsim.errors import ScenarioError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, run

THREE = """
bodies:
  one: {{mass: 2, inertia: 0.01, at: [0, 0]}}
  two: {{mass: 2, inertia: 0.01, at: [0, 0.1]}}
  three: {{mass: 2, inertia: 0.01, at: [0, 0.2]}}
joints:
  first: {{type: prismatic, bodies: [ground, one], axis: [1, 0, 0]}}
  second: {{type: prismatic, bodies: [ground, two], axis: [1, 0, 0]}}
  third: {{type: prismatic, bodies: [ground, three], axis: [1, 0, 0]}}
drives:
  a: {{type: actuator, bodies: [ground, one], points: [[-0.3, 0], [0, 0]], velocity: {0}, {3}}}
  b: {{type: actuator, bodies: [ground, two], points: [[-0.3, 0.1], [0, 0.1]], velocity: {1}, {3}}}
  c: {{type: actuator, bodies: [ground, three], points: [[-0.3, 0.2], [0, 0.2]],
      velocity: {2}, {3}}}
forces:
  shaft: {{type: sync_shaft, actuators: [a, b, c], ratio: 700, {4}}}
  hold_b: {{type: applied_load, body: two, direction: [1, 0, 0], force: {5}}}
solver: {{end: {6}, tolerance: 1e-9}}
output: {{every: 1 ms}}
"""
SUPPLY = "stiffness: 1e6, damping: 1e3, supply: {stiffness: 5e5, damping: 1e3, mass: 1}"
SHAFT = "stiffness: 0.4, damping: 2e-4"


def three(speeds=(0.1, 0.1, 0.1), actuator=SUPPLY, shaft=SHAFT, load=0, end=0.2):
    return THREE.format(*speeds, actuator, shaft, load, end)


def test_no_torque_while_synchronous():
    there = run(three())
    for channel in ("torque_1", "torque_2", "force_1", "force_2", "force_3", "difference"):
        assert np.abs(there[f"shaft.{channel}"]).max() < 1e-9


def test_prescribed_speeds_tell_the_torque_and_feel_nothing():
    """M = g k (v_2 - v_1) t; the forces of the actuators are those without the shaft."""
    rigid = "stiffness: 1e6, damping: 1e3"
    there = run(three((0.1, 0.102, 0.1), rigid, "stiffness: 0.4"))
    assert there["shaft.torque_1"] == pytest.approx(700 * 0.4 * 0.002 * there.t, abs=1e-12)
    assert there["shaft.torque_2"] == pytest.approx(-700 * 0.4 * 0.002 * there.t, abs=1e-12)
    assert there["shaft.difference"] == pytest.approx(0.002 * there.t, abs=1e-14)
    without = run(three((0.1, 0.102, 0.1), rigid, "stiffness: 0"))
    # works of the shaft have a say in the steps, so places agree to the tolerance: 1e-9 of about
    # 0.1 m, with 1e6 N/m between them
    np.testing.assert_allclose(there["b.force"], without["b.force"], rtol=0, atol=1e-4)
    assert np.abs(there["energy.residual"]).max() < 1e-9


def steady(load, shaft):
    """Strokes of the pistons that balance a load on the second block, all speeds alike, m.

    k_s (f - u) + G = load of the block; G from springs g^2 k between neighbours.
    """
    k_s, between = 5e5, 700**2 * shaft
    K = np.diag([k_s] * 3) + between * np.array([[1, -1, 0], [-1, 2, -1], [0, -1, 1]])
    return np.linalg.solve(K, [0.0, load, 0.0])


@pytest.mark.parametrize("stiffness", [0.0, 0.4, 40.0, 4e4])
def test_load_is_shared_by_the_shaft(stiffness):
    """From free actuators (k = 0) to equal strokes (k large), exactly the linear solution."""
    there = run(three(shaft=f"stiffness: {stiffness}, damping: 1e-3",
                      load="-800*smoothstep(t/0.2)", end=0.6))  # fmt: skip
    found = [there[f"{name}.piston"][-1] - 0.1 * 0.6 for name in "abc"]
    assert found == pytest.approx(steady(-800.0, stiffness), abs=2e-9)
    forces = [there[f"shaft.force_{k}"][-1] for k in (1, 2, 3)]
    assert sum(forces) == pytest.approx(0.0, abs=1e-6)
    assert (forces[1] > 1.0) == (stiffness > 0.0)  # the one that lags is helped
    assert np.abs(there["energy.residual"]).max() < 1e-7


@pytest.mark.parametrize("efficiency", [1.0, 0.8, 0.55])
def test_losses_of_the_gears(efficiency):
    """A piston that is helped gets eta of the torque's force, one that is held 1/eta_b of it."""
    there = run(three((0.1, 0.11, 0.1), shaft=f"{SHAFT}, efficiency: {efficiency}"))
    back = 2.0 - 1.0 / efficiency
    helped = 700 * there["shaft.torque_1"][-1]
    held = 700 * (there["shaft.torque_2"][-1] - there["shaft.torque_1"][-1])
    assert helped > 0.0 > held
    assert there["shaft.force_1"][-1] == pytest.approx(efficiency * helped, rel=1e-3)
    assert there["shaft.force_2"][-1] == pytest.approx(held / back, rel=1e-3)
    assert np.abs(there["energy.residual"]).max() < 1e-7
    assert (there["energy.work.friction"][-1] < 0.0) == (efficiency < 1.0)


def test_self_locking_gear_stops_who_leads():
    """Half an efficiency: the leader cannot turn the shaft, is held, and its source stalls."""
    jams = SUPPLY + ", stall: 300"
    soft = "stiffness: 0.05, damping: 2e-4"
    there = run(three((0.1, 0.11, 0.1), jams, f"{soft}, efficiency: 0.5"))
    assert there.outcome.status == "jammed"
    assert "b reached its stall force" in there.outcome.reason
    free = run(three((0.1, 0.11, 0.1), jams, f"{soft}, efficiency: 0.6"))
    assert free.outcome.status == "done"
    # its source gains 10 mm/s on it, with 10 N of its damper; a hundred times the springs to both
    # neighbours hold it
    held = 100 * 2 * 700**2 * 0.05
    together = 5e5 * held / (5e5 + held)
    assert there.outcome.time == pytest.approx(290 / together / 0.01, rel=0.01)
    assert "b.supply_force" in there.outcome.reason


def test_synchronism_is_lost():
    """Prescribed speeds: 2 mm/s apart, 0.3005 mm after 0.15025 s, a quarter behind a row."""
    text = three((0.1, 0.102, 0.1), "stiffness: 1e6", f"{SHAFT}, lost_at: 0.3005 mm")
    there = run(text)
    assert there.outcome.status == "jammed"
    assert there.outcome.time == pytest.approx(0.15025, rel=1e-9)
    assert "0.0003005 m" in there.outcome.reason
    assert "b.force" in there.outcome.reason
    assert there["shaft.difference"][-1] == pytest.approx(0.3e-3, rel=1e-9)
    # what springs of actuators make of the rounding of places is no reason for short steps
    assert there.outcome.statistics["steps"] < 400


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("[a, b, c]", "[a]", "two or more"),
        ("[a, b, c]", "[a, b, a]", "'a' stands there twice"),
        ("[a, b, c]", "[a, d]", "nothing named 'd' in drives"),
        ("[a, b, c]", "[a, b, hinge]", "no actuator with a velocity"),
        (SHAFT, f"{SHAFT}, efficiency: 0.4, self_locking: false", "is self-locking"),
    ],
)
def test_refused(old, new, told):
    text = three().replace(old, new)
    text = text.replace("drives:\n", "drives:\n  hinge: {joint: third, velocity: 0.1}\n")
    with pytest.raises(ScenarioError, match=told):
        built(text)


def test_check_says_that_it_changes_nothing():
    quiet = built(three(actuator="stiffness: 1e6"))
    assert any("its torque is told" in note for note in quiet.notes)
    assert not any("its torque is told" in note for note in built(three()).notes)


def slow(text, by):
    """The same motion, so many times slower: forces and strokes as before at times by t."""
    for speed in ("0.11", "0.1"):
        text = text.replace(f"velocity: {speed},", f"velocity: {float(speed) / by},")
    return text


@pytest.mark.parametrize("efficiency", [0.8, 0.55])
def test_losses_do_not_depend_on_the_speed(efficiency):
    """A shaft that turns 500 times slower, dampers 500 times stronger: the same forces."""
    supply = "stiffness: 1e6, damping: 5e5, supply: {stiffness: 5e5, damping: 5e5, mass: 2.5e5}"
    shaft = f"stiffness: 0.4, damping: 0.1, efficiency: {efficiency}, turning_speed: 2e-6"
    text = slow(three((0.1, 0.11, 0.1), supply, shaft, end=100), 500.0)
    there = run(text.replace("mass: 2,", "mass: 5e5,").replace("every: 1 ms", "every: 0.5"))
    back = 2.0 - 1.0 / efficiency
    helped = 700 * there["shaft.torque_1"][-1]
    held = 700 * (there["shaft.torque_2"][-1] - there["shaft.torque_1"][-1])
    assert helped > 0.0 > held
    assert there["shaft.force_1"][-1] == pytest.approx(efficiency * helped, rel=1e-3)
    assert there["shaft.force_2"][-1] == pytest.approx(held / back, rel=1e-3)
    assert not [x for x in doubts(there.scenario, there.mechanism, there.outcome) if "turn" in x]


def test_friction_that_is_not_whole_is_told():
    """At half a millimetre a second, with the turning speed nobody asked about."""
    there = run(three((5e-4, 5.5e-4, 5e-4), shaft=f"{SHAFT}, efficiency: 0.8"))
    told, *_ = doubts(there.scenario, there.mechanism, there.outcome)  # rounding, perhaps
    assert told.startswith("forces.shaft.turning_speed: its actuators move with at most 0.00055")
    there = run(three((5e-4, 5.5e-4, 5e-4), shaft=SHAFT))
    told = doubts(there.scenario, there.mechanism, there.outcome)
    assert not [x for x in told if "turning_speed" in x]


def test_nothing_is_said_of_speeds_that_are_not_recorded():
    text = three((5e-4, 5.5e-4, 5e-4), shaft=f"{SHAFT}, efficiency: 0.8")
    there = run(text.replace("every: 1 ms", "every: 1 ms, channels: [one.position]"))
    told = doubts(there.scenario, there.mechanism, there.outcome)
    assert not [x for x in told if "turning_speed" in x]
