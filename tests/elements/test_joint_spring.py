"""Springs and dampers by laws of their own on angles and strokes."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.errors import ScenarioError

from ..runs import built, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power, put_right

HINGED = """
joints: {{hinge: {{type: {}, bodies: [{}], at: [0.2, 0.1, 0], axis: [1, 2, 2]}}}}
forces: {{coil: {{type: joint_spring, joint: hinge{}, {}}}}}
"""
LAW = 'elastic: "30*stretch + 5*stretch**3", damper: "4*rate*abs(rate)", free: -0.2'
TABLE = (
    "elastic: {table: [[-4, -9], [0, 1], [2, 9], [4, 10]]}, damper: rate, damper_acts: compression"
)


@pytest.mark.parametrize("law", [LAW, TABLE])
@pytest.mark.parametrize("order", ["left, right", "right, left"])
@pytest.mark.parametrize(
    "joint, of",
    [("revolute", ""), ("prismatic", ""), ("cylindrical", ".stroke"), ("cylindrical", ".angle")],
)
def test_action_is_reaction_and_forces_follow_from_the_energy(law, order, joint, of):
    b = bench(HINGED.format(joint, order, of, law), np.random.default_rng(3))
    turn, shift = (0.7, 0.0) if joint == "revolute" else (0.0, 0.4)
    if joint == "cylindrical":
        turn, shift = 0.7, 0.4
    axis = np.array([1, 2, 2]) / 3
    put_right(b, np.array([0.2, 0.1, 0.0]), turn * axis, shift * axis)
    b.branch = np.full(b.mechanism.model.n_s, -0.7 if "right, left" in order else 0.7)
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] <= 0.0
    if joint != "cylindrical":  # elsewhere moves of a body leave the joint
        return
    if of == ".stroke" and "table" not in law:
        check_gradient(b)


SLIDE = """
bodies: {{block: {{mass: 2, inertia: 0.01, velocity: [3, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [{}], axis: [{}, 0, 0]}}}}
forces: {{buffer: {{type: joint_spring, joint: slide, elastic: "{}", damper: "{}"}}}}
solver: {{end: 2, tolerance: 1e-9}}
output: {{every: 0.1}}
"""


@pytest.mark.parametrize("bodies, axis", [("ground, block", 1), ("ground, block", -1),
                                          ("block, ground", 1), ("block, ground", -1)])  # fmt: skip
def test_a_stroke_whatever_the_axis_and_the_order(bodies, axis):
    """m x'' = -(k x + k3 x^3) - c x' |x'|: the laws are odd, so nothing depends on either."""
    r = run(SLIDE.format(bodies, axis, "200*stretch + 900*stretch**3", "3*rate*abs(rate)"))

    def rate(t, y):
        return [y[1], -(200 * y[0] + 900 * y[0] ** 3 + 3 * y[1] * abs(y[1])) / 2]

    exact = solve_ivp(rate, (0, 2), [0, 3], rtol=1e-11, atol=1e-12, t_eval=r.t)
    np.testing.assert_allclose(r["block.position"][:, 0], exact.y[0], atol=1e-7)
    assert np.abs(r["energy.residual"]).max() < 1e-7 * 9


def test_an_angle_over_several_turns():
    """A disc wound up by a table that is one line: five turns and back, as a linear spring."""
    r = run("""
bodies: {disc: {mass: 1, inertia: 0.5, angular_velocity: [0, 0, 60]}}
joints: {axle: {type: revolute, bodies: [ground, disc], at: [0, 0]}}
forces: {coil: {type: joint_spring, joint: axle, elastic: {table: [[-50, -100], [50, 100]]}}}
solver: {end: 3, tolerance: 1e-9}
output: {every: 0.1}
""")
    np.testing.assert_allclose(r["coil.stretch"], 30 * np.sin(2 * r.t), atol=1e-6)
    np.testing.assert_allclose(r["coil.force"], -60 * np.sin(2 * r.t), atol=3e-6)
    assert r["coil.stretch"].max() > 4 * 2 * math.pi


def test_it_is_the_torsion_spring_where_its_law_is_linear():
    text = """
bodies: {{rod: {{mass: 1, inertia: 0.5, at: [0.3, 0], angle: 20 deg}}}}
joints: {{axle: {{type: revolute, bodies: [ground, rod], at: [0, 0]}}}}
forces: {{coil: {{type: {}}}}}
gravity: [0, -9.81, 0]
solver: {{end: 2, tolerance: 1e-9}}
output: {{every: 0.1}}
"""
    one = run(text.format("torsion_spring, joint: axle, stiffness: 8, damping: 0.3, preload: 2"))
    other = run(text.format(
        'joint_spring, joint: axle, elastic: "8*stretch - 2", damper: "0.3*rate"'))  # fmt: skip
    np.testing.assert_allclose(other["rod.position"], one["rod.position"], atol=1e-9)
    np.testing.assert_allclose(other["coil.force"], one["coil.torque"], atol=1e-7)


@pytest.mark.parametrize(
    "law, what",
    [
        ("elastic: {table: [[0 mm, 0], [1 mm, 3]]}", "'stretch' is in rad"),
        ("damper: {table: [[0 m/s, 0], [1 m/s, 3]]}", "'rate' is in rad/s"),
        ("elastic: 3 N", "wrong unit: 'N'"),
        ("elastic: 3 N*m, free: 2 mm", "wrong unit: 'mm'"),
        ("free: 1", "nothing acts"),
    ],
)
def test_what_is_refused(law, what):
    text = HINGED.format("revolute", "ground, left", "", law)
    with pytest.raises(ScenarioError, match=what):
        built("bodies: {left: {mass: 1, inertia: 1}}\n" + text.replace(", axis: [1, 2, 2]", ""))
