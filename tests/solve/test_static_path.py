"""Static paths against closed forms, and against slow dynamics where inertia is told."""

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator
from scipy.optimize import brentq

from tests.linkages import UPRIGHT_CRANK
from tests.runs import energy_error, run
from trsim.errors import ModelError, ScenarioError
from trsim.solve.path.place import Place
from trsim.solve.path.results import slope

G = 9.81
SOLVER = """
gravity: [0, -9.81, 0]
solver: {{method: {method}, end: {end}}}
output: {{every: {every}, channels: ["*"]}}
"""


def path(text, end=1.0, every=0.05, method="static_path", fails=False):
    return run(text + SOLVER.format(method=method, end=end, every=every), fails=fails)


def events(r, kind):
    """Times and rows of the events of a kind."""
    return r.events[r.events[:, 1] == kind][:, [0, 2]]


def row(r, name):
    return next(e for e, i in enumerate(r.mechanism.instances) if i.name == name)


ONSET, SEPARATION, USER, CORNER, TURNS = 1, 2, 5, 7, 8

PENDULUM = """
bodies:
  rod: {{mass: 2 kg, inertia: [0.01, 0.02, 0.05], at: [{x}, {y}]}}
joints:
  hinge: {{type: revolute, bodies: [{bodies}], at: [{x0}, {y}]}}
drives:
  motor: {{joint: hinge, {motion}}}
sensors: {{turn: {{joint: hinge}}}}
"""
RATE = 3.0


@pytest.mark.parametrize("bodies, side", [("ground, rod", 1), ("rod, ground", -1)])
@pytest.mark.parametrize("motion", ['position: "{}*t"', "velocity: {}"])
@pytest.mark.parametrize("far, plane", [(0, ""), (300, ""), (0, "planar: false")])
def test_pendulum_held_along_an_angle(bodies, side, motion, far, plane):
    text = PENDULUM.format(
        x=far + 0.2, x0=far, y=far, bodies=bodies, motion=motion.format(side * RATE)
    )
    r = path(plane + text)
    assert r["motor.force"] == pytest.approx(side * 2 * G * 0.2 * np.cos(RATE * r.t), abs=1e-9)
    assert r["turn"] == pytest.approx(side * RATE * r.t, abs=1e-9)
    assert r["rod.angular_velocity"][:, 2] == pytest.approx(RATE, abs=1e-6)
    assert r["rod.acceleration"][:, 0] == pytest.approx(
        -0.2 * RATE**2 * np.cos(RATE * r.t), abs=2e-3 * RATE**2
    )
    assert not np.any(r["energy.kinetic"]) and energy_error(r) < 1e-4
    work = 2 * G * 0.2 * np.sin(RATE * r.t)
    assert r["energy.work.drives"] == pytest.approx(work, abs=1e-3)


def test_speed_changes_only_velocities():
    """A path has no inertia and no damping: t only says how far it has come."""
    damped = (
        PENDULUM
        + "forces: {{oil: {{type: torsion_spring, joint: hinge, stiffness: 3, damping: 9}}}}"
    )
    at = {"x": 0.2, "x0": 0, "y": 0, "bodies": "ground, rod"}
    slow, fast = (
        path(damped.format(motion=f'position: "{v}*t"', **at), end=2 / v, every=0.08 / v)
        for v in (0.01, 1000.0)
    )
    assert slow["motor.force"] == pytest.approx(fast["motor.force"], abs=1e-9)
    assert slow["rod.velocity"] * 1e5 == pytest.approx(fast["rod.velocity"], abs=1e-2)
    angle = slow["turn"]
    assert fast["motor.force"] == pytest.approx(3 * angle + 2 * G * 0.2 * np.cos(angle), abs=1e-9)


def test_a_drive_that_gives_way():
    """Its spring is all there is, whatever its damper and the speed."""
    give = "position: {}*t, compliance: {{stiffness: 50, damping: 70}}"
    for speed in (1.0, 100.0):
        text = PENDULUM.format(x=0.2, x0=0, y=0, bodies="ground, rod", motion=give.format(speed))
        r = path(text, end=1 / speed, every=0.1 / speed)
        held = 50 * (speed * r.t - r["turn"])
        assert held == pytest.approx(2 * G * 0.2 * np.cos(r["turn"]), abs=1e-9)
        assert r["motor.force"] == pytest.approx(held, abs=1e-9)


