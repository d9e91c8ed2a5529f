"""Ball spring by functions of the angle of the turn and of the size of the angular velocity."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from trsim.errors import TrsimError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, energy_error, run
from .bench import bench, check_action_is_reaction, check_gradient, check_power
from .test_ball_spring import BALL, SHAFTS, pendulum

TABLE = "{table: [[0, 0], [0.5, 2], [1.5, 3], [3.2, 9]], interpolation: INTERPOLATION}"


@pytest.mark.parametrize("joint", [BALL, SHAFTS])
@pytest.mark.parametrize(
    "elastic",
    ["4*angle + 2*angle**3", "3*max(0, angle - 0.1)", *(
        TABLE.replace("INTERPOLATION", way) for way in ("linear", "akima", "spline"))],
)  # fmt: skip
@pytest.mark.parametrize("seed", range(2))
def test_its_moment_is_minus_the_gradient_of_the_energy(joint, elastic, seed):
    law = elastic if elastic.startswith("{") else f'"{elastic}"'
    spring = f"{{type: ball_spring, joint: joint, elastic: {law}, damper: '0.3*rate**2'}}"
    b = bench(f"joints: {{joint: {joint}}}\nforces: {{spring: {spring}}}\n",
              np.random.default_rng(seed))  # fmt: skip
    check_gradient(b, rel=1e-7)
    check_action_is_reaction(b)
    check_power(b)
    w = np.linalg.norm(b.V[2, 3:] - b.V[1, 3:])
    assert b.book[2] == pytest.approx(-0.3 * w**3, rel=1e-12)


def swung(elastic, damper, spin, t, I=0.05, load=0.0):
    """The turn of a body of inertia I about one axis, by scipy."""

    def rates(_, y):
        pull = np.sign(y[0]) * elastic(abs(y[0])) + np.sign(y[1]) * damper(abs(y[1]))
        return y[1], (load - pull) / I

    return solve_ivp(rates, (0, t[-1]), (0, spin), t_eval=t, rtol=1e-12, atol=1e-12,
                     method="DOP853", max_step=1e-3).y[0]  # fmt: skip


def turned(q):
    """The turn of a quaternion, scalar last: its rotation vector, angle below pi, and matrix."""
    x, y, z, w = (q / np.sqrt(q @ q)).tolist()
    x, y, z, w = (x, y, z, w) if w >= 0.0 else (-x, -y, -z, -w)
    sine = math.sqrt(x * x + y * y + z * z)
    angle = 2.0 * math.atan2(sine, w)
    matrix = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
    return np.array([x, y, z]) * (angle / sine if sine else 2.0), angle, matrix


def rate_of(q, w):
    """Of a quaternion, scalar last, at an angular velocity in axes of the body."""
    (x, y, z, r), (a, b, c) = q.tolist(), w.tolist()
    return [0.5 * (r * a + y * c - z * b), 0.5 * (r * b + z * a - x * c),
            0.5 * (r * c + x * b - y * a), -0.5 * (x * a + y * b + z * c)]  # fmt: skip


def across(u, v):
    """The vector product: that of numpy takes thirty times as long for a single pair."""
    (a, b, c), (d, e, f) = u.tolist(), v.tolist()
    return np.array([b * f - c * e, c * d - a * f, a * e - b * d])


LAWS = "elastic: '2*angle + 5*angle**3', damper: '0.01*rate**2'"


@pytest.mark.parametrize("bodies", ["ground, top", "top, ground"])
@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_hardening_spring_with_a_quadratic_damper(bodies, planar):
    axis = (0, 0, 1) if planar == "true" else (2, -1, 2)
    r = run(pendulum(LAWS, axis, 6.0, bodies, planar))
    x = swung(lambda x: 2 * x + 5 * x**3, lambda w: 0.01 * w**2, 6.0, r.t)
    sign, along = (1.0 if bodies == "ground, top" else -1.0), np.array(axis) / np.linalg.norm(axis)
    assert r["s.rotation_vector"] == pytest.approx(sign * np.outer(x, along), abs=1e-7)
    assert np.abs(x).max() > 0.5
    assert energy_error(r) < 1e-8


def test_the_largest_turn_is_where_the_energy_is_stored():
    """I w^2 / 2 = integral of the table, by hand: 0.25 rad, 0.5 N m there, 1 N m/rad on."""
    law = "elastic: {table: [[0, 0], [0.25, 0.5], [2, 2.25]], interpolation: linear}"
    r = run(pendulum(law, (1, 2, -2), np.sqrt(2 * 0.2 / 0.05)))
    # 0.0625 J up to 0.25 rad; then 0.5 d + d^2/2 = 0.1375 J
    d = -0.5 + np.sqrt(0.25 + 2 * 0.1375)
    assert 3 * r.largest("s.rotation_vector")[0] == pytest.approx(0.25 + d, abs=1e-7)
    assert energy_error(r) < 1e-8


def test_a_hard_end_is_never_passed_over():
    """A turn of 20 rad/s meets a wall of 1e5 N m/rad at 0.4 rad and is back after pi sqrt(I/k)."""
    r = run(pendulum("elastic: '1e5*max(0, angle - 0.4)'", (1, -1, 0), 20.0, end=0.2))
    period = 4 * 0.4 / 20 + 2 * np.pi * np.sqrt(0.05 / 1e5)
    quarter = 0.02
    phase = r.t % period
    away = np.where(phase <= quarter, 20 * phase, np.nan)
    angle = np.linalg.norm(r["s.rotation_vector"], axis=1)
    free = ~np.isnan(away)
    assert free.sum() > 3
    assert angle[free] == pytest.approx(away[free], abs=1e-6)


def test_a_wall_that_is_just_touched_is_never_passed_over():
    """A swing of 0.5 rad that a hard wall turns back at 0.4995 rad, 7 ms before it would turn."""
    k, I, T, a = 2.0, 0.05, 1e3, 0.4995
    f = np.sqrt(k / I)
    law = f"stiffness: {k}, elastic: '{T}*(angle > {a})'"
    r = run(pendulum(law, (1, -1, 0), 0.5 * f).replace("1e-10", "1e-6"))
    there = np.arcsin(a / 0.5)
    lost = 2 * np.sqrt(0.25 - a**2) * f * I / (T + k * a)  # s in the wall, at an even push
    phase = f * (r.t % (2 * there / f + lost))
    exact = 0.5 * np.sin(np.minimum(phase, 2 * there - phase + f * lost))
    angle = np.linalg.norm(r["s.rotation_vector"], axis=1)
    assert angle == pytest.approx(exact, abs=1e-4)


def test_a_knee_that_is_just_passed_is_never_passed_over():
    """A damper that acts above 0.99 of the speed that a swing under an even load would have."""
    k, I, M = 2.0, 0.05, 1.0
    fast = 0.99 * M / np.sqrt(k * I)
    law = f"stiffness: {k}, damper: '5*max(0, rate - {fast})'"
    text = pendulum(law, (1, -1, 0), 0.0, end=4).replace(
        "forces: {",
        f"forces: {{m: {{type: applied_load, body: top, direction: [1, -1, 0], torque: {M}}}, ",
    )
    r = run(text)
    x = swung(lambda x: k * x, lambda w: 5 * max(0, w - fast), 0.0, r.t, load=M)
    angle = np.linalg.norm(r["s.rotation_vector"], axis=1)
    assert angle == pytest.approx(x, abs=1e-7)
    assert np.abs(x - M / k * (1 - np.cos(np.sqrt(k / I) * r.t))).max() > 1e-3


@pytest.mark.parametrize("knee", [0.5, 4.0])
def test_a_damper_with_a_knee(knee):
    """I w' = -c min(w, knee): falls evenly, then exponentially; about any axis."""
    c, I, w0 = 0.1, 0.05, 10.0
    r = run(pendulum(f"damper: '{c}*min(rate, {knee})'", (1, 2, -2), w0))
    speed = np.linalg.norm(r["top.angular_velocity"], axis=1)
    met = (w0 - knee) * I / (c * knee)
    exact = np.where(r.t < met, w0 - c * knee / I * r.t, knee * np.exp(-c / I * (r.t - met)))
    assert speed == pytest.approx(exact, abs=1e-7)
    assert r["energy.work.dampers"] == pytest.approx(0.5 * I * (exact**2 - w0**2), abs=1e-7)


