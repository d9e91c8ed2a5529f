"""The families of scenes: each a function of random numbers."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .draw import (
    OWN_EVENTS,
    X,
    Y,
    Z,
    about,
    any_inertia,
    bar_inertia,
    between,
    chain,
    consistent,
    decades,
    direction,
    dressed,
    extras,
    given,
    gravity,
    in_plane,
    pick,
    rotation,
)
from .one import Carried, OneAngle
from .scene import (
    Bar,
    Body,
    Bushing,
    Drive,
    Event,
    Fn,
    Joint,
    Law,
    Limit,
    Load,
    Scene,
    Section,
    Sensor,
    Spring,
    Torsion,
    Wall,
    Writer,
)

ENGINE, RIGID, INVALID, TIGHT_RUN, ONE = "engine", "rigid", "invalid", "tight", "one"


@dataclass
class Drawn:
    """A scene, and how it is judged."""

    scene: Scene
    by: str = ENGINE
    forces: bool = True  # reactions are unique, and compared
    truth: Callable[[Scene], Any] | None = None  # where `by` is ONE
    begins: tuple[float, bool] = (0.0, False)  # when the motion begins, and whether drives let go


Family = Callable[[Any], Drawn]
FAMILIES: dict[str, Family] = {}


def family(f: Family) -> Family:
    FAMILIES[f.__name__] = f
    return f


@family
def chain_planar(rng: Any) -> Drawn:
    n = int(rng.integers(1, 5))
    s = chain(rng, n, True, lambda k: "prismatic" if rng.random() < 0.15 else "revolute")
    w = between(rng, 0, 6)
    extras(rng, gravity(rng, consistent(s, rng, w)))
    s.end = between(rng, 1.0, 4.0) * 2 / (2 + w)
    return Drawn(dressed(rng, s, 12.0 + 2 * w))


@family
def chain_spatial(rng: Any) -> Drawn:
    kinds = ("revolute", "revolute", "spherical", "universal", "prismatic", "fixed")
    n = int(rng.integers(1, 5))
    s = chain(rng, n, False, lambda k: pick(rng, *kinds))
    if all(j.type == "fixed" for j in s.joints):
        s.joints[0].type, s.joints[0].axis = "revolute", direction(rng)
        s.sensors = [Sensor("x0", "j0")]
    w = between(rng, 0, 6)
    extras(rng, gravity(rng, consistent(s, rng, w)))
    s.end = between(rng, 1.0, 4.0) * 2 / (2 + w)
    return Drawn(dressed(rng, s, 15.0 + 3 * w))


def link(s: Scene, rng: Any, name: str, a: Any, b: Any) -> None:
    a, b = np.asarray(a, float), np.asarray(b, float)
    m = decades(rng, 0.2, 2.0)
    middle = a + (b - a) * between(rng, 0.4, 0.6)
    s.bodies.append(Body(name, m, bar_inertia(m, b - a, 0.15), middle))


def hinge(
    s: Scene, name: str, i: str, j: str, at: Any, axis: Any = Z, sensor: bool = False
) -> None:
    s.joints.append(Joint(name, "revolute", i, j, np.asarray(at, float), np.asarray(axis, float)))
    if sensor:
        s.sensors.append(Sensor(f"at_{name}", name))


def four_bar(rng: Any, extra: int = 0) -> Scene:
    """A crank-rocker of random lengths, well away from its dead centres, drawn anywhere."""
    s = Scene(end=2.0, flat=True)
    while True:
        a, b, c, d = rng.uniform([0.2, 0.8, 0.6, 0.8], [0.4, 1.4, 1.2, 1.2])
        if a + max(b, c, d) < 0.93 * (b + c + d - max(b, c, d)):
            break
    th = between(rng, 0, 6.28)
    A, D = a * np.array([np.cos(th), np.sin(th), 0]), d * X
    e = D - A
    l = np.linalg.norm(e)
    x = (b * b - c * c + l * l) / (2 * l)
    B = A + x * e / l + np.sqrt(b * b - x * x) * np.cross(Z, e / l)
    link(s, rng, "crank", np.zeros(3), A)
    link(s, rng, "rod", A, B)
    link(s, rng, "rocker", D, B)
    hinge(s, "O", "ground", "crank", np.zeros(3), sensor=True)
    hinge(s, "A", "crank", "rod", A)
    hinge(s, "B", "rod", "rocker", B, sensor=True)
    hinge(s, "D", "ground", "rocker", D, sensor=True)
    return s


def slider_crank(rng: Any) -> Scene:
    s = Scene(end=2.0, flat=True)
    r, l = between(rng, 0.2, 0.4), between(rng, 0.7, 1.3)
    th, off = between(rng, 0, 6.28), between(rng, -0.2, 0.2)
    A = r * np.array([np.cos(th), np.sin(th), 0])
    B = np.array([A[0] + np.sqrt(l * l - (A[1] - off) ** 2), off, 0])
    link(s, rng, "crank", np.zeros(3), A)
    link(s, rng, "rod", A, B)
    s.bodies.append(Body("slider", decades(rng, 0.2, 2), 0.02 * np.eye(3), B))
    hinge(s, "O", "ground", "crank", np.zeros(3), sensor=True)
    hinge(s, "A", "crank", "rod", A)
    hinge(s, "B", "rod", "slider", B)
    s.joints.append(Joint("guide", "prismatic", "ground", "slider", B, X))
    s.sensors.append(Sensor("stroke", "guide"))
    return s


def motion(rng: Any, s: Scene, w: float) -> Scene:
    """Driven, or let go with a speed."""
    how = rng.random()
    if how < 0.35:
        fn = Fn("sine", (0.0, 0.0, 1.0, 0.0, pick(rng, -1, 1) * w))
        if rng.random() < 0.5:
            fn = Fn("area", (w, 0.0, between(rng, 0.2, 0.5)))
        rate = float(fn.p[4]) if fn.kind == "sine" else 0.0
        spin = [np.zeros(6) for _ in s.bodies]
        s.drives.append(Drive("motor", s.joints[0].name, fn, by_rate=True))
        if rate:
            given(s, spin)
        return s
    if how < 0.5:
        c = 0.3
        fn = Fn("sine", (0.0, 0.0, 1.0, 0.0, w))
        s.drives.append(Drive("motor", s.joints[0].name, fn, True, decades(rng, 10, 300), c))
        return given(s, [np.zeros(6) for _ in s.bodies])
    return consistent(s, rng, w)


@family
def loop(rng: Any) -> Drawn:
    kind = pick(rng, "four", "slider", "five", "space")
    w = between(rng, 1, 8)
    if kind == "four":
        s = motion(rng, four_bar(rng), w)
    elif kind == "slider":
        s = motion(rng, slider_crank(rng), w)
    elif kind == "five":
        s = Scene(end=2.0, flat=True)
        P = [
            np.array(p, float)
            for p in ((0, 0, 0), (0.3, 0.7, 0), (0.9, 1.1, 0), (1.5, 0.6, 0), (1.4, 0, 0))
        ]
        P = [p + rng.uniform(-0.1, 0.1, 3) * [1, 1, 0] for p in P]
        for k in range(4):
            link(s, rng, f"b{k}", P[k], P[k + 1])
        for k in range(5):
            i = "ground" if k == 0 else f"b{k - 1}"
            j = f"b{k}" if k < 4 else "ground"
            hinge(s, f"j{k}", i, j, P[k], sensor=k < 2)
        s = consistent(s, rng, 0.5 * w)
    else:  # a crank and a rocker about any axes, and a rod with two balls
        s = Scene(end=2.0)
        D = np.array([1.0, 0.2, 0.4]) + rng.uniform(-0.1, 0.1, 3)
        a, c = direction(rng), direction(rng)
        A = 0.25 * np.cross(a, direction(rng))
        B = D + between(rng, 0.6, 0.9) * np.cross(c, direction(rng))
        link(s, rng, "crank", np.zeros(3), A)
        link(s, rng, "rod", A, B)
        link(s, rng, "rocker", D, B)
        s.bodies[0].inertia += 0.02 * np.eye(3)
        hinge(s, "O", "ground", "crank", np.zeros(3), a, True)
        s.joints.append(Joint("A", "spherical", "crank", "rod", A))
        s.joints.append(Joint("B", "spherical", "rod", "rocker", B))
        hinge(s, "D", "ground", "rocker", D, c, True)
        s = consistent(s, rng, 0.5 * w)
        w *= 0.5
    gravity(rng, s)
    s.end = between(rng, 2.0, 6.0) / w
    d = Drawn(dressed(rng, s, 10.0 + 4 * w + 20 * bool(s.drives and s.drives[0].k)))
    d.forces = not s.flat or in_plane(s)
    return d


@family
def redundant(rng: Any) -> Drawn:
    kind = pick(rng, "cranks", "flat", "door", "bennett", "welds", "guides")
    w = between(rng, 1, 6)
    if kind == "cranks":  # three or four cranks of one length on a coupler that keeps its direction
        s = Scene(end=2.0, flat=True)
        r, th = between(rng, 0.3, 0.8), between(rng, 0.3, 2.8)
        e = r * np.array([np.cos(th), np.sin(th), 0])
        n = int(rng.integers(3, 5))
        at = np.cumsum(rng.uniform(0.3, 0.8, n))[:, None] * X
        m = decades(rng, 0.3, 2)
        s.bodies.append(Body("coupler", m, bar_inertia(m, at[-1] - at[0]), at.mean(axis=0) + e))
        for k, p in enumerate(at):
            link(s, rng, f"c{k}", p, p + e)
            hinge(s, f"O{k}", "ground", f"c{k}", p, sensor=k == 0)
            hinge(s, f"A{k}", f"c{k}", "coupler", p + e)
        # stays clear of the flat position, where cranks may go either way
        s.forces.append(Torsion("back", "O0", decades(rng, 40, 200), 0.1))
        s = consistent(s, rng, 0.4)
    elif kind == "flat":
        s = motion(rng, pick(rng, four_bar, slider_crank)(rng), w)
        s.turned = rotation(rng)
    elif kind == "door":  # hinges on one axis
        s = Scene(end=2.0)
        a = direction(rng)
        p = rng.uniform(-0.2, 0.2, 3)
        m = decades(rng, 0.3, 3)
        s.bodies.append(Body("door", m, any_inertia(rng, m, 0.8), p + 0.5 * direction(rng)))
        for k in range(int(rng.integers(2, 4))):
            hinge(s, f"h{k}", "ground", "door", p + (0.6 * k) * a, a, k == 0)
        s = consistent(s, rng, w)
    elif kind == "bennett":
        s = bennett(rng)
        s = consistent(s, rng, 1.5)
    elif kind == "welds":  # a body held twice on the one before
        s = chain(rng, 2, False, lambda k: ("revolute", "fixed")[k])
        s.joints.append(Joint("again", pick(rng, "fixed", "spherical", "prismatic"), "b0", "b1",
                              s.bodies[1].at + 0.1, direction(rng)))  # fmt: skip
        if s.joints[-1].type != "prismatic":
            s.joints[-1].axis = None
        s = consistent(s, rng, w)
    else:  # a slide on two parallel guides
        s = Scene(end=2.0)
        a, m = direction(rng), decades(rng, 0.3, 3)
        s.bodies.append(Body("table", m, any_inertia(rng, m, 0.8), np.zeros(3)))
        for k in range(2):
            at = rng.uniform(-0.5, 0.5, 3)
            s.joints.append(Joint(f"g{k}", "prismatic", "ground", "table", at, a))
        s.sensors.append(Sensor("x", "g0"))
        near = rng.uniform(-0.2, 0.2, 3)
        s.forces.append(Spring("s", "ground", "table", np.ones(3), near,
                               decades(rng, 5, 50)))  # fmt: skip
        s = consistent(s, rng, 0.0, 1.0)
    gravity(rng, s)
    s.end = between(rng, 1.0, 4.0) / np.sqrt(w)
    turned = s.turned
    s = dressed(rng, s, 20.0 + 4 * w + 20 * bool(s.drives and s.drives[0].k))
    if kind == "flat":
        s.turned = turned
    return Drawn(s, forces=False)


def bennett(rng: Any) -> Scene:
    """Four skew hinges: opposite links alike, a / sin(alpha) = b / sin(beta)."""
    al, be = between(rng, 0.4, 0.9), between(rng, 1.0, 1.4)
    a = 0.6
    b = a * np.sin(be) / np.sin(al)
    th = between(rng, 0.8, 2.2)  # joint angles by Bennett's relation
    ph = 2 * np.arctan(np.sin(0.5 * (be + al)) / np.sin(0.5 * (be - al)) / np.tan(th / 2))

    def go(theta: float, l: float, twist: float) -> np.ndarray:
        T = np.eye(4)
        T[:3, :3] = about(Z, theta) @ about(X, twist)
        T[:3, 3] = about(Z, theta) @ (l * X)
        return T

    best: tuple[float, Any] = (1.0, None)
    for q in (ph, -ph, np.pi - ph, np.pi + ph):
        for sign in (1, -1):
            T, frames = np.eye(4), [np.eye(4)]
            for angle, l, twist in (
                (th, a, al),
                (q, b, sign * be),
                (2 * np.pi - th, a, al),
                (2 * np.pi - q, b, sign * be),
            ):
                T = T @ go(angle, l, twist)
                frames.append(T)
            off = float(np.abs(T - np.eye(4)).max())
            best = min(best, (off, frames), key=lambda x: x[0])
    assert best[0] < 1e-9, best[0]
    s, frames = Scene(end=2.0), best[1]
    at = [f[:3, 3] for f in frames[:4]]
    axis = [f[:3, 2] for f in frames[:4]]
    names = ["ground", "l1", "l2", "l3"]
    for k in range(1, 4):
        p, q = at[k], at[(k + 1) % 4]
        m = decades(rng, 0.3, 2)
        s.bodies.append(Body(names[k], m, bar_inertia(m, q - p, 0.2), 0.5 * (p + q)))
    for k in range(4):
        i, j = names[(k - 1) % 4], names[k]
        i, j = names[k], names[(k - 1) % 4]
        hinge(s, f"h{k}", i, j, at[k], axis[k], k == 0)
    return s


@family
def spinning(rng: Any) -> Drawn:
    s = Scene(end=1.0)
    m = decades(rng, 0.2, 5)
    kind = pick(rng, "free", "free", "symmetric", "top", "pair")
    I = any_inertia(rng, m, 1.0)
    if kind in ("symmetric", "top"):
        d = rng.uniform(0.05, 0.5)
        R = rotation(rng)
        I = R @ np.diag([d, d, d * between(rng, 0.3, 1.9)]) @ R.T * m
    w = decades(rng, 1, 100)
    s.bodies.append(Body("top", m, I, rng.uniform(-0.5, 0.5, 3)))
    spin = w * direction(rng)
    if kind == "top":
        p = s.bodies[0].at - 0.3 * R[:, 2]
        s.joints.append(Joint("tip", "spherical", "ground", "top", p))
        spin = w * R[:, 2] + 0.1 * w * direction(rng)
        gravity(rng, s)
    if kind == "pair":
        s.bodies.append(Body("other", m, any_inertia(rng, m, 1.0), rng.uniform(1.0, 1.5, 3)))
        s.joints.append(Joint("ball", "spherical", "top", "other", rng.uniform(0.4, 0.9, 3)))
    v = [
        np.concatenate([rng.normal(size=3) * 0.3 * w, spin * between(rng, 0.5, 1)])
        for _ in s.bodies
    ]
    given(s, v)
    s.end = between(rng, 2, 12) * 6.28 / w
    return Drawn(dressed(rng, s, 3 * w))


@family
def small_inertia(rng: Any) -> Drawn:
    n = int(rng.integers(1, 4))
    s = chain(rng, n, False, lambda k: pick(rng, "revolute", "spherical", "universal"))
    k = int(rng.integers(n))
    b = s.bodies[k]
    if rng.random() < 0.6:  # one principal inertia next to nothing
        R = rotation(rng)
        d = between(rng, 0.02, 0.2)
        b.inertia = R @ np.diag([d, d * between(rng, 0.9, 1.0), decades(rng, 1e-9, 1e-3) * d]) @ R.T
    elif rng.random() < 0.5:
        f = decades(rng, 1e-6, 1e-2)
        b.mass, b.inertia = b.mass * f, b.inertia * f
    else:
        b.inertia = b.inertia * decades(rng, 1e-7, 1e-2)
    consistent(s, rng, 1.0)
    gravity(rng, s)
    s.end = between(rng, 0.3, 1.0)
    return Drawn(dressed(rng, s, 100.0, tight=-8.0, rk4=False))


def rotor(rng: Any, w: float, flat: bool, m: float = 1.0) -> Scene:
    """A balanced rotor on a hinge."""
    s = Scene(end=1.0, flat=flat)
    s.bodies.append(Body("rotor", m, 0.5 * m * np.eye(3) * [0.6, 0.6, 1.0], np.zeros(3)))
    hinge(s, "O", "ground", "rotor", np.zeros(3), sensor=True)
    s.bodies[0].velocity, s.bodies[0].spin = np.zeros(3), w * Z
    s.end = between(rng, 6, 40) * 6.28 / w
    return s


def oscillator(rng: Any, w: float, flat: bool = True) -> Scene:
    """A mass on a slide and a spring."""
    s = Scene(end=between(rng, 3, 12) * 6.28 / w, flat=flat)
    m = decades(rng, 0.5, 2)
    s.bodies.append(Body("mass", m, 0.1 * np.eye(3), np.zeros(3)))
    s.joints.append(Joint("slide", "prismatic", "ground", "mass", np.zeros(3), X))
    s.sensors.append(Sensor("x", "slide"))
    s.forces.append(Spring("spring", "ground", "mass", 10 * X, np.zeros(3), m * w * w, 0.0))
    s.bodies[0].velocity, s.bodies[0].spin = between(rng, 0.3, 1) * w * X * 0.3, np.zeros(3)
    return s


@family
def stops(rng: Any) -> Drawn:
    kind = pick(rng, "rim", "bar", "pendulum", "slider", "bar_space")
    w = decades(rng, 1, 100)
    if kind == "rim":  # touches once a turn
        s = rotor(rng, w, bool(rng.random() < 0.6))
        s.end = between(rng, 3, 16) * 6.28 / w
        th = between(rng, 1.0, 5.0)
        depth = decades(rng, 1e-3, 3e-2)
        n = np.array([np.cos(th), np.sin(th), 0.0])
        k = s.bodies[0].mass * w * w * decades(rng, 1, 100)
        s.forces.append(Wall("rim", "ground", "rotor", (1 - depth) * n, X.copy(), -n, k))
        fast = np.sqrt(k) + w
    elif kind in ("bar", "bar_space"):
        flat = kind == "bar"
        s = Scene(end=1.0, flat=flat)
        m = 1.0
        s.bodies.append(
            Body("bar", m, bar_inertia(m, X, 0.1) if flat else any_inertia(rng, m, 1.0), Y.copy())
        )
        s.gravity = -9.81 * Y
        v = rng.normal(size=3) * [1, 1, 0 if flat else 1]
        spin = pick(rng, -1, 1) * w * 0.5 * (Z if flat else direction(rng))
        s.bodies[0].velocity, s.bodies[0].spin = v, spin
        k = decades(rng, 1e3, 1e5)
        low = between(rng, 0.0, 0.45)
        for a in (-0.5, 0.5):
            name = "left" if a < 0 else "right"
            s.forces.append(Wall(name, "ground", "bar", low * Y, Y + a * X, Y.copy(), k,
                                 between(rng, 0, 10), 1e-3))  # fmt: skip
        s.end = between(rng, 0.3, 0.7)
        fast = np.sqrt(k) * 2 + w
    elif kind == "pendulum":
        s = chain(rng, 1, True, lambda k: "revolute")
        consistent(s, rng, min(w, 8.0))
        gravity(rng, s)
        k = decades(rng, 1e2, 1e4)
        s.forces.append(
            Limit(
                "limit",
                "j0",
                -between(rng, 0.3, 2),
                between(rng, 0.3, 2),
                k,
                between(rng, 0, 3),
                1e-3,
            )
        )
        s.end = between(rng, 1, 3)
        fast = np.sqrt(k / 0.05)
    else:
        w = min(w, 20.0)
        s = oscillator(rng, w, False)
        k = s.forces[0].k * decades(rng, 3, 300)
        amp = float(np.linalg.norm(s.bodies[0].velocity)) / w
        s.forces.append(
            Limit(
                "limit", "slide", None, amp * between(rng, 0.3, 0.97), k, between(rng, 0, 1), 1e-3
            )
        )
        s.end *= 0.5
        fast = np.sqrt(k)
    return Drawn(dressed(rng, s, fast, methods=(*OWN_EVENTS, "scipy:RK45"), tight=-9.0))


@family
def clearance(rng: Any) -> Drawn:
    w = between(rng, 2, 20)
    if rng.random() < 0.5:  # a pendulum in a wide bearing
        s = chain(rng, 1, True, lambda k: "revolute")
        consistent(s, rng, 0.3 * w)
        name = "j0"
        gravity(rng, s)
        s.end = between(rng, 0.3, 0.8)
    else:
        s = slider_crank(rng)
        name = "B"
        fn = Fn("sine", (0.0, 0.0, 1.0, 0.0, w))
        s.drives.append(Drive("motor", "O", fn, by_rate=True))
        given(s, [np.zeros(6) for _ in s.bodies])
        s.end = between(rng, 2, 5) / w
    j = s.joint(name)
    j.clearance, j.law = decades(rng, 1e-3, 1e-2), "pin"
    s.laws.append(Law("pin", decades(rng, 1e5, 3e7), 1.5, between(rng, 0.5, 0.95), 0.05, 1e-3))
    d = Drawn(dressed(rng, s, 2000.0, methods=OWN_EVENTS, tight=-8.0, orient=False))
    d.forces = True
    return d


@family
def events(rng: Any) -> Drawn:
    kind = pick(rng, "rotor", "rotor", "swing", "lock", "release", "set", "end")
    w = decades(rng, 1, 100)
    if kind == "rotor":
        flat = bool(rng.random() < 0.5)
        s = rotor(rng, w, flat)
        s.sensors[0].sign = pick(rng, 1, -1)
        # an arm that swings to and fro once a turn is watched
        crank_slider(rng, s)
        amp = 0.3
        s.events.append(
            Event(
                "hit",
                "y",
                amp * between(rng, -0.95, 0.99),
                pick(rng, "up", "down", "both"),
                record=True,
            )
        )
        s.events.append(
            Event("turns", "at_O", s.sensors[0].sign * between(rng, 3, 30), record=True)
        )
    elif kind == "swing":
        n = int(rng.integers(1, 4))
        s = chain(rng, n, bool(rng.random() < 0.5), lambda k: "revolute")
        consistent(s, rng, min(w, 6))
        gravity(rng, s)
        s.end = between(rng, 1, 3)
        for k in range(n):
            s.events.append(
                Event(
                    f"e{k}",
                    f"x{k}",
                    s.sensors[k].at_start + between(rng, -1, 1),
                    pick(rng, "up", "down", "both"),
                    record=True,
                )
            )
        w = 10.0
    elif kind in ("lock", "end"):
        w = min(w, 20.0)
        s = oscillator(rng, w)
        amp = float(np.linalg.norm(s.bodies[0].velocity)) / w
        value = amp * between(rng, 0.2, 0.95)
        if kind == "lock":
            s.events.append(Event("shut", "x", value, "up", 1, lock=("slide",)))
            s.events.append(
                Event("free", "t", between(rng, 0.4, 0.7) * s.end, "up", unlock=("slide",))
            )
        else:
            s.events.append(
                Event("stop", "x", value, pick(rng, "up", "down"), record=True, end=True)
            )
    elif kind == "release":
        s = chain(rng, int(rng.integers(1, 4)), bool(rng.random() < 0.5), lambda k: "revolute")
        consistent(s, rng, min(w, 6))
        gravity(rng, s)
        s.end = between(rng, 0.6, 1.5)
        s.events.append(
            Event("let", "t", between(rng, 0.2, 0.7) * s.end, "up", release=(s.joints[0].name,))
        )
        if rng.random() < 0.4:
            s.events[0] = replace(
                s.events[0],
                when="x0",
                value=s.sensors[0].at_start + between(rng, 0.1, 1),
                crosses="both",
                times=1,
            )
        w = 10.0
    else:
        w = between(rng, 1, 6)
        s = four_bar(rng)
        s.drives.append(Drive("motor", "O", Fn("area", (w, 0.0, 0.3)), True))
        gravity(rng, s)
        s.end = between(rng, 3, 6) / w
        other = Fn("sine", (0.0, 0.0, 1.0, 0.0, between(rng, -1, 2) * w))
        if rng.random() < 0.5:
            other = Fn("cubic", (0.0, w, between(rng, -1, 1), between(rng, -1, 1)))
        s.events.append(
            Event(
                "gear",
                "at_O",
                between(rng, 0.2, 0.7) * w * s.end,
                "up",
                1,
                record=True,
                set=("motor", other, True),
            )
        )
    d = Drawn(dressed(rng, s, 3 * w + 10, methods=(*OWN_EVENTS, "rk4"), tight=-9.0))
    d.forces = (not s.flat or in_plane(s)) and kind not in ("set", "rotor")
    return d


def crank_slider(rng: Any, s: Scene) -> None:
    """A yoke on the rotor: a slide that goes to and fro as a sine, driven by a light spring."""
    s.bodies.append(Body("yoke", 0.05, 0.01 * np.eye(3), np.array([0.3, 0, 0])))
    w = float(s.bodies[0].spin[2])
    s.joints.append(Joint("way", "prismatic", "ground", "yoke", s.bodies[1].at, Y))
    s.sensors.append(Sensor("y", "way"))
    k = 0.05 * (w * between(rng, 0.9, 1.1)) ** 2
    s.forces.append(Spring("swing", "ground", "yoke", np.array([0.3, 30, 0]), s.bodies[1].at, k))
    s.bodies[1].velocity, s.bodies[1].spin = 0.3 * np.sqrt(k / 0.05) * Y, np.zeros(3)


@family
def sections(rng: Any) -> Drawn:
    kind = pick(rng, "rotor", "chain", "oscillator", "turns")
    w = decades(rng, 1, 100)
    after = 0.0
    if kind == "rotor":
        s = rotor(rng, w, bool(rng.random() < 0.5))
        crank_slider(rng, s)
        names = ["y", "y.rate"]
    elif kind == "oscillator":
        s = oscillator(rng, w, bool(rng.random() < 0.5))
        names = ["x", "x.rate"]
        amp = float(np.linalg.norm(s.bodies[0].velocity)) / w
        s.sensors[0].at_start = amp * between(rng, -0.98, 0.98)
    elif kind == "turns":
        s = rotor(rng, w, bool(rng.random() < 0.5))
        names = ["at_O", "at_O.rate"]
        s.forces.append(
            Torsion("spring", "O", 0.5 * w * w * decades(rng, 0.01, 1), between(rng, 0, 0.02))
        )
        s.sensors[0].at_start = between(rng, -1, 1)
    else:
        n = int(rng.integers(1, 4))
        s = chain(rng, n, bool(rng.random() < 0.5), lambda k: "revolute")
        consistent(s, rng, min(w, 6))
        gravity(rng, s)
        s.end, w = between(rng, 1, 4), 10.0
        names = ["x0", "x0.rate"]
    for k, rate in enumerate((False, True)):
        if rng.random() < 0.3:
            after = between(rng, 0, 0.5) * s.end
        s.sections.append(
            Section(
                f"s{k}",
                names[0],
                pick(rng, "up", "down", "both"),
                (names[0], names[1]),
                rate,
                after=after,
            )
        )
    return Drawn(dressed(rng, s, 3 * w + 10, tight=-9.0))


FUNCTIONS = ("box", "tent", "bell", "table", "pulses", "ramp")


def feature(
    rng: Any, kind: str, size: float, low: float, high: float, of: str, count: int = 3
) -> Fn:
    """A load with something narrow in it between low and high of its argument."""
    width = (high - low) * decades(rng, 1e-3, 0.2)
    at = between(rng, low + 0.1 * (high - low), high - 0.1 * (high - low) - width)
    style = int(rng.integers(2))
    if kind == "box":
        return Fn("box", (size, at, at + width), of, style=style)
    if kind in ("tent", "bell"):
        return Fn(kind, (size, at, 0.5 * width), of)
    if kind == "ramp":
        return Fn("ramp", (size, at, width), of, style=style)
    if kind == "pulses":
        return Fn("pulses", (size, 6.28 * count / (high - low), between(rng, 0.5, 0.999)), of)
    x = np.sort(rng.uniform(low, high, 9))
    x = low + np.cumsum(rng.uniform(0.2, 1, 9)) / 9 * (high - low)
    y = size * np.cumsum(rng.normal(size=9)) / 3
    return Fn("table", (), of, [(float(a), float(b)) for a, b in zip(x, y, strict=True)])


@family
def features(rng: Any) -> Drawn:
    kind = pick(rng, *FUNCTIONS)
    w = decades(rng, 1, 30)
    how = pick(rng, "time", "time", "rotor", "slide", "driven")
    if how == "time":
        s = oscillator(rng, w, bool(rng.random() < 0.5))
        s.end *= 0.5
        f = feature(rng, kind, s.forces[0].k * 0.3, 0.0, s.end, "t", int(rng.integers(1, 6)))
        s.forces.append(Load("load", "mass", X.copy(), f))
    elif how == "rotor":
        s = rotor(rng, w, bool(rng.random() < 0.5))
        s.end = between(rng, 1, 6) * 6.28 / w
        f = feature(
            rng,
            kind,
            0.5 * w * w * 0.05 * pick(rng, 1, -1),
            0.3,
            w * s.end * 0.9,
            "at_O",
            int(rng.integers(1, 12)),
        )
        s.forces.append(Load("load", "rotor", Z.copy(), f, torque=True))
    elif how == "slide":
        s = oscillator(rng, w, bool(rng.random() < 0.5))
        s.end *= 0.5
        amp = float(np.linalg.norm(s.bodies[0].velocity)) / w
        f = feature(rng, kind, s.forces[0].k * amp * 0.3, -amp, amp, "x", int(rng.integers(1, 6)))
        s.forces.append(Load("load", "mass", X.copy(), f))
    else:  # along a driven stroke: the work is the area below it
        s = oscillator(rng, w, bool(rng.random() < 0.5))
        s.forces, s.end = [], 2.0
        v = between(rng, 0.3, 1)
        s.bodies[0].velocity = v * X
        s.drives.append(
            Drive("jack", "slide", Fn("sine", (0.0, 0.0, 1.0, 0.0, v)), bool(rng.random() < 0.5))
        )
        f = feature(rng, kind, 10.0, 0.02, 2 * v, "x", int(rng.integers(1, 6)))
        s.forces.append(Load("load", "mass", X.copy(), f))
        w = 5.0
    return Drawn(dressed(rng, s, 3 * w + 10, tight=-9.0, rk4=False))


@family
def drives(rng: Any) -> Drawn:
    """About every axis and along it, one after another: what they do and what they need."""
    kind = pick(rng, "arm", "arm", "loop", "jump")
    w = between(rng, 1, 10)
    if kind == "jump":  # no motion is true
        s = chain(rng, 1, False, lambda k: pick(rng, "revolute", "prismatic"))
        s.end = 1.0
        a = pick(rng, -1, 1) * between(rng, 0.05, 1.0)
        s.drives.append(
            Drive(
                "jump",
                "j0",
                Fn("box", (a, between(rng, 0.1, 0.8), 2.0), style=int(rng.integers(2))),
            )
        )
        return Drawn(dressed(rng, s, 20.0), by=INVALID)
    if kind == "loop":
        s = motion(rng, pick(rng, four_bar, slider_crank)(rng), w)
        while not s.drives:
            s = motion(rng, pick(rng, four_bar, slider_crank)(rng), w)
    else:
        n = int(rng.integers(1, 4))
        s = chain(
            rng,
            n,
            bool(rng.random() < 0.2),
            lambda k: pick(rng, "revolute", "revolute", "prismatic"),
        )
        if not s.flat:
            axis = direction(rng)
            for k, j in enumerate(s.joints):
                j.axis = pick(rng, direction(rng), X, Y, Z, axis)
                if k and rng.random() < 0.3:
                    j.axis = np.cross(s.joints[k - 1].axis, direction(rng))
        for k, j in enumerate(s.joints):
            amp = between(rng, 0.2, 1.5) * (0.3 if j.slides else 1)
            f = between(rng, 0.5, 1) * w
            law = pick(rng, "sine", "speed", "ramp", "free")
            if law == "free" and k:
                continue
            soft = (
                (decades(rng, 20, 500), between(rng, 0, 1)) if rng.random() < 0.25 else (None, 0.0)
            )
            if law == "ramp":
                fn, by = Fn("area", (amp * f, between(rng, 0, 0.2), between(rng, 0.1, 0.5))), True
            elif law == "sine":
                fn, by = Fn("sine", (amp, amp, f, -np.pi / 2, 0.0)), bool(rng.random() < 0.5)
            else:
                fn, by = Fn("sine", (0.0, 0.0, 1.0, 0.0, amp * f)), bool(rng.random() < 0.5)
            s.drives.append(Drive(f"d{k}", j.name, fn, by, *soft))
        given(s, [np.zeros(6) for _ in s.bodies])
    gravity(rng, s)
    s.end = between(rng, 3, 12) / w
    d = Drawn(dressed(rng, s, 10 + 4 * w + (200 if any(x.k for x in s.drives) else 0)))
    d.forces = not s.flat or in_plane(s) or kind == "arm"
    return d


@family
def welds(rng: Any) -> Drawn:
    """Bodies welded to one another, at any angle, anywhere in a chain."""
    n = int(rng.integers(2, 5))
    flat = bool(rng.random() < 0.4)
    kinds = ["fixed"] * n
    kinds[0] = "revolute" if flat else pick(rng, "revolute", "spherical", "fixed")
    for k in range(1, n):
        if rng.random() < 0.5:
            kinds[k] = "revolute"
    if all(k == "fixed" for k in kinds):
        kinds[1] = "revolute"
    s = chain(rng, n, flat, lambda k: kinds[k])
    if rng.random() < 0.2:  # a free flight of welded bodies
        s.joints.pop(0)
        s.sensors = [x for x in s.sensors if x.joint != "j0"]
    w = between(rng, 0, 6)
    extras(rng, gravity(rng, consistent(s, rng, w)))
    s.end = between(rng, 1.0, 3.0) * 2 / (2 + w)
    return Drawn(dressed(rng, s, 15.0 + 3 * w))


@family
def turns(rng: Any) -> Drawn:
    """Angles over many turns, about any axis, by long steps."""
    w = decades(rng, 1, 300)
    kind = pick(rng, "rotor", "pair", "driven", "limit", "precess")
    s = rotor(rng, w, bool(rng.random() < 0.3))
    if kind == "pair":  # a rotor on a rotor, the other way round
        a = Z if s.flat else direction(rng)
        s.bodies.append(
            Body(
                "second",
                0.3,
                0.05 * np.eye(3),
                np.zeros(3),
                np.zeros(3),
                w * Z - between(rng, 0.5, 2) * w * a,
            )
        )
        hinge(s, "P", "rotor", "second", np.zeros(3), a, True)
        given(s, [np.concatenate([b.velocity, b.spin]) for b in s.bodies])
    elif kind == "driven":
        s.drives.append(
            Drive("motor", "O", Fn("sine", (0.0, 0.0, 1.0, 0.0, w)), bool(rng.random() < 0.5))
        )
    elif kind == "limit":  # a stop after some turns
        after = between(rng, 0.3, 0.8) * w * s.end
        s.forces.append(Limit("limit", "O", None, after, 0.5 * w * w * decades(rng, 0.1, 10)))
    elif kind == "precess":
        a = direction(rng)
        s.flat = False
        s.bodies.append(
            Body(
                "wheel",
                1.0,
                np.eye(3) * 0.1 + 0.1 * np.outer(a, a),
                np.zeros(3),
                np.zeros(3),
                np.zeros(3),
            )
        )
        hinge(s, "P", "rotor", "wheel", np.zeros(3), a, True)
        s.bodies[0].spin = 0.1 * w * Z
        s.bodies[1].spin = 0.1 * w * Z + w * a
    fast = w
    if kind != "limit" or rng.random() < 0.5:
        sensor = pick(rng, *s.sensors)
        s.events.append(Event("far", sensor.name, between(rng, 0.1, 0.7) * w * s.end, record=True))
    if kind == "limit":
        fast = w * 5
    return Drawn(
        dressed(
            rng,
            s,
            2 * fast,
            methods=OWN_EVENTS if s.events or kind == "limit" else None,
            tight=-9.0,
        )
    )


@family
def starts(rng: Any) -> Drawn:
    """From values of joints that are not those of the drawing, and from given speeds."""
    n = int(rng.integers(1, 4))
    flat = bool(rng.random() < 0.4)
    s = chain(rng, n, flat, lambda k: pick(rng, "revolute", "revolute", "prismatic"))
    for j in s.joints:
        # those not named move as well, so all are named
        s.initial[j.name] = between(rng, -0.4, 0.4) if j.slides else between(rng, -2.5, 2.5)
    extras(rng, gravity(rng, s))
    # as drawn is what springs are told by; loads that turn with a body too
    s.forces = [f for f in s.forces if not isinstance(f, Load)]
    s.end = between(rng, 1.0, 3.0)
    return Drawn(dressed(rng, s, 15.0))


@family
def actuators(rng: Any) -> Drawn:
    kind = pick(rng, "jack", "jack", "mount", "rail", "springs")
    if kind == "jack":
        flat = bool(rng.random() < 0.5)
        n = int(rng.integers(1, 3))
        s = chain(rng, n, flat, lambda k: "revolute")
        flatten = np.array([1, 1, 0.0]) if flat else np.ones(3)
        first = s.bodies[0]
        d = first.at - s.joints[0].at
        a = Z if flat else s.joints[0].axis
        side = np.cross(a, d)
        p = first.at + 0.1 * direction(rng) * flatten
        q = (
            p
            + side / np.linalg.norm(side) * between(rng, 0.6, 1.2)
            + 0.2 * direction(rng) * flatten
        )
        amp = 0.1 * np.linalg.norm(d)
        fn = Fn("sine", (0.0, amp, between(rng, 1, 6), 0.0, 0.0))
        if rng.random() < 0.5:
            fn = Fn("area", (amp, 0.1, 0.3))
        soft = (decades(rng, 100, 3000), between(rng, 0, 5)) if rng.random() < 0.5 else (None, 0.0)
        s.drives.append(
            Drive(
                "jack",
                None,
                fn,
                bool(rng.random() < 0.7) or fn.kind == "area",
                *soft,
                ("ground", first.name),
                (q, p),
            )
        )
        given(s, [np.zeros(6) for _ in s.bodies])
        s.end = between(rng, 0.5, 1.5)
        rate = 100.0
    elif kind in ("mount", "rail"):
        s = Scene(end=1.0)
        m = decades(rng, 0.5, 3)
        s.bodies.append(Body("engine", m, any_inertia(rng, m, 1.0), rng.uniform(-0.3, 0.3, 3)))
        for k in range(1 if kind == "mount" else 2):
            kk = decades(rng, 30, 1000) * rng.uniform(0.3, 1, 3)
            if kind == "rail":
                kk[0] = 0.0
            cc = rng.uniform(0, 1, 3) * (kk > 0)
            R = rotation(rng)
            at = rng.uniform(-0.6, 0.6, 3)
            s.forces.append(Bushing(f"m{k}", "ground", "engine", at, R, kk, cc,
                                    rng.uniform(5, 50, 3), rng.uniform(0, 0.3, 3)))  # fmt: skip
        consistent(s, rng, 1.5, 0.5)
        s.end = between(rng, 0.5, 1.5)
        rate = 120.0
    else:
        s = Scene(end=between(rng, 0.5, 1.5))
        n = int(rng.integers(1, 4))
        for k in range(n):
            m = decades(rng, 0.5, 3)
            s.bodies.append(Body(f"b{k}", m, any_inertia(rng, m, 0.5), rng.uniform(-1, 1, 3)))
        for k in range(2 * n):
            j = s.bodies[k % n]
            i = pick(rng, "ground", *(b.name for b in s.bodies if b is not j))
            far = 3 * direction(rng) if i == "ground" else s.body(i).at + 0.2 * direction(rng)
            free = None if rng.random() < 0.5 else between(rng, 0.5, 2)
            near, stiffness = j.at + 0.3 * direction(rng), decades(rng, 10, 300)
            law = (stiffness, between(rng, 0, 2), free, between(rng, -3, 3))
            s.forces.append(Spring(f"s{k}", i, j.name, far, near, *law))
        consistent(s, rng, 2.0, 0.5)
        rate = 80.0
    gravity(rng, s)
    return Drawn(dressed(rng, s, rate))


def carried(s: Scene, name: str, m: float, p: np.ndarray, q: np.ndarray) -> float:
    """A link from p to q with its centre in the middle; its inertia about z."""
    I = bar_inertia(m, q - p, 0.15)
    s.bodies.append(Body(name, m, I, 0.5 * (p + q)))
    return float(I[2, 2])


def parallelogram(rng: Any, begin: float) -> tuple[Scene, list[Carried]]:
    """Two to four cranks of one length under a coupler; flat at 0 and pi."""
    s, of = Scene(end=1.0, flat=True), []
    r = between(rng, 0.3, 0.8)
    at = np.cumsum(rng.uniform(0.4, 0.9, int(rng.integers(2, 5))))[:, None] * X
    if rng.random() < 0.3 and len(at) == 2:
        at[1] = at[0] + r * X  # a rhombus
    e = r * np.array([np.cos(begin), np.sin(begin), 0])
    m = decades(rng, 0.3, 2)
    I = carried(s, "coupler", m, at[0] + e, at[-1] + e)
    of.append(Carried("coupler", m, I, 0.5 * (at[0] + at[-1]), r * X, r * Y, 0.0))
    for k, p in enumerate(at):
        m = decades(rng, 0.3, 2)
        I = carried(s, f"c{k}", m, p, p + e)
        of.append(Carried(f"c{k}", m, I, p, 0.5 * r * X, 0.5 * r * Y, 1.0))
        hinge(s, f"O{k}", "ground", f"c{k}", p)
        hinge(s, f"A{k}", f"c{k}", "coupler", p + e)
    return s, of


def isosceles(rng: Any, begin: float) -> tuple[Scene, list[Carried]]:
    """A slider-crank with rod and crank of one length: singular where both are upright."""
    s, r = Scene(end=1.0, flat=True), between(rng, 0.3, 0.8)
    c, d = np.cos(begin), np.sin(begin)
    A, B = r * np.array([c, d, 0]), np.array([2 * r * c, 0, 0])
    m = rng.uniform(0.3, 2, 3)
    none = np.zeros(3)
    I = carried(s, "crank", m[0], none, A), carried(s, "rod", m[1], A, B)
    of = [
        Carried("crank", m[0], I[0], none, 0.5 * r * X, 0.5 * r * Y, 1.0),
        Carried("rod", m[1], I[1], none, 1.5 * r * X, 0.5 * r * Y, -1.0),
        Carried("slider", m[2], 0.02, none, 2 * r * X, none, 0.0),
    ]
    s.bodies.append(Body("slider", m[2], 0.02 * np.eye(3), B))
    hinge(s, "O0", "ground", "crank", none)
    hinge(s, "A", "crank", "rod", A)
    hinge(s, "B", "rod", "slider", B)
    s.joints.append(Joint("guide", "prismatic", "ground", "slider", B, X))
    return s, of


@family
def singular(rng: Any) -> Drawn:
    """Through and from places where rows depend on one another; chains that start straight."""
    kind = pick(rng, "flat", "flat", "through", "isosceles", "straight")
    w = between(rng, 2, 10)
    if kind == "straight":
        n = int(rng.integers(2, 5))
        d = direction(rng)
        s = chain(rng, n, False, lambda k: pick(rng, "spherical", "revolute", "universal"))
        at = np.zeros(3)
        for b, j in zip(s.bodies, s.joints, strict=True):
            l = between(rng, 0.3, 0.8)
            b.at, j.at = at + 0.5 * l * d, at
            b.inertia = bar_inertia(b.mass, l * d, 0.15)
            at = at + l * d
        s.sensors = []
        gravity(rng, s)
        if rng.random() < 0.5:
            s.gravity = -9.81 * d * pick(rng, 1, -1)
        consistent(s, rng, between(rng, 0.5, 4))
        s.end = between(rng, 0.6, 1.5)
        return Drawn(dressed(rng, s, 25.0))
    begin = 0.0 if kind == "flat" else between(rng, 0.2, 1.3)
    s, of = (isosceles if kind == "isosceles" else parallelogram)(rng, begin)
    gravity(rng, s, between(rng, 0, 6))
    s.sensors.append(Sensor("angle", "O0"))
    one = OneAngle(of, (begin, pick(rng, -1, 1) * w), s.gravity, driven=bool(rng.random() < 0.3))
    if rng.random() < 0.3 and not one.driven:
        one.spring = decades(rng, 0.1, 3)
        s.forces.append(Torsion("spring", "O0", one.spring))
    if one.driven:
        law = Fn("sine", (0.0, 0.0, 1.0, 0.0, one.begin[1]))
        s.drives.append(Drive("motor", "O0", law, bool(rng.random() < 0.5)))
    s.end = between(rng, 3, 10) / w
    s.bodies = [
        replace(b, velocity=x.slope(begin) * one.begin[1], spin=x.k * one.begin[1] * Z)
        for b, x in zip(s.bodies, of, strict=True)
    ]
    d = Drawn(dressed(rng, s, 10 + 4 * w), by=ONE, truth=one.truth)
    return d


@family
def taut(rng: Any) -> Drawn:
    """Movable to first order only, or nearly so."""
    kind = pick(rng, "two", "three", "crank", "nearly", "truss")
    s = Scene(end=between(rng, 0.5, 2), flat=True)
    gravity(rng, s)
    if kind in ("two", "three"):
        n = 2 if kind == "two" else 3
        d = about(Z, between(rng, 0, 6.28)) @ X
        at = [np.zeros(3)]
        for _ in range(n):
            at.append(at[-1] + between(rng, 0.3, 1) * d)
    elif kind == "nearly":  # a chain of three, a little longer than its span
        eps = decades(rng, 1e-3, 5e-2)
        s.flat = True
        a, b = rng.uniform(0.3, 1, 2)
        sag = between(rng, 0.2, 0.6) * np.sqrt(eps)
        at = [np.zeros(3), np.array([a, sag, 0]), np.array([a + b, 1.4 * sag, 0])]
        at.append(np.array([a + b + between(rng, 0.3, 1), 0, 0]))
        n = 3
    elif kind == "truss":  # two bars at an angle: a rigid triangle
        h = decades(rng, 1e-3, 1.0)
        at = [np.zeros(3), np.array([between(rng, 0.3, 1), h, 0]), np.array([1.3, 0, 0])]
        n = 2
    else:  # a parallelogram with a third crank of another length
        r, th = between(rng, 0.4, 0.8), between(rng, 0.5, 2.5)
        e = r * np.array([np.cos(th), np.sin(th), 0])
        at = np.cumsum(rng.uniform(0.3, 0.8, 3))[:, None] * X
        carried(s, "coupler", 1.0, at[0] + e, at[2] + e)
        for k in range(3):
            f = 1.0 if k < 2 else pick(rng, between(rng, 0.4, 0.8), between(rng, 1.2, 1.6))
            foot = at[k] + e - f * e
            carried(s, f"c{k}", 1.0, foot, at[k] + e)
            hinge(s, f"O{k}", "ground", f"c{k}", foot)
            hinge(s, f"A{k}", f"c{k}", "coupler", at[k] + e)
    if kind != "crank":
        for k in range(n):
            link(s, rng, f"b{k}", at[k], at[k + 1])
        for k in range(n + 1):
            i = "ground" if k == 0 else f"b{k - 1}"
            hinge(s, f"j{k}", i, f"b{k}" if k < n else "ground", at[k])
    by = RIGID
    if kind in ("nearly", "truss"):
        by = ENGINE
        if kind == "nearly":
            s.sensors.append(Sensor("x", "j0"))
            consistent(s, rng, 0.3)
    d = Drawn(dressed(rng, s, 60.0, tight=-9.0), by=by)
    d.forces = in_plane(s)
    return d


@family
def bars(rng: Any) -> Drawn:
    """Flexible bars: against a tight run of another method on the same mesh."""
    kind = pick(rng, "pendulum", "cantilever", "tip", "crank", "space", "twist")
    flat = kind not in ("space", "twist")
    s = Scene(end=between(rng, 0.2, 0.6), flat=flat)
    gravity(rng, s)
    d = np.array([np.cos(a := between(rng, 0, 6.28)), np.sin(a), 0]) if flat else direction(rng)
    wave = decades(rng, 20, 150)  # m/s of waves along it
    density, thick = between(rng, 500, 3000), between(rng, 0.02, 0.08)
    bar = Bar("bar", np.zeros(3), d, int(rng.integers(2, 6)), density * wave**2, density, thick)
    s.bodies.append(bar)  # type: ignore[arg-type]
    mass = density * np.pi / 4 * thick**2
    if kind in ("cantilever", "tip", "twist"):
        s.joints.append(Joint("root", "fixed", "ground", "bar", np.zeros(3)))
    elif kind == "space":
        s.joints.append(Joint("root", "spherical", "ground", "bar", np.zeros(3)))
    else:
        hinge(s, "root", "ground", "bar", np.zeros(3), sensor=True)
    if kind in ("tip", "twist"):
        m = mass * between(rng, 0.3, 2)
        centre = d * 1.1 if kind == "tip" else d + 0.2 * np.cross(d, direction(rng))
        s.bodies.append(Body("disc", m, m * 0.02 * np.eye(3), centre))
        s.joints.append(Joint("weld", "fixed", "bar", "disc", d.copy()))
    if kind == "crank":
        m = mass
        s.bodies.append(Body("block", m, m * 0.02 * np.eye(3), d.copy()))
        hinge(s, "pin", "bar", "block", d)
        way = d / np.linalg.norm(d)
        s.joints.append(Joint("guide", "prismatic", "ground", "block", d.copy(), np.cross(Z, way)))
        s.joints = [j for j in s.joints if j.name != "root"]
        s.sensors = [Sensor("x", "guide")]
        q = -0.5 * d
        s.forces.append(Spring("spring", "ground", "bar", q, np.zeros(3), mass * 200.0))
    if rng.random() < 0.5:
        f = Fn("sine", (0.0, mass * 5, between(rng, 5, 20), 0.0, 0.0))
        side = np.cross(Z, d) if flat else direction(rng)
        s.forces.append(Load("push", "bar", side, f, at=d.copy()))
    stiff = 8 * bar.elements * wave
    names = ("auto", "dop853", "radau", "generalized_alpha", "scipy:RK45")
    s = dressed(rng, s, stiff, methods=names, tight=-7.0, loose=-3.0)
    if kind != "twist" and not (flat and not in_plane(s)):
        return Drawn(s, by=TIGHT_RUN)
    # in space a weld to a body would hold the twist, and a hinge too: such bars have none
    return Drawn(s, by=INVALID if kind in ("twist", "pendulum", "crank") else TIGHT_RUN)


@family
def towed(rng: Any) -> Drawn:
    """What is stiff, or strongly damped, and carries little: parts that move on together."""
    s, w, fast = train(rng, 3, 60)
    s.end = between(rng, 0.3, 2) * 6.28 / w
    return Drawn(dressed(rng, s, 3 * fast))


def train(rng: Any, least: float, most: float) -> tuple[Scene, float, float]:
    """A chain that turns with w, and what holds its bodies together, `least` to `most` as fast."""
    flat = bool(rng.random() < 0.5)
    s = chain(rng, int(rng.integers(2, 4)), flat, lambda k: "revolute")
    w = decades(rng, 0.3, 3)
    fast = w * decades(rng, least, most)
    kind = pick(rng, "spring", "damper", "both")
    for k, j in enumerate(s.joints[1:], 1):
        one, other = s.bodies[k - 1], s.bodies[k]
        I = other.mass * float((other.at - j.at) @ (other.at - j.at))
        stiffness = I * fast**2 if kind != "damper" else I * w**2 * between(rng, 0, 2)
        damping = I * fast * between(rng, 0.3, 1) if kind != "spring" else 0.0
        if rng.random() < 0.7:
            s.forces.append(Torsion(f"t{k}", j.name, stiffness, damping))
        else:  # across the joint
            p, q = one.at - j.at, other.at - j.at
            lever = float(np.linalg.norm(np.cross(p, q - p)) / np.linalg.norm(q - p)) + 0.05
            law = stiffness / lever**2, damping / lever**2
            s.forces.append(Spring(f"s{k}", one.name, other.name, one.at, other.at, *law))
    axis = s.joints[0].axis
    given(s, [np.r_[np.cross(w * axis, b.at), w * axis] for b in s.bodies])
    gravity(rng, s, w**2 * 2)
    return s, w, fast


@family
def stiff(rng: Any) -> Drawn:
    """Springs hundreds to thousands of times as fast as the motion, whose vibration dies out: what
    errors of places make of them is larger by the square of that."""
    s, w, fast = train(rng, 100, 3000)
    for f in s.forces:
        if f.c == 0.0:
            f.c = f.k / fast * between(rng, 0.3, 1)
    if rng.random() < 0.3:  # a stop that nothing meets
        j = s.joints[-1].name
        s.forces.append(Limit("stop", j, -1.0, 1.0, s.forces[0].k, ramp=decades(rng, 1e-4, 0.1)))
    s.end = min(between(rng, 0.3, 2) * 6.28 / w, decades(rng, 1000, 10000) / fast)
    dressed(rng, s, 3 * fast, methods=("auto", "radau", "dop853", "scipy:Radau"))
    s.tolerance = decades(rng, 1e-7, 1e-2)
    if s.method == "radau":
        s.settings["formulation"] = pick(rng, "ggl", "index1")
    return Drawn(s)


@family
def kicked(rng: Any) -> Drawn:
    """Springs 10 to 300 times as fast as a chain that meets a soft stop, which kicks them."""
    s, w, fast = train(rng, 10, 300)
    for f in s.forces:
        f.c = max(f.c, f.k / fast * decades(rng, 0.01, 1))
    j = s.joints[0]
    inertia = sum(b.mass * float((b.at - j.at) @ (b.at - j.at)) for b in s.bodies)
    stop = w * decades(rng, 2, 20)
    k, c = inertia * stop**2, inertia * stop * pick(rng, 0.0, between(rng, 0, 0.5))
    s.forces.append(
        Limit("stop", j.name, -2.0, between(rng, 0.05, 1), k, c, ramp=decades(rng, 1e-3, 0.1))
    )
    s.end = min(between(rng, 0.3, 2) * 6.28 / w, decades(rng, 300, 3000) / fast)
    dressed(rng, s, 3 * fast, methods=("auto", "radau", "dop853"))
    s.tolerance = decades(rng, 1e-8, 1e-2)
    if s.method == "radau":
        s.settings["formulation"] = pick(rng, "ggl", "index1")
    return Drawn(s)


@family
def drifting(rng: Any) -> Drawn:
    """Baumgarte's stabilisation instead of projection, from far too slow to nearly stiff rates."""
    kind = pick(rng, "chain_planar", "chain_spatial", "loop", "loop", "redundant", "singular")
    drawn = FAMILIES[kind](rng)
    rate = decades(rng, 3.0, 300.0)
    drawn.scene.rates = rate, rate * pick(rng, 1.0, 1.0, 0.5, 2.0)
    drawn.scene.settings.pop("formulation", None)  # ggl has a stabilisation of its own
    return drawn


