"""Jumps of prescribed motions: those of place are refused, those of velocity are impulses that are
told and booked, and steep ones are not passed over."""

import numpy as np
import pytest

from trsim.errors import ScenarioError
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.march.record import JOLT

from ..runs import energy_error, run

SLIDE = """
bodies: {block: {mass: 2, inertia: [0.01, 0.01, 0.01]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [2, 1, 2]}}
drives: {pull: {joint: slide, DRIVE}}
EXTRA
solver: {end: 1, SOLVER}
output: {every: 0.05}
"""
METHODS = (
    "method: dop853", "method: radau", "method: generalized_alpha", "method: auto",
    "method: rk4, step: 0.003", "method: scipy:RK45",
)  # fmt: skip


def slide(drive, solver="tolerance: 1e-8", extra="", fails=False):
    text = SLIDE.replace("DRIVE", drive).replace("SOLVER", solver).replace("EXTRA", extra)
    return run(text, fails=fails)


def jolts(r):
    """Time, size, work, impulse of the jumps of drives."""
    mine = r.events[r.events[:, 1] == JOLT]
    return mine[:, [0, 3, 5, 6]]


@pytest.mark.parametrize(
    "motion, by, at",
    [
        ("0.1*(t > 0.5)", "0.1", "0.5"),
        ("0.1*(sin(7*t) > 0.5)", "0.1", "0.07479982"),
        ("0.3*t - 0.2*(t >= 0.25)", "-0.2", "0.25"),
        ("0.1*(t > 0.3)*(t < 0.3000001)", "0.1", "0.3"),
        ("min(t, 0.4 + 0.5*(t > 0.9))", "0.5", "0.9"),
        ("atan2(sin(5*t), cos(5*t))", "-6.28319", "0.62831"),
    ],
)
def test_a_place_that_jumps_is_refused_before_the_run(motion, by, at):
    with pytest.raises(ScenarioError) as refused:
        slide(f'position: "{motion}"')
    said = str(refused.value)
    assert f"drives.pull.position: the prescribed position jumps by {by} m at t = {at}" in said


def test_a_place_that_an_event_sets_and_that_jumps_ends_the_run():
    event = """
events:
  go: {when: t, value: 0.3, do: {set: {pull: {position: "0.1*(t > 0.2)"}}}}"""
    for solver in METHODS[:-1]:
        r = slide("position: 0", solver, event, fails=True)
        assert r.outcome.time == pytest.approx(0.5, abs=1e-12)
        said = "drives.pull: the prescribed position jumps by 0.1 m at t = 0.5 s"
        assert r.outcome.reason.startswith(said)


@pytest.mark.parametrize("solver", METHODS)
@pytest.mark.parametrize(
    "drive", ['velocity: "0.1 + 0.4*(t > 0.31)"', 'position: "0.1*t + 0.4*max(0, t - 0.31)"']
)
def test_a_velocity_that_jumps_is_an_impulse(drive, solver):
    r = slide(drive, solver)
    ((time, by, work, impulse),) = jolts(r)
    assert (time, by) == pytest.approx((0.31, 0.4), abs=1e-12)
    assert impulse == pytest.approx(2.0 * 0.4, rel=1e-9)
    assert work == pytest.approx(0.5 * 2.0 * (0.5**2 - 0.1**2), rel=1e-9)
    assert r["energy.work.events"][-1] == pytest.approx(work, rel=1e-12)
    assert r["pull.position"][-1] == pytest.approx(0.1 + 0.4 * 0.69, rel=1e-9)
    assert energy_error(r) < 1e-9
    (told,) = (w for w in doubts(r.scenario, r.mechanism, r.outcome) if "jumps" in w)
    assert "drives.pull: its velocity jumps by 0.4 m/s at t = 0.31 s: an impulse of 0.8 N*s" in told
    if "velocity" in drive:
        assert "its velocity jumps by 0.4 m/s at t = 0.31 s" in " ".join(r.mechanism.notes)


