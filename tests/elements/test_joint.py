"""Joints as lists of rows: how many motions each leaves, and that each is closed as drawn."""

import numpy as np
import pytest

from trsim.assemble.reduce import jacobian
from trsim.elements import load
from trsim.elements.scene import scene

from ..runs import built, energy_error, run
from .test_constraints import JOINTS, written

# what one body may still do against another, in space
FREE = {
    "fixed": 0,
    "revolute": 1,
    "shaft": 1,
    "prismatic": 1,
    "screw": 1,
    "cylindrical": 2,
    "universal": 2,
    "constant_velocity": 2,
    "spherical": 3,
    "planar": 3,
    "inline": 4,
    "parallel": 4,
    "point_on_curve": 4,
    "inplane": 5,
    "link": 5,
    "cam": 5,
}
IDEAL = [word for word, joint in JOINTS.items() if not joint.ideal]
IN_THE_PLANE = {
    "fixed": 0,
    "revolute": 1,
    "prismatic": 1,
    "spherical": 1,
    "inline": 2,
    "inplane": 2,
    "parallel": 2,
    "link": 2,
    "planar": 3,
}
# what a joint of points and turns is drawn as; other joints say it themselves
DRAWN = {"spherical": "ball", "universal": "cross", "revolute": "pin", "fixed": "weld",
         "inline": "bead", "cylindrical": "sleeve", "prismatic": "slide"}  # fmt: skip
TURNED = """
bodies:
  left: {mass: 2, inertia: [0.02, 0.03, 0.04], at: [300.1, -0.2, 0.3], angle: 2.7}
  right: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [300.5, 0.2, -0.1], angle: -0.9}
"""


def test_every_joint_is_in_the_table():
    assert {*IDEAL} == {*FREE}


@pytest.mark.parametrize("word", DRAWN)
def test_pictures(word):
    assert load(word).picture == DRAWN[word]


@pytest.mark.parametrize("word", IDEAL)
def test_degrees_of_freedom(word):
    m = built(f"planar: false\n{TURNED}joints: {{j: {{bodies: [ground, left], {written(word)}}}}}")
    assert m.mobility == 6 + FREE[word]  # the right body is free
    assert m.mobility == m.mobility_by_count and not m.redundant and not m.singular


@pytest.mark.parametrize("word", IN_THE_PLANE)
def test_degrees_of_freedom_in_the_plane(word):
    axis = "axis: [0, 0, 1]" if word == "planar" else "axis: [3, -4, 0]"
    axis = "" if word == "revolute" else axis
    keys = [f"type: {word}"]
    fields = JOINTS[word].spec.model_fields
    keys += ["at: [0.3, 0.2]"] * ("at" in fields) + [axis] * (axis != "" and "axis" in fields)
    keys += ["points: [[0, 0], [0.3, 0.2]]"] * ("points" in fields)
    text = f"""
planar: true
bodies: {{rod: {{mass: 1, inertia: 0.1, at: [0.5, 0.1], angle: 1.1}}}}
joints: {{j: {{bodies: [ground, rod], {", ".join(keys)}}}}}
"""
    m = built(text)
    assert (m.mobility, m.redundant) == (IN_THE_PLANE[word], ())


@pytest.mark.parametrize("word", [word for word in IDEAL if word != "cam"])
def test_is_closed_as_drawn(word):
    """Bodies turned away from the drawing's axes, both moving, far from the origin.

    The roller of a cam is drawn about where it is: test_cam.py.
    """
    place = "" if word == "link" else "at: [300.2, 0.1, 0]"
    text = written(word).replace("at: [0.2, 0.1, 0]", place)
    m = built(f"planar: false\n{TURNED}joints: {{j: {{bodies: [left, right], {text}}}}}")
    work = scene(m.model)
    for x in m.coordinates.values():
        work.branch[x.entry] = x.drawn
    assert np.abs(jacobian(work, 0.0, m.y0)[0]).max() < 1e-12


FLYING = """
planar: false
bodies:
  left: {mass: 2, inertia: [0.02, 0.03, 0.04], at: [0.1, -0.2, 0.3], angle: 2.7,
         velocity: [1, 2, 3], angular_velocity: [5, -3, 4]}
  right: {mass: 3, inertia: [0.05, 0.04, 0.03], at: [0.5, 0.2, -0.1], angle: -0.9,
          velocity: [0.5, 1, -1], angular_velocity: [1, 2, 9]}
"""
INERTIA = {"left": (2, np.diag([0.02, 0.03, 0.04])), "right": (3, np.diag([0.05, 0.04, 0.03]))}


@pytest.mark.parametrize("word", IDEAL)
def test_a_pair_in_free_flight_keeps_its_momentum(word):
    """What a joint does to one body it takes from the other, force, moment and energy."""
    r = run(f"""{FLYING}
joints: {{j: {{bodies: [left, right], {written(word)}}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.05, channels: ["*", "*.rotation"]}}
""")
    momentum, turning = 0.0, 0.0
    for body, (m, I) in INERTIA.items():
        R = r[f"{body}.rotation"].reshape(-1, 3, 3)
        v, omega = r[f"{body}.velocity"], r[f"{body}.angular_velocity"]
        momentum = momentum + m * v
        own = np.einsum("nij,jk,nlk,nl->ni", R, I, R, omega)
        turning = turning + np.cross(r[f"{body}.position"], m * v) + own
    assert np.abs(momentum - momentum[0]).max() < 1e-10
    assert np.abs(turning - turning[0]).max() < 1e-8
    assert np.abs(r["right.angular_velocity"]).max() > 1.0 and energy_error(r) < 1e-9