def test_a_top_that_turns_about_all_axes():
    """Against Euler's equations with a rotation vector by scipy; the ground may come second."""
    I, w0 = np.array([0.05, 0.08, 0.03]), np.array([1.0, -2.0, 1.5])
    text = f"""
planar: false
bodies: {{top: {{mass: 3, inertia: {I.tolist()}, at: [4, -2, 7], angular_velocity: {w0.tolist()}}}}}
joints: {{ball: {{type: spherical, bodies: [top, ground], at: [4, -2, 7]}}}}
forces: {{s: {{type: ball_spring, joint: ball, {LAWS}}}}}
solver: {{end: 2, tolerance: 1e-10}}
output: {{every: 0.01, channels: ["*", "*.rotation"]}}
"""
    r = run(text)

    def rates(_, y):
        (theta, x, _), w = turned(y[:4]), y[4:]
        m = -(2 * x + 5 * x**3) * theta / (x or 1.0) - 0.01 * math.sqrt(w @ w) * w
        return [*rate_of(y[:4], w), *((m - across(w, I * w)) / I)]

    y = solve_ivp(rates, (0, 2), [0, 0, 0, 1, *w0], t_eval=r.t, rtol=1e-11, atol=1e-12).y
    exact = Rotation.from_quat(y[:4].T).as_matrix()
    assert r["top.rotation"].reshape(-1, 3, 3) == pytest.approx(exact, abs=1e-7)
    assert energy_error(r) < 1e-8


