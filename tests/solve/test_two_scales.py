"""A small parallelogram that turns beside a large one, past its flat places twice a turn.

Cranks of length l and a plate that does not turn, all of mass m, in a plane of space:

    J theta'' = 2 m l (g_y cos theta - g_x sin theta),    J = 2 (I + m l^2 / 4) + m l^2

The error norm has one unit of speed.  It was that of the small cranks' turns at the arm of the
large ones; and stages that only the dense output is made of felt what they were off the rows by,
so that rows came out with a plate that turned.
"""

from functools import cache
from itertools import chain
from math import cos, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from trsim.solve.diagnose.doubts import doubts

from ..runs import run
from ..sizes import size

M, G = 1.0, np.array([0.0, 0.0, -9.81])
LARGE = 3.0
TURNED = size(30, 60)  # rad, by the small one in a drawn scene
# all that is compared: extremes of forces, which are chance at flat places, are sought for long
MOTION = "output.channels=['*.velocity', '*.angular_velocity']"


def numbers(v):
    return [float(x) for x in v]


def parallelogram(name, at, l, theta, rate, R):
    """Bodies and joints of one whose feet are 2 l apart."""
    inertia = [0.1 * M * l**2] * 3
    spin, axis = numbers(rate * R[:, 2]), numbers(R[:, 2])
    up = l * np.array([np.cos(theta), np.sin(theta), 0.0])
    v = R @ (rate * np.array([-up[1], up[0], 0.0]))
    feet = [np.array(at) + R @ np.array([x, 0.0, 0.0]) for x in (0.0, 2.0 * l)]
    bodies, joints = [], []
    for k, foot in enumerate(feet):
        bodies.append(
            f"{name}{k}: {{mass: {M}, inertia: {inertia}, at: {numbers(foot + R @ up / 2)}, "
            f"velocity: {numbers(v / 2)}, angular_velocity: {spin}}}"
        )
        for of, i, j, place in (("F", "ground", f"{name}{k}", foot),
                                ("T", f"{name}{k}", f"{name}p", foot + R @ up)):  # fmt: skip
            joints.append(
                f"{name}{of}{k}: {{type: revolute, bodies: [{i}, {j}], at: {numbers(place)}, "
                f"axis: {axis}}}"
            )
    bodies.append(
        f"{name}p: {{mass: {M}, inertia: {inertia}, at: {numbers(sum(feet) / 2 + R @ up)}, "
        f"velocity: {numbers(v)}}}"
    )
    return bodies, joints


def exact(l, theta, rate, R, t):
    """Velocity of the plate and turning rate at times t."""
    x, y, _ = R.T @ G
    angle, w = turned(l, theta, rate, x, y, tuple(t))
    return (R @ (l * w * np.array([-np.sin(angle), np.cos(angle), 0.0 * w]))).T, w


@cache
def turned(l, theta, rate, x, y, times):
    """Angle and rate of the cranks in a gravity of x and y; of both methods the same."""
    J = 2.0 * (0.1 * M * l**2 + M * l**2 / 4.0) + M * l**2
    of = solve_ivp(
        lambda _, u: [u[1], 2.0 * M * l * (y * cos(u[0]) - x * sin(u[0])) / J],
        (0.0, times[-1]), [theta, rate], "DOP853", times, rtol=1e-12, atol=1e-12,
    )  # fmt: skip
    return of.y


def drawn(seed):
    """Text of a scene, and what each of its mechanisms starts with."""
    rng = np.random.default_rng(seed)
    l = 10.0 ** rng.uniform(-3, -1)
    turns = [Rotation.random(random_state=int(k)).as_matrix() for k in rng.integers(1e6, size=2)]
    rate, theta = rng.uniform(1.5, 15.0) / np.sqrt(l), rng.uniform(-0.3, 0.3)
    return scene(l, theta, rate, turns, min(2.0, TURNED / rate), 10.0 ** rng.uniform(-8, -6))


def slow(end):
    """One that turns over slowly: rows between its steps were off the rows of joints by a tenth."""
    turns = [Rotation.random(random_state=k).as_matrix() for k in (3, 9)]
    return scene(0.003, 0.05, 20.0, turns, end, 1e-6)


def scene(l, theta, rate, turns, end, tolerance):
    mechanisms = {
        "a": ([0.0, 0.0, 0.0], l, theta, rate, turns[0]),
        "b": ([5.0, 0.0, 1.0], LARGE, 0.01, 2.0, turns[1]),
    }
    bodies, joints = zip(*(parallelogram(n, *m) for n, m in mechanisms.items()), strict=True)
    text = (
        "planar: false\nbodies:\n  "
        + "\n  ".join(chain(*bodies))
        + "\njoints:\n  "
        + "\n  ".join(chain(*joints))
        + f"\ngravity: {numbers(G)}\nsolver: {{end: {end}, tolerance: {tolerance}}}"
        + f"\noutput: {{every: {end / 200}}}\n"
    )
    return text, mechanisms, tolerance


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("way, of", [(drawn, k) for k in range(size(6, 60))]
                         + [(slow, end) for end in (1.7, 1.9, 2.0)])  # fmt: skip
def test_rows_of_the_small_one_are_right(way, of, method):
    text, mechanisms, tolerance = way(of)
    r = run(text, f"solver.method={method}", MOTION)
    unit = tolerance * np.abs(r["bp.velocity"]).max()
    for name, (_, l, theta, rate, R) in mechanisms.items():
        v, w = exact(l, theta, rate, R, r.t)
        # next to the motion that just comes to rest on top a unit of speed grows a thousandfold
        felt = np.abs(exact(l, theta, rate + unit / l, R, r.t)[0] - v).max()
        allowed = max(100.0 * unit, 10.0 * felt)
        assert np.abs(r[f"{name}p.velocity"] - v).max() < allowed
        assert np.abs(r[f"{name}p.angular_velocity"]).max() * l < 100.0 * unit
        for k in (0, 1):
            off = np.abs(r[f"{name}{k}.angular_velocity"] @ R[:, 2] - w).max()
            assert off * l / 2 < allowed


def test_a_body_too_small_for_the_tolerance_is_told():
    """Its arm is half a crank's length."""
    text, mechanisms, _ = drawn(0)
    arm = mechanisms["a"][1] / 2
    for tolerance in (0.02 * arm / LARGE, 0.005 * arm / LARGE):
        r = run(text, f"solver.tolerance={tolerance}", "solver.end=0.01")
        said = [x for x in doubts(r.scenario, r.mechanism, r.outcome) if "'a0'" in x]
        assert len(said) == (tolerance > 0.01 * arm / LARGE)
        assert all("0.02 rad too far" in x for x in said)