def test_dampers_and_friction_by_a_function_are_told():
    """They are no part of a path: a run that would feel them says so."""
    text = PENDULUM.format(x=0.2, x0=0, y=0, bodies="ground, rod", motion='position: "t"')
    text += """
forces:
  oil: {type: applied_load, body: rod, torque: "-2*turn.rate/sqrt(turn.rate**2 + 1e-6)",
        direction: [0, 0, 1]}
"""
    (told,) = [one for one in path(text).outcome.said if "dampers" in one]
    assert "by up to 51 %" in told and told.startswith("drives.motor")


WEDGE = """
planar: true
bodies:
  wedge: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [0, 0]}
  block: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0, 0.2]}
joints:
  rail: {type: prismatic, bodies: [ground, wedge], axis: [1, 0]}
  guide: {type: prismatic, bodies: [ground, block], axis: [0, 1]}
drives:
  motor: {joint: rail, position: "0.1*t"}
forces:
  face: {type: limit_stop, point: {body: block, at: [0, 0.2]}, stiffness: 1e5,
         wall: {body: wedge, at: [0, 0.2], normal: [NX, 2]}}
  spring: {type: joint_spring, joint: guide, elastic: "100*stretch"}
"""


@pytest.mark.parametrize("slope", [0.5, -0.5])
def test_slider_on_a_wedge(slope):
    """The face y = -slope x, pressed in by d = -(slope x + y) cos: k d cos = m g + 100 y."""
    r = path(WEDGE.replace("NX", repr(-2 * slope)))
    x, k, c = 0.1 * r.t, 1e5, 1 / np.hypot(1, slope)
    y = (-k * c * c * slope * x - 2 * G) / (100 + k * c * c)
    force = (100 * y + 2 * G) / c
    assert r["block.position"][:, 1] - 0.2 == pytest.approx(y, abs=1e-12)
    assert r["face.normal_force"] == pytest.approx(force, abs=1e-7)
    assert r["motor.force"] == pytest.approx(-force * slope * c, abs=1e-7)
    assert r.outcome.statistics["lowest_eigenvalue"] == pytest.approx(
        (100 + k * c * c) / 2, rel=1e-6
    )
    assert energy_error(r) < 1e-8


TRUSS = """
planar: true
bodies:
  top: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [0, 0.3]}
joints:
  guide: {type: prismatic, bodies: [ground, top], axis: [0, 1]}
forces:
  left: {type: spring_damper, bodies: [ground, top], points: [[-1, 0], [0, 0.3]], stiffness: 1000}
  right: {type: spring_damper, bodies: [ground, top], points: [[1, 0], [0, 0.3]], stiffness: 1000}
  load: {type: applied_load, body: top, at: [0, 0.3], direction: [0, -1], force: "LOAD"}
sensors: {down: {joint: guide}}
"""
BAR = np.hypot(1, 0.3)


def truss_force(y):
    """Upwards, at the height y of the top: von Mises' truss."""
    return -2 * 1000 * (np.hypot(1, y) - BAR) * y / np.hypot(1, y)


@pytest.mark.parametrize("load", ["20*t", "20*t**3", "20 - 20*cos(t)"])
def test_snap_through_of_a_truss(load):
    """It turns back where the bars have the length L^(1/3): cos^3 of their angle is 1/L."""
    r = path(TRUSS.replace("LOAD", f"{load} - {G}"), end=2)
    top = np.sqrt(BAR ** (2 / 3) - 1)
    most = truss_force(top)
    assert r.outcome.status == "limit" and "limit point" in r.outcome.reason
    when = brentq(lambda t: eval(load, {"t": t, "cos": np.cos}) - most, 0, 2, xtol=1e-15)  # noqa: S307
    assert r.outcome.time == pytest.approx(when, abs=1e-9)
    assert 0.3 + r["down"][-1] == pytest.approx(top, abs=1e-6)
    assert f"guide = {top - 0.3:.6g}" in r.outcome.reason
    given = [eval(load, {"t": t, "cos": np.cos}) for t in r.t]  # noqa: S307
    assert truss_force(0.3 + r["down"]) == pytest.approx(np.array(given), abs=1e-8)


