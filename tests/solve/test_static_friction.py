"""Friction along a static path: against the travel, sticking, and locked."""

import numpy as np
import pytest

from ..runs import run
from .test_static_path import TURNS, G, events, path, row

SLIDE = """
PLANE
bodies:
  block: {mass: 2 kg, inertia: [0.01, 0.01, 0.01], at: [0, 0, 0]}
joints:
  guide: {type: prismatic, bodies: [BODIES], axis: [1, 0, 0]}
drives:
  motor: {joint: guide, position: "SIGN*0.05*sin(2*pi*t)"}
forces:
  rub: {type: joint_friction, joint: guide, friction: {LAW}}
  spring: {type: joint_spring, joint: guide, elastic: "100*stretch"}
"""
LAWS = (
    "law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1 m/s",
    "law: sticking, coefficient: 0.3, static_coefficient: 0.5, stribeck_speed: 1 mm/s, "
    "bristle_stiffness: 1e4",
)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("plane", ["planar: true", "planar: false"])
@pytest.mark.parametrize("bodies, side", [("ground, block", 1), ("block, ground", -1)])
def test_loop_of_a_slide(law, plane, bodies, side):
    """100 x + mu m g, the sign that of the travel: full at once, whatever the speed of the law."""
    text = SLIDE.replace("LAW", law).replace("PLANE", plane).replace("BODIES", bodies)
    r = path(text.replace("SIGN", str(side)))
    before = np.concatenate([[1.0], np.sign(np.diff(np.sin(2 * np.pi * r.t)))])
    wanted = side * (100 * 0.05 * np.sin(2 * np.pi * r.t) + 0.3 * 2 * G * before)
    assert r["motor.force"] == pytest.approx(wanted, abs=1e-8)
    turns = events(r, TURNS)
    assert turns[:, 0] == pytest.approx([0.25, 0.75], abs=1e-6)
    assert set(turns[:, 1]) == {row(r, "rub")}
    assert r["energy.work.friction"][-1] == pytest.approx(-0.3 * 2 * G * 0.2, rel=1e-5)


DRAGGED = """
planar: true
bodies:
  puller: {mass: 1 kg, inertia: 0.01 kg*m^2, at: [1, 0]}
  block: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0, 0]}
joints:
  rail: {type: prismatic, bodies: [ground, puller], axis: [1, 0]}
  guide: {type: prismatic, bodies: [ground, block], axis: [1, 0]}
drives:
  motor: {joint: rail, position: "0.1*sin(2*pi*t)"}
forces:
  rub: {type: joint_friction, joint: guide,
        friction: {law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1 mm/s}}
  spring: {type: spring_damper, bodies: [block, puller], points: [[0, 0], [1, 0]],
           stiffness: 200, damping: 50}
"""


def test_a_block_dragged_by_a_spring_sticks_and_slides():
    """The play of a spring with dry friction: it sticks while the spring is turned round."""
    r = path(DRAGGED, end=1.0, every=5e-3)
    assert r.outcome.statistics["rejected_steps"] < 15
    f = 0.3 * 2 * G / 200
    fine = np.linspace(0, 1, 4_001)
    block = [0.0]
    for x in 0.1 * np.sin(2 * np.pi * fine[1:]):
        block.append(min(max(block[-1], x - f), x + f))
    wanted = np.interp(r.t, fine, block)
    assert r["block.position"][:, 0] == pytest.approx(wanted, abs=1e-6)
    x = 0.1 * np.sin(2 * np.pi * r.t)
    assert r["motor.force"] == pytest.approx(200 * (x - wanted), abs=2e-4)
    turned = (0.5 * np.pi + np.arccos(1 - 2 * f / 0.1)) / (2 * np.pi)
    assert events(r, TURNS)[0, 0] == pytest.approx(turned, abs=1e-5)


def test_a_block_on_an_incline_is_held_by_friction():
    """Nothing holds it but what rubs: it stays where it is drawn as long as it can."""
    text = """
planar: true
bodies: {block: {mass: 2 kg, inertia: 0.01 kg*m^2, at: [0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, block], axis: [4, 3]}}
forces:
  rub: {type: joint_friction, joint: guide,
        friction: {law: modified_coulomb, coefficient: 0.8, v0: 0, v1: 1 mm/s}}
  push: {type: applied_load, body: block, at: [0, 0], direction: [-4, -3], force: "10*t"}
"""
    r = path(text)
    slides = 2 * G * (0.8 * 0.8 - 0.6) / 10
    assert r.outcome.status == "limit"
    assert r.outcome.time == pytest.approx(slides, abs=1e-6)
    assert r["block.position"][:, 0] == pytest.approx(0, abs=1e-6)


