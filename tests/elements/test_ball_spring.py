"""Ball spring: its moment is minus the gradient of the energy for any turn, and a free body on it
swings like a torsion pendulum about any axis."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, energy_error, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power, now, put_right

PLACE = np.array([0.2, 0.1, 0.0])
BALL = "{type: spherical, bodies: [left, right], at: [0.2, 0.1, 0]}"
SHAFTS = """{type: constant_velocity, bodies: [left, right], at: [0.2, 0.1, 0],
    axis: [0.48, 0.6, 0.64], second_axis: [0.8, -0.1, 0.3]}"""
SPRING = "spring: {type: ball_spring, joint: joint, stiffness: 7, damping: 0.3}"


def thrown(joint, seed, turn=None):
    rng = np.random.default_rng(seed)
    b = bench(f"joints: {{joint: {joint}}}\nforces: {{{SPRING}}}\n", rng)
    if turn is not None:
        put_right(b, PLACE, np.array(turn), np.zeros(3))
    return b


@pytest.mark.parametrize("joint", [BALL, SHAFTS])
@pytest.mark.parametrize("seed", range(4))
def test_its_moment_is_minus_the_gradient_of_the_energy(joint, seed):
    b = thrown(joint, seed)
    check_gradient(b, rel=1e-8)
    check_action_is_reaction(b)
    check_power(b)
    assert b.book[2] < 0.0


@pytest.mark.parametrize("turn", [(0, 0, 1e-9), (0.3, -0.4, 0.1), (2.0, 1.0, -2.0)])
def test_of_a_ball_from_the_drawing(turn):
    b = thrown(BALL, 3, turn)
    b.V[:] = 0.0
    assert b.wrenches()[2, 3:] == pytest.approx(-7 * now(b, np.array(turn)), rel=1e-12, abs=1e-14)


def test_of_shafts_from_where_they_are_straight():
    """Drawn bent: against the bend, by the angle between the shafts."""
    b = thrown(SHAFTS, 3, (0, 0, 0))
    b.V[:] = 0.0
    first, second = np.array([0.48, 0.6, 0.64]), np.array([0.8, -0.1, 0.3])
    second /= np.linalg.norm(second)
    n = np.cross(first, second)
    bend = np.arctan2(np.linalg.norm(n), first @ second)
    wanted = -7 * bend * now(b, n / np.linalg.norm(n))
    assert b.wrenches()[2, 3:] == pytest.approx(wanted, rel=1e-12)


def pendulum(keys, axis, spin, bodies="ground, top", planar="false", end=2):
    omega = spin * np.array(axis) / np.linalg.norm(axis)
    return f"""
planar: {planar}
bodies: {{top: {{mass: 3, inertia: [0.05, 0.05, 0.05], at: [4, -2, 0], angle: 0.6,
               angular_velocity: {omega.tolist()}}}}}