@pytest.mark.parametrize("height", [0.02, 0.005])
def test_snap_through_of_a_shallow_truss(height):
    """The way it would jump is as short as a step: it is no step all the same."""
    bar, text = np.hypot(1, height), TRUSS.replace("0.3]", f"{height}]").replace("BAR", "")
    top = np.sqrt(bar ** (2 / 3) - 1)
    most = 2000 * (bar / np.hypot(1, top) - 1) * top
    r = path(text.replace("LOAD", f"{1.5 * float(most)!r}*t - {G}"), every=0.1)
    assert r.outcome.status == "limit"
    assert r.outcome.time == pytest.approx(1 / 1.5, rel=1e-6)
    assert height + r["down"][-1] == pytest.approx(top, rel=1e-4)


def test_driven_through_a_snap():
    """Where the place is driven there is no limit point, and the force falls below zero."""
    text = TRUSS.replace("LOAD", f"{-G}") + 'drives: {press: {joint: guide, position: "-0.6*t"}}'
    r = path(text)
    y = 0.3 - 0.6 * r.t
    assert r.outcome.status == "done"
    assert r["press.force"] == pytest.approx(-truss_force(y), abs=1e-9)


TOGGLE = """
planar: true
parameters: {a: 0.5}
bodies:
  first: {mass: 1 kg, inertia: 0.01 kg*m^2, at: ["a/2", 0]}
  second: {mass: 1 kg, inertia: 0.01 kg*m^2, at: ["3*a/2", 0]}
  end: {mass: 1 kg, inertia: 0.01 kg*m^2, at: ["2*a", 0]}
joints:
  foot: {type: revolute, bodies: [ground, first], at: [0, 0]}
  knee: {type: revolute, bodies: [first, second], at: [a, 0]}
  head: {type: revolute, bodies: [second, end], at: ["2*a", 0]}
  guide: {type: prismatic, bodies: [ground, end], axis: [1, 0]}
forces:
  stay: {type: torsion_spring, joint: foot, stiffness: 6}
  other: {type: torsion_spring, joint: knee, stiffness: 3}
  push: {type: applied_load, body: end, at: ["2*a", 0], direction: [-1, 0], force: "40*t"}
  up: {type: applied_load, body: first, frame: world, direction: [0, 1], force: 9.81}
  upper: {type: applied_load, body: second, frame: world, direction: [0, 1], force: 9.81}
"""


def test_a_toggle_of_two_springs_buckles():
    """Straight it stands until P a (2 theta^2) is the energy of its springs: 2 a P = k + 4 c."""
    r = path(TOGGLE)
    load = (6 + 4 * 3) / (2 * 0.5)
    (told,) = [text for text in r.outcome.said if "unstable" in text]
    assert float(told.split("t = ")[1].split()[0]) == pytest.approx(load / 40, abs=1e-6)
    assert r.outcome.status == "done" and r.outcome.statistics["lowest_eigenvalue"] < 0
    assert r["first.position"][:, 1] == pytest.approx(0, abs=1e-9)


STOPPED = """
bodies:
  rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}
drives:
  motor: {joint: hinge, position: "1.2*sin(3*t)"}
forces:
  stop: {type: limit_stop, joint: hinge, upper: 0.7, stiffness: 1e4, damping: 50}
  rope: {type: spring, bodies: [ground, rod], points: [[0, -1], [0.4, 0]], elastic: "500*stretch",
         damper: "40*rate", free_length: 1.2, tension_only: true}
sensors: {turn: {joint: hinge}}
"""


