"""What families have in common: random bodies, directions, speeds, methods, units and axes."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from . import engine as e
from .reference import Builder, start_state
from .scene import Body, Fn, Joint, Load, Scene, Sensor, Spring, Torsion

X, Y, Z = np.eye(3)
METHODS = (
    ("auto", 0.34), ("dop853", 0.14), ("radau", 0.12), ("generalized_alpha", 0.08),
    ("rk4", 0.08), ("scipy:RK45", 0.08), ("scipy:Radau", 0.08), ("scipy:BDF", 0.08),
)  # fmt: skip
# tighter ones would take these methods, of low orders or in Python, too long
TIGHTEST = {
    "generalized_alpha": -4.5, "scipy:RK45": -8.0, "scipy:Radau": -7.0, "scipy:BDF": -6.0,
}  # fmt: skip
OWN_EVENTS = ("auto", "dop853", "radau", "generalized_alpha")


def pick(rng: Any, *choices: Any) -> Any:
    return choices[int(rng.integers(len(choices)))]


def between(rng: Any, a: float, b: float) -> float:
    return float(rng.uniform(a, b))


def decades(rng: Any, a: float, b: float) -> float:
    return float(10.0 ** rng.uniform(np.log10(a), np.log10(b)))


def direction(rng: Any) -> np.ndarray:
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def rotation(rng: Any) -> np.ndarray:
    q, R = rng.normal(size=4), np.empty((3, 3))
    e.rotation(q, R)
    return R


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    R = np.empty((3, 3))
    a = axis / np.linalg.norm(axis)
    e.rotation(np.array([np.cos(angle / 2), *(np.sin(angle / 2) * a)]), R)
    return R


def bar_inertia(m: float, along: np.ndarray, thick: float = 0.1) -> np.ndarray:
    """Of an even bar of some thickness."""
    l2 = float(along @ along)
    return m / 12 * (l2 * np.eye(3) - np.outer(along, along)) + m * l2 * thick**2 * np.eye(3)


def any_inertia(rng: Any, m: float, l: float) -> np.ndarray:
    """Principal ones that a body can have, in any axes."""
    d = rng.uniform(0.02, 1.0, 3)  # second moments of mass
    I = m * l * l * np.diag([d[1] + d[2], d[0] + d[2], d[0] + d[1]]) / 6
    R = rotation(rng)
    return R @ I @ R.T


def consistent(scene: Scene, rng: Any, spin: float, speed: float = 0.0) -> Scene:
    """Velocities that joints allow, next to random ones of this size, written to the last digit."""
    flat = np.array([1, 1, 0, 0, 0, 1.0]) if scene.flat else np.ones(6)
    v = [rng.normal(size=6) * flat * np.repeat([speed, spin], 3) for _ in scene.bodies]
    return given(scene, v)


def given(scene: Scene, v: list[np.ndarray]) -> Scene:
    """These velocities, projected on the joints."""
    bodies = [replace(b, velocity=a[:3], spin=a[3:]) for b, a in zip(scene.bodies, v, strict=True)]
    # drives that give way begin at their speed too
    driven = [replace(d, k=None) for d in scene.drives]
    trial = replace(scene, bodies=bodies, drives=driven, events=[], sections=[])
    b = Builder(trial)
    y = start_state(b)
    from .reference import begun, independent, restricted

    m = restricted(b.arrays, independent(b, y))
    side, _ = begun(b, m, y)
    for _ in range(3):
        e.projected(m, 0.0, y, side)
    n = range(len(bodies))
    y[np.abs(y) < 1e-13] = 0.0
    scene.bodies = [
        replace(bodies[k], velocity=y[13 * k + 7 : 13 * k + 10].copy(),
                spin=y[13 * k + 10 : 13 * k + 13].copy())
        for k in n
    ]  # fmt: skip
    return scene


def chain(rng: Any, n: int, flat: bool, joint: Callable[[int], str], base: str = "ground") -> Scene:
    """n links one after another, each hung on the one before."""
    s = Scene(end=1.0, flat=flat)
    at, before = np.zeros(3), base
    for k in range(n):
        d = direction(rng)
        if flat:
            d[2] = 0.0
            d /= np.linalg.norm(d)
        l, m = between(rng, 0.3, 1.0), decades(rng, 0.2, 3.0)
        middle = at + d * l * between(rng, 0.35, 0.65)
        I = bar_inertia(m, d * l, 0.15) if flat or rng.random() < 0.5 else any_inertia(rng, m, l)
        name, kind = f"b{k}", joint(k)
        s.bodies.append(Body(name, m, I, middle))
        a = Z if flat else direction(rng)
        if kind == "prismatic" and flat:
            a = d
        j = Joint(f"j{k}", kind, before, name, at.copy())
        if kind in ("revolute", "prismatic", "universal"):
            j.axis = a
        if kind == "universal":
            j.second_axis = np.cross(a, direction(rng))
            j.second_axis /= np.linalg.norm(j.second_axis)
        s.joints.append(j)
        if kind in ("revolute", "prismatic"):
            s.sensors.append(Sensor(f"x{k}", j.name, pick(rng, 1, 1, -1), between(rng, -1, 1)))
        at, before = at + d * l, name
    return s


def gravity(rng: Any, s: Scene, size: float = 9.81) -> Scene:
    d = direction(rng)
    if s.flat:
        d[2] = 0.0
    s.gravity = size * between(rng, 0.2, 1.0) * d / np.linalg.norm(d)
    return s


def extras(rng: Any, s: Scene) -> Scene:
    """A few springs, dampers and loads."""
    flat = np.array([1, 1, 0.0]) if s.flat else np.ones(3)
    body = s.bodies[-1]
    if rng.random() < 0.4:
        p = body.at + rng.uniform(-0.1, 0.1, 3) * flat
        q = p + direction(rng) * flat * between(rng, 1.0, 2.0)
        if np.linalg.norm(q - p) < 0.3:
            q = p + 1.2 * X
        k = decades(rng, 1, 50)
        free = None if rng.random() < 0.5 else between(rng, 0.5, 2.0)
        s.forces.append(Spring("spring", "ground", body.name, q, p, k, between(rng, 0, 1), free))
    turning = [j for j in s.joints if j.type == "revolute" and j.clearance is None]
    if turning and rng.random() < 0.3:
        j = pick(rng, *turning)
        s.forces.append(Torsion("torsion", j.name, decades(rng, 0.3, 20), between(rng, 0, 0.3)))
    if rng.random() < 0.4:
        d = direction(rng) * flat
        frame = pick(rng, "world", body.name)
        f = Fn("sine", (0.0, between(rng, 1, 8), between(rng, 1, 6), between(rng, 0, 6), 0.0))
        torque = bool(rng.random() < 0.4)
        d = np.array([0, 0, 1.0]) if torque and s.flat else d
        at = None if torque else body.at + rng.uniform(-0.2, 0.2, 3) * flat
        s.forces.append(Load("load", body.name, d, f, frame, at, torque))
    return s


def dressed(
    rng: Any, s: Scene, rate: float, methods: tuple[str, ...] | None = None,
    orient: bool = True, tight: float = -10.0, loose: float = -2.0, rk4: bool = True,
) -> Scene:  # fmt: skip
    """Method, tolerance, units and axes.  rate: of the fastest motion, 1/s."""
    names = [m for m, _ in METHODS if (methods is None or m in methods) and (rk4 or m != "rk4")]
    weights = np.array([w for m, w in METHODS if m in names])
    s.method = str(rng.choice(names, p=weights / weights.sum()))
    s.tolerance = float(10.0 ** rng.uniform(max(tight, TIGHTEST.get(s.method, -10.0)), loose))
    if s.method == "rk4":
        s.step, s.tolerance = 0.03 / rate, 1e-6
    s.rows = int(pick(rng, 8, 16, 24, 32))
    if rng.random() < 0.6:
        s.scale = tuple(decades(rng, 1e-3, 1e3) for _ in range(3))  # type: ignore[assignment]
    if rng.random() < 0.5:
        s.moved = rng.uniform(-2, 2, 3) * (np.array([1, 1, 0]) if s.flat else 1)
    if orient:
        if not s.flat:
            s.turned = rotation(rng)
        elif rng.random() < 0.6:
            s.turned = about(Z, between(rng, 0, 6.28))
            if rng.random() < 0.6:
                s.turned = rotation(rng)
    return s


def in_plane(s: Scene) -> bool:
    """Whether the text of a flat scene lies in the x-y plane."""
    return bool(abs(s.turned[2, 2] - 1) < 1e-12)