joints: {{ball: {{type: spherical, bodies: [{bodies}], at: [4, -2, 0]}}}}
forces: {{s: {{type: ball_spring, joint: ball, {keys}}}}}
solver: {{end: {end}, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*", "*.rotation"]}}
"""


@pytest.mark.parametrize("bodies", ["ground, top", "top, ground"])
@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_torsion_pendulum_about_any_axis(bodies, planar):
    """theta(t) = w/f exp(-d t) sin(f t), d = c/(2 I), f^2 = k/I - d^2."""
    k, c, I, spin = 2.0, 0.06, 0.05, 5.0
    axis = (0, 0, 1) if planar == "true" else (2, -1, 2)
    r = run(pendulum(f"stiffness: {k}, damping: {c}", axis, spin, bodies, planar))
    d = c / (2 * I)
    f = np.sqrt(k / I - d**2)
    theta = spin / f * np.exp(-d * r.t) * np.sin(f * r.t)
    sign = 1.0 if bodies == "ground, top" else -1.0
    along = np.array(axis) / np.linalg.norm(axis)
    assert r["s.rotation_vector"] == pytest.approx(sign * np.outer(theta, along), abs=1e-8)
    turned = Rotation.from_matrix(r["top.rotation"].reshape(-1, 3, 3))
    seen = (turned * turned[0].inv()).as_rotvec()
    assert seen == pytest.approx(np.outer(theta, along), abs=1e-8)
    assert r["energy.work.dampers"][-1] < -0.1
    assert energy_error(r) < 1e-9


def test_a_damper_alone_slows_any_spin():
    r = run(pendulum("damping: 0.02", (1, 2, -2), 30.0))
    speed = np.linalg.norm(r["top.angular_velocity"], axis=1)
    assert speed == pytest.approx(30 * np.exp(-0.4 * r.t), rel=1e-8)


def test_a_shaft_that_hangs_on_a_bent_joint():
    """A rod on a joint of constant velocity whose first shaft is turned: it rises to where
    k bend = m g l sin bend has its other root, and turns as fast as the shaft."""
    k, m, l = 4.0, 2.0, 0.5
    r = run(f"""
planar: false
bodies:
  shaft: {{mass: 1, inertia: [0.1, 0.1, 0.1], at: [0, 0, -0.1]}}
  rod: {{mass: {m}, inertia: [0.02, 0.02, 0.01], at: [{-l * np.sin(1.5)}, 0, {l * np.cos(1.5)}]}}
joints:
  bearing: {{type: revolute, bodies: [ground, shaft], at: [0, 0, -0.2], axis: [0, 0, 1]}}
  joint: {{type: constant_velocity, bodies: [shaft, rod], at: [0, 0, 0], axis: [0, 0, 1],
          second_axis: [{-np.sin(1.5)}, 0, {np.cos(1.5)}]}}
drives: {{hold: {{joint: bearing, position: 0}}}}
forces: {{s: {{type: ball_spring, joint: joint, stiffness: {k}, damping: 1.5}}}}
gravity: [0, 0, -9.81]
solver: {{end: 12, tolerance: 1e-8}}
output: {{every: 0.1, channels: ["*"]}}
""")
    bend = r["joint.bend"]
    assert np.linalg.norm(r["s.rotation_vector"], axis=1) == pytest.approx(bend, abs=1e-7)
    rest = bend[-1]
    assert k * rest == pytest.approx(m * 9.81 * l * np.sin(rest), abs=1e-6)
    assert rest > 1.6
    assert energy_error(r) < 1e-6


def test_half_a_turn_is_told():
    far = run(pendulum("stiffness: 0.1", (1, 0, 1), 4.4))  # to 3.11 rad
    assert any("turned by 17" in text and "forces.s" in text for text in said(far))
    near = run(pendulum("stiffness: 0.1", (1, 0, 1), 4.0))
    assert not any("forces.s" in text for text in said(near))


def said(r):
    return doubts(r.scenario, r.mechanism, r.outcome)


@pytest.mark.parametrize(
    "joint, keys, words",
    [
        ("type: spherical", "", "nothing acts"),
        ("type: spherical", "stiffness: -1", ">= 0|greater than or equal"),
        ("type: revolute", "stiffness: 1", "does not turn about every axis"),
        ("type: fixed", "stiffness: 1", "does not turn about every axis"),
    ],
)
def test_refused(joint, keys, words):
    text = pendulum(keys or "stiffness: 0", (0, 0, 1), 1.0).replace("type: spherical", joint)
    with pytest.raises(TrsimError, match=words):
        built(text)


def test_a_flexible_bar_in_space_is_refused():
    text = """
planar: false
bodies: {bar: {mass: 2, inertia: [1e-4, 0.17, 0.17], at: [0.5, 0],
              flexible: {youngs_modulus: 70 GPa, area: 1e-4, second_moment: 1e-9, elements: 2}}}
joints:
  ball: {type: spherical, bodies: [ground, bar], at: [0, 0]}
  far: {type: inline, bodies: [ground, bar], at: [1, 0], axis: [1, 0, 0]}
forces: {s: {type: ball_spring, joint: ball, damping: 1}}
"""
    with pytest.raises(TrsimError, match="about itself"):
        built(text)


def test_a_torsion_spring_names_it():
    text = pendulum("stiffness: 1", (0, 0, 1), 1.0).replace("ball_spring", "torsion_spring")
    with pytest.raises(TrsimError, match="has no coordinate") as caught:
        built(text)
    assert "ball_spring" in caught.value.hint
