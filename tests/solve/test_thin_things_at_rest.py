"""Searches for rest do not pass through what is thin, however small the gap that is open to it."""

import numpy as np
import pytest

from trsim.scenario.load import loads
from trsim.solve.start.bars import places
from trsim.solve.start.consistent import start

from ..runs import assemble, run

PRESSED = """
planar: PLANAR
gravity: [0, 0, 0]
bodies: {b: {mass: 0.05, inertia: [1e-6, 1e-6, 1e-6], at: [0, 0, 0]}}
joints: {v: {type: prismatic, bodies: [ground, b], axis: [0, SIGN, 0]}}
sensors: {y: {joint: v}}
forces:
  sp: {type: spring_damper, bodies: [ground, b], points: [[0, SIGN*0.05, 0], [0, 0, 0]],
       stiffness: 2000, free_length: 60 mm}
  c: {type: surface_contact, surface: {body: S, SHAPE}, ball: {body: B, at: PLACE, radius: RADIUS}}
contact_laws: {k: {normal: impact, stiffness: 1e8, exponent: 1.5, damping: 10, ramp: 0.01 mm}}
initial: {equilibrium: [v]}
solver: {end: 1 ms}
"""
OPEN = "shape: profile, points: [[-60 mm, {0}], [60 mm, {0}]]"
BENT = "shape: profile, points: [[-60 mm, {0}], [1 mm, {0}], [60 mm, {0}]]"
PLATE = (
    "shape: profile, closed: true, corner_radius: 0.05 mm, points: "
    "[[-60 mm, {0}], [60 mm, {0}], [60 mm, {1}], [-60 mm, {1}]]"
)


def rested(shape, at, radius, sign=1, carried=False, planar="true"):
    """How far along its joint a body comes to rest that is pressed onto a ball or its surface."""
    surface, ball = ("b", "ground") if carried else ("ground", "b")
    text = PRESSED.replace("SIGN*0.05", str(0.05 * sign)).replace("SIGN", str(sign))
    text = text.replace("S, SHAPE", f"{surface}, {shape}")
    text = text.replace("B, at: PLACE", f"{ball}, at: {at}")
    scenario = loads(text.replace("RADIUS", f"{radius!r} m").replace("PLANAR", planar))
    mechanism = assemble(scenario)
    y = start(scenario, mechanism, located=True).y
    return sign * float(y[1])


def pressed_in(gap):
    """The root of 1e8 d^1.5 = 2000 (0.01 - gap - d)."""
    d = 0.0
    for _ in range(60):
        d = (2000.0 * (0.01 - gap - d) / 1e8) ** (2.0 / 3.0)
    return d


@pytest.mark.parametrize("planar", ["true", "false"])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("gap", [0.0, 1e-6, 1e-5, 1e-3])
def test_a_ball_on_an_open_profile(gap, sign, planar):
    shape = OPEN.format(-sign * (2.5e-3 + gap))
    y = rested(shape, "[0, 0, 0]", 2.5e-3, sign, planar=planar)
    assert y == pytest.approx(-gap - pressed_in(gap), abs=1e-9)


def test_a_profile_that_is_carried_onto_a_ball():
    y = rested(BENT.format(0.0), "[0, -2.51 mm, 0]", 2.5e-3, carried=True)
    assert y == pytest.approx(-1e-5 - pressed_in(1e-5), abs=1e-9)


def test_a_point_on_a_thin_plate():
    """The plate is 0.2 mm thick: what is deeper than half of it is pressed out below."""
    y = rested(PLATE.format(-0.01e-3, -0.21e-3), "[0, 0, 0]", 0.0)
    assert y == pytest.approx(-1e-5 - pressed_in(1e-5), abs=1e-9)


@pytest.mark.parametrize("shape", ["cylinder", "sphere"])
def test_a_thin_wire(shape):
    y = rested(f"shape: {shape}, radius: 0.1 mm, at: [0, -0.21 mm, 0]", "[0, 0, 0]", 1e-4)
    assert y == pytest.approx(-1e-5 - pressed_in(1e-5), abs=1e-9)


