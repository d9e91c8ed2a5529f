"""Torques of an open chain by Newton and Euler's equations, forces of rams by virtual work."""

from pathlib import Path

import numpy as np
import pytest

from tests.runs import run
from trsim.scenario.load import load

VALIDATION = Path(__file__).parents[2] / "scenarios" / "validation"
G = 9.81


def about_y(q):
    c, s = np.cos(q), np.sin(q)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def about_z(q):
    c, s = np.cos(q), np.sin(q)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def tensor(xx, yy, zz, xy=0.0, xz=0.0, yz=0.0):
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


LINKS = (  # mass, inertia, joint and centre of mass as drawn, axis
    (12, tensor(0.20, 0.21, 0.15), [0, 0, 0], [0.02, 0.01, 0.25], [0, 0, 1]),
    (6, tensor(0.02, 0.24, 0.25, 0.003, -0.002, 0.004), [0, 0, 0.5], [0.28, 0.02, 0.5], [0, 1, 0]),
    (3, tensor(0.02, 0.09, 0.08, 0.001, 0.002, -0.003), [0.6, 0, 0.5], [0.82, -0.01, 0.52],
     [0, 1, 0]),
)  # fmt: skip
TIP = np.array([1.1, 0, 0.5])


def motions(t):
    """Angles, rates and second rates of the joints."""
    return (
        (1.2 * np.sin(3 * t), -0.9 * np.sin(2 * t) ** 2, 0.8 * (1 - np.cos(4 * t))),
        (3.6 * np.cos(3 * t), -1.8 * np.sin(4 * t), 3.2 * np.sin(4 * t)),
        (-10.8 * np.sin(3 * t), -7.2 * np.cos(4 * t), 12.8 * np.cos(4 * t)),
    )


def torques(t):
    """Newton and Euler: outwards the motion, inwards forces and moments at the joints."""
    R, w, alpha = np.eye(3), np.zeros(3), np.zeros(3)
    place, a, before = np.zeros(3), np.zeros(3), np.zeros(3)
    links = []
    for (m, I, joint, centre, axis), q, rate, second in zip(LINKS, *motions(t), strict=True):
        arm = R @ (np.array(joint) - before)
        a = a + np.cross(alpha, arm) + np.cross(w, np.cross(w, arm))
        place, before = place + arm, np.array(joint)
        u = R @ np.array(axis)
        alpha = alpha + second * u + np.cross(w, rate * u)
        w = w + rate * u
        R = R @ (about_z(q) if axis[2] else about_y(q))
        c = R @ (np.array(centre) - before)
        a_c = a + np.cross(alpha, c) + np.cross(w, np.cross(w, c))
        I_world = R @ I @ R.T
        N = I_world @ alpha + np.cross(w, I_world @ w)
        links.append((u, place, place + c, m * (a_c + np.array([0, 0, G])), N))
    tip = place + R @ (TIP - before)
    load = np.array([0, 0, -20.0])
    found = []
    for k in range(3):
        u, pivot = links[k][:2]
        moment = -np.cross(tip - pivot, load)
        for _, _, c, F, N in links[k:]:
            moment = moment + N + np.cross(c - pivot, F)
        found.append(u @ moment)
    return found


def test_robot_arm():
    r = run(load(VALIDATION / "robot_arm.yaml"))
    known = np.array([torques(t) for t in r.t])
    found = np.column_stack([r[f"{name}_motor.force"] for name in ("base", "shoulder", "elbow")])
    print(found[100], np.abs(found - known).max())
    assert found == pytest.approx(known, abs=1e-9)
    assert found[100] == pytest.approx([-23.6526, -46.4926, -13.7272], abs=1e-4)
    assert r.outcome.statistics["evaluations"] <= 4 * len(r.t)
    dynamic = run(
        load(VALIDATION / "robot_arm.yaml", ["solver.method=dop853", "solver.tolerance=1e-11"])
    )
    assert dynamic["elbow_motor.force"] == pytest.approx(known[:, 2], abs=1e-6)


# --- excavator ---------------------------------------------------------------------------------

A, C, D, E, F, H = map(
    np.array, ([0, 0], [4.5, 2.0], [5.5, -0.6], [5.3, 0.0], [5.9, 0.2], [6.0, -0.5])
)
BOOM, STICK, BUCKET = (
    ([0.6, -0.5], [2.0, 1.6]), ([2.6, 2.4], [4.4, 2.9]), ([4.8, 1.9], [5.9, 0.2])
)  # fmt: skip
MASSES = (900, 450, 300, 30, 25)
INERTIAS = (1600, 420, 60, 1.5, 1.2)
CENTRES = np.array([[2.3, 1.3], [4.9, 0.9], [5.9, -1.1], [5.6, 0.1], [5.95, -0.15]])
TOOTH = np.array([6.4, -1.6])


