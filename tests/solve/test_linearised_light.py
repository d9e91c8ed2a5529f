"""Small motions beside a body without inertia about its axis, which spins: no gyroscope."""

import numpy as np
import pytest

from trsim.solve.diagnose.linearised import linearised
from trsim.solve.start.consistent import start

from ..runs import assemble, scenario

GIMBAL = """
planar: false
bodies:
  fork: {mass: 1, inertia: [0.02, 0.03, 0.04], at: [0, 0, 0]}
  arm: {mass: 2, inertia: [0.05, 0.06, 0.07], at: [0, 0, 0]}
  needle: {mass: 0.1, inertia: [0, 0.001, 0.001], at: [0, 0, 0]}
joints:
  first: {type: revolute, bodies: [ground, fork], at: [0, 0, 0], axis: [0, 0, 1]}
  second: {type: revolute, bodies: [fork, arm], at: [0, 0, 0], axis: [0, 1, 0]}
  bearing: {type: revolute, bodies: [arm, needle], at: [0, 0, 0], axis: [1, 0, 0]}
forces:
  k1: {type: torsion_spring, joint: first, stiffness: 40}
  k2: {type: torsion_spring, joint: second, stiffness: 50}
drives: {motor: {joint: bearing, velocity: 1e5}}
solver: {end: 1}
"""


def test_a_needle_that_spins_is_no_gyroscope():
    """k / I of either axis, to the rounding of a stiffness beside 1e5 rad/s."""
    read = scenario(GIMBAL)
    mechanism = assemble(read)
    found = linearised(mechanism, start(read, mechanism, located=True))
    moments = np.array([0.04 + 0.07 + 0.001, 0.06 + 0.001])
    values = np.linalg.eigvals(found.A)
    slowly = np.sort(np.abs(values))
    assert slowly[::2] == pytest.approx(np.sort(np.sqrt([40, 50] / moments)), rel=1e-5)
