"""Energy sensor beside bodies without mass or inertia: what they are solved with does not count."""

from math import log

import numpy as np
import pytest

from ..runs import run

# a pinion without mass or inertia turns a hundred times as fast as the table
GEARED = """
bodies:
  table: {mass: 10, inertia: 0.5, at: [0, 0]}
  pinion: {mass: 0, inertia: 0, at: [0.505, 0]}
joints:
  tb: {type: revolute, bodies: [ground, table], at: [0, 0]}
  pb: {type: revolute, bodies: [ground, pinion], at: [0.505, 0]}
  g: {type: gear, joints: [tb, pb], radii: [500 mm, 5 mm]}
sensors: {T: {type: energy, of: kinetic}, U: {type: energy, of: total}}
initial: {tb.rate: 10}
events: {e: {when: T, value: 24 J, crosses: down, do: {end: true}}}
forces: {br: {type: torsion_spring, joint: tb, stiffness: 0, damping: 0.5}}
solver: {end: 1, tolerance: 1e-10}
output: {every: 0.1}
"""
# a needle without inertia about its own axis, spun by a motor, on an arm that falls
SPUN = """
planar: false
gravity: [0, 0, -9.81]
bodies:
  arm: {mass: 2, inertia: [0.02, 0.03, 0.04], at: [0.3, 0, 0]}
  needle: {mass: 0.1, inertia: [0, 0.001, 0.001], at: [0.6, 0, 0]}
joints:
  ball: {type: spherical, bodies: [ground, arm], at: [0, 0, 0]}
  bearing: {type: revolute, bodies: [arm, needle], at: [0.6, 0, 0], axis: [1, 0, 0]}
drives: {motor: {joint: bearing, velocity: 3e3}}
sensors: {T: {type: energy, of: kinetic}, U: {type: energy, of: total}}
solver: {end: 10 ms}
output: {every: 5 ms}
"""


def test_a_wheel_without_inertia_has_no_energy():
    """I w^2 / 2 of the table alone, and an event on it at the time of e^(-2 c t / I)."""
    r = run(GEARED)
    assert r["T"][0] == pytest.approx(25.0, rel=1e-12)
    assert r["U"][0] == pytest.approx(25.0, rel=1e-12)
    assert r.outcome.time == pytest.approx(log(25 / 24) / 2, rel=1e-7)


def test_a_needle_has_no_energy_of_its_spin():
    r = run(SPUN)
    assert r["T"] == pytest.approx(r["energy.kinetic"], abs=1e-9)
    assert np.ptp(r["U"]) < 1e-6
