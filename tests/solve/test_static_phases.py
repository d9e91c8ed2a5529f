"""Static and dynamic phases in one run, against closed forms."""

from math import cos, sin, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from trsim.errors import ScenarioError

from ..runs import energy_error, run
from .test_phases import said, told

M, L, J, G, W = 2.0, 0.4, 0.05, 9.81, 2.0
INERTIA = J + M * L**2  # about the hinge
ROD = f"""
bodies: {{rod: {{mass: {M}, inertia: [{J}, {J}, {J}], at: [{L}, 0]}}}}
joints: {{hinge: {{type: revolute, bodies: [BODIES], at: [0, 0]}}}}
drives: {{motor: {{joint: hinge, velocity: 0}}}}
sensors: {{angle: {{joint: hinge}}}}
gravity: [0, -{G}, 0]
solver: {{end: 2 s, tolerance: 1e-10}}
output: {{every: 10 ms}}
phases:
"""
LIFTED = ROD + (
    f"  - {{name: lift, static: true, drive: {{motor: {{velocity: SIGN{W}}}}}, "
    "until: {when: angle, value: SIGN0.5, crosses: WAY}}\n"
    "  - {name: swing, release: [motor], until: {when: angle, value: SIGN-1, crosses: BACK}}\n"
)


def lifted(bodies="ground, rod"):
    up = bodies.startswith("ground")
    text = LIFTED.replace("BODIES", bodies).replace("WAY", "up" if up else "down")
    text = text.replace("BACK", "down" if up else "up")
    return text.replace("SIGN-", "-" if up else "").replace("SIGN", "" if up else "-")


@pytest.mark.parametrize("bodies", ["ground, rod", "rod, ground"])
@pytest.mark.parametrize("method", ["dop853", "radau", "auto", "rk4, step: 0.5 ms"])
@pytest.mark.parametrize("plane", ["", "planar: false\n"])
def test_a_rod_is_lifted_in_balance_and_swings_back(bodies, method, plane):
    """M g L cos(phi) holds it on its way to 0.5 rad, without inertia; then it goes on at the speed
    it has there, 2 rad/s, and falls."""
    r = run(plane + lifted(bodies).replace("end: 2 s,", f"end: 2 s, method: {method},"))
    assert r.outcome.status == "released"
    side = 1.0 if bodies.startswith("ground") else -1.0
    (_, begin, _), (t1, lift, _), (_, swing, _) = told(r)
    assert (begin, lift, swing) == ("lift.begin", "lift.until", "swing.until")
    assert t1 == pytest.approx(0.5 / W, abs=1e-9)
    still = r.t < t1
    angle, moment = side * r["angle"], side * r["motor.force"]
    assert angle[still] == pytest.approx(W * r.t[still], abs=1e-9)
    assert moment[still] == pytest.approx(M * G * L * np.cos(angle[still]), rel=1e-8)
    assert side * r["angle.rate"][still] == pytest.approx(W, rel=1e-8)
    # then its energy is kept: the speed at -1 rad, and at each row
    free = r.t > t1
    fallen = 2 * M * G * L / INERTIA * (sin(0.5) - np.sin(angle[free]))
    tight = 1e-7 if "rk4" not in method else 1e-6
    assert r["angle.rate"][free] ** 2 == pytest.approx(W**2 + fallen, rel=tight, abs=tight)
    assert side * r["angle.rate"][free][0] > 0.0  # it goes on upwards
    assert energy_error(r) < 1e-6


def test_times_of_both():
    """The time of a free fall behind a static phase, by quadrature."""
    from scipy.integrate import solve_ivp

    r = run(lifted())
    fall = solve_ivp(lambda t, y: [y[1], -M * G * L * cos(y[0]) / INERTIA], (0, 2), [0.5, W],
                     rtol=1e-12, atol=1e-12, events=lambda t, y: y[0] + 1.0)  # fmt: skip
    (*_, (t2, _, _)) = told(r)
    assert t2 == pytest.approx(0.25 + fall.t_events[0][0], abs=1e-8)


BOX = f"""
bodies: {{box: {{mass: {M}, inertia: [1, 1, 1]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, box], axis: [0, 1, 0]}}}}
drives: {{jack: {{joint: slide, velocity: 0}}}}
sensors: {{height: {{joint: slide}}}}
forces: {{spring: {{type: joint_spring, joint: slide, elastic: "100*stretch"}}}}
gravity: [0, -{G}, 0]
solver: {{end: 3 s, tolerance: 1e-10}}
output: {{every: 50 ms}}
phases:
"""


