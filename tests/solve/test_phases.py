"""Phases: what begins and ends each, against closed forms."""

from math import acos, log, pi, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from trsim.errors import ScenarioError
from trsim.solve.diagnose.doubts import doubts
from trsim.solve.march.record import (
    EVENT_KIND,
    EVENT_SPEED,
    EVENT_TIME,
    EVENT_WORK,
    USER,
)

from ..runs import energy_error, run

M = 3.0
SLIDER = f"""
bodies: {{slider: {{mass: {M}, inertia: 1}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
drives: {{push: {{joint: slide, velocity: 0}}}}
sensors: {{x: {{joint: slide}}}}
solver: {{end: 1, tolerance: 1e-10}}
output: {{every: 10 ms}}
"""
THROWN = (
    SLIDER
    + """
phases:
  - {name: throw, drive: {push: {velocity: 2}}, until: {when: x, value: 0.3}}
  - {name: fly, release: [push], until: {when: x, value: 0.5}}
  - {name: held, lock: [slide], for: 0.1}
"""
)


def told(r):
    """Time, name and work of every line that an event left."""
    first, events = len(r.mechanism.instances) + 1, r.mechanism.stages.switches.events
    lines = r.events[r.events[:, EVENT_KIND] == USER]
    return [(line[EVENT_TIME], events[int(line[2]) - first].name, line[EVENT_WORK])
            for line in lines]  # fmt: skip


def said(r):
    return " ".join(doubts(r.scenario, r.mechanism, r.outcome))


# --- their order -----------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["dop853", "radau", "auto", "rk4, step: 1 ms"])
def test_each_phase_begins_where_the_one_before_ends(method):
    """2 m/s from 0 to 0.3 m, on to 0.5 m, and 0.1 s held there."""
    r = run(THROWN.replace("end: 1,", f"end: 1, method: {method},"))
    times, names, works = zip(*told(r), strict=True)
    assert names == ("throw.begin", "throw.until", "fly.until", "held.for")
    assert times == pytest.approx((0.0, 0.15, 0.25, 0.35), abs=1e-9)
    assert works == pytest.approx((0.0, 0.0, -0.5 * M * 4.0, 0.0), abs=1e-9)
    assert r.outcome.status == "done" and r.outcome.time == pytest.approx(0.35, abs=1e-9)
    assert "phase 'held', the last one, ended at t = 0.35 s" in r.outcome.reason
    assert "phases_left" not in r.outcome.statistics and "phases." not in said(r)
    assert np.all(r["push.force"][r.t > 0.151] == 0.0)
    assert r["x"] == pytest.approx(np.minimum(2 * r.t, 0.5), abs=1e-9)
    assert energy_error(r) < 1e-10


def test_motions_begin_with_their_phase():
    """In them t is the time since the phase began."""
    r = run(
        SLIDER
        + """
phases:
  - {drive: {push: {position: "0.2*t"}}, for: 0.4 s}
  - {drive: {push: {position: "0.08 - 0.5*t**2"}}, for: 0.3}
  - {drive: {push: {velocity: "t"}}, for: 0.2}
"""
    )
    t = r.t
    one, two = 0.2 * t, 0.08 - 0.5 * (t - 0.4) ** 2
    three = 0.08 - 0.5 * 0.09 + 0.5 * (t - 0.7) ** 2
    assert r["x"] == pytest.approx(
        np.where(t <= 0.4, one, np.where(t <= 0.7, two, three)), abs=1e-9
    )
    assert [name for _, name, _ in told(r)] == [
        "phase_1.begin", "phase_1.for", "phase_2.for", "phase_3.for"
    ]  # fmt: skip
    assert r.outcome.time == pytest.approx(0.9)


