"""Friction on static paths whose drives stop, turn round at once, or go on after a rest."""

import numpy as np
import pytest

from trsim.solve.diagnose.doubts import doubts

from ..runs import run

SLIDE = """
planar: PLANAR
gravity: [0, -10, 0]
bodies: {b: {mass: 10, inertia: [0.1, 0.1, 0.1], at: [0, 0, 0]}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
drives: {d: {joint: g, MOTION}}
forces:
  sp: {type: spring_damper, bodies: [ground, b], points: [[-1, 0, 0], [0, 0, 0]], stiffness: 1000}
  fr: {type: joint_friction, joint: g, friction: {LAW}}
solver: {method: static_path, end: 2 s}
output: {every: 0.1}
"""
COULOMB = "law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s"
BRISTLES = (
    "law: sticking, coefficient: 0.2, static_coefficient: 0.3, stribeck_speed: 1 mm/s, "
    "bristle_stiffness: 1e4"
)
SLIDES = 0.2 * 10 * 10  # N, of friction


def slide(motion, law=COULOMB, planar="true"):
    return run(SLIDE.replace("MOTION", motion).replace("LAW", law).replace("PLANAR", planar))


def said(r):
    return [*r.mechanism.notes, *doubts(r.scenario, r.mechanism, r.outcome)]


@pytest.mark.parametrize("law", [COULOMB, BRISTLES])
@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize(
    "motion",
    [
        'position: "0.04*min(t, 1)"',
        'position: "0.04*smoothstep(t)"',
        "position: {table: [[0, 0], [1, 0.04], [2, 0.04]], interpolation: linear}",
        'velocity: "0.04*(t < 1)"',
    ],
)
def test_what_a_drive_holds_keeps_its_friction(motion, law, planar):
    """40 N of the spring and 20 N of friction, which nothing takes away while it stands."""
    r = slide(motion, law, planar)
    held = r.t >= 1.0
    assert r["d.force"].ravel()[held] == pytest.approx(np.full(held.sum(), 60.0), abs=1e-6)
    assert r["energy.residual"].ravel() == pytest.approx(np.zeros(len(r.t)), abs=1e-9)
    assert not [x for x in said(r) if "dampers" in x or "impulse" in x]


def test_friction_at_a_stop_at_the_end_of_the_path():
    r = run(
        SLIDE.replace("MOTION", 'position: "0.04*smoothstep(t/2)"').replace("LAW", COULOMB)
        .replace("PLANAR", "true")
    )  # fmt: skip
    assert r["d.force"].ravel()[-1] == pytest.approx(60.0, abs=1e-6)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_drive_that_goes_on_after_a_rest(sense):
    """In its old direction friction stays; in the other it turns round at once."""
    r = slide(f'position: "0.04*min(t, 0.5) + {sense}*0.02*max(0, t - 1.5)"')
    t = r.t
    x = 0.04 * np.minimum(t, 0.5) + sense * 0.02 * np.maximum(0.0, t - 1.5)
    way = np.where(t > 1.501, sense, 1.0)
    assert r["d.force"].ravel() == pytest.approx(1000 * x + SLIDES * way, abs=1e-6)
    turns = [] if sense > 0.0 else [1.5]
    assert r.events[:, 0] == pytest.approx(turns, abs=1e-9)


@pytest.mark.parametrize("planar", ["true", "false"])
def test_the_work_of_a_drive_that_turns_round_at_once(planar):
    """k x^2 / 2 and friction along the way."""
    r = slide('position: "0.04*t*(t < 1) + (t >= 1)*(0.04 - 0.03*(t - 1))"', planar=planar)
    x = np.where(r.t <= 1.0, 0.04 * r.t, 0.04 - 0.03 * (r.t - 1.0))
    way = np.where(r.t <= 1.0, 0.04 * r.t, 0.04 + 0.03 * (r.t - 1.0))
    assert r["energy.work.drives"].ravel() == pytest.approx(500 * x**2 + SLIDES * way, abs=1e-8)
    assert r["energy.work.friction"].ravel() == pytest.approx(-SLIDES * way, abs=1e-8)
    assert not [x for x in said(r) if "impulse" in x or "energy" in x]