def test_smooth_motions_are_no_jumps():
    for motion in ("step(t, 0.2, 0, 0.3, 0.1)", "step5(t, 0.2, 0, 0.201, 0.1)", "0.1*sin(9*t)",
                   "max(0, t - 0.3)**2", "abs(t - 0.4)**3"):  # fmt: skip
        r = slide(f'position: "{motion}"')
        assert len(jolts(r)) == 0
        assert "energy.work.events" not in r.place
    r = slide('velocity: "max(0, t - 0.4)"')
    assert len(jolts(r)) == 0


def test_the_end_of_a_table_is_a_jump_of_its_rate():
    r = slide("position: {table: [[0, 0], [0.3, 0.1], [0.6, 0.4]], of: t}")
    ((time, by, _, impulse),) = jolts(r)
    before = r["pull.velocity"][np.flatnonzero(r.t < 0.6)[-1]]
    assert time == pytest.approx(0.6, abs=1e-12)
    assert impulse == pytest.approx(2.0 * by, rel=1e-9)
    assert by < -before
    assert energy_error(r) < 1e-9


def test_what_gives_way_may_jump():
    """Its spring is stretched at once: k x^2 / 2, booked."""
    soft = "compliance: {stiffness: 1000, damping: 3}"
    r = slide(f'position: "0.1*(t > 0.31)", {soft}')
    assert r["energy.work.events"][-1] == pytest.approx(0.5 * 1000 * 0.1**2, rel=1e-9)
    assert energy_error(r) < 1e-7
    r = slide(f'velocity: "0.1*(t > 0.31)", {soft}')
    assert r["energy.work.events"][-1] == pytest.approx(0.0, abs=1e-12)
    assert energy_error(r) < 1e-7


CRANK = """
gravity: [0, -9.81, 0]
bodies:
  crank: {mass: 1, inertia: 0.02, at: [0.1, 0]}
  rod: {mass: 2, inertia: 0.1, at: [0.5, 0.0], angle: 0}
  slider: {mass: 3, inertia: 1, at: [0.8, 0]}
joints:
  bearing: {type: revolute, bodies: [ground, crank], at: [0, 0]}
  pin: {type: revolute, bodies: [crank, rod], at: [0.2, 0]}
  end: {type: revolute, bodies: [rod, slider], at: [0.8, 0]}
  guide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0], at: [0.8, 0]}
drives:
  motor: {joint: bearing, velocity: "3 + 4*(sin(11*t) > 0.3) - 6*(t > 0.5)"}
sensors: {theta: {joint: bearing}}
solver: {end: 1, tolerance: 1e-9, METHOD}
output: {every: 0.01}
"""


@pytest.mark.parametrize("method", ["method: dop853", "method: radau", "method: auto"])
def test_impulses_of_a_slider_crank(method):
    """The impulse is I(theta) times the jump, I the inertia seen at the crank."""
    r = run(CRANK.replace("METHOD", method))
    found = jolts(r)
    assert len(found) == 5
    for time, by, work, impulse in found:
        n = int(np.argmax(r.t > time))
        before = r["motor.velocity"][n - 1]  # constant until then
        theta = r["theta"][n - 1] + before * (time - r.t[n - 1])
        s, c = np.sin(theta), np.cos(theta)
        phi = np.arcsin(0.2 * s / 0.6)  # of the rod
        turn = 0.2 * c / (0.6 * np.cos(phi))
        slide_ = 0.2 * s + 0.6 * np.sin(phi) * turn
        middle = np.array([0.2 * s + 0.3 * np.sin(phi) * turn, 0.2 * c - 0.3 * np.cos(phi) * turn])
        inertia = 0.02 + 0.01 + 0.1 * turn**2 + 2.0 * middle @ middle + 3.0 * slide_**2
        assert impulse == pytest.approx(inertia * by, rel=1e-6)
        assert work == pytest.approx(0.5 * inertia * ((before + by) ** 2 - before**2), rel=1e-6)
    assert energy_error(r) < 1e-7


