"""The error norm: what a run is off by stays in proportion to its tolerance, in any units."""

from functools import cache

import numpy as np
import pytest

from ..mechanisms import torsion_pendulum
from ..runs import run

TURNS, RATE = 8, 20.0  # rad/s: sqrt(2 / 5e-3)
# times the tolerance after 8 turns: about the sum of the local errors, each over its part of a turn
MOST_TIMES = {"dop853": 10.0, "radau": 10.0, "generalized_alpha": 25.0, "scipy:BDF": 25.0,
        "scipy:RK45": 10.0}  # fmt: skip


@pytest.mark.parametrize("method", MOST_TIMES)
def test_phase_after_many_turns_is_in_proportion_to_the_tolerance(method):
    over = []
    for tolerance in (1e-2, 1e-3, 1e-4):
        solver = f"end: {TURNS * 2 * np.pi / RATE}, method: {method}, tolerance: {tolerance}"
        text, angle = torsion_pendulum(solver=solver)
        r = run(text, "output.every=0.01")
        over.append(np.abs(r["angle"] - angle(r.t)).max() / tolerance)
    assert max(over) < MOST_TIMES[method], over
    assert over[2] < 1.5 * over[0], over


@pytest.mark.parametrize("method", MOST_TIMES)
def test_a_small_vibration_is_as_right_as_a_large_one(method):
    """Accelerations at the start say how fast a fall would be; a spring turns it back sooner."""
    off = []
    for amplitude in (1.0, 1e-2, 1e-4):
        solver = f"end: {TURNS * 2 * np.pi / RATE}, method: '{method}', tolerance: 1e-3"
        text, angle = torsion_pendulum(amplitude, solver=solver)
        r = run(text, "output.every=0.01")
        off.append(np.abs(r["angle"] - angle(r.t)).max() / amplitude)
    assert max(off) < 2.5 * MOST_TIMES[method] * 1e-3, off  # fewer entries share the error


def test_the_unit_of_velocities_follows_the_speeds_met():
    text, _ = torsion_pendulum(1e-3, solver="end: 1, tolerance: 1e-6")
    r = run(text).outcome.record
    arm = np.sqrt(5e-3 / 2.0)  # the radius of gyration of a disc with nothing away from its centre
    assert r.top_speed == pytest.approx(1e-3 * RATE * arm, rel=0.1)
    assert r.speed < 2.0 * r.top_speed < 0.1 * r.speed_cap


def sprung(anchor, tolerance=1e-4):
    """A mass on a slide; its spring is as long as drawn, so that only its stiffness counts."""
    return run(f"""
bodies: {{mass: {{mass: 1, inertia: 0.1, at: [0, 0], velocity: [2, 0, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, mass], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: slide}}}}
forces: {{spring: {{type: spring_damper, bodies: [ground, mass], points: [[{anchor}, 0], [0, 0]],
         stiffness: 100}}}}
gravity: [0, 0]
solver: {{end: 6, method: dop853, tolerance: {tolerance}}}
""")


def test_an_anchor_far_away_makes_no_motion_larger():
    near, far = sprung(2.0), sprung(30.0)
    assert near.outcome.statistics["steps"] == far.outcome.statistics["steps"]
    exact = 0.2 * np.sin(10 * far.t)
    assert np.abs(far["x"] - exact).max() < 1e-4 * np.sqrt(0.1) * 20  # of the radius of gyration


def stopped(unit):
    """A pendulum between stops, with lengths in units of so many metres."""
    m = unit
    return run(f"""
bodies: {{rod: {{mass: 1, inertia: {0.1 * m * m}, at: [{0.5 * m}, 0]}}}}
joints: {{O: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
sensors: {{a: {{joint: O}}}}
forces: {{stop: {{type: limit_stop, joint: O, lower: -2, upper: 0.3, stiffness: {3000 * m * m},
         damping: {m * m}, ramp: 1e-3}}}}
gravity: [0, {-9.81 * m}]
solver: {{end: 3, tolerance: 1e-5}}
""")


def test_stops_on_angles_are_the_same_in_any_unit_of_length():
    one, small, large = stopped(1.0), stopped(2.0**-9), stopped(2.0**7)
    for other in (small, large):
        steps = other.outcome.statistics["steps"]
        assert steps == pytest.approx(one.outcome.statistics["steps"], abs=3)
        assert np.abs(other["a"] - one["a"]).max() < 1e-4  # ten tolerances


@cache
def struck(speed, method, tolerance):
    """A rod against a stop with damping, whose force has a kink where the stop would pull."""
    return run(f"""
bodies: {{rod: {{mass: 1, inertia: 0.1, at: [0.5, 0], velocity: [0, {0.5 * speed}, 0],
               angular_velocity: [0, 0, {speed}]}}}}
joints: {{O: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
sensors: {{a: {{joint: O}}}}
forces: {{stop: {{type: limit_stop, joint: O, lower: -1, upper: 0.3, stiffness: 3000, damping: 4,
         ramp: 1e-3}}}}
gravity: [0, -9.81]
solver: {{end: 0.6, tolerance: {tolerance}, method: '{method}'}}
output: {{every: 0.01}}
""")


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
@pytest.mark.parametrize("method", ["dop853", "scipy:RK45"])
def test_a_kink_between_two_stages_stays_in_proportion_to_the_tolerance(method, tolerance):
    """An error of a step is estimated from its stages, and a kink lies anywhere between them."""
    for speed in np.linspace(2.0, 9.0, 15):
        rough, tight = struck(speed, method, tolerance), struck(speed, "radau", 1e-9)
        assert np.abs(rough["a"] - tight["a"]).max() < 10.0 * tolerance, speed