def test_what_moves_is_put_into_balance():
    """A box on a spring swings freely and is stopped in balance, 0.19 m down; the energy that is
    left out is told."""
    r = run(
        BOX.replace("drives: {jack: {joint: slide, velocity: 0}}\n", "")
        + """
  - {name: swing, for: 0.3 s}
  - {name: rest, static: true, for: 0.2 s}
  - {name: on, for: 0.1 s}
"""
    )
    w, rest = sqrt(100 / M), -M * G / 100
    swings = r.t < 0.3 - 1e-9
    assert r["height"][swings] == pytest.approx(rest * (1 - np.cos(w * r.t[swings])), abs=1e-8)
    rests = r.t > 0.3 + 1e-9
    assert r["height"][rests] == pytest.approx(rest, abs=1e-9)
    assert r["height.rate"][rests] == pytest.approx(0.0, abs=1e-9)
    begun = 0.5 * M * G * -rest  # J, which it would swing with for ever
    (_, (_, name, _), *_) = told(r)
    assert name == "swing.for"
    assert r["energy.work.events"][rests] == pytest.approx(-begun, rel=1e-7)
    assert energy_error(r) < 1e-8
    assert "rest" in said(r) and "balance" in said(r)


def test_up_and_down_against_friction():
    """A box that rubs on its guide, lifted and let down in balance: the force of the jack is that
    of the weight and of the spring, and friction adds to it or takes from it."""
    text = BOX.replace(
        "forces: {",
        "forces: {rub: {type: joint_friction, joint: slide, friction: {law: modified_coulomb, "
        "coefficient: 0.3, v0: 0.1 mm/s, v1: 1 mm/s}}, "
        "push: {type: applied_load, body: box, force: 40, direction: [1, 0, 0]}, ",
    )
    r = run(
        text
        + """
  - {name: lift, static: true, drive: {jack: {velocity: 0.2}}, until: {when: height, value: 0.1}}
  - {name: lower, static: true, drive: {jack: {velocity: -0.1}}, for: 0.5 s}
  - {name: rest, drive: {jack: {velocity: 0}}, for: 0.1 s}
"""
    )
    up, down = (r.t > 1e-9) & (r.t < 0.5 - 1e-9), (r.t > 0.5 + 1e-9) & (r.t < 1.0 - 1e-9)
    held = M * G + 100 * r["height"]
    assert r["jack.force"][up] == pytest.approx(held[up] + 12.0, rel=1e-7)
    assert r["jack.force"][down] == pytest.approx(held[down] - 12.0, rel=1e-7)
    still = r.t > 1.0 + 1e-9
    assert r["height"][still] == pytest.approx(0.05, abs=1e-8)
    assert r["jack.force"][still] == pytest.approx(held[still], rel=1e-6)
    assert energy_error(r) < 1e-6


@pytest.mark.parametrize("motion, place", [
    ("position: \"0.1*sin(t)\"", lambda t: 0.1 * np.sin(t)),
    ("velocity: \"0.1*cos(t)\"", lambda t: 0.1 * np.sin(t)),
])  # fmt: skip
def test_motions_have_clocks_of_their_own(motion, place):
    """A motion of a static phase that does not begin at the start of the run."""
    r = run(
        BOX
        + f"""
  - {{name: wait, drive: {{jack: {{velocity: 0}}}}, for: 0.4 s}}
  - {{name: move, static: true, drive: {{jack: {{{motion}}}}}, for: 1 s}}
  - {{name: again, static: true, drive: {{jack: {{{motion}}}}}, for: 0.5 s}}
""".replace(
            'again, static: true, drive: {jack: {position: "0.1*sin(t)"}}',
            'again, static: true, drive: {jack: {position: "0.1*sin(t) + 0.1*sin(1)"}}',
        )
    )
    first = (r.t > 0.4) & (r.t < 1.4)
    assert r["height"][first] == pytest.approx(place(r.t[first] - 0.4), abs=1e-8)
    second = r.t > 1.4
    there = place(1.0) + place(r.t[second] - 1.4)
    assert r["height"][second] == pytest.approx(there, abs=1e-8)


def test_all_phases_of_a_static_path():
    """`method: static_path` with phases: each is one."""
    text = BOX.replace("end: 3 s,", "end: 3 s, method: static_path,")
    r = run(
        text
        + """
  - {name: lift, drive: {jack: {velocity: 0.2}}, until: {when: jack.force, value: 25}}
  - {name: free, release: [jack], for: 0.1 s}
"""
    )
    (_, (t1, _, _), _) = told(r)
    assert r.outcome.status == "released"
    assert t1 == pytest.approx((25 - M * G) / 100 / 0.2, abs=1e-9)
    assert r["height"][-1] == pytest.approx(-M * G / 100, abs=1e-9)  # it fell back, which is told
    assert "moves by" in said(r)


