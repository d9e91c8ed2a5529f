"""Kinematic analysis, a load that jumps in a rate: extremes behind the jump are those of the side
it is on there."""

from math import acos

import numpy as np
import pytest

from tests.runs import run

TURNING = """
bodies:
  b: {{mass: 2, inertia: 0.1, at: [0, 0]}}
joints:
  s: {{type: prismatic, bodies: [ground, b], axis: [1, 0]}}
sensors: {{x: {{joint: s}}}}
forces:
  f: {{type: applied_load, body: b, direction: [-1, 0], force: "40*(x.rate > 0) - 100*x.rate"}}
drives: {{m: {{joint: s, position: "0.3*sin(2*t) + 0.05*t"}}}}
solver: {{method: kinematic, end: 0.9, tolerance: 1e-9}}
output: {{every: {every}}}
"""


@pytest.mark.parametrize("every", [0.01, 0.05])
def test_no_sample_behind_a_jump_is_of_the_side_before_it(every):
    # x' = 0.6 cos 2t + 0.05 is zero once; the load is 40 - 100 x' before, and -100 x' behind
    turns = 0.5 * acos(-0.05 / 0.6)
    found = run(TURNING.format(every=every))
    assert found.largest("f.magnitude") == pytest.approx((40.0, turns), abs=1e-7)
    # the drive: m x'' and the load
    before = -2 * 1.2 * np.sin(2 * turns) + 40.0
    assert found.largest("m.force") == pytest.approx((before, turns), abs=1e-7)
