"""Relations of joints: where they act on the bodies of their joints."""

import numpy as np
import pytest

from ..runs import built

GEARS = """
bodies:
  a: {mass: 1, inertia: 0.01, at: [0.1, 0.2]}
  b: {mass: 1, inertia: 0.01, at: [0.5, -0.1]}
joints:
  one: {type: revolute, bodies: [ground, a], at: [0, 0]}
  two: {type: revolute, bodies: [ground, b], at: [0.3, 0.1]}
  teeth: {type: gear, joints: [one, two], teeth: [20, 10]}
solver: {end: 1}
"""


def test_a_gear_acts_where_its_joints_are():
    """On both bodies of each, at the place of the joint as seen from their centres."""
    mechanism = built(GEARS)
    (gear,) = (i for i in mechanism.instances if i.name == "teeth")
    centres = {0: [0, 0, 0], mechanism.frames["a"]: [0.1, 0.2, 0],
               mechanism.frames["b"]: [0.5, -0.1, 0]}  # fmt: skip
    places = gear.element.acts_at(gear.row)
    assert {frame for frame, _ in places} == {*centres}
    found = [np.add(centres[frame], place) for frame, place in places]
    assert np.array(found) == pytest.approx(
        np.array([[0, 0, 0], [0, 0, 0], [0.3, 0.1, 0], [0.3, 0.1, 0]]), abs=1e-12
    )