def test_the_first_of_several_ends_a_phase():
    """x = 2 t meets 0.3 at 0.15 s, t 0.2 s, the clock 0.25 s: one after the other is left out."""
    text = (
        SLIDER
        + """
phases:
  - name: one
    drive: {push: {velocity: 2}}
    until: [{when: x, value: 0.3}, {when: t, value: 0.2 s}]
    for: 0.25 s
  - {name: two, for: 0.1 s}
"""
    )
    for sets, time, name in (
        ((), 0.15, "one.until_1"),
        (("phases.0.until.0.value=0.9",), 0.2, "one.until_2"),
        (("phases.0.until.0.value=0.9", "phases.0.until.1.value=0.9"), 0.25, "one.for"),
    ):
        r = run(text, *sets)
        assert told(r)[1][:2] == (pytest.approx(time, abs=1e-9), name)
        assert r.outcome.time == pytest.approx(time + 0.1, abs=1e-9)


def test_two_that_meet_end_one_phase():
    """What else is reached then is no longer asked for: the next phase lasts its time."""
    r = run(SLIDER + """
phases:
  - {name: a, drive: {push: {velocity: 2}}, until: [{when: x, value: 0.3}, {when: t, value: 0.15}]}
  - {name: b, until: [{when: x, value: 0.4}, {when: t, value: 0.9}]}
  - {name: c, for: 0.1}
""")  # fmt: skip
    assert [name for _, name, _ in told(r)][2:] == ["b.until_1", "c.for"]
    assert [time for time, _, _ in told(r)] == pytest.approx([0, 0.15, 0.2, 0.3], abs=1e-9)


def test_what_is_beyond_its_value_ends_a_phase_at_once():
    """In the order of the file, and the run says so; a phase that ends so does what it says."""
    r = run(SLIDER + """
phases:
  - {name: a, drive: {push: {velocity: 2}}, until: {when: x, value: 0.3}}
  - {name: b, release: [push], until: {when: x, value: 0.2}}
  - {name: c, lock: [slide], for: 0.1}
""")  # fmt: skip
    assert [name for _, name, _ in told(r)] == ["a.begin", "a.until", "b.until", "c.for"]
    assert [time for time, _, _ in told(r)] == pytest.approx([0, 0.15, 0.15, 0.25], abs=1e-9)
    assert "phases.b: ended as it began: x rises through 0.2 m" in said(r)
    assert np.all(r["push.force"][r.t > 0.151] == 0.0)


def test_the_same_value_again_is_reached_already():
    """Also where the phase has stopped what is watched, and from below: `crosses: down` waits."""
    text = SLIDER + """
phases:
  - {name: a, drive: {push: {velocity: 2}}, until: {when: x, value: 0.3}}
  - {name: b, release: [push], lock: [slide], until: {when: x, value: 0.3}}
  - {name: c, for: 0.1}
"""  # fmt: skip
    r = run(text)
    assert r.outcome.time == pytest.approx(0.25, abs=1e-9)
    assert "phases.b: ended as it began" in said(r)
    r = run(text.replace("value: 0.3}}\n  - {name: c", "value: 0.3, crosses: down}}\n  - {name: c"))
    assert r.outcome.time == 1.0 and r.outcome.statistics["phases_left"] == 2


def test_a_start_on_the_value_waits():
    """A pendulum let go upwards at 0 comes back to 0: t = 2 v / g of a stone."""
    r = run("""
bodies: {stone: {mass: 2, inertia: 1, velocity: [0, 3]}}
joints: {slide: {type: prismatic, bodies: [ground, stone], axis: [0, 1, 0]}}
sensors: {y: {joint: slide}}
gravity: [0, -9.81, 0]
solver: {end: 2, tolerance: 1e-10}
phases: [{until: {when: y, crosses: down}}]
""")
    assert r.outcome.time == pytest.approx(6 / 9.81, abs=1e-9)