def test_locks_parks_and_loads_of_static_phases():
    """What a static phase locks, and what acts in it alone."""
    r = run(
        BOX.replace("drives: {jack: {joint: slide, velocity: 0}}\n", "").replace(
            "forces: {",
            "forces: {push: {type: applied_load, body: box, force: 30, direction: [0, 1, 0]}, ",
        )
        + """
  - {name: pushed, static: true, apply: [push], for: 0.2 s}
  - {name: held, static: true, lock: [slide], for: 0.2 s}
  - {name: free, unlock: [slide], for: 0.3 s}
"""
    )
    pushed, held, free = r.t < 0.2 - 1e-9, (r.t > 0.2) & (r.t < 0.4 - 1e-9), r.t > 0.4
    high, rest = (30 - M * G) / 100, -M * G / 100
    assert r["height"][pushed | held] == pytest.approx(high, abs=1e-9)
    swing = rest + (high - rest) * np.cos(sqrt(100 / M) * (r.t[free] - 0.4))
    assert r["height"][free] == pytest.approx(swing, abs=1e-8)


def test_a_path_that_ends_inside_a_phase():
    """A toggle of two rods: past the dead point no balance is near, and the run says where."""
    r = run(f"""
bodies: {{arm: {{mass: 1, inertia: 0.1, at: [0.5, 0.3]}}}}
joints: {{hinge: {{type: revolute, bodies: [ground, arm], at: [0, 0]}}}}
sensors: {{turn: {{joint: hinge}}}}
drives: {{puller: {{type: actuator, bodies: [ground, arm], points: [[0, 1], [1, 0.6]],
          velocity: 0}}}}
gravity: [0, -{G}, 0]
solver: {{end: 60 s}}
output: {{every: 0.2 s}}
phases:
  - {{name: wait, for: 0.1 s}}
  - {{name: pull, static: true, drive: {{puller: {{velocity: -0.05}}}}, for: 50 s}}
""")
    assert r.outcome.status == "limit"
    # the shortest the actuator can be: both points on one line with the hinge
    shortest = abs(sqrt(1 + 0.36) - 1.0)
    long = sqrt(1 + 0.16)
    assert r.t[-1] == pytest.approx(0.1 + (long - shortest) / 0.05, rel=1e-4)


@pytest.mark.parametrize("text, told_of", [
    ("- {name: a, static: true, stall: {energy: 1, for: 1}, for: 1 s}", "stall"),
    ("- {name: a, static: yes, for: 1 s}", "static"),
])  # fmt: skip
def test_what_a_static_phase_does_not_know(text, told_of):
    with pytest.raises(ScenarioError) as error:
        run(BOX + "  " + text + "\n")
    assert told_of in str(error.value)


def test_the_impulse_of_a_lock_behind_a_static_phase():
    """A lock takes the speed of the path away; its work is the energy of it."""
    r = run(
        lifted()
        .replace("release: [motor], until", "lock: [hinge], release: [motor], until")
        .replace("value: -1, crosses: down", "value: 1")
    )
    (_, (_, _, work), *_) = told(r)
    assert work == pytest.approx(-0.5 * INERTIA * W**2, rel=1e-8)
    assert r["angle"][-1] == pytest.approx(0.5, abs=1e-9)


K, GAP = 1e5, 0.02
ON_A_PAD = f"""
bodies: {{box: {{mass: {M}, inertia: 1, at: [0, {GAP}]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, box], axis: [0, 1, 0], at: [0, {GAP}]}}}}
drives: {{jack: {{joint: slide, velocity: 0}}}}
sensors: {{height: {{joint: slide}}}}
forces:
  pad:
    type: surface_contact
    surface: {{body: ground}}
    ball: {{body: box, at: [0, {GAP}]}}
contact_laws:
  rubber: {{normal: impact, exponent: 1, stiffness: {K}, damping: 0, ramp: 1 um}}
gravity: [0, -{G}, 0]
solver: {{end: 3 s, tolerance: 1e-10}}
output: {{every: 5 ms}}
phases:
"""


