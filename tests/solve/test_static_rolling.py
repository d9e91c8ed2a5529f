"""Static paths of what rolls: journals in their play, rollers, and what touches and turns round."""

import numpy as np
import pytest

from .test_static_path import TURNS, G, events, path, row

JOURNAL = """
bodies:
  lever: {mass: 4, inertia: 0.1, at: [0, 0]}
joints:
  pin: {type: revolute, bodies: [ground, lever], at: [0, 0], clearance: 0.2 mm, contact: steel}
drives: {motor: {joint: pin, position: "0.5*sin(pi*t)"}}
contact_laws:
  steel: {normal: lankarani_nikravesh, stiffness: internal, bearing_radius: 10 mm,
          youngs_modulus: 200 GPa, poisson: 0.3, restitution: 0.5,
          friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s}}
"""


def test_a_journal_rolls_in_its_bearing_where_its_drive_turns_back():
    """It climbs to the angle of friction phi, and from there to -phi rolls, with contact at r of
    the journal:  r theta = e 2 phi.  The moment of the drive is m g r sin of the angle it is at."""
    r = path(JOURNAL, end=0.7, every=0.02)
    phi, contact = np.arctan(0.2), 9.8e-3
    far = np.hypot(r["pin.eccentricity_x"], r["pin.eccentricity_y"])
    back = 0.5 * (1.0 - np.sin(np.pi * r.t))
    angle = np.maximum(phi - contact * back / far, -phi)
    angle[r.t <= 0.5] = phi
    wanted = 4 * G * contact * np.sin(angle)
    # what sticks creeps by 1e-9 of the size, 1 m, a step: less than 40 from there
    creeps = 40e-9 / far[-1]
    assert r["motor.force"][1:] == pytest.approx(wanted[1:], abs=creeps * 4 * G * contact)
    back = far[-1] * 2 * phi / contact
    assert events(r, TURNS) == pytest.approx(
        np.array([[0.5 + np.arccos(1.0 - 2.0 * back) / np.pi, row(r, "pin")]]), abs=1e-5
    )


SLED = """
bodies:
  puller: {mass: 1, inertia: 0.1, at: [0, 1]}
  rod: {mass: 0.1, inertia: 0.01, at: [0.1, 1]}
  sled: {mass: 2, inertia: 0.1, at: [0.1, 0.02]}
joints:
  rail: {type: prismatic, bodies: [ground, puller], axis: [1, 0]}
  guide: {type: prismatic, bodies: [ground, rod], axis: [1, 0]}
  lift: {type: prismatic, bodies: [rod, sled], axis: [0, 1]}
drives: {motor: {joint: rail, position: "0.05*sin(pi*t)"}}
forces:
  spring: {type: spring_damper, bodies: [puller, rod], points: [[0, 1], [0.1, 1]],
           stiffness: 500, free_length: 0.1}
  touch: {type: surface_contact, surface: {body: ground, shape: plane},
          ball: {body: sled, at: [0.1, 0.02], radius: 20 mm}}
contact_laws:
  s: {normal: impact, stiffness: 1e7, exponent: 1.5, damping: 10, ramp: 1e-5,
      friction: {law: modified_coulomb, coefficient: 0.3, v0: 0, v1: 1 mm/s}}
"""


@pytest.mark.parametrize("every", [0.05, 0.03])
def test_a_touch_tells_where_its_sliding_turns_round(every):
    """It sticks from where the drive turns back, at a row or between two, until the spring has
    turned round:  500 0.05 (1 - sin(pi t)) = 2 mu m g, and not before."""
    r = path(SLED, end=1.0, every=every)
    back = 2 * 0.3 * 2 * G / 500 / 0.05
    assert events(r, TURNS) == pytest.approx(
        np.array([[0.5 + np.arccos(1.0 - back) / np.pi, row(r, "touch")]]), abs=1e-5
    )


ROLLER = """
bodies:
  table: {mass: 1, inertia: 0.01, at: [0, 0]}
  arm: {mass: 2, inertia: 0.02, at: [0.1, 0.06]}
  roller: {mass: 0.5, inertia: 1e-4, at: [0.2, 0.02]}
joints:
  guide: {type: prismatic, bodies: [ground, table], axis: [1, 0]}
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0.1]}
  axle: {type: revolute, bodies: [arm, roller], at: [0.2, 0.02]}
drives: {motor: {joint: guide, position: "0.1*t"}}
sensors: {turn: {joint: axle}}
forces:
  touch: {type: surface_contact, surface: {body: table},
          ball: {body: roller, at: [0.2, 0.02], radius: 20 mm}}
  rub: {type: joint_friction, joint: axle, radius: 5 mm,
        friction: {law: modified_coulomb, coefficient: 0.2, v0: 0, v1: 1 mm/s}}
contact_laws:
  s: {normal: impact, stiffness: 1e9, exponent: 1.5, damping: 10, ramp: 1e-5,
      friction: {law: modified_coulomb, coefficient: 0.4, v0: 0, v1: 1 mm/s}}
"""


def test_a_roller_rolls_on_a_driven_table_against_the_friction_of_its_axle():
    """From the start on, in steps of rows:  0.02 F = 0.2 0.005 |(N - m g, F)|,
    0.2 N + 0.1 F = (0.1 2 + 0.2 0.5) g  about the hinge, with r less the penetration; the table
    goes on by r times the turn."""
    r = path(ROLLER, end=0.2, every=0.05)
    F = 0.0
    for _ in range(30):
        N = 1.5 * G - 0.5 * F
        F = 0.001 / (0.02 - (N / 1e9) ** (2 / 3)) * np.hypot(N - 0.5 * G, F)
    # the axle comes down by the penetration, 6e-6 m of 0.2
    assert r["motor.force"] == pytest.approx(F, rel=3e-5)
    assert r["touch.normal_force"] == pytest.approx(N, rel=3e-5)
    # the arm turns by what the touch gives: 2e-6 m of 0.2
    assert np.diff(r["turn"]) == pytest.approx(0.1 * 0.05 / 0.02, rel=1e-3)
    assert not len(events(r, TURNS))
    assert r.outcome.statistics["steps"] < 100