def test_a_phase_that_is_never_ended_is_told():
    r = run(THROWN, "phases.1.until.value=5 m")
    assert r.outcome.status == "done" and r.outcome.time == 1.0
    assert r.outcome.statistics["phases_left"] == 2
    assert (
        "phases.fly: nothing had ended it when the run ended at 1 s (what ends it: x rises through "
        "5 m; it is 2); held did not begin"
    ) in said(r)
    r = run(THROWN, "phases.2.for=9 s")
    assert r.outcome.statistics["phases_left"] == 1 and "phases.held: nothing had" in said(r)


def test_the_last_phase_may_last_as_long_as_the_run():
    r = run(THROWN.replace(", for: 0.1}", "}"))
    assert r.outcome.time == 1.0 and "phases_left" not in r.outcome.statistics
    assert "phases." not in said(r)


def test_events_go_on_beside_phases():
    r = run(THROWN + "events: {late: {when: t, value: 0.2 s, do: {record: true}}}\n")
    assert [name for _, name, _ in told(r)][2] == "late" and len(r.recorded) == 1
    assert r.outcome.fired == {"late": 1}


def test_a_line_is_recorded_as_a_phase_begins():
    r = run(THROWN.replace("name: fly", "name: fly, record: true"))
    start, _ = r.place["x"]
    assert r.recorded[:, [0, 2 + start]] == pytest.approx(np.array([[0.15, 0.3]]), abs=1e-9)


# --- forces ----------------------------------------------------------------------------------

PUSHED = """
bodies: {slider: {mass: 3, inertia: 1}}
joints: {slide: {type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}
sensors: {x: {joint: slide}}
forces:
  push: {type: applied_load, body: slider, direction: [1, 0, 0], force: 6 N}
  pull: {type: applied_load, body: slider, direction: [-1, 0, 0], force: 12 N}
  spring: {type: spring_damper, bodies: [ground, slider], points: [[-1, 0], [0, 0]], stiffness: 0,
           preload: 0}
solver: {end: 1, tolerance: 1e-10}
output: {every: 10 ms}
"""


def test_what_a_phase_applies_acts_in_it_alone():
    """2 m/s^2 for 0.2 s, free for 0.3 s, -4 m/s^2 for 0.1 s: v = 0.4, 0.4, 0."""
    r = run(PUSHED + """
phases:
  - {apply: [push], for: 0.2}
  - {for: 0.3}
  - {apply: [pull], for: 0.1}
  - {}
""")  # fmt: skip
    t, v = r.t, np.interp(r.t, [0, 0.2, 0.5, 0.6, 1.0], [0, 0.4, 0.4, 0, 0])
    assert r["x.rate"] == pytest.approx(v, abs=1e-10)
    a = np.select([t < 0.2 + 1e-9, t < 0.5 + 1e-9, t < 0.6 + 1e-9], [2.0, 0.0, -4.0])
    assert r["x.acceleration"] == pytest.approx(a, abs=1e-9)
    assert r["energy.work.loads"][-1] == pytest.approx(0.0, abs=1e-10) and energy_error(r) < 1e-9


def test_events_apply_and_remove():
    """What an event is first to apply rests before; what it is first to remove acts before."""
    r = run(PUSHED + """
events:
  on: {when: t, value: 0.2, do: {apply: [push]}}
  off: {when: t, value: 0.5, do: {remove: [pull, push]}}
  again: {when: t, value: 0.7, do: {apply: [pull]}}
""")  # fmt: skip
    v = np.interp(r.t, [0, 0.2, 0.5, 0.7, 1.0], [0, -0.8, -1.4, -1.4, -2.6])
    assert r["x.rate"] == pytest.approx(v, abs=1e-9)