LEVER = """
gravity: [0, -9.81, 0]
bodies: {lever: {mass: 0.2, inertia: 1e-4, at: [0.02, 0]}}
joints: {o: {type: revolute, bodies: [ground, lever], at: [0, 0]}}
forces:
  c: {type: surface_contact, surface: {body: ground, shape: profile,
      points: [[0.9, -0.011], [1.1, -0.011]]}, ball: {body: lever, at: [1, 0], radius: 10 mm}}
contact_laws: {k: {normal: impact, stiffness: 1e8, exponent: 1.5, damping: 10, ramp: 0.01 mm}}
initial: {equilibrium: [o]}
solver: {end: 1 ms}
"""


def test_a_lever_whose_tip_moves_fifty_times_as_far_as_its_centre():
    """Its weight of 1.962 N at 20 mm is held at 1 m."""
    scenario = loads(LEVER)
    y = start(scenario, assemble(scenario), located=True).y
    d = (0.2 * 9.81 * 0.02 / 1e8) ** (2.0 / 3.0)
    assert y[2] == pytest.approx(-np.arcsin(1e-3 + d), abs=1e-8)


FALL = """
gravity: [0, -9.81, 0]
bodies: {pin: {mass: 0.05, inertia: 1e-6, at: [0, 0]}}
joints: {v: {type: prismatic, bodies: [ground, pin], axis: [0, 1, 0]}}
sensors: {y: {joint: v}}
forces:
  sp: {type: spring_damper, bodies: [ground, pin], points: [[0, 0.05], [0, 0]], stiffness: 20,
       damping: 1, free_length: 60 mm}
  c: {type: surface_contact, surface: {body: ground, shape: profile, points: [[-60 mm, -2.51 mm],
      [60 mm, -2.51 mm]]}, ball: {body: pin, at: [0, 0], radius: 2.5 mm}}
contact_laws: {k: {normal: impact, stiffness: 1e8, exponent: 1.5, damping: 10, ramp: 0.01 mm}}
phases: [{name: fall, for: 0.1 ms}, {name: rest, static: true, for: 1 ms}]
solver: {end: 1 s}
output: {every: 0.5 ms}
"""


def test_a_static_phase_behind_a_fall():
    r = run(FALL)
    y = r["y"].ravel()[-1]
    assert 1e8 * (-y - 1e-5) ** 1.5 == pytest.approx(20.0 * (0.01 + y) + 0.05 * 9.81, rel=1e-6)


CANTILEVER = """
planar: PLANAR
bodies:
  beam: {type: ancf_cable, start: [0, 0], end: [1, 0], elements: 4, area: 1, second_moment: 1e-5,
         youngs_modulus: 1e5, density: 1, strain: engineering, curvature: gerstmayr}
joints: {clamp: {type: fixed, bodies: [ground, beam], at: [0, 0]}}
forces:
  tip: {type: applied_load, body: beam, at: [1, 0], direction: [0, -1, 0], force: 1}
  touch: {type: surface_contact, ball: {body: beam, at: [1, 0], radius: 5 mm},
          surface: {body: ground, shape: profile, points: [[0.6, PLACE], [1.2, PLACE]]}}
contact_laws: {k: {normal: impact, stiffness: 1e6, exponent: 1.5, damping: 10, ramp: 0.01 mm}}
initial: {equilibrium: all}
solver: {end: 10 ms}
"""


@pytest.mark.parametrize("gap, planar", [(1e-3, "true"), (0.05, "true"), (0.02, "false")])
def test_a_bar_that_bends_onto_a_plate(gap, planar):
    """Of 1 m, EI = 1 N m^2, pressed down by 1 N: its tip comes down by w = gap + d, where the
    plate takes N = 1 - 3 EI w / L^3 = 1e6 d^1.5, and not by a third of a metre."""
    text = CANTILEVER.replace("PLACE", repr(-0.005 - gap)).replace("PLANAR", planar)
    scenario = loads(text)
    mechanism = assemble(scenario)
    r, _ = places(mechanism, mechanism.beams["beam"], start(scenario, mechanism, True).y)
    d = 0.0
    for _ in range(60):
        d = ((1.0 - 3.0 * (gap + d)) / 1e6) ** (2.0 / 3.0)
    # the arch of the bar makes 3 EI w / L^3 larger by some w^2 of it
    assert r[-1, 1] == pytest.approx(-gap - d, abs=d * 3.0 * gap * gap + 1e-8)