@pytest.mark.parametrize("every", [0.02, 0.25])
def test_a_stop_and_a_rope_on_the_way(every):
    """Both are met and left at the places of closed forms, also between rows far apart."""
    r = path(STOPPED, every=every)
    first, last = (np.arcsin(0.7 / 1.2) / 3, (np.pi - np.arcsin(0.7 / 1.2)) / 3)
    e = row(r, "stop")
    assert events(r, ONSET) == pytest.approx(np.array([[first, e]]), abs=1e-11)
    assert events(r, SEPARATION) == pytest.approx(np.array([[last, e]]), abs=1e-11)
    taut = np.arcsin((1.2**2 - 1.16) / 0.8)  # 0.4^2 + 1 + 2 0.4 sin = 1.2^2
    times = np.arcsin(taut / 1.2) / 3
    corners = events(r, CORNER)
    assert set(corners[:, 1]) == {row(r, "rope")}
    assert corners[:, 0] == pytest.approx([times, np.pi / 3 - times], abs=1e-10)
    a = r["turn"]
    length = np.sqrt(1.16 + 0.8 * np.sin(a))
    pull = 500 * np.maximum(length - 1.2, 0) * 0.4 * np.cos(a) / length
    assert r["motor.force"] == pytest.approx(
        2 * G * 0.2 * np.cos(a) + pull + 1e4 * np.maximum(a - 0.7, 0), abs=1e-6
    )


@pytest.mark.parametrize("deep", [5e-4, 1e-6])
def test_a_touch_between_two_rows(deep):
    """In and out again between two rows, and no change of sign at the rows."""
    r = path(STOPPED.replace("upper: 0.7", f"upper: {1.2 - deep!r}"), end=1.0, every=1.0)
    there = np.arcsin((1.2 - deep) / 1.2) / 3
    assert events(r, ONSET)[:, 0] == pytest.approx([there], abs=1e-9)
    assert events(r, SEPARATION)[:, 0] == pytest.approx([np.pi / 3 - there], abs=1e-9)


BRUSH = """
bodies: {rod: {mass: 2 kg, inertia: 0.05 kg*m^2, at: [0.2, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
drives: {motor: {joint: hinge, position: "3.01*t"}}
forces:
  brush: {type: limit_stop, point: {body: rod, at: [0.4, 0]}, stiffness: 1e5,
          wall: {body: ground, at: [0, CEILING], normal: [0, -1]}}
"""


def test_a_touch_of_no_depth():
    assert path(BRUSH.replace("CEILING", "0.4")).outcome.status == "done"


@pytest.mark.parametrize("deep", [1e-5, 1e-7])
@pytest.mark.parametrize("every", [0.01, 0.5])
def test_a_touch_in_passing(deep, every):
    """The tip of a turning lever brushes a ceiling, for a small part of a step."""
    r = path(BRUSH.replace("CEILING", repr(0.4 - deep)), every=every, end=0.6 if every < 0.1 else 1)
    away = np.arccos(1 - deep / 0.4)
    assert events(r, ONSET)[:, 0] == pytest.approx([(np.pi / 2 - away) / 3.01], abs=1e-10)
    assert events(r, SEPARATION)[:, 0] == pytest.approx([(np.pi / 2 + away) / 3.01], abs=1e-10)


def test_where_joints_do_not_reach():
    pulled = 'planar: true\ndrives: {pull: {joint: guide, position: "0.5*t"}}\n'
    r = path(UPRIGHT_CRANK + pulled)
    reach = 0.1 + np.hypot(0.3, 0.1) - 0.3
    assert r.outcome.status == "limit" and "dead end" in r.outcome.reason
    assert r.outcome.time == pytest.approx(reach / 0.5, abs=1e-9)


CAM = """
planar: true
bodies:
  cam:    {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0, 0]}
  tappet: {mass: 0.5 kg, inertia: 0.001 kg*m^2, at: [0, 0.15]}
  lever:  {mass: 1 kg, inertia: 0.01, at: [0.2, 0.2]}
joints:
  shaft: {type: revolute, bodies: [ground, cam], at: [0, 0]}
  guide: {type: prismatic, bodies: [ground, tappet], axis: [0, 1]}
  hinge: {type: revolute, bodies: [ground, lever], at: [0.4, 0.2]}
  lobe:
    type: cam
    bodies: [cam, tappet]
    at: [0, "sqrt(0.052**2 - 0.015**2)"]
    radius: 0.012
    curve: {x: 0.04*cos(s) + 0.015, y: 0.04*sin(s), range: [0, 2*pi], closed: true}
drives:
  motor: {joint: shaft, position: "W*t"}
forces:
  touch: {type: limit_stop, point: {body: lever, at: [0.0, 0.18]}, stiffness: 1e5, damping: 200,
          wall: {body: tappet, at: [0, 0.17], normal: [0, 1]}}
  hold: {type: torsion_spring, joint: hinge, stiffness: 30}
initial: {equilibrium: [hinge]}
"""