def test_a_spring_that_is_removed_takes_its_energy_along():
    """And its stretch is still told; its force is none."""
    r = run(PUSHED.replace("stiffness: 0", "stiffness: 300").replace("12 N", "0").replace(
        "6 N", "0").replace("inertia: 1}", "inertia: 1, velocity: [1, 0]}") + """
events: {off: {when: x, value: 50 mm, times: 1, do: {remove: [spring]}}}
""")  # fmt: skip
    speed = sqrt(1 - 300 * 0.05**2 / 3)
    assert told(r)[0][2] == pytest.approx(-0.5 * 300 * 0.05**2, abs=1e-9)
    after = r["x"] > 0.0501
    assert r["x.rate"][after] == pytest.approx(speed, abs=1e-9)
    assert np.all(r["spring.force"][after] == 0.0)
    assert r["spring.length"][after] == pytest.approx(1 + r["x"][after], abs=1e-12)
    assert energy_error(r) < 1e-9


def test_a_spring_that_is_applied_brings_its_energy_along():
    """At x = 0.2 m a spring of 300 N/m acts that is free at 0: 6 J come with it, and it swings."""
    r = run(PUSHED.replace("stiffness: 0", "stiffness: 300").replace(
        "inertia: 1}", "inertia: 1, velocity: [1, 0]}") + """
phases: [{until: {when: x, value: 0.2}}, {apply: [spring]}]
""", "forces.push.force=0", "forces.pull.force=0")  # fmt: skip
    assert told(r)[1][2] == pytest.approx(6.0, abs=1e-9)
    t = r.t[r.t > 0.2] - 0.2
    assert r["x"][r.t > 0.2] == pytest.approx(0.2 * np.cos(10 * t) + 0.1 * np.sin(10 * t), abs=1e-8)
    assert np.all(r["energy.stored.springs"][r.t < 0.2] == 0.0) and energy_error(r) < 1e-9


RESTING = {
    "a pole": ('"0.01/(x - 0.3)"', 0.01 * log(0.7 / 0.3)),
    "a table that ends": ("{table: [[0.5, 1], [2, 1]], of: x, outside: error}", 0.4),
    "a logarithm": ('"log(x - 0.55)"', 0.45 * log(0.45) - 0.05 * log(0.05) - 0.4),
    "corners": ('"3*(x > 0.2) - 5*(x > 0.3)"', -0.8),
}


@pytest.mark.parametrize("force, work", RESTING.values(), ids=RESTING)
def test_a_load_that_rests_may_have_no_value(force, work):
    """x = t passes where it has none, or where it jumps, before it acts from 0.6 to 1 m."""
    text = PUSHED.replace("inertia: 1}", "inertia: 1, velocity: [1, 0]}").replace("6 N", force)
    text += "phases: [{until: {when: x, value: 0.6}}, {apply: [push], until: {when: x, value: 1}}]"
    r = run(text, "forces.pull.force=0", "solver.end=3")
    assert r["x.rate"][r.t < 0.6] == pytest.approx(1.0, abs=1e-12)
    assert r.events[-1, EVENT_SPEED] == pytest.approx(sqrt(1 + 2 * work / 3), abs=1e-8)


def test_load_sets_act_in_phases():
    text = (
        PUSHED
        + """
load_sets: {gust: {loads: [push, pull], ultimate: 1.5}}
loads: {gust: ultimate}
phases: [{for: 0.2}, {apply: [gust], for: 0.3}]
"""
    )
    r = run(text)
    assert r["x.rate"][r.t < 0.2] == pytest.approx(0.0, abs=1e-12)
    assert r["x.rate"][-1] == pytest.approx(-0.3 * 1.5 * 6 / 3, abs=1e-9)
    with pytest.raises(ScenarioError, match="load set 'gust' does not act"):
        run(text.replace("loads: {gust: ultimate}", "loads: {}"))