@family
def stabilised(rng: Any) -> Drawn:
    """Radau on the stabilised equations, as it solves many bodies; most with a fast vibration whose
    speeds are little more than the tolerance, so that only accelerations tell of it."""
    kind = pick(rng, *4 * ("towed",), "chain_planar", "chain_spatial", "loop", "redundant")
    drawn = FAMILIES[kind](rng)
    s = drawn.scene
    s.method, s.step = "radau", None
    s.tolerance = max(s.tolerance, 1e-10)
    s.settings["formulation"] = "ggl"
    if kind == "towed":
        s.tolerance = decades(rng, 1e-6, 1e-3)
        shaken(rng, s, s.tolerance * decades(rng, 1.0, 300.0))
    return drawn


def shaken(rng: Any, s: Scene, part: float) -> None:
    """Without gravity, and with speeds off those given by a part of the largest."""
    s.gravity = np.zeros(3)
    v = [np.r_[b.velocity, b.spin] for b in s.bodies]
    most = part * float(np.abs(v).max())
    way = np.array([1, 1, 0, 0, 0, 1.0]) if s.flat else np.ones(6)
    given(s, [a + most * way * rng.normal(size=6) for a in v])


@family
def unheld(rng: Any) -> Drawn:
    """No stabilisation: joints open as errors of accelerations add up."""
    kind = pick(rng, "chain_planar", "chain_spatial", "loop", "loop", "redundant", "singular")
    drawn = FAMILIES[kind](rng)
    drawn.scene.settings.pop("formulation", None)
    drawn.scene.settings["stabilisation"] = "none"
    return drawn


