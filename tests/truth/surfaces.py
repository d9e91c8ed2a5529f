"""Families of contacts: balls, rollers and points on surfaces of all shapes, and seals."""

from typing import Any

import numpy as np

from .draw import (
    OWN_EVENTS,
    X,
    Z,
    about,
    any_inertia,
    bar_inertia,
    between,
    decades,
    direction,
    dressed,
    given,
    pick,
    rotation,
)
from .families import Drawn, family
from .joints import FAMILIES as FAMILIES
from .scene import Body, Drive, Fn, Grip, Joint, Scene, Seal, Sensor, Spring, Torsion, Touch

LAWS = ("impact", "impact", "lankarani_nikravesh", "hunt_crossley", "flores", "identified")


def grip(rng: Any, name: str, m: float, v: float, size: float, shape: str, ball: float) -> Grip:
    """A law under which a mass m at speed v goes in by a small part of the size."""
    n = pick(rng, 1.0, 1.5, 1.5, 1.5, 2.0)
    deep = size * decades(rng, 1e-3, 2e-2)
    K = (n + 1) / 2 * m * v * v / deep ** (n + 1)
    law = Grip(name, K, n, pick(rng, *LAWS))
    if law.normal == "impact":
        law.ramp = deep * between(rng, 0.05, 1.0)
        law.damping = pick(rng, 0.0, m * v / deep * decades(rng, 1e-2, 1.0))
    else:
        law.restitution = between(rng, 0.3, 1.0)
    law.friction = pick(rng, "none", "modified_coulomb", "modified_coulomb", "sticking")
    if law.friction == "sticking" and shape == "sphere":
        law.friction = "modified_coulomb"
    law.mu = between(rng, 0.05, 0.8)
    law.v0 = pick(rng, 0.0, 0.0, v * decades(rng, 1e-3, 1e-2))
    law.v1 = law.v0 + v * decades(rng, 1e-2, 0.3)
    law.mu_s = law.mu * pick(rng, 1.0, between(rng, 1.0, 1.5))
    law.v_s = v * decades(rng, 1e-2, 0.3)
    law.sigma0 = 1 / deep * decades(rng, 0.1, 3.0)
    law.sigma1 = law.sigma0 * deep / v * pick(rng, 0.0, decades(rng, 0.1, 1.0))
    return law


def convex(rng: Any, size: float) -> list[tuple[float, float]]:
    """Corners round a middle, anticlockwise."""
    n = int(rng.integers(3, 7))
    while True:
        turn = np.sort(rng.uniform(0, 2 * np.pi, n))
        gaps = np.diff([*turn, turn[0] + 2 * np.pi])
        if gaps.max() < 2.4 and gaps.min() > 0.5:
            return [(float(size * np.cos(a)), float(size * np.sin(a))) for a in turn]


def on_a_surface(
    rng: Any, s: Scene, i: str, j: str, at: np.ndarray, ball: float, law: str
) -> Touch:
    """A contact whose surface is somewhere about `at`, without its ball; its place comes later."""
    Q = about(Z, between(rng, 0, 6.28)) if s.flat else rotation(rng)
    shapes = ["plane", "cylinder", "polygon", "line", "ellipse"] + (
        ["sphere"] * 2 if not s.flat else []
    )
    f = Touch("touch", i, j, at, Q, at.copy(), ball, law, pick(rng, *shapes))
    f.hollow = bool(rng.random() < 0.4) and f.shape not in ("plane", "line")
    R = ball * between(rng, 2.5, 6) + 0.2
    if f.shape in ("sphere", "cylinder"):
        f.radius = R
    if f.shape == "ellipse":
        f.other = (R, R * between(rng, 0.6, 0.95))
    if f.shape == "polygon":
        f.points = convex(rng, R * 1.6)
        f.radius = ball * between(rng, 1.05, 1.4) + 0.02 if f.hollow else 0.1 * R
    if f.shape == "line":
        x = np.cumsum(rng.uniform(0.5, 1.0, 4)) * R
        y = -0.15 * R * (np.arange(4) - 1.5) ** 2  # arched: a ball on it touches one place
        f.points = [(float(a), float(b)) for a, b in zip(x - x.mean(), y, strict=True)]
    return f


def place_ball(rng: Any, f: Touch, flat: bool, gap: float) -> np.ndarray:
    """Where a ball is that is a gap away from the surface, and the way from the surface there."""
    from . import touches as t
    from .grips import SHAPES
    from .touches import distance

    p = np.zeros((1, t.WIDTH))
    p[0, [t.SHAPE, t.RADIUS, t.FREE, t.BALLS]] = SHAPES[f.shape], f.radius, 1 - 2 * f.hollow, f.ball
    p[0, t.ROUND] = f.radius if f.shape == "polygon" else 0.0
    if f.shape == "ellipse":
        p[0, [t.RADIUS, t.OTHER]] = f.other
    core = f.core()
    p[0, t.LAST] = len(core)
    table = np.array([[*q, 0, 0, 0] for q in core], float).reshape(-1, 5)
    far = 2.0 * max([1.0, f.radius, *f.other, *[abs(c) for q in f.points for c in q]])
    for _ in range(10000):
        x = rng.uniform(-1, 1, 3) * far
        if f.shape == "line":
            x[1] = abs(x[1])
        if flat:
            x[2] = 0.0
        s, n = distance(p, 0, table, *x)
        x = x + (f.ball + gap - s) * np.array(n)
        s, n = distance(p, 0, table, *x)
        if abs(s - f.ball - gap) < 1e-9 and (f.shape != "line" or x[1] > f.points[1][1]):
            return f.at + f.axes.T @ x, f.axes.T @ np.array(n)
    raise ValueError("no place for the ball")