def test_a_load_of_a_later_phase_is_not_felt_by_the_start():
    """The equilibrium is that of the first phase: hanging straight down, and then at 45 degrees."""
    r = run("""
bodies: {rod: {mass: 2, inertia: 0.05, at: [0.3, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
sensors: {angle: {joint: hinge}}
gravity: [0, -10, 0]
initial: {equilibrium: all}
forces:
  side: {type: applied_load, body: rod, direction: [1, 0, 0], force: 20 N}
  damp: {type: torsion_spring, joint: hinge, stiffness: 0, damping: 2}
solver: {end: 12, tolerance: 1e-9}
phases: [{for: 1 s}, {apply: [side]}]
""")
    before = r.t < 1.0
    assert r["angle"][before] == pytest.approx(-pi / 2, abs=1e-7)
    assert r["angle"][-1] == pytest.approx(-pi / 4, abs=1e-4)


@pytest.mark.parametrize("rests", [True, False])
def test_a_bushing_of_a_later_phase_takes_nothing_along_at_the_start(rests):
    """A rate at the start is that of what holds together: one slider without it, both with it."""
    text = """
bodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1, at: [0, 1]}}
joints:
  one: {type: prismatic, bodies: [ground, a], axis: [1, 0, 0]}
  two: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0], at: [0, 1]}
forces: {rubber: {type: bushing, bodies: [a, b], at: [0, 0.5], stiffness: [1e3, 1e3, 0],
         damping: [1, 1, 0]}}
initial: {one.rate: 1 m/s}
solver: {end: 0.1}
phases: [{for: 0.05}, {}]
"""
    r = run(text, f"phases.{int(rests)}.apply=[rubber]")
    assert r["b.velocity"][0, 0] == pytest.approx(0.0 if rests else 1.0, abs=1e-12)


# --- parking ---------------------------------------------------------------------------------

CHAIN = """
bodies:
  door: {mass: 5, inertia: [1, 1, 1], at: [1, 0, 0]}
  arm: {mass: 2, inertia: [0.05, 0.06, 0.07], at: [0.2, 0, 0]}
  rod: {mass: 1, inertia: [0.02, 0.03, 0.04], at: [0.6, 0, 0]}
joints:
  pivot: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: [0, 0, 1]}
  elbow: {type: revolute, bodies: [arm, rod], at: [0.4, 0, 0], axis: [0, 0, 1]}
  wrist: {type: spherical, bodies: [rod, door], at: [0.8, 0, 0]}
gravity: [0, -9.81, 0]
solver: {end: 0.6, tolerance: 1e-9}
phases:
  - {name: all, for: 0.2}
  - {name: parted, release: [wrist], park: [arm], for: 0.2}
  - {name: again, unpark: [arm, rod]}
"""


@pytest.mark.parametrize("planar", ["", "planar: false\n"])
@pytest.mark.parametrize("far", [0.0, 1e4])
def test_a_parked_body_stays_with_what_hangs_on_it(planar, far):
    """The door falls freely from there; arm and rod stay, and are held against their weight."""
    frame = f"frame: {{at: [{far}, {far}, 0]}}\n" if far else ""
    r = run(planar + frame + CHAIN)
    t, held = r.t, (r.t > 0.2 + 1e-9) & (r.t < 0.4 + 1e-9)
    near = 1e-9 * (1 + 10 * far)
    for body in ("arm", "rod"):
        places = r[f"{body}.position"][held]
        assert np.ptp(places, axis=0) == pytest.approx(0.0, abs=near)
        assert np.abs(r[f"{body}.velocity"][held]).max() < near
    total = sum(r[name][held] for name in ("arm.park.force", "rod.park.force", "pivot.reaction"))
    assert total == pytest.approx(np.tile([0, 3 * 9.81, 0], (len(total), 1)), abs=1e-6)
    assert np.all(r["arm.park.force"][t < 0.2] == 0.0)
    door = r["door.velocity"][held, 1]
    assert door == pytest.approx(door[0] - 9.81 * (t[held] - t[held][0]), abs=1e-6)
    assert r["arm.velocity"][-1, 1] < -0.1  # and falls again
    assert "park arm, park rod" in r.mechanism.stages.switches.events[1].said
    assert energy_error(r) < 1e-7