@pytest.mark.parametrize("speed, apart", [(1.0, 0.01), (8.0, 0.1)])
def test_as_slow_dynamics_and_the_ratio_explains_the_rest(speed, apart):
    text = CAM.replace("W*t", f"{speed}*t")
    times = {"end": 3 / speed, "every": 0.02 / speed}
    still, moving = (path(text, method=method, **times) for method in ("static_path", "auto"))
    largest = np.abs(still["motor.force"]).max()
    off = np.abs(still["motor.force"] - moving["motor.force"])[1:].max() / largest
    ratio = still.outcome.statistics["inertia_ratio"]
    assert off < apart
    assert off == pytest.approx(ratio, rel=0.01)
    assert bool(still.outcome.said) == (ratio > 0.05)
    force = still["touch.normal_force"] - moving["touch.normal_force"]
    assert np.abs(force)[1:].max() < apart * still["touch.normal_force"].max()


@pytest.mark.parametrize("below", [1e-4, 1e-7])
def test_an_event_in_passing(below):
    """A sensor that comes to its value and turns back within a step."""
    text = PENDULUM.format(x=0.2, x0=0, y=0, bodies="ground, rod", motion='position: "3.01*t"')
    text = text.replace("sensors: {", "sensors: {height: {type: point, body: rod, at: [0.6, 0, 0],"
                        " axis: [0, 1, 0]}, ")  # fmt: skip
    text += f"events: {{top: {{when: height, value: {0.6 - below!r}, crosses: both,"
    text += " do: {record: true}}}"
    r = path(text, every=0.5)
    away = np.arccos(1 - below / 0.6)
    wanted = [(np.pi / 2 - away) / 3.01, (np.pi / 2 + away) / 3.01]
    assert events(r, USER)[:, 0] == pytest.approx(wanted, abs=1e-10)
    assert dict(r.outcome.fired) == {"top": 2}


SPACE = """
planar: false
bodies:
  crank: {mass: 1 kg, inertia: [0.02, 0.03, 0.01], at: [0.05, 0.0, 0]}
  rod: {mass: 2 kg, inertia: [0.01, 0.04, 0.03], at: [0.25, 0.1, 0.05]}
  rocker: {mass: 1.5 kg, inertia: [0.02, 0.01, 0.02], at: [0.4, 0.1, 0.1]}
joints:
  a: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: [0, 0, 1]}
  b: {type: spherical, bodies: [crank, rod], at: [0.1, 0, 0]}
  c: {type: universal, bodies: [rocker, rod], at: [0.4, 0.2, 0.1], axis: [0, 0, 1],
      second_axis: [1, 0, 0]}
  d: {type: revolute, bodies: [ground, rocker], at: [0.4, 0, 0.1], axis: [0, 0.2, 1]}
drives:
  motor: {joint: a, velocity: 0.02}
sensors: {swing: {joint: d}}
forces:
  rub: {type: joint_friction, joint: d, radius: 20 mm, thrust_radius: 15 mm, length: 0.1,
        friction: {law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1e-5}}
  ball: {type: joint_friction, joint: b, radius: 15 mm,
         friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1e-5}}
  stop: {type: limit_stop, joint: d, upper: 0.15, stiffness: 3000}
  line: {type: spring_damper, bodies: [ground, rod], points: [[0.2, 0.6, 0.3], [0.25, 0.1, 0.05]],
         stiffness: 300, free_length: 0.3}
"""


def test_in_space_as_slow_dynamics():
    """A hinge and a ball that rub by their reactions, a stop met on the way: all but inertia."""
    still, moving = (path(SPACE, 150, 2.5, method) for method in ("static_path", "radau"))
    assert events(still, ONSET)[:, 0] == pytest.approx(events(moving, ONSET)[:, 0], abs=1e-6)
    assert len(events(still, TURNS)) == 1
    slides = np.abs(moving["rub.sliding_speed"]) > 2e-5  # above the ramp of the law
    slides[0] = False
    for name in ("motor.force", "rub.force", "ball.moment", "stop.normal_force", "c.reaction"):
        off = np.abs(still[name] - moving[name])[slides].max()
        assert off < 1e-3 * np.abs(moving[name]).max(), name
    assert still["rod.velocity"] == pytest.approx(moving["rod.velocity"], abs=1e-9)