@family
def surface_contact(rng: Any) -> Drawn:
    kind = pick(rng, "ball", "ball", "both", "arm", "carrier", "cam")
    flat = bool(rng.random() < 0.4)
    s = Scene(end=1.0, flat=flat)
    level = np.array([1, 1, 0.0]) if flat else np.ones(3)
    spins = np.array([0, 0, 1.0]) if flat else np.ones(3)
    ball, v = decades(rng, 0.03, 0.3), decades(rng, 0.3, 3.0)
    m = decades(rng, 0.3, 3.0)
    i, base = "ground", None
    if kind in ("both", "carrier", "cam"):
        base = Body("base", decades(rng, 0.3, 5.0), np.eye(3), np.zeros(3))
        base.inertia = (
            base.mass * any_inertia(rng, 1.0, 0.6) if not flat else 0.2 * base.mass * np.eye(3)
        )
        s.bodies.append(base)
        i = "base"
    I = any_inertia(rng, m, 2 * ball) if rng.random() < 0.3 else 0.4 * m * ball**2 * np.eye(3)
    if flat:
        I = 0.5 * m * ball**2 * np.eye(3)
    at = rng.uniform(-0.3, 0.3, 3) * level
    f = on_a_surface(rng, s, i, "ball", at, ball, "law")
    if rng.random() < 0.15 and f.shape != "line" and (f.shape != "polygon" or not f.hollow):
        f.ball = ball = 0.0 if f.shape != "ellipse" else ball
    law = grip(rng, "law", m, v, max(f.ball, 0.1), f.shape, f.ball)
    s.laws.append(law)
    if law.friction == "modified_coulomb" and f.ball and rng.random() < 0.5:
        law.mu = max(law.mu, 0.05)
        f.rolling = pick(rng, 0.0, 0.05 * f.ball)
        f.spinning = pick(rng, 0.0, 0.3 * f.ball) if not flat else 0.0
    f.centre, out = place_ball(rng, f, flat, 0.02 + 0.3 * decades(rng, 0.01, 1.0) * 0.3)
    if rng.random() < 0.5:
        s.bodies.append(Body("ball", m, I, f.centre.copy()))
    else:  # its centre is not the body's
        s.bodies.append(
            Body("ball", m, I, f.centre + 0.3 * max(f.ball, 0.1) * direction(rng) * level)
        )
    if flat and rng.random() < 0.2:
        f.axes = np.array([f.axes[0], f.axes[1], f.axes[2]])
    s.forces.append(f)
    g = v * v / (2 * max(f.ball, 0.1)) * between(rng, 0.1, 1.0)
    if rng.random() < 0.8:
        s.gravity = -g * out if rng.random() < 0.6 else g * direction(rng) * level
        if flat:
            s.gravity *= level
    if kind in ("arm",):
        tip = f.centre
        root = tip + (0.6 + 0.5 * rng.random()) * direction(rng) * level
        if flat:
            s.joints.append(Joint("hinge", "revolute", "ground", "ball", root, Z))
        else:
            s.joints.append(
                Joint(
                    "hinge",
                    pick(rng, "spherical", "revolute"),
                    "ground",
                    "ball",
                    root,
                    direction(rng),
                )
            )
        if s.joints[-1].type == "spherical":
            s.joints[-1].axis = None
    if kind in ("carrier", "cam"):
        a = Z if flat else direction(rng)
        pivot = at + 0.3 * direction(rng) * level
        s.joints.append(Joint("pivot", "revolute", "ground", "base", pivot, a))
        if kind == "cam":
            rate = v / 0.5 * between(rng, -1, 1)
            s.drives.append(Drive("motor", "pivot", Fn("sine", (0.0, 0.0, 1.0, 0.0, rate)), True))
        else:
            s.forces.append(Torsion("spring", "pivot", decades(rng, 1, 20) * v * v, 0.05))
    if kind in ("arm", "cam", "carrier", "both") and rng.random() < 0.5:
        p = f.centre + 1.0 * out
        s.forces.append(
            Spring("string", "ground", "ball", p * level, f.centre, m * v * v * 4, 0.0, 0.7)
        )
    speeds = []
    for b in s.bodies:
        if b.name == "base":
            speeds.append(
                np.r_[0.3 * v * rng.normal(size=3) * level, 0.5 * v * rng.normal(size=3) * spins]
            )
        else:
            u = -out * v * between(rng, 0.2, 1.0) + v * rng.normal(size=3) * 0.5 * level
            spin = v / max(f.ball, 0.1) * rng.normal(size=3) * spins * pick(rng, 0, 1)
            speeds.append(np.r_[u * level, spin])
    given(s, speeds)
    s.end = between(rng, 0.3, 2.0) / v
    fast = np.sqrt(
        law.K
        * (1.5 if law.exponent > 1 else 1)
        * (0.01 * max(f.ball, 0.1)) ** (law.exponent - 1)
        / m
    )
    dressed(rng, s, 2 * fast, methods=(*OWN_EVENTS, "scipy:RK45"), tight=-9.0)
    if f.shape == "ellipse":
        s.tolerance = max(s.tolerance, 1e-4)
    return Drawn(s)