def test_what_an_earlier_phase_released_holds_nothing_any_more():
    r = run(CHAIN.replace("name: all,", "name: all, release: [wrist],").replace(
        "name: parted, release: [wrist],", "name: parted,"))  # fmt: skip
    said = r.mechanism.stages.switches.events[1].said
    assert "park arm, park rod" in said and "park door" not in said


def test_what_is_joined_elsewhere_does_not_hang():
    """Without the release the door holds the rod as well, and nothing but the arm is parked."""
    r = run(CHAIN.replace("release: [wrist], ", "").replace(
        "gravity", "  hinge: {type: spherical, bodies: [ground, door], at: [1.2, 0.3, 0]}\ngravity"
    ).replace("unpark: [arm, rod]", "unpark: [arm]"))  # fmt: skip
    assert "park arm" in r.mechanism.stages.switches.events[1].said
    assert "park rod" not in r.mechanism.stages.switches.events[1].said


def test_the_first_phase_may_lock_and_park_what_moves():
    """At t = 0, with the energy of the start, and told in the table of events."""
    text = THROWN.replace("drive: {push: {velocity: 2}}, until: {when: x, value: 0.3}", "WHAT")
    text = text.replace("inertia: 1}", "inertia: 1, velocity: [2, 0]}")
    text = text.replace("drives: {push: {joint: slide, velocity: 0}}\n", "")
    text = text.replace("release: [push], ", "unlock: [slide], ")
    r = run(text.replace("WHAT", "lock: [slide], for: 0.1"), "phases.1.until={when: t, value: 0.2}")
    assert told(r)[0] == (0.0, "throw.begin", pytest.approx(-6.0, abs=1e-12))
    assert np.all(np.abs(r["x"]) < 1e-12) and energy_error(r) < 1e-12
    text = text.replace("unlock: [slide]", "unpark: [slider]")
    r = run(
        text.replace("WHAT", "park: [slider], for: 0.1"), "phases.1.until={when: t, value: 0.2}"
    )
    assert told(r)[0] == (0.0, "throw.begin", pytest.approx(-6.0, abs=1e-12))
    assert np.all(np.abs(r["x"]) < 1e-12)


# --- how a run ends --------------------------------------------------------------------------


def test_stalled():
    """A block slides into the sand and stays: m x'' = -c x', x to v m / c, too short of the value.

    The energy E0 exp(-2 c t / m) is below the bound from t0 on; 16 looks later the run ends.
    """
    text = (
        SLIDER
        + """
forces: {sand: {type: spring_damper, bodies: [ground, slider], points: [[-9, 0], [0, 0]],
         stiffness: 0, damping: 60}}
phases:
  - {name: throw, drive: {push: {velocity: 2}}, until: {when: x, value: 0.3}}
  - {name: slide, release: [push], until: {when: x, value: 0.5}, stall: {energy: 1e-3, for: 80 ms}}
  - {name: never, for: 1 s}
"""
    )
    r = run(text)
    still = 0.15 + 3 / 120 * log(0.5 * 3 * 4 / 1e-3)
    assert r.outcome.status == "stalled"
    assert still + 0.08 <= r.outcome.time <= still + 0.08 + 0.005 + 1e-9
    assert f"x is {0.3 + 2 * 3 / 60 * (1 - np.exp(-20 * (r.outcome.time - 0.15))):.6g} m" in (
        r.outcome.reason
    )
    assert "phase 'slide': nothing has moved since t = " in r.outcome.reason
    assert r.outcome.statistics["phases_left"] == 2
    assert run(text, "phases.1.until.value=0.31").outcome.status == "done"