@pytest.mark.parametrize("method", ["auto", "radau"])
def test_a_box_put_down_on_a_pad_and_let_go(method):
    """Lowered in balance, pressed down by 1,000 N and let go: it goes on with what the pad has
    stored and the speed it had, flies, and comes down on the pad again."""
    r = run(
        ON_A_PAD.replace("end: 3 s,", f"end: 3 s, method: {method},")
        + """
  - {name: lower, static: true, drive: {jack: {velocity: -0.1}},
     until: {when: jack.force, value: -1000, crosses: down}}
  - {name: jump, release: [jack], for: 0.3 s}
"""
    )
    depth = (1000 + M * G) / K
    (_, (t1, lowered, _), (_, jumped, _)) = told(r)
    assert (lowered, jumped) == ("lower.until", "jump.for")
    assert t1 == pytest.approx((GAP + depth) / 0.1, abs=1e-8)
    down = r.t < t1 - 1e-9
    pressed = np.maximum(0.0, 0.1 * r.t[down] - GAP)
    assert r["pad.normal_force"][down] == pytest.approx(K * pressed, abs=1e-4)
    assert r["jack.force"][down] == pytest.approx(M * G - K * pressed, abs=1e-4)
    # from the deepest place on: the energy of the spring, of the weight and of 0.1 m/s
    speed2 = 0.01 + K / M * depth**2 - 2 * G * depth
    high = speed2 / (2 * G)
    assert r.largest("height")[0] == pytest.approx(high - GAP, rel=1e-7)
    flies = r["height"] > -GAP
    free = flies & (r.t > t1)
    lift = 2 * G * (r["height"][free] + GAP)
    assert r["height.rate"][free] ** 2 == pytest.approx(speed2 - lift, abs=1e-6)
    assert energy_error(r) < 1e-7
    # touches are located in both: it leaves the pad behind a quarter of a swing, less its speed
    onset, separation = (r.events[r.events[:, 1] == kind][0, 0] for kind in (1.0, 2.0))
    w, rest = sqrt(K / M), depth - M * G / K
    leaves = brentq(lambda t: rest * cos(w * t) + 0.1 / w * sin(w * t) + M * G / K, 0.1 / w, 3 / w)
    assert onset == pytest.approx(GAP / 0.1, abs=1e-9)
    assert separation - t1 == pytest.approx(leaves, abs=1e-8)


def test_events_beside_static_phases():
    """Events that record go on in static phases; what ends a phase counts there alone."""
    r = run(
        BOX.replace(
            "phases:",
            """
events:
  high: {when: height, value: 0.05, crosses: both, do: {record: true}}
  once: {when: t, value: 0.3, do: {record: true}}
phases:""",
        )
        + """
  - {name: up, static: true, drive: {jack: {position: "0.1*sin(pi*t)"}}, for: 1.5 s,
     until: {when: height, value: 0.5}}
  - {name: on, drive: {jack: {velocity: 0}}, for: 0.1 s}
"""
    )
    names = [e.name for e in r.mechanism.stages.switches.events]
    lines = [(names[int(k)], t) for t, k in r.recorded[:, :2]]
    assert [name for name, _ in lines] == ["high", "once", "high"]
    times = [np.arcsin(0.5) / np.pi, 0.3, 1 - np.arcsin(0.5) / np.pi]
    assert [t for _, t in lines] == pytest.approx(times, abs=1e-9)
    assert r["height"][-1] == pytest.approx(-0.1, abs=1e-8)
    assert r.largest("height")[0] == pytest.approx(0.1, abs=1e-8)