@family
def seal(rng: Any) -> Drawn:
    """A lid or a free body with a strip that is pressed against a plane, which may move too."""
    flat = bool(rng.random() < 0.3)
    kind = pick(rng, "lid", "lid", "free", "door", "slide")
    s = Scene(end=1.0, flat=flat)
    level = np.array([1, 1, 0.0]) if flat else np.ones(3)
    spins = np.array([0, 0, 1.0]) if flat else np.ones(3)
    m, v, l = decades(rng, 0.3, 3.0), decades(rng, 0.1, 2.0), between(rng, 0.4, 1.2)
    Q = about(Z, between(rng, 0, 6.28)) if flat else rotation(rng)
    x, n = Q[0], Q[1]
    tilt = pick(rng, 0.0, between(rng, -0.3, 0.3))
    along = l * (np.cos(tilt) * x + np.sin(tilt) * n)
    height = decades(rng, 3e-3, 0.1) * l
    i = "ground"
    if kind == "door":
        s.bodies.append(
            Body("base", decades(rng, 1, 5), bar_inertia(3.0, X, 0.3), 0.3 * n - 0.2 * x)
        )
        s.joints.append(
            Joint("pivot", "revolute", "ground", "base", np.zeros(3), Z if flat else direction(rng))
        )
        i = "base"
    least = max(-along @ n, 0.0)
    begin = n * (height * between(rng, 0.3, 1.3) + least) - 0.3 * l * x
    begin = begin + (0 if flat else 0.1 * Q[2])
    middle = begin + 0.5 * along + 0.1 * l * direction(rng) * level
    s.bodies.append(
        Body(
            "lid",
            m,
            bar_inertia(m, along, 0.2) if flat or rng.random() < 0.5 else any_inertia(rng, m, l),
            middle,
        )
    )
    deep = height * between(rng, 0.2, 1.0)
    e = pick(rng, 1.0, 1.2, 1.5, between(rng, 1.0, 3.0))
    load = m * v * v / l / (0.3 * height) * (e + 1) * decades(rng, 0.5, 5.0)
    f = Seal("seal", i, "lid", np.zeros(3), n, begin, begin + along, height, load, deep, e)
    if rng.random() < 0.5:
        f.at = 0.7 * x + (0 if flat else 0.3 * Q[2])
    f.damping = pick(rng, 0.0, deep / v * decades(rng, 0.03, 1.0))
    f.friction = pick(rng, 0.0, between(rng, 0.1, 1.0))
    f.full = v * decades(rng, 0.02, 0.3)
    if rng.random() < 0.3:
        f.springs = int(rng.integers(1, 9))
    s.forces.append(f)
    if kind == "lid":
        s.joints.append(
            Joint(
                "hinge",
                pick(rng, "revolute", "revolute", "spherical"),
                "ground",
                "lid",
                begin - 0.1 * l * x * pick(rng, 1, -12) + 0.1 * n,
                Z if flat else (Q[2] if rng.random() < 0.7 else direction(rng)),
            )
        )
        if s.joints[-1].type == "spherical":
            s.joints[-1].axis = None
        elif rng.random() < 0.6:
            s.sensors.append(Sensor("turn", "hinge"))
    if kind == "slide":
        a = n + 0.7 * direction(rng) * level
        s.joints.append(Joint("rail", "prismatic", "ground", "lid", middle, a / np.linalg.norm(a)))
    if rng.random() < 0.6:
        s.forces.append(
            Spring(
                "back", "ground", "lid", middle - 0.8 * n, middle, m * v * v / l**2 * 10, 0.0, 0.5
            )
        )
    g = v * v / (2 * height) * between(rng, 0.1, 1.0)
    if rng.random() < 0.7:
        s.gravity = -g * n if rng.random() < 0.5 else g * direction(rng) * level
    given(
        s,
        [
            np.r_[
                (-n * v * between(rng, 0.2, 1) + 0.5 * v * rng.normal(size=3)) * level,
                v / l * rng.normal(size=3) * spins * pick(rng, 0.2, 1.0),
            ]
            for _ in s.bodies
        ],
    )
    s.end = between(rng, 0.1, 0.7) * l / v
    fast = np.sqrt(load * l * e / deep * (height / deep) ** (e - 1) / m)
    dressed(rng, s, 3 * fast, methods=(*OWN_EVENTS, "scipy:RK45"), tight=-9.0)
    if f.friction or f.springs:  # kinks of single places, which nothing locates
        s.tolerance = min(max(s.tolerance, 1e-5), 1e-3)
    return Drawn(s)