@family
def beside(rng: Any) -> Drawn:
    """Bodies at rest beside a motion, to which they are nothing."""
    kind = pick(rng, *6 * ("towed",), "chain_planar", "loop", "redundant", "stops", "clearance")
    drawn = FAMILIES[kind](rng)
    s = drawn.scene
    if kind == "towed":  # errors of a fast vibration, of one body, add up
        s.method = pick(rng, "auto", "dop853", "radau", "radau", "scipy:Radau")
        s.step, s.tolerance = None, decades(rng, 1e-6, 1e-3)
        s.settings.pop("formulation", None)
        if s.method == "radau":
            s.settings["formulation"] = pick(rng, "ggl", "index1")
        shaken(rng, s, decades(rng, 1e-3, 1e-1))
        s.forces = [replace(f, c=0.0) for f in s.forces]
        s.end *= between(rng, 1.0, 4.0)
    write, of = Writer(s), s.bodies[-1]
    count = int(rng.integers(5, 31))
    rest = [replace(of, name=f"rest{k}", velocity=None, spin=None) for k in range(count)]
    s.extra["bodies"] = {b.name: write.body(b) for b in rest}
    if np.any(s.gravity):
        s.extra["joints"] = {
            f"weld{k}": write.joint(Joint(f"weld{k}", "fixed", "ground", f"rest{k}", of.at))
            for k in range(count)
        }
    return drawn