def test_user_events():
    text = (
        STOPPED
        + """
events:
  seen: {when: turn, value: 0.5, do: {record: true}}
  heard: {when: motor.force, value: 5, crosses: up, do: {record: true}}
  over: {when: turn, value: 0.9, do: {end: true}}
"""
    )
    r = path(text, every=0.05)
    assert r.outcome.status == "done" and "'over'" in r.outcome.reason
    assert r.outcome.time == pytest.approx(np.arcsin(0.9 / 1.2) / 3, abs=1e-11)
    assert dict(r.outcome.fired) == {"seen": 1, "heard": 1, "over": 1}
    times = dict(events(r, USER)[:, ::-1].tolist())
    base = len(r.mechanism.instances) + 1
    assert times[base] == pytest.approx(np.arcsin(0.5 / 1.2) / 3, abs=1e-11)
    k = np.searchsorted(r.t, times[base + 1])
    assert r["motor.force"][k - 1] < 5 < r["motor.force"][k]


REDUNDANT = """
planar: false
bodies:
  door: {mass: 12 kg, inertia: [1.2, 1.5, 0.36], at: [0.3, 0.4, 0]}
joints:
  bottom: {type: revolute, bodies: [ground, door], at: [0, 0, 0], axis: [1, 0, 0]}
  top: {type: revolute, bodies: [ground, door], at: [1, 0, 0], axis: [1, 0, 0]}
drives: {hand: {joint: bottom, position: "t"}}
"""


def test_redundant_hinges_share_alike():
    r = path(REDUNDANT)
    both = r["bottom.reaction"] + r["top.reaction"]
    assert both == pytest.approx(np.tile([0, 12 * G, 0], (len(r.t), 1)), abs=1e-8)
    assert r["hand.force"] == pytest.approx(-12 * G * 0.4 * np.sin(r.t), abs=1e-9)


@pytest.mark.parametrize(
    "more, said",
    [
        (
            "events: {e: {when: t, value: 0.1, do: {lock: [hinge]}}}",
            "events that record, end a run",
        ),
        ("events: {e: {when: t, value: 0.1, do: {release: [hinge]}}}", "or let a drive go"),
        ("poincare: {p: {when: turn, plot: [turn, turn.rate]}}", "a section of a motion"),
    ],
)
def test_refused(more, said):
    with pytest.raises(ScenarioError, match=said):
        path(STOPPED + more)


def test_what_nothing_holds():
    with pytest.raises(ModelError, match="no static equilibrium"):
        path("bodies: {stone: {mass: 1 kg, inertia: 0.1}}")


def test_what_friction_alone_does_not_hold_is_refused():
    """A rod between two balls spins about itself: nothing holds that."""
    text = """
planar: false
bodies:
  rod: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0.5, 0, 0]}
  end: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [1, 0, 0]}
joints:
  foot: {type: spherical, bodies: [ground, rod], at: [0, 0, 0]}
  head: {type: spherical, bodies: [rod, end], at: [1, 0, 0]}
  guide: {type: prismatic, bodies: [ground, end], axis: [1, 0, 0]}
"""
    with pytest.raises(ModelError, match="nothing holds 'rod'"):
        path(text)


def test_a_load_that_jumps():
    text = """
bodies: {arm: {mass: 1, inertia: 0.1, at: [0.3, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0]}}
sensors: {turn: {joint: hinge}}
forces:
  back: {type: torsion_spring, joint: hinge, stiffness: 10}
  push: {type: applied_load, body: arm, frame: arm, direction: [0, 1], force: "10*(t > 0.5)"}
"""
    r = path(text)
    (told,) = r.outcome.said
    assert "at t = 0.5 s the path jumps" in told
    load = np.where(r.t > 0.505, 10.0, 0.0)
    assert energy_error(r) < 1e-6  # what the jump loses is told, and no error
    assert 10 * r["turn"] == pytest.approx(0.3 * (load - G * np.cos(r["turn"])), abs=1e-9)