THREAD = """
planar: false
bodies:
  nut: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0]}
  spindle: {mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0]}
joints:
  flank: {type: inplane, bodies: [ground, nut], at: [0.1, 0, 0], axis: [0, 0, 1]}
  bearing: {type: revolute, bodies: [ground, spindle], at: [0, 0, 0], axis: [0, 1, 0]}
  thread: {type: screw, bodies: [nut, spindle], at: [0, 0, 0], axis: [0, 1, 0], pitch: 6 mm}
drives: {ram: {type: actuator, bodies: [ground, nut], points: [[0, -1, 0], [0, 0, 0]],
               position: 0.01*t}}
forces:
  rub: {type: joint_friction, joint: thread, radius: 10 mm,
        friction: {law: modified_coulomb, coefficient: MU, v0: 0, v1: 1e-6}}
  twist: {type: torsion_spring, joint: bearing, stiffness: 1}
"""
LEAD = np.arctan(6e-3 / (2 * np.pi * 10e-3))


def test_a_thread_that_is_pushed():
    """F r tan(lead - rho) = T, as long as friction lets it: tan(rho) = mu."""
    r = path(THREAD.replace("MU", "0.05"), end=0.3)
    torque = 0.01 * r.t * 2 * np.pi / 6e-3
    pushed = torque / (10e-3 * np.tan(LEAD - np.arctan(0.05))) + G
    assert r["ram.force"][1:] == pytest.approx(pushed[1:], rel=1e-6)


def test_a_thread_that_locks_itself():
    r = path(THREAD.replace("MU", "0.15"))
    assert np.tan(LEAD) < 0.15
    assert r.outcome.status == "limit" and "friction lock" in r.outcome.reason
    assert r.outcome.time < 1e-4


TURNING = """
planar: false
bodies:
  cam: {mass: 1 kg, inertia: [0.2, 0.2, 0.2], at: [0, 0, 0]}
  arm: {mass: 0.5 kg, inertia: [0.02, 0.02, 0.02], at: [0.5, 0.3, 0.4]}
joints:
  pivot: {type: revolute, bodies: [ground, cam], at: [0.05, 0, 0], axis: [0.3, 1, 0.2]}
  hinge: {type: revolute, bodies: [ground, arm], at: [0.8, 0.3, 0.3], axis: [0.2, 1, -0.3]}
drives: {motor: {joint: pivot, position: "0.8*t"}}
forces:
  touch: {type: surface_contact, surface: {body: cam, shape: sphere, radius: 0.3},
          ball: {body: arm, at: [0.1, 0.1, 0.38], radius: 0.1}, contact: rough}
  back: {type: torsion_spring, joint: hinge, stiffness: 20, preload: -10}
contact_laws:
  rough: {normal: impact, stiffness: 1e4, exponent: 1, damping: 0, ramp: 1 mm,
          friction: {law: LAW, coefficient: 0.3, v0: 0, v1: 1 mm/s}}
solver: {method: static_path, end: 1}
output: {every: 0.05, channels: ["*", "*.rotation"]}
"""


def test_friction_of_a_surface_is_against_the_travel_in_space():
    """By the velocities of both bodies at the place of touch, whose direction turns."""
    r = run(TURNING.replace("LAW", "modified_coulomb"))
    turned = []
    for k in range(1, len(r.t)):
        at, R, v, w = (
            {b: r[f"{b}.{word}"][k] for b in ("cam", "arm")}
            for word in ("position", "rotation", "velocity", "angular_velocity")
        )
        ball = at["arm"] + R["arm"].reshape(3, 3) @ (np.array([0.1, 0.1, 0.38]) - [0.5, 0.3, 0.4])
        n = (ball - at["cam"]) / np.linalg.norm(ball - at["cam"])
        place = at["cam"] + 0.3 * n
        slip = v["arm"] - v["cam"]
        slip = slip + np.cross(w["arm"], place - at["arm"]) - np.cross(w["cam"], place - at["cam"])
        slip -= (slip @ n) * n
        force = r["touch.force"][k]
        rub = force - (force @ n) * n
        assert np.linalg.norm(rub) == pytest.approx(0.3 * (force @ n), rel=1e-9)
        turned.append(slip / np.linalg.norm(slip))
        across = np.cross(rub, slip) / np.linalg.norm(rub) / np.linalg.norm(slip)
        assert rub @ slip < 0 and np.linalg.norm(across) < 1e-4
    assert np.linalg.norm(turned[0] - turned[-1]) > 0.02


TWO_WAYS = """
planar: false
bodies:
  shaft: {mass: 1 kg, inertia: [0.01, 0.01, 0.01], at: [0, 0, 0]}
joints: {sleeve: {type: cylindrical, bodies: [BODIES], at: [0, 0, 0], axis: AXIS}}
drives:
  push: {joint: sleeve.stroke, position: "SIGN*0.05*sin(2*pi*t)"}
  turn: {joint: sleeve.angle, position: "SIGN*2*(1 - cos(2*pi*t))"}
forces:
  rub: {type: joint_friction, joint: sleeve, radius: 20 mm, friction: {LAW}}
  weight: {type: applied_load, body: shaft, at: [0, 0, 0], direction: ACROSS, force: 30}
gravity: [0, 0, 0]
solver: {method: static_path, end: END}
output: {every: 0.053, channels: ["*"]}
"""