TWO = """
planar: true
gravity: [0, -10, 0]
bodies:
  a: {mass: 1, inertia: 0.1, at: [0, 0]}
  b: {mass: 2, inertia: 0.1, at: [0, 1]}
joints:
  ga: {type: prismatic, bodies: [ground, a], axis: [1, 0, 0]}
  gb: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}
drives:
  da: {joint: ga, position: "-0.01*min(t, 1)"}
  db: {joint: gb, position: "BOTH"}
forces:
  fa: {type: joint_friction, joint: ga, friction: {COULOMB}}
  fb: {type: joint_friction, joint: gb, friction: {COULOMB}}
solver: {method: static_path, end: 2 s}
output: {every: 0.1}
"""


@pytest.mark.parametrize("after", [0.5, -0.5])
def test_one_of_two_stops(after):
    """The other goes on, or turns round at the same time."""
    motion = f"0.5*min(t, 1) + ({after})*max(0, t - 1)"
    r = run(TWO.replace("BOTH", motion).replace("COULOMB", COULOMB))
    assert r["da.force"].ravel() == pytest.approx(np.full(len(r.t), -2.0), abs=1e-9)
    moves = np.where(r.t > 1.001, np.sign(after), 1.0)
    assert r["db.force"].ravel() == pytest.approx(4.0 * moves, abs=1e-9)


def test_a_motion_that_rests_at_all_its_corners_has_no_jumps():
    """Rounding of the rate at the end of a smooth step is none."""
    assert not [x for x in slide('position: "0.04*smoothstep(t/0.95)"').mechanism.notes]
    text = SLIDE.replace("MOTION", 'position: "0.04*smoothstep(t/0.95)"').replace("LAW", COULOMB)
    r = run(text.replace("PLANAR", "true").replace("method: static_path, ", ""))
    assert not [x for x in r.mechanism.notes if "jumps" in x]


CAM = """
gravity: [0, -10, 0]
bodies:
  bar: {mass: 1, inertia: 1e-3, at: [0, 0]}
  pin: {mass: 1, inertia: 1e-6, at: [0, 0.0025]}
joints:
  g: {type: prismatic, bodies: [ground, bar], axis: [1, 0, 0]}
  v: {type: prismatic, bodies: [ground, pin], axis: [0, 1, 0]}
drives: {d: {joint: g, position: "0.01*t"}}
sensors: {x: {joint: g}}
forces:
  c: {type: surface_contact, surface: {body: bar, at: [0, 0], x_axis: [4, 3]},
      ball: {body: pin, at: [0, 0.0025], radius: 2 mm}}
contact_laws:
  k: {normal: impact, stiffness: 1e8, exponent: 1.5, damping: 10, ramp: 0.01 mm,
      friction: {law: modified_coulomb, coefficient: 0.1, v0: 0, v1: 1e-4}}
events: {here: {when: x, value: AT, do: {record: true}}}
solver: {method: static_path, end: 0.6 s}
output: {every: 0.1}
"""


@pytest.mark.parametrize("beside", [0.0, 2e-12, 1e-11, 1e-9])
def test_an_event_close_behind_a_row(beside):
    """What slides has its full friction there, however short the way from the row."""
    r = run(CAM.replace("AT", f"{0.005 + beside:.15g}"))
    (line,) = r.recorded
    speed = line[2 + r.place["pin.velocity"][0] + 1]
    assert speed == pytest.approx(-0.0075, rel=1e-6)
    assert not [x for x in said(r) if "inertia" in x]


def test_a_load_by_the_sign_of_a_rate():
    """It is against the way of a path, whose speed is next to nothing, from the first row on."""
    text = """
bodies: {b: {mass: 2, inertia: 0.1, at: [0, 0]}}
joints: {s: {type: prismatic, bodies: [ground, b], axis: [1, 0]}}
sensors: {x: {joint: s}}
forces: {f: {type: applied_load, body: b, direction: [-1, 0], force: "10*sign(x.rate) + 1"}}
drives: {m: {joint: s, position: "0.3*sin(2*t) + 0.05*t"}}
solver: {method: static_path, end: 0.9}
output: {every: 0.05}
"""
    r = run(text)
    rate = 0.6 * np.cos(2 * r.t) + 0.05
    assert r["m.force"].ravel() == pytest.approx(10 * np.sign(rate) + 1, abs=1e-9)
    assert r["m.force"].ravel() == pytest.approx(-r["f.load"][:, 0], abs=1e-9)
    assert not [x for x in said(r) if "energy" in x]