@pytest.mark.parametrize("per", [1, 2, 16])
def test_what_turns_round_is_not_stalled(per):
    """A swing is at rest at every look, where looks are whole periods apart, and is not."""
    period = 2 * pi / sqrt(200 / 2)
    r = run(f"""
bodies: {{slider: {{mass: 2, inertia: 1}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, slider], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: slide}}}}
forces: {{spring: {{type: spring_damper, bodies: [ground, slider], points: [[-1, 0], [0, 0]],
         stiffness: 200, free_length: 0.9}}}}
solver: {{end: 12, tolerance: 1e-8}}
phases: [{{until: {{when: x, value: 1}}, stall: {{energy: 0.1 J, for: {16 * period / per} s}}}}]
""")
    assert r.outcome.status == "done" and r.outcome.time == 12.0


def test_a_start_at_rest_is_not_stalled_before_its_time():
    """What falls from rest is below the bound for a moment."""
    r = run("""
bodies: {stone: {mass: 2, inertia: 1}}
sensors: {y: {type: point, body: stone, at: [0, 0], axis: [0, -1, 0]}}
gravity: [0, -9.81, 0]
solver: {end: 2}
phases: [{until: {when: y, value: 1}, stall: {energy: 1e-3 J, for: 0.1}}]
""")
    assert r.outcome.status == "done" and r.outcome.time == pytest.approx(sqrt(2 / 9.81), abs=1e-7)


ROPE = """
bodies: {load: {mass: 2, inertia: 1, at: [0, -1]}}
joints: {rail: {type: prismatic, bodies: [ground, load], axis: [0, 1, 0]}}
sensors: {y: {joint: rail}}
gravity: [0, -10, 0]
initial: {rail: -0.1 m}
forces: {wire: {type: spring, bodies: [ground, load], points: [[0, 0], [0, -1]], free_length: 1 m,
         elastic: "800*stretch", tension_only: true}}
solver: {end: 1, tolerance: 1e-10}
phases: [{name: hang, taut: [wire], for: 0.5 s}, {name: on}]
"""


def test_slack():
    """From 0.1 m below on a rope of 800 N/m: y = -0.025 - 0.075 cos 20 t meets 0 at cos = -1/3."""
    r = run(ROPE)
    assert r.outcome.status == "slack"
    assert r.outcome.time == pytest.approx(acos(-1 / 3) / 20, abs=1e-8)
    assert "phase 'hang': 'wire' went slack at t = 0.0955" in r.outcome.reason
    assert run(ROPE, "phases.0.taut=[]").outcome.status == "done"
    assert run(ROPE, "initial.rail=-0.04 m").outcome.status == "done"  # never slack
    r = run(ROPE, "initial.rail=0.02 m")
    assert r.outcome.status == "slack" and r.outcome.time == 0.0
    assert "slack already" in said(r)


def test_a_rope_over_a_pulley_that_would_push_is_slack():
    """A push of 60 t N on the load takes the tension 19.6 N away from t = 0.1 s on: as a rod."""
    r = run("""
bodies: {load: {mass: 2, inertia: 1, at: [0, -1]}, other: {mass: 2, inertia: 1, at: [1, -1]}}
joints:
  rail: {type: prismatic, bodies: [ground, load], axis: [0, 1, 0]}
  side: {type: prismatic, bodies: [ground, other], axis: [0, 1, 0]}
  line: {type: rope, through: [{body: load, at: [0, -1]}, {body: ground, at: [0, 0]},
         {body: ground, at: [1, 0]}, {body: other, at: [1, -1]}]}
gravity: [0, -10, 0]
forces: {up: {type: applied_load, body: load, direction: [0, 1, 0], force: "400*t"}}
solver: {end: 1, tolerance: 1e-10}
phases: [{taut: [line]}]
""")
    assert r.outcome.status == "slack" and r.outcome.time == pytest.approx(0.1, abs=1e-8)


