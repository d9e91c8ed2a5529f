"""Static paths of open chains: one joint driven; springs, stops, contacts, loads on the others."""

from typing import Any

import numpy as np

from .draw import X, Z, between, chain, decades, direction, gravity, pick
from .families import Drawn, family
from .scene import Drive, Fn, Grip, Limit, Load, Scene, Sensor, Spring, Torsion
from .surfaces import FAMILIES as FAMILIES
from .surfaces import on_a_surface, place_ball

STATIC = "static"


def path_of(rng: Any, s: Scene, joint: str, far: float) -> None:
    """A motion of a joint, by place or by rate."""
    s.end = between(rng, 0.5, 2.0)
    fn = pick(
        rng,
        Fn("sine", (0.0, 0.0, 1.0, 0.0, far / s.end)),
        Fn("sine", (0.0, far, between(rng, 1, 6) / s.end, 0.0, 0.0)),
        Fn("cubic", (0.0, far / s.end, 0.3 * far / s.end**2, 0.0)),
    )
    s.drives.append(Drive("motor", joint, fn, bool(rng.random() < 0.5)))


def dress(rng: Any, s: Scene) -> Drawn:
    from .draw import about, rotation

    s.method, s.rows = "static_path", int(pick(rng, 8, 16, 24))
    s.sensors = [Sensor(f"at_{j.name}", j.name) for j in s.joints]
    if rng.random() < 0.6:
        s.scale = tuple(decades(rng, 1e-3, 1e3) for _ in range(3))  # type: ignore[assignment]
    if rng.random() < 0.5:
        s.moved = rng.uniform(-2, 2, 3) * (np.array([1, 1, 0]) if s.flat else 1)
    if not s.flat:
        s.turned = rotation(rng)
    elif rng.random() < 0.6:
        s.turned = about(Z, between(rng, 0, 6.28))
    return Drawn(s, by=STATIC)


@family
def static_path(rng: Any) -> Drawn:
    """Chains with springs and stops, a load that follows t or a joint."""
    flat = bool(rng.random() < 0.5)
    n = int(rng.integers(2, 5))
    s = chain(rng, n, flat, lambda k: "prismatic" if rng.random() < 0.2 else "revolute")
    gravity(rng, s)
    total = sum(b.mass for b in s.bodies)
    for j in s.joints[1:]:
        k = total * 9.81 * decades(rng, 0.5, 5.0) * (1 if j.type == "revolute" else 5)
        s.forces.append(Torsion(f"t_{j.name}", j.name, k, between(rng, 0, 1), between(rng, -1, 1)))
        if rng.random() < 0.6:
            low, high = -decades(rng, 0.01, 0.5), decades(rng, 0.01, 0.5)
            stiff = k * decades(rng, 1, 100)
            s.forces.append(
                Limit(
                    f"stop_{j.name}",
                    j.name,
                    pick(rng, None, low),
                    high,
                    stiff,
                    between(rng, 0, 1),
                    1e-3,
                )
            )
    body = s.bodies[-1]
    level = np.array([1, 1, 0.0]) if flat else np.ones(3)
    if rng.random() < 0.5:
        of = pick(rng, "t", "at_j0", f"at_{s.joints[-1].name}")
        size = total * 9.81 * between(rng, 0.1, 1.0)
        fn = pick(
            rng,
            Fn("sine", (0.0, size, between(rng, 0.5, 2), between(rng, 0, 6), 0.0), of),
            Fn("tent", (size, between(rng, 0.2, 0.8), between(rng, 0.1, 0.4)), of),
        )
        s.forces.append(
            Load(
                "load",
                body.name,
                direction(rng) * level,
                fn,
                pick(rng, "world", body.name),
                body.at + 0.1 * direction(rng) * level,
            )
        )
    if rng.random() < 0.4:
        p = body.at + 0.1 * direction(rng) * level
        s.forces.append(
            Spring(
                "spring",
                "ground",
                body.name,
                p + 1.2 * direction(rng) * level + 0.3 * X,
                p,
                total * 9.81 * decades(rng, 0.3, 3),
            )
        )
    path_of(
        rng,
        s,
        "j0",
        pick(rng, -1, 1) * between(rng, 0.3, 2.5) * (1 if s.joints[0].type == "revolute" else 0.3),
    )
    return dress(rng, s)


@family
def static_cam(rng: Any) -> Drawn:
    """A surface on a driven body pushes a ball on an arm, with friction or without."""
    from .draw import bar_inertia
    from .scene import Body, Joint

    flat = bool(rng.random() < 0.6)
    s = Scene(end=1.0, flat=flat)
    level = np.array([1, 1, 0.0]) if flat else np.ones(3)
    ball = decades(rng, 0.03, 0.2)
    s.bodies.append(Body("cam", 1.0, 0.2 * np.eye(3), 0.1 * direction(rng) * level))
    slides = bool(rng.random() < 0.3)
    a = direction(rng) * level if slides else (Z if flat else direction(rng))
    a /= np.linalg.norm(a)
    s.joints.append(
        Joint(
            "pivot",
            "prismatic" if slides else "revolute",
            "ground",
            "cam",
            0.1 * direction(rng) * level,
            a,
        )
    )
    f = on_a_surface(rng, s, "cam", "arm", np.zeros(3), ball, "law")
    while f.shape in ("ellipse", "line"):  # a thin plate has two sides
        f = on_a_surface(rng, s, "cam", "arm", np.zeros(3), ball, "law")
    gap = pick(rng, 0.0, between(rng, 0.0, 0.05))
    f.centre, out = place_ball(rng, f, flat, gap + 1e-3)
    force = decades(rng, 1, 100)
    deep = ball * decades(rng, 1e-3, 5e-2)
    n = pick(rng, 1.0, 1.5, 2.0)
    law = Grip("law", force / deep**n, n, "impact", damping=between(rng, 0, 1), ramp=0.1 * deep)
    if flat and rng.random() < 0.7:
        law.friction, law.mu = pick(rng, "modified_coulomb", "sticking"), between(rng, 0.02, 0.3)
        law.mu_s, law.sigma0, law.v1, law.v_s = 1.2 * law.mu, 1e3, 1e-3, 1e-2
        if f.shape == "sphere":
            law.friction = "modified_coulomb"
    s.laws.append(law)
    s.forces.append(f)
    across = np.cross(out, Z if flat else direction(rng))
    across /= np.linalg.norm(across)
    arm = 0.5 + 0.5 * rng.random()
    root = f.centre + arm * across
    hinge = np.cross(out, across)
    s.bodies.append(Body("arm", 0.5, bar_inertia(0.5, arm * across, 0.2), 0.5 * (f.centre + root)))
    s.joints.append(Joint("hinge", "revolute", "ground", "arm", root, Z if flat else hinge))
    sign = 1.0 if np.dot(np.cross(Z if flat else hinge, f.centre - root), -out) > 0 else -1.0
    s.forces.append(
        Torsion(
            "back",
            "hinge",
            force * arm * decades(rng, 0.1, 3.0),
            0.1,
            sign * force * arm * between(rng, 0.1, 1.0),
        )
    )
    if rng.random() < 0.5:
        gravity(rng, s, force / 2)
    path_of(rng, s, "pivot", pick(rng, -1, 1) * between(rng, 0.1, 0.8) * (0.3 if slides else 1))
    return dress(rng, s)