def turned(q, p, about, to):
    """A point p of a body, as drawn, that has turned by q about a point that is now at `to`."""
    c, s = np.cos(q), np.sin(q)
    x, y = np.asarray(p) - about
    return np.array([c * x - s * y, s * x + c * y]) + to


def opened(pivot, fixed, moving, more):
    """How far the second point has turned about the pivot with its ram longer by `more`."""
    u, v = np.asarray(fixed) - pivot, np.asarray(moving) - pivot
    drawn = np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v)
    a, b = np.hypot(*u), np.hypot(*v)
    length = np.hypot(*(v - u)) + more
    return np.sign(drawn) * np.arccos((a * a + b * b - length**2) / (2 * a * b)) - drawn


def way(p, q):
    return np.arctan2(*(q - p)[::-1])


def pose(strokes):
    """x, y and angle of the bodies, and the place of the tooth, by triangles."""
    boom = opened(A, *BOOM, strokes[0])
    stick = opened(C, *STICK, strokes[1])
    rocker = opened(E, *BUCKET, strokes[2])
    # in the axes of the stick: where circles about F and D meet
    f = turned(rocker, F, E, E)
    a, b = np.hypot(*(H - F)), np.hypot(*(H - D))
    d = np.hypot(*(D - f))
    along = (d * d + a * a - b * b) / (2 * d)
    across = np.sqrt(a * a - along * along)
    x = (D - f) / d
    h = f + along * x + across * np.array([-x[1], x[0]])
    side = np.cross([*(D - F), 0], [*(H - F), 0])[2]
    if side < 0:
        h = f + along * x - across * np.array([-x[1], x[0]])
    rod, bucket = way(f, h) - way(F, H), way(D, h) - way(D, H)
    own = [(0, A, A), (0, C, C), (bucket, D, D), (rocker, E, E), (rod, F, f)]
    places = [turned(q, p, about, to) for (q, about, to), p in zip(own, CENTRES, strict=True)]
    tooth = turned(bucket, TOOTH, D, D)
    places = [places[0], *(turned(stick, p, C, C) for p in [*places[1:], tooth])]
    places = [turned(boom, p, A, A) for p in places]
    angles = np.array([0, stick, stick + bucket, stick + rocker, stick + rod]) + boom
    return np.concatenate([np.array(places).ravel(), angles])


def strokes(t):
    return np.array([0.35 * np.sin(0.8 * t), 0.15 * (1 - np.cos(t)), 0.08 * np.sin(1.5 * t)])


def second(f, t, h=2e-3):
    """f'' by differences of order 6."""
    w = {0: -49 / 18, 1: 1.5, 2: -0.15, 3: 1 / 90}
    return sum(w[abs(k)] * f(t + k * h) for k in range(-3, 4)) / h**2


def by_virtual_work(t):
    """P_k dl_k + sum of (m (g - a) . dr - I alpha dtheta) + L . d(tooth) = 0 for every ram k."""
    a = second(lambda time: pose(strokes(time)), t)
    load = 4000 * (1 + np.sin(2 * t)) * np.array([-3, 1]) / np.sqrt(10)
    force = np.zeros(17)
    for i in range(5):
        force[2 * i : 2 * i + 2] = MASSES[i] * (np.array([0, -G]) - a[2 * i : 2 * i + 2])
        force[12 + i] = -INERTIAS[i] * a[12 + i]
    force[10:12] = load
    found = []
    for k in range(3):
        e = 1e-5 * np.eye(3)[k]
        l = strokes(t)
        change = (8 * (pose(l + e) - pose(l - e)) - (pose(l + 2 * e) - pose(l - 2 * e))) / 12e-5
        found.append(-force @ change)
    return found


def test_excavator_arm():
    r = run(load(VALIDATION / "excavator_arm.yaml"))
    known = np.array([by_virtual_work(t) for t in r.t[::3]])
    found = np.column_stack([r[f"{name}_ram.force"] for name in ("boom", "stick", "bucket")])
    print(found[100], np.abs(found[::3] - known).max(), np.abs(known).max())
    assert found[::3] == pytest.approx(known, abs=1e-5 * np.abs(known).max())
    assert found[100] == pytest.approx([43171.7, -28412.2, -11558.5], abs=0.1)
    assert r["bucket_ram.position"] == pytest.approx(0.08 * np.sin(1.5 * r.t), abs=1e-12)
    assert r.outcome.statistics["evaluations"] <= 4 * len(r.t)