def test_released():
    """By the last phase, or by an event that says so; `end: done` says otherwise."""
    text = SLIDER + "phases:\n  - {drive: {push: {velocity: 2}}, for: 0.1}\n"
    text += "  - {name: gone, release: [push, slide], for: 0.2}\n"
    r = run(text)
    assert r.outcome.status == "released"
    assert "phase 'gone', the last one, ended at t = 0.3 s" in r.outcome.reason
    assert run(text.replace("for: 0.2}", "for: 0.2, end: done}")).outcome.status == "done"
    r = run(SLIDER + "events: {go: {when: t, value: 0.3, do: {release: [push], end: released}}}\n")
    assert r.outcome.status == "released" and r.outcome.time == pytest.approx(0.3)
    assert r.outcome.reason == (
        "event 'go' ended the run at t = 0.3 s: t rises through 0.3 s: release push, end released"
    )


# --- letting go ------------------------------------------------------------------------------


A, D, FREE, K = 0.3, 1.0, 0.95, 500.0  # m, m, m, N/m
HAND = f"""
bodies: {{crank: {{mass: MASS, inertia: 0.05}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, crank], at: [0, 0]}}}}
drives: {{hand: {{joint: hinge, MOTION}}}}
sensors: {{phi: {{joint: hinge}}}}
forces:
  spring: {{type: spring_damper, bodies: [ground, crank], points: [[{D}, 0], [{A}, 0]],
           stiffness: {K}, free_length: {FREE}}}
  roller: {{type: torsion_spring, joint: hinge, stiffness: 0, damping: DRAG}}
solver: {{end: 4, tolerance: 1e-10}}
output: {{every: 5 ms}}
"""
LET_GO = {
    "phases": """
phases:
  - {name: far, until: {when: phi, value: 0.4}}
  - {name: hold, until: {when: hand.force, crosses: up}}
  - {name: free, release: [hand], for: 0.05}
""",
    "an event": """
events:
  let_go: {when: hand.force, crosses: up, times: 1, do: {release: [hand]}}
  over: {when: t, value: 3.9, do: {end: true}}
""",
}


@pytest.mark.parametrize("how", LET_GO.values(), ids=LET_GO)
@pytest.mark.parametrize("motion", ["velocity: 0.4", 'position: "0.4*t"'])
@pytest.mark.parametrize("mass, drag", [(0.5, 0.0), (8.0, 0.0), (2.0, 0.6)])
def test_let_go_where_the_force_changes_sign(how, motion, mass, drag):
    """A hand turns a crank at 0.4 rad/s with a spring that is pressed at first, and a drag.

    A spring from the crank pin (radius a, phi from the line of centres) to a pin at a distance d
    has the length l^2 = a^2 + d^2 - 2 a d cos phi, and the hand gives k (l - l0) a d sin phi / l
    and the drag.  Without drag it changes sign where l = l0, cos phi = (a^2 + d^2 - l0^2)/(2 a d).
    """

    def given(phi):
        length = np.sqrt(A * A + D * D - 2 * A * D * np.cos(phi))
        return K * (length - FREE) * A * D * np.sin(phi) / length + drag * 0.4

    phi = np.arccos((A**2 + D**2 - FREE**2) / (2 * A * D))
    if drag:
        phi = brentq(given, 0.4, phi, xtol=1e-14)
    text = HAND.replace("MASS", str(mass)).replace("MOTION", motion).replace("DRAG", str(drag))
    r = run(text + how)
    time, _, work = next(line for line in told(r) if line[1] in ("hold.until", "let_go"))
    assert time == pytest.approx(phi / 0.4, abs=1e-8)
    jump = r.jumps[r.jumps[:, 0] == time]
    assert len(jump) == 1 and jump[0, 11] == pytest.approx(0.4, abs=1e-10)
    assert jump[0, 9:12] == pytest.approx(jump[0, 12:15], abs=1e-10)
    assert work == pytest.approx(0.0, abs=1e-10)
    assert np.all(r["hand.force"][r.t > time] == 0.0)
    assert np.all(r["hand.force"][(r.t > 1.0) & (r.t < time)] < 0.0)