TWO = """
bodies:
  one: {mass: 2, inertia: [0.1, 0.1, 0.1]}
  two: {mass: 1, inertia: [0.1, 0.1, 0.1]}
joints:
  first: {type: prismatic, bodies: [ground, one], axis: [1, 0, 0]}
  second: {type: prismatic, bodies: [one, two], axis: [0, 0, 1]}
drives:
  along: {joint: first, velocity: "0.3*(t > 0.5)"}
  up: {joint: second, position: "max(0, 2*(t - 0.5))"}
solver: {end: 1}
"""


def test_two_drives_that_jump_at_once():
    r = run(TWO)
    found = jolts(r)
    assert found[:, 0] == pytest.approx([0.5, 0.5])
    assert sorted(found[:, 3]) == pytest.approx([3 * 0.3, 1 * 2.0])
    assert r["energy.work.events"][-1] == pytest.approx(0.5 * 3 * 0.09 + 0.5 * 4.0)


SUPPLIED = """
bodies: {block: {mass: 20, inertia: [1, 1, 1], at: [1, 0, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}
drives:
  line: {type: actuator, bodies: [ground, block], points: [[0, 0, 0], [1, 0, 0]],
         velocity: "0.1 + 0.2*(t > 0.5)", stiffness: 1e5, damping: 100,
         supply: {stiffness: 5e4, damping: 1e3, mass: 2}}
solver: {end: 1, tolerance: 1e-10}
output: {every: 0.02 ms}
"""


def test_a_piston_keeps_its_speed_where_its_supply_jumps():
    """The force of the supply jumps by what its damper adds to a velocity, and it does no work."""
    r = run(SUPPLIED)
    assert energy_error(r) < 1e-8
    n = int(np.flatnonzero(r.t <= 0.5 + 1e-9)[-1])
    force = r["line.supply_force"]
    assert force[n + 1] - force[n] == pytest.approx(1e3 * 0.2, rel=0.15)
    assert abs(r["energy.work.events"][-1]) < 1e-9


@pytest.mark.parametrize(("motion", "after"), [
    ("velocity: 0.1", "velocity: 0.3"), ('position: "0.1*t"', 'position: "0.05 + 0.3*t"'),
])  # fmt: skip
def test_a_piston_keeps_its_speed_where_an_event_sets_its_drive(motion, after):
    """The same motion as that whose velocity jumps by itself."""
    text = SUPPLIED.replace('velocity: "0.1 + 0.2*(t > 0.5)"', motion)
    r = run(f"{text}events: {{on: {{when: t, value: 0.5, do: {{set: {{line: {{{after}}}}}}}}}}}\n")
    same = run(SUPPLIED)
    assert energy_error(r) < 1e-8
    assert r["energy.work.events"][-1] == pytest.approx(0.0, abs=1e-9)
    assert r["line.piston"] == pytest.approx(same["line.piston"], abs=1e-9)
    assert r["line.force"] == pytest.approx(same["line.force"], abs=1e-4)


def test_a_rigid_actuator_whose_stroke_jumps_is_refused():
    text = SUPPLIED.replace('velocity: "0.1 + 0.2*(t > 0.5)", stiffness: 1e5, damping: 100,',
                            'position: "0.1*(t > 0.5)"}')  # fmt: skip
    text = text.replace("\n         supply: {stiffness: 5e4, damping: 1e3, mass: 2}}", "")
    with pytest.raises(ScenarioError, match=r"jumps by 0\.1 m at t = 0\.5 s"):
        run(text)


@pytest.mark.parametrize("solver", ["dop853", "radau", "scipy:RK45"])
@pytest.mark.parametrize("motion", ["0.1/(1 + exp(-(t - 0.5012)/8e-4))",
                                    "0.1*sqrt((t - 0.5)**2 + 1e-12)"])  # fmt: skip
def test_a_steep_motion_is_not_passed_over(motion, solver):
    """A step as long as the run sees none of it, and ends 100 mm, or 0.2 m/s, away."""
    r = slide(f'position: "{motion}"', f"method: {solver}, max_step: 1, tolerance: 1e-7")
    assert r.outcome.statistics["position_residual"] < 1e-5
    assert r.outcome.statistics["steps"] > 20
    lost = r.outcome.statistics["work_of_projection"]
    assert abs(lost) < 1e-5 * r.largest("energy.kinetic")[0]