@pytest.mark.parametrize("law, end", [(LAWS[0], 1), (LAWS[1], 0.4)])
@pytest.mark.parametrize("bodies, side", [("ground, shaft", 1), ("shaft, ground", -1)])
@pytest.mark.parametrize("axis", [(1, 0, 0), (0.48, -0.8, 0.36)])
def test_friction_of_a_sleeve_is_along_its_helix(law, end, bodies, side, axis):
    """N mu along the stroke by v / |(v, r w)|, and r N mu about it by r w: the helix turns all the
    way round as both drives go to and fro; 30 N across press it."""
    across = np.cross(axis, [0.2, 0.3, 0.9]).tolist()
    text = (
        TWO_WAYS.replace("END", str(end))
        .replace("LAW", law)
        .replace("BODIES", bodies)
        .replace("AXIS", str(list(axis)))
    )
    r = run(text.replace("SIGN", str(side)).replace("ACROSS", str(across)))
    v = 0.05 * 2 * np.pi * np.cos(2 * np.pi * r.t)
    u = 0.02 * 2 * 2 * np.pi * np.sin(2 * np.pi * r.t)
    force = 0.3 * 30 / np.hypot(u, v)
    assert r["push.force"] == pytest.approx(side * force * v, abs=1e-3 * 9)
    assert r["turn.force"] == pytest.approx(side * force * u * 0.02, abs=1e-3 * 9 * 0.02)


ON_A_PLANE = """
planar: false
bodies:
  rail: {mass: 1 kg, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0.5]}
  slide: {mass: 1 kg, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0.3]}
  foot: {mass: 1 kg, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0.1]}
joints:
  along: {type: prismatic, bodies: [ground, rail], at: [0, 0, 0.5], axis: [1, 0, 0]}
  across: {type: prismatic, bodies: [rail, slide], at: [0, 0, 0.3], axis: [0, 1, 0]}
  down: {type: prismatic, bodies: [slide, foot], at: [0, 0, 0.1], axis: [0, 0, 1]}
drives:
  x: {joint: along, position: "0.2*sin(2*pi*t)"}
  y: {joint: across, position: "0.3*(1 - cos(2*pi*t))"}
forces:
  touch: {type: surface_contact,
          surface: {body: ground, shape: plane, at: [0, 0, 0], x_axis: [1, 0, 0],
                    y_axis: [0, 0, 1]},
          ball: {body: foot, at: [0, 0, 0.1], radius: 0.1}, contact: rough}
contact_laws:
  rough: {normal: impact, stiffness: 1e4, exponent: 1, damping: 0, ramp: 1 mm,
          friction: {law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1 mm/s}}
gravity: [0, 0, -10]
solver: {method: static_path, end: 1}
output: {every: 0.053, channels: ["*"]}
"""


def test_friction_on_a_plane_in_two_directions():
    """A foot of 10 N that two drives lead round an ellipse: 3 N against its way, at any place."""
    r = run(ON_A_PLANE)
    v = np.array([0.2 * np.cos(2 * np.pi * r.t), 0.3 * np.sin(2 * np.pi * r.t)])
    force = 3.0 * v / np.linalg.norm(v, axis=0)
    assert r["x.force"] == pytest.approx(force[0], abs=1e-3 * 3)
    assert r["y.force"] == pytest.approx(force[1], abs=1e-3 * 3)
    assert r["touch.force"][:, :2] == pytest.approx(-force.T, abs=1e-3 * 3)


@pytest.mark.parametrize("slower", [1, 30, 1000])
def test_what_slides_slowly_rubs_in_full_from_the_start(slower):
    """A slide that a coupler moves so many times slower than the driven one, pressed by 40 N."""
    r = path(f"""
bodies:
  fast: {{mass: 1, inertia: 1}}
  slow: {{mass: 1, inertia: 1, at: [0, 1]}}
joints:
  quick: {{type: prismatic, bodies: [ground, fast], axis: [1, 0, 0]}}
  lazy: {{type: prismatic, bodies: [ground, slow], axis: [1, 0, 0], at: [0, 1]}}
  gear: {{type: coupler, joints: [quick, lazy], coefficients: [1, {-slower}]}}
drives: {{pusher: {{joint: quick, position: 0.05*t}}}}
sensors: {{x: {{joint: lazy}}}}
forces:
  press: {{type: applied_load, body: slow, force: 40, direction: [0, -1, 0]}}
  rub: {{type: joint_friction, joint: lazy,
        friction: {{law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1 mm/s}}}}
""")
    assert np.abs(r["pusher.force"]) == pytest.approx(0.3 * (40 + G) / slower, rel=1e-6)