def test_a_run_goes_on_behind_a_static_phase(monkeypatch):
    """From a checkpoint of the motion behind it, to the last bit."""
    from trsim.solve import simulate as module

    from .test_checkpoint import TABLES, assert_same, blocks

    unbroken, outcome = blocks((), text=lifted())
    monkeypatch.setattr(module, "VISIT", 5)
    cut, again = blocks((), text=lifted())
    assert_same(cut, again, unbroken, outcome)
    later = [k for k, block in enumerate(cut[:-1]) if block.state is not None]
    assert len(later) > 3 and TABLES
    for k in later[:: max(1, len(later) // 3)]:
        rest, end = blocks((), cut[k].state, text=lifted())
        assert_same([*cut[: k + 1], *rest], end, unbroken, outcome)


@pytest.mark.parametrize("angle", [1.0, 2.5])
def test_a_pendulum_is_put_where_it_hangs(angle):
    """Not on its top, however near that is."""
    text = ROD.replace(
        "drives: {motor: {joint: hinge, velocity: 0}}\n", f"initial: {{hinge: {angle}}}\n"
    )
    r = run(text.replace("BODIES", "ground, rod") + """
  - {name: swing, for: 0.05 s}
  - {name: rest, static: true, for: 0.1 s}
""")  # fmt: skip
    turns = (r["angle"][-1] + np.pi / 2) / (2 * np.pi)
    assert turns == pytest.approx(round(turns), abs=1e-9)


def test_a_start_at_rest_and_a_second_static_phase_are_those_of_one():
    """Two static phases with one motion are one path."""
    motion = '"0.1*sin(t)"'
    one = run(
        BOX + f"  - {{name: a, static: true, drive: {{jack: {{position: {motion}}}}}, for: 2}}\n"
    )
    begun = f"  - {{name: a, static: true, drive: {{jack: {{position: {motion}}}}}, for: 0.7}}\n"
    two = run(BOX + begun + "  - {name: b, static: true, for: 1.3}\n")
    assert len(one.t) == len(two.t)
    for name in ("height", "height.rate", "jack.force", "energy.work.drives"):
        assert two[name] == pytest.approx(one[name], abs=1e-7), name


@pytest.mark.parametrize("begin", ["solver: {end: 4, method: static_path}", "phases:"])
def test_a_force_that_passes_a_value_and_comes_back_between_rows(begin):
    """A spring with a hump of 50 N at 0.12 m, 10 mm wide, and rows 50 mm apart."""
    hump = BOX.replace("100*stretch", "100*stretch + 50*exp(-((stretch - 0.12)/0.005)**2)")
    hump = hump.replace("50 ms", "0.5 s")
    hump = hump.replace("velocity: 0}", "velocity: 0.1}").replace(f"-{G}", "0")
    if begin == "phases:":
        r = run(
            hump + "  - {name: up, static: true, until: {when: jack.force, value: 60}, for: 3}\n"
        )
    else:
        events = "events: {high: {when: jack.force, value: 60, do: {end: true}}}\n"
        hump = hump.replace("solver: {end: 3 s, tolerance: 1e-10}", begin)
        r = run(hump.replace("phases:\n", events))
    there = brentq(lambda x: 100 * x + 50 * np.exp(-(((x - 0.12) / 0.005) ** 2)) - 60, 0.11, 0.12)
    assert r.outcome.time == pytest.approx(there / 0.1, abs=1e-9)


def test_what_a_compliant_drive_moves_at_a_steady_speed():
    """It goes at the speed of the drive, K f = weight behind it, and goes on so in motion."""
    soft = BOX.replace(
        "velocity: 0}", "velocity: 0.2, compliance: {stiffness: 500, damping: 3}}"
    ).replace('"100*stretch"', "0")
    r = run(soft + "  - {name: lift, static: true, for: 1}\n  - {name: on, for: 0.5}\n")
    assert r["height"] == pytest.approx(0.2 * r.t - M * G / 500, abs=1e-8)
    assert r["height.rate"] == pytest.approx(0.2, abs=1e-7)
    assert r.outcome.statistics["steps"] < 1000


@pytest.mark.parametrize("until, time", [
    ("{when: height, value: -0.1, crosses: down}", 0.1),
    ("{when: height, value: -0.1, crosses: both}", 0.1),
    ("{when: height, value: -0.3, crosses: down}", 0.6),
])  # fmt: skip
def test_a_value_on_the_way_to_the_balance_that_a_phase_begins_in(until, time):
    """A box held at 0 m and let go in balance, 0.196 m down, passes 0.1 m as the phase begins."""
    r = run(
        BOX
        + f"""
  - {{name: hold, drive: {{jack: {{velocity: 0}}}}, for: 0.1}}
  - {{name: rest, static: true, release: [jack], until: {until}, for: 0.5}}
  - {{name: on, for: 0.1}}
"""
    )
    (*_, (t, _, _), _) = told(r)
    assert t == pytest.approx(time, abs=1e-9)
    assert r["height"][-1] == pytest.approx(-M * G / 100, abs=1e-8)
    assert energy_error(r) < 1e-8


def test_an_event_that_lets_a_path_jump_over_the_end_of_its_phase():
    r = run(
        BOX.replace(
            "phases:",
            "events: {drop: {when: height, value: 0.05, times: 1, do: {release: [jack]}}}\nphases:",
        )
        + """
  - {name: up, static: true, drive: {jack: {velocity: 0.1}},
     until: {when: height, value: -0.1, crosses: down}, for: 2}
  - {name: on, for: 0.1}
"""
    )
    assert [(name, t) for t, name, _ in told(r)][2] == ("up.until", pytest.approx(0.5, abs=1e-9))
