"""Fixed joint: two bodies move as one, and the cut carries force and moment."""

import numpy as np
import pytest

from ..runs import run

# a bar welded to a hub that turns about the vertical; its weight bends the weld
WELD = """
planar: {planar}
gravity: {gravity}
bodies:
  hub: {{mass: 1, inertia: [1, 1, 1]}}
  bar: {{mass: 2, inertia: [0.2, 0.3, 0.4], at: [0.5, 0, 0.0]}}
joints:
  hinge: {{type: revolute, bodies: [ground, hub], at: [0, 0]}}
  weld: {{type: fixed, bodies: [hub, bar], at: [0.1, 0]}}
drives: {{motor: {{joint: hinge, velocity: 4*t}}}}
solver: {{end: 0.5, tolerance: 1e-10}}
"""


@pytest.mark.parametrize("planar, gravity", [("true", "[0, 0]"), ("false", "[0, 0, -10]")])
def test_cut_force_and_moment(planar, gravity):
    r = run(WELD.format(planar=planar, gravity=gravity))
    angle, weight = 2 * r.t**2, 20.0 if planar == "false" else 0.0
    along = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    across = np.stack([-along[:, 1], along[:, 0], 0 * angle], axis=1)
    acceleration = 0.5 * (4 * across - (4 * r.t[:, None]) ** 2 * along)
    assert r["bar.angular_velocity"][:, 2] == pytest.approx(4 * r.t, abs=1e-8)
    force = 2 * acceleration + [0, 0, weight]
    assert r["weld.reaction"] == pytest.approx(force, abs=1e-6)
    # about the cut, 0.4 m from the centre:  I alpha e_z + 0.4 along x force
    moment = 0.4 * np.cross(along, force) + [0, 0, 0.4 * 4]
    assert r["weld.reaction_moment"] == pytest.approx(moment, abs=1e-6)