def test_half_a_turn_is_told():
    r = run(pendulum("elastic: '0.1*angle'", (1, 0, 1), 4.4))
    assert any("turned by 17" in text and "forces.s" in text
               for text in doubts(r.scenario, r.mechanism, r.outcome))  # fmt: skip


@pytest.mark.parametrize(
    "keys, words",
    [
        ("elastic: 2", "a moment of 2 at an angle of 0"),
        ("elastic: '1 + angle'", "a moment of 1 at an angle of 0"),
        ("elastic: {table: [[0.1, 1], [1, 2]]}", "without a row at an angle of 0"),
        ("elastic: {table: [[0, 1], [1, 2]]}", "a moment of 1 at an angle of 0"),
        ("elastic: '2*(angle > 0)'", "a moment of 2 at once, where `angle`"),
        ("damper: '2*sign(rate)'", "a moment of 2 at once, where `rate`"),
        ("elastic: 'stretch'", "'stretch' cannot stand here"),
        ("elastic: {table: [[0 m, 0], [1 m, 2]]}", "wrong unit: 'm'; 'angle' is in rad"),
        ("elastic: {table: [[0, 0 N], [1, 2 N]]}", "unit"),
        ("damper: '-rate'", "it drives"),
        ("damper: '0.1 + rate'", "at rest"),
        ("damper: {table: [[0 m/s, 0], [1 m/s, 2]]}", "wrong unit: 'm/s'; 'rate' is in rad/s"),
    ],
)
def test_refused(keys, words):
    with pytest.raises(TrsimError, match=words):
        built(pendulum(keys, (0, 0, 1), 1.0))


def test_corners_of_all_kinds_in_space():
    """A rod on a ball, against scipy: an elastic table, a damper with a knee, a load that jumps
    with the bend.  Of every knee it is known whether the rate passes it: steps are few."""
    I, m, s, g = np.array([0.3, 0.25, 0.05]), 2.0, np.array([0, 0, -0.6]), np.array([1, -2, -9.81])
    r = run(f"""
planar: false
bodies: {{rod: {{mass: {m}, inertia: {I.tolist()}, at: [100, 200, 299.4], velocity: [-0.6, 0, 0],
               angular_velocity: [0, 1, 4]}}}}
joints: {{ball: {{type: spherical, bodies: [ground, rod], at: [100, 200, 300], axis: [0, 0, -1]}}}}
sensors: {{b: {{joint: ball.bend}}}}
forces:
  s: {{type: ball_spring, joint: ball, damper: "0.05*rate + 0.4*max(0, rate - 2)",
      elastic: {{table: [[0, 0], [0.3, 1.5], [0.6, 6]], interpolation: linear, outside: extend}}}}
  load: {{type: applied_load, body: rod, direction: [0, 0, 1], torque: "3*floor(10*b)"}}
gravity: {g.tolist()}
solver: {{end: 1, method: dop853, tolerance: 1e-10}}
output: {{every: 0.01}}
""")
    J = np.diag(I) + m * (s @ s * np.eye(3) - np.outer(s, s))
    inverse = np.linalg.inv(J)

    def rates(_, y):
        (theta, x, A), w = turned(y[:4]), y[4:]
        fast, down = math.sqrt(w @ w), float(A[2, 2])
        bend = math.atan2(math.sqrt(max(0.0, 1 - down * down)), down)
        pull = np.interp(x, [0, 0.3, 0.6, 3.6], [0, 1.5, 6, 51]) / (x or 1.0)
        slow = (0.05 * fast + 0.4 * max(0, fast - 2)) / (fast or 1.0)
        loads = across(A @ s, m * g) + np.array([0, 0, 3 * math.floor(10 * bend)])
        M = A.T @ (loads - pull * theta) - slow * w
        return [*rate_of(y[:4], w), *(inverse @ (M - across(w, J @ w)))]

    y = solve_ivp(rates, (0, 1), [0, 0, 0, 1, 0, 1, 4], t_eval=r.t, rtol=1e-9, atol=1e-11,
                  max_step=5e-4).y  # fmt: skip
    place = Rotation.from_quat(y[:4].T).apply(s) + np.array([100, 200, 300])
    assert r["rod.position"] == pytest.approx(place, abs=1e-5)
    assert r.outcome.statistics["steps"] < 200
