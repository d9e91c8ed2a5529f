"""Static paths of what touches one profile in two places at once: each is told of its own."""

import numpy as np
import pytest

from .test_static_path import ONSET, SEPARATION, events, path, row

W = 2 * 9.81  # N
CONTACT = """
contact_laws:
  hard: {normal: impact, stiffness: 1e11, exponent: 1.5, damping: 10, ramp: 0.01 mm,
         friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s}}
"""
GROOVE = """
bodies:
  bar: {mass: 1, inertia: 1e-3, at: [0, 0]}
  pin: {mass: 2, inertia: 1e-4, at: [-0.04, 0.01]}
joints:
  guide: {type: prismatic, bodies: [ground, bar], axis: [1, 0]}
  lift: {type: prismatic, bodies: [ground, pin], at: [-0.04, 0.01], axis: [0, 1]}
drives: {motor: {joint: guide, position: "-0.1*t"}}
forces:
  touch: {type: surface_contact, ball: {body: pin, at: [-0.04, 0.01], radius: 10 mm},
          surface: {body: bar, shape: profile,
                    points: [[-90 mm, 0], [-20 mm, 0], [0, -20 mm], [20 mm, 0], [90 mm, 0]]}}
"""


def force(x):
    """Of the drive under a pin of 10 mm at x of the groove: over an edge, and along a flank."""
    r, u = 0.01, 0.02 - abs(x)
    rises = 0.0 if u < 0.0 else u / np.sqrt(r**2 - u**2) if u < r * np.sqrt(0.5) else 1.0
    rises *= np.sign(x)
    return -W * (rises + 0.2) / (1.0 - 0.2 * rises)


def test_a_pin_is_drawn_through_a_groove():
    """Down one flank and up the other, with friction against the travel: -W (y' + mu)/(1 - mu y');
    on the bottom it touches both, for the depth of penetration."""
    r = path(GROOVE + CONTACT, end=0.6, every=0.05)
    x = -0.04 + 0.1 * r.t
    away = np.abs(x) > 1e-9
    wanted = np.array([force(one) for one in x[away]])
    # places are off by the penetration, 3e-7 m, of the radius of the edge
    assert r["motor.force"][away] == pytest.approx(wanted, abs=2e-4 * W)
    assert events(r, ONSET) == pytest.approx(np.array([[0.4, row(r, "touch.2")]]), abs=1e-5)
    assert events(r, SEPARATION) == pytest.approx(np.array([[0.4, row(r, "touch.1")]]), abs=1e-5)


ALONG = """
planar: false
bodies:
  cart: {mass: 1, inertia: [1e-3, 1e-3, 1e-3], at: [0, 0.01414, 0]}
  ball: {mass: 2, inertia: [1e-4, 1e-4, 1e-4], at: [0, 0.01414, 0]}
joints:
  rail: {type: prismatic, bodies: [ground, cart], at: [0, 0.01414, 0], axis: [0, 0, 1]}
  HELD
drives: {motor: {joint: rail, position: "0.02*t"}}
forces:
  rope: {type: spring_damper, bodies: [cart, ball], stiffness: 1000, free_length: 0.1,
         points: [[0, 0.01414, 0.1], [0, 0.01414, 0]]}
  HOLD
  touch: {type: surface_contact, ball: {body: ball, at: [0, 0.01414, 0], radius: 10 mm},
          surface: {body: ground, shape: profile,
                    points: [[-30 mm, 30 mm], [0, 0], [30 mm, 30 mm]]}}
"""
UPRIGHT = "turns: {type: parallel, bodies: [ground, ball], at: [0, 0.01414, 0], axis: [0, 0, 1]}"
SPRING = "spring: {type: torsion_spring, joint: turns.angle, stiffness: 100}"


@pytest.mark.parametrize("held", [True, False])
def test_a_ball_is_dragged_along_a_groove(held):
    """N = W/(2 cos 45 deg) on both flanks; one that cannot turn slides, against 2 mu N, and one
    that can rolls on both."""
    text = ALONG.replace("HELD", UPRIGHT if held else "").replace("HOLD", SPRING if held else "")
    r = path(text + CONTACT.replace("1e11", "1e9"), end=0.5, every=0.1)
    N = W / np.sqrt(2.0)
    # the rope is level to 6e-6 m of its 0.1 m
    for k in (1, 2):
        assert r[f"touch.{k}.normal_force"] == pytest.approx(N, rel=1e-4)
    assert r["motor.force"][-1] == pytest.approx(0.4 * N if held else 0.0, abs=1e-4 * N)
