"""Prismatic joint: the stroke along a moving axis, and the reaction that keeps to it."""

import numpy as np
import pytest

from ..runs import run

# a slider on a turntable: on it act the drive, the track across it, and its weight
TABLE = """
planar: {planar}
bodies:
  table: {{mass: 1, inertia: [1, 1, 1]}}
  slider: {{mass: 2, inertia: [0.1, 0.1, 0.1], at: [0.3, 0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, table], at: [0, 0]}}
  track: {{type: prismatic, bodies: [table, slider], axis: [1, 0, 0]}}
drives:
  turn: {{joint: hinge, velocity: 3}}
  push: {{joint: track, velocity: 0.5}}
sensors: {{stroke: {{joint: track}}}}
solver: {{end: 1, tolerance: 1e-10}}
output: {{every: 0.01}}
"""


@pytest.mark.parametrize("planar", ["true", "false"])
def test_spiral(planar):
    r = run(TABLE.format(planar=planar))
    radius = 0.3 + 0.5 * r.t
    along = np.stack([np.cos(3 * r.t), np.sin(3 * r.t)], axis=1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    assert r["stroke"] == pytest.approx(0.5 * r.t, abs=1e-9)
    assert r["slider.position"][:, :2] == pytest.approx(radius[:, None] * along, abs=1e-9)
    assert r["push.force"] == pytest.approx(-2 * radius * 9, abs=1e-7)
    coriolis = 2 * 2 * 3 * 0.5
    assert r["track.reaction"][:, :2] == pytest.approx(coriolis * across, abs=1e-7)
    assert r["turn.force"] == pytest.approx(coriolis * radius, abs=1e-7)