RESTING = """
bodies:
  b0: {mass: 2.0787, inertia: 0.17886, at: [0.43139, 0.030996], velocity: [-0.05614, 0.781335],
       angular_velocity: [0, 0, 1.811193]}
joints: {j0: {type: revolute, bodies: [ground, b0], at: [0, 0], clearance: 1.2896e-3, contact: pin}}
contact_laws:
  pin: {normal: lankarani_nikravesh, stiffness: 1.0290895e6, exponent: 1.5, restitution: 0.64615,
        bearing_radius: 0.05, slowest_impact: 1e-3, friction: {law: none}}
gravity: [-3.91785, -0.87567]
solver: {method: METHOD, end: 0.6775, tolerance: TOLERANCE}
output: {every: 2e-3, channels: ['b0.*']}
"""


@cache
def rested(method, tolerance):
    """Angular accelerations of the journal's rod, behind its last touch."""
    r = run(RESTING.replace("METHOD", method).replace("TOLERANCE", f"{tolerance}"))
    return r["b0.angular_acceleration"][r.t > 0.2]


def settled(method, tolerance):
    """Their largest error, of the largest of them."""
    tight = rested("radau", 1e-9)
    return float(np.abs(rested(method, tolerance) - tight).max() / np.abs(tight).max())


@pytest.mark.parametrize("method", ["dop853", "auto"])
def test_a_journal_that_rests_on_its_contact_does_not_tremble(method):
    """The damping of a touch as light as its last one is stiff, and noise makes forces of it."""
    for tolerance in (2e-3, 1.1e-3, 5e-4, 1e-4, 1e-5, 1e-6):
        assert settled(method, tolerance) < 200 * tolerance, tolerance


TREMBLING = """
bodies:
  rotor: {mass: 1, inertia: 0.5, at: [0, 0], angular_velocity: [0, 0, 1.5]}
  yoke: {mass: 0.05, inertia: 0.01, at: [0.3, 0], velocity: [0, 0.5, 0]}
joints:
  O: {type: revolute, bodies: [ground, rotor], at: [0, 0]}
  way: {type: prismatic, bodies: [ground, yoke], at: [0.3, 0], axis: [0, 1, 0]}
sensors: {turn: {joint: O}, y: {joint: way}}
forces: {spring: {type: spring_damper, bodies: [ground, yoke], points: [[0.3, 30], [0.3, 0]],
         stiffness: 0.16}}
events: {hit: {when: y, value: VALUE, crosses: down, do: {record: true}}}
gravity: [0, 0]
solver: {method: METHOD, end: 60, tolerance: 2e-2}
output: {every: 0.5}
"""


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha"])
@pytest.mark.parametrize("part", [0.9, 0.97, 0.99, 0.998])
def test_a_step_that_ends_on_an_event_ends_at_its_time(method, part):
    """Close to where a motion turns Newton's method need not come nearer to a value."""
    amplitude = 0.5 / np.sqrt(0.16 / 0.05)
    text = TREMBLING.replace("VALUE", f"{-part * amplitude}").replace("METHOD", method)
    r = run(text)
    assert np.abs(r["turn"] - 1.5 * r.t).max() < 1e-9


BESIDE = """
bodies:
  wheel: {{mass: 1, inertia: 0.02, at: [0.5, 0], angular_velocity: [0, 0, 2]}}
  bob: {{mass: 1, inertia: 0.02, at: [{bent}, 1]}}
joints:
  O: {{type: revolute, bodies: [ground, wheel], at: [0.5, 0], axis: [0, 0, 1]}}
  way: {{type: prismatic, bodies: [ground, bob], at: [0, 1], axis: [1, 0, 0]}}
forces: {{spring: {{type: spring_damper, bodies: [ground, bob], points: [[-5, 1], [{bent}, 1]],
         stiffness: {stiffness}, free_length: 5}}}}
gravity: [0, 0]
solver: {{end: {end}, method: {method}, tolerance: {tolerance}}}
output: {{every: 2e-3, channels: ['*']}}
"""


def beside(method, tolerance):
    """The error of the bob's acceleration, of the largest: the geometric mean over its rates."""
    turns, largest, off = 8, 13.0, []
    for rate in np.linspace(45.0, 75.0, 13):  # of any one steps may happen to fit well or badly
        bent = largest / rate**2
        text = BESIDE.format(bent=bent, stiffness=rate**2, end=2 * np.pi * turns / rate,
            method=method, tolerance=tolerance)  # fmt: skip
        r = run(text)
        off.append(np.abs(r["bob.acceleration"][:, 0] + largest * np.cos(rate * r.t)).max())
    return float(np.exp(np.mean(np.log(off))) / largest)


@pytest.mark.parametrize("method", ["dop853", "radau", "generalized_alpha"])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-4])
def test_accelerations_of_a_vibration_beside_a_faster_motion(method, tolerance):
    """Its speed is a tenth of the wheel's, at the rim, and its acceleration the largest there is:
    what is allowed of speeds was ten times as much of that, and added up from turn to turn."""
    assert beside(method, tolerance) < 100.0 * tolerance
