"""Reaction sensor: components and sizes of what joints put on bodies, in any frame."""

import numpy as np
import pytest

from trsim.analyse.trajectory import problem
from trsim.errors import TrsimError
from trsim.solve.march.record import EVENT_KIND, EVENT_TIME, USER

from .. import small
from ..runs import built, run, scenario

SPUN = """
planar: false
bodies:
  arm: {mass: 2, inertia: [0.05, 0.04, 0.03, 0.001, 0.002, -0.003], at: [100.3, 0.1, 0.2],
        angle: 0.7}
  bob: {mass: 1, inertia: [0.01, 0.02, 0.03], at: [100.8, 0.1, 0]}
points: {tip: {body: arm, at: [100.5, 0.3, 0.1], x_axis: [1, 2, 2], y_axis: [0, 1, 0]}}
joints:
  bearing: {type: revolute, bodies: [ground, arm], at: [100, 0, 0], axis: [1, 2, 2]}
  ball: {type: universal, bodies: [arm, bob], at: [100.6, 0.2, 0.1], axis: [1, 0, 0],
         second_axis: [0, 1, 0]}
drives: {motor: {joint: bearing, velocity: 9}}
sensors:
  fx: {type: reaction, joint: bearing, axis: [2, 0, 0]}
  force: {type: reaction, joint: bearing}
  first: {type: reaction, joint: bearing, axis: [1, 0, 0], on: ground}
  m: {type: reaction, joint: bearing, of: moment, axis: [0, 1, 0]}
  size: {type: reaction, joint: ball, of: moment, on: arm}
  carried: {type: reaction, joint: ball, axis: tip.x, frame: tip}
  about: {type: reaction, joint: bearing, of: moment, axis: tip.z, frame: arm, at: tip}
gravity: [0, -9.81, 0]
solver: {end: 0.5, tolerance: 1e-9}
output: {every: 0.01, channels: ["*", "*.rotation"]}
"""


def test_are_the_reactions_of_the_joints():
    r = run(SPUN)
    F, M = r["bearing.reaction"], r["bearing.reaction_moment"]
    size = np.abs(F).max()
    assert r["fx"] == pytest.approx(F[:, 0], abs=1e-12 * size)
    assert r["first"] == pytest.approx(-F[:, 0], abs=1e-12 * size)
    assert r["force"] == pytest.approx(np.linalg.norm(F, axis=1), abs=1e-12 * size)
    assert r["m"] == pytest.approx(M[:, 1], abs=1e-10 * size)
    # the moment of a joint whose points coincide is that on either body
    moment = np.linalg.norm(r["ball.reaction_moment"], axis=1)
    assert moment.max() > 0.1
    assert r["size"] == pytest.approx(moment, abs=1e-8 * size)
    axes = r["tip.rotation"].reshape(-1, 3, 3)
    along = np.einsum("nb,nb->n", axes[:, :, 0], r["ball.reaction"])
    assert r["carried"] == pytest.approx(along, abs=1e-11 * size)
    d = np.array([100.0, 0, 0]) - r["tip.position"]
    about = np.einsum("nb,nb->n", axes[:, :, 2], M + np.cross(d, F))
    assert r["about"] == pytest.approx(about, abs=1e-9 * size)
    units = {c.name: c.unit for c in r.mechanism.columns}
    assert (units["fx"], units["m"]) == ("N", "N*m")


def test_in_the_plane():
    """Out of it nothing is told, wherever the place of a moment is."""
    text = """
bodies: {rod: {mass: 2, inertia: 0.1, at: [0.5, 0]}}
joints: {hinge: {type: revolute, bodies: [ground, rod], at: [0, 0]}}
sensors:
  up: {type: reaction, joint: hinge, axis: [0, 1]}
  aside: {type: reaction, joint: hinge, of: moment, axis: [1, 0], at: [0.5, 0, 2]}
  here: {type: reaction, joint: hinge, of: moment, axis: [0, 0, 1], at: [0.5, 0, 2]}
gravity: [0, -10]
solver: {end: 0.1}
"""
    r = run(text)
    assert r.mechanism.planar
    assert r["up"] == pytest.approx(r["hinge.reaction"][:, 1], abs=1e-12)
    assert not r["aside"].any()
    # at t = 0: m g I_c / (I_c + m l^2), at a lever of 0.5 m
    assert r["up"][0] == pytest.approx(20 * 0.1 / 0.6) and r["here"][0] == pytest.approx(-10 / 6)


def test_of_a_joint_with_clearance():
    """In flight nothing, in touch the force of the contact."""
    more = "sensors:\n  load: {type: reaction, joint: B, axis: [1, 0]}\n"
    assert "sensors:\n" in small.SLIDER_CRANK
    r = run(small.SLIDER_CRANK.replace("sensors:\n", more))
    assert np.abs(r["load"]).max() > 1.0
    force = np.hypot(r["B.normal_force"], r["B.friction_force"])
    assert np.all(np.abs(r["load"]) <= force * (1 + 1e-9) + 1e-12)
    flying = r["B.contact_force"] == 0.0
    assert flying.any() and not r["load"][flying].any()


def test_in_an_event():
    text = """
bodies: {block: {mass: 2, inertia: 1}}
joints: {weld: {type: fixed, bodies: [ground, block], at: [0, 0]}}
forces: {push: {type: applied_load, body: block, direction: [3, 4], force: 100*t*t}}
sensors: {load: {type: reaction, joint: weld}}
events: {over: {when: load, value: 0.04 kN, do: {release: [weld]}}}
solver: {end: 1}
phase_portraits: {p: {x: load, y: block.velocity.x}}
"""
    r = run(text)
    times = r.events[r.events[:, EVENT_KIND] == USER][:, EVENT_TIME]
    assert times == pytest.approx([0.4**0.5], abs=1e-7)
    assert not r["load"][r.t > 0.64].any()


@pytest.mark.parametrize(
    "old, new, path, what",
    [
        ("joint: bearing, axis: [2", "joint: baring, axis: [2", ("joint",), "no joint named"),
        ("axis: [2, 0, 0]", "axis: [0, 0, 0]", ("axis",), "must not be zero"),
        ("axis: [2, 0, 0]", "axis: [2, 0, 0], on: bob", ("on",), "none of its bodies"),
        ("axis: [2, 0, 0]", "axis: [2, 0, 0], frame: bib", ("frame",), "no body or point"),
    ],
)
def test_refused(old, new, path, what):
    assert old in SPUN
    with pytest.raises(TrsimError, match=what) as caught:
        built(SPUN.replace(old, new))
    [error] = caught.value.problems
    assert error.path == ("sensors", "fx", *path)


def test_a_gear_bears_nothing():
    text = """
bodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1, at: [1, 0]}}
joints:
  x: {type: revolute, bodies: [ground, a], at: [0, 0]}
  y: {type: revolute, bodies: [ground, b], at: [1, 0]}
  g: {type: gear, joints: [x, y], teeth: [10, 20]}
sensors: {s: {type: reaction, joint: g}}
"""
    with pytest.raises(TrsimError, match="bears nothing"):
        built(text)


def test_is_no_motion_where_runs_are_compared():
    """A reaction jumps at an impact, so it tells nothing of where two motions part."""
    text = SPUN.replace(
        "bearing, axis: [2, 0, 0]}", "bearing, axis: [2, 0, 0]}\n  turn: {joint: bearing}"
    )
    chosen = [c.name for c in problem(scenario(text)).quantities]
    assert chosen == ["turn", "turn.rate"]