def test_unstable_from_the_beginning():
    text = """
bodies: {arm: {mass: 1, inertia: 0.1, at: [0, 0.3]}}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [0, 0]}}
forces: {back: {type: torsion_spring, joint: hinge, stiffness: 2}}
"""
    (told,) = path(text).outcome.said
    assert "at t = 0 s the equilibrium is unstable" in told


def test_a_force_without_a_number():
    odd = '  odd: {type: applied_load, body: rod, direction: [0, 1], force: "t/(t < 0.503)"}\n'
    r = path(STOPPED.replace("sensors:", f"{odd}sensors:"), fails=None)
    assert r.outcome.status == "failed" and "not finite" in r.outcome.reason


def test_accelerations_between_uneven_places():
    """The slope of the parabola through three velocities."""
    none = np.zeros((0, 0))
    places = [Place(t, none, none, none, none, np.array([3 * t - 5 * t * t]), none)
              for t in (0.1, 0.2, 0.5)]  # fmt: skip
    assert slope(places[0], places[1], places[2], 1e-9) == pytest.approx(3 - 10 * 0.2)
    assert slope(None, places[1], places[2], 1e-9) == pytest.approx(3 - 5 * 0.7)


PUSHED = """
bodies:
  cart: {mass: 1 kg, inertia: 0.01, at: [0, 0]}
  block: {mass: 2 kg, inertia: 0.01, at: [0, 1]}
joints:
  rail: {type: prismatic, bodies: [ground, cart], at: [0, 0], axis: [1, 0]}
  guide: {type: prismatic, bodies: [ground, block], at: [0, 1], axis: [0, 1]}
drives: {motor: {joint: rail, position: "SIDE*t"}}
sensors: {x: {joint: rail}, y: {joint: guide}}
forces:
  spring: {type: joint_spring, joint: guide, elastic: "100*stretch"}
  push: {type: applied_load, body: block, direction: [0, 1, 0],
         force: {table: TABLE, of: x, interpolation: linear}}
"""


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("every", [0.05, 0.3])
def test_points_of_a_bent_table_are_corners(side, every):
    """Also where it begins on one: rates before and behind them are those of the lines there."""
    x, F = np.array([0.0, 0.335, 0.617, 0.8]), np.array([0.0, 10.0, -5.0, -5.0])
    order = slice(None, None, side)
    table = [[side * float(a), float(b)] for a, b in zip(x[order], F[order], strict=True)]
    r = path(PUSHED.replace("SIDE", str(side)).replace("TABLE", str(table)), every=every)
    slope = np.append(np.diff(F) / np.diff(x), 0.0)
    assert r["y"] == pytest.approx(np.interp(r.t, x, F) / 100 - 2 * G / 100, abs=1e-12)
    there = slope[np.searchsorted(x, r.t, side="right") - 1] / 100
    assert r["block.velocity"][:, 1] == pytest.approx(there, abs=1e-7)
    assert np.abs(r["block.acceleration"]).max() < 1e-6
    assert events(r, CORNER)[:, 0] == pytest.approx(x[1:], abs=1e-10)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("every", [0.05, 0.3])
def test_ends_of_a_smooth_table_that_are_held_are_corners(side, every):
    """Rates before and behind them are those of the curve, and none; points between are smooth."""
    x, F = np.array([0.113, 0.25, 0.335, 0.5, 0.617]), np.array([-9.0, 10.0, 7.0, -5.0, 8.0])
    order = slice(None, None, side)
    table = [[side * float(a), float(b)] for a, b in zip(x[order], F[order], strict=True)]
    text = PUSHED.replace("SIDE", str(side)).replace("TABLE", str(table))
    r = path(text.replace("interpolation: linear", "outside: hold"), every=every)
    curve = Akima1DInterpolator(x, F)
    assert r["y"] == pytest.approx(curve(np.clip(r.t, x[0], x[-1])) / 100 - 2 * G / 100, abs=1e-12)
    there = np.where((r.t > x[0]) & (r.t < x[-1]), curve(np.clip(r.t, x[0], x[-1]), 1), 0.0) / 100
    assert r["block.velocity"][:, 1] == pytest.approx(there, abs=1e-6)
    told = events(r, CORNER)
    assert told[:, 0] == pytest.approx(x[[0, -1]], abs=1e-10)
    assert set(told[:, 1]) == {row(r, "push")}
