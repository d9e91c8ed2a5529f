"""The family of joints that hang bodies on each other in any way, and of what gears them.

Chains of one to four bodies by joints of all kinds, named from either body; loops closed by links
and planes; gears, racks, worms and couplers on carriers that stand or move; about any axes.  The
truth is that of screws.py.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from .draw import (
    any_inertia,
    bar_inertia,
    between,
    decades,
    direction,
    dressed,
    gravity,
    pick,
)
from .families import FAMILIES as FAMILIES
from .families import ONE, Drawn, family
from .scene import Body, Fn, Gear, Joint, Load, Scene, Sensor, Spring, Torsion
from .screws import Tree

TELLS = {
    "revolute": ("",), "prismatic": ("",), "cylindrical": (".angle", ".stroke"),
    "screw": (".angle", ".stroke"), "planar": (".angle", ".x", ".y"),
}  # fmt: skip
KINDS = ("inplane", "planar", "parallel", "screw", "constant_velocity", "cylindrical", "inline",
         "revolute", "prismatic", "spherical", "universal", "fixed")  # fmt: skip


FLAT = ("revolute", "planar", "prismatic", "inplane", "inline", "parallel", "spherical")


def level(s: Scene, v: np.ndarray) -> np.ndarray:
    """A vector, of a flat scene its part in the plane."""
    return v * [1, 1, 0] if s.flat else v


def way(rng: Any, s: Scene) -> np.ndarray:
    """A direction; of a flat scene in the plane."""
    v = level(s, direction(rng))
    return v / np.linalg.norm(v)


def across(rng: Any, a: np.ndarray) -> np.ndarray:
    v = np.cross(a, direction(rng))
    return v / np.linalg.norm(v)


def hang(s: Scene, rng: Any, before: str, kind: str, at: np.ndarray, axis: Any = None) -> str:
    """A body on another, by a joint named from either of both; its name."""
    k = len(s.bodies)
    name, m, l = f"b{k}", decades(rng, 0.3, 3.0), between(rng, 0.3, 0.8)
    d = l * way(rng, s)
    I = (
        bar_inertia(m, d, 0.3)
        if s.flat or rng.random() < 0.5
        else any_inertia(rng, m, l) + 0.02 * np.eye(3)
    )
    s.bodies.append(Body(name, m, I, at + 0.5 * d))
    ends = (before, name) if rng.random() < 0.6 else (name, before)
    j = Joint(f"j{k}", kind, *ends, at.copy())
    if kind not in ("spherical", "fixed"):
        j.axis = axis_of(rng, s, kind) if axis is None else axis
    if kind == "planar":
        j.x_axis = across(rng, j.axis)
    if kind == "universal":
        j.second_axis = across(rng, j.axis)
    if kind == "constant_velocity":
        j.second_axis = j.axis + between(rng, 0.4, 0.9) * across(rng, j.axis)
        j.second_axis /= np.linalg.norm(j.second_axis)
    if kind == "screw":
        j.pitch = pick(rng, -1, 1) * decades(rng, 0.05, 3.0)
    s.joints.append(j)
    for own in TELLS.get(kind, ()):
        sensor = Sensor(f"x{k}{own[1:]}", j.name + own, pick(rng, 1, 1, -1), between(rng, -1, 1))
        s.sensors.append(sensor)
    return name


def axis_of(rng: Any, s: Scene, kind: str) -> np.ndarray:
    """Any; of a flat scene one about which, or along which, a body stays in the plane."""
    if s.flat and kind in ("revolute", "planar", "parallel"):
        return np.array([0.0, 0.0, pick(rng, -1.0, 1.0)])
    return way(rng, s)


def held(s: Scene, rng: Any, name: str) -> None:
    """A spring and a load, so that what is free does not fly away."""
    b = s.body(name)
    p = b.at + level(s, rng.uniform(-0.1, 0.1, 3))
    q = p + between(rng, 0.8, 1.6) * way(rng, s)
    k = decades(rng, 3, 40) * b.mass
    s.forces.append(Spring(f"s_{name}", "ground", name, q, p, k, between(rng, 0, 1)))
    if rng.random() < 0.4:
        fn = Fn(
            "sine", (0.0, between(rng, 1, 6) * b.mass, between(rng, 1, 5), between(rng, 0, 6), 0.0)
        )
        frame, torque = pick(rng, "world", name), bool(rng.random() < 0.4)
        at = None if torque else p
        d = np.array([0.0, 0.0, 1.0]) if s.flat and torque else way(rng, s)
        s.forces.append(Load(f"f_{name}", name, d, fn, frame, at, torque))


def finished(s: Scene, rng: Any, w: float, forces: bool = True) -> Drawn:
    gravity(rng, s, 6.0)
    tree = Tree(s)
    y = tree.start(rng.normal(size=tree.n) * w)
    tree.speeds(y)
    s.end = between(rng, 0.5, 1.5)
    dressed(rng, s, 25.0 + 4 * w, tight=-9.0)
    return Drawn(s, ONE, forces, lambda scene: Tree(scene).truth(y, forces))


def chain_of(rng: Any, kinds: Callable[[int], str], n: int, flat: bool = False) -> Scene:
    s = Scene(end=1.0, flat=flat)
    at, before = level(s, rng.uniform(-0.5, 0.5, 3)), "ground"
    for k in range(n):
        before = hang(s, rng, before, kinds(k), at)
        at = 2 * s.bodies[-1].at - at
        held(s, rng, before)
    return s


@family
def joints(rng: Any) -> Drawn:
    """Open chains."""
    s = chain_of(rng, lambda k: pick(rng, *KINDS[: 5 if k == 0 else 12]), int(rng.integers(1, 4)))
    return finished(s, rng, between(rng, 0.3, 1.5))


@family
def joint_loops(rng: Any) -> Drawn:
    """Chains whose last body is held once more: by a link or two, a plane, a direction."""
    n = int(rng.integers(1, 4))
    free = ("spherical", "planar", "parallel", "inplane", "cylindrical", "inline", "universal")
    s = chain_of(rng, lambda k: pick(rng, *free) if k == n - 1 else pick(rng, "revolute", "screw",
                 "cylindrical", "planar", "universal", "constant_velocity"), n)  # fmt: skip
    last, kind = s.bodies[-1], pick(rng, "link", "link", "inplane", "loose")
    p = last.at + rng.uniform(-0.2, 0.2, 3)
    if kind == "inplane":
        ends = ("ground", last.name) if rng.random() < 0.5 else (last.name, "ground")
        s.joints.append(Joint("close", "inplane", *ends, p, direction(rng)))
    else:
        other = pick(rng, "ground", *(b.name for b in s.bodies[:-1]))
        q = p + between(rng, 0.6, 1.2) * direction(rng)
        ends, points = (other, last.name), (q, p)
        if rng.random() < 0.5:
            ends, points = ends[::-1], points[::-1]
        s.joints.append(Joint("close", "link", *ends, points[0], points=points))
    if kind == "loose":  # a bob on two links
        m = decades(rng, 0.3, 2)
        at = last.at + 0.7 * direction(rng)
        s.bodies.append(Body("bob", m, any_inertia(rng, m, 0.4) + 0.02 * np.eye(3), at))
        for k, name in enumerate((last.name, pick(rng, "ground", last.name))):
            near = at + 0.1 * direction(rng)
            far = near + between(rng, 0.6, 1.0) * direction(rng)
            s.joints.append(Joint(f"l{k}", "link", "bob", name, near, points=(near, far)))
        held(s, rng, "bob")
    return finished(s, rng, between(rng, 0.3, 1.2))


@family
def geared(rng: Any) -> Drawn:
    """Wheels, racks and worms on carriers that stand or move, and couplers of any coordinates."""
    kind = pick(rng, "gear", "gear", "rack", "worm", "bevel", "coupler", "planet")
    if kind == "coupler":
        n = int(rng.integers(2, 4))
        s = chain_of(rng, lambda k: pick(rng, *TELLS), n)
        names = [x.joint for x in s.sensors if not x.joint.endswith(".y")]
        count = int(rng.integers(2, min(3, len(names)) + 1))
        chosen = [str(x) for x in rng.choice(names, count, replace=False)]
        screws = {j.name for j in s.joints if j.type == "screw"}
        chosen = [x for x in chosen if x.split(".")[0] not in screws or x.endswith(".angle")]
        if len(chosen) < 2:
            chosen = [names[0], names[-1]]
            chosen = [x.replace(".stroke", ".angle") if x.split(".")[0] in screws else x
                      for x in chosen]  # fmt: skip
        c = tuple(pick(rng, -1, 1) * decades(rng, 0.2, 3.0) for _ in chosen)
        s.gears.append(Gear("g", "coupler", tuple(chosen), coefficients=c))
        return finished(s, rng, between(rng, 0.3, 1.5))
    s, at, carrier = Scene(end=1.0), rng.uniform(-0.5, 0.5, 3), "ground"
    for _ in range(int(rng.integers(3))):
        carrier = hang(s, rng, carrier, pick(rng, "revolute", "cylindrical", "prismatic", "planar",
                                             "screw", "universal"), at)  # fmt: skip
        held(s, rng, carrier)
        at = at + 0.5 * direction(rng)
    a, first = direction(rng), len(s.bodies)
    e = across(rng, a)  # from the first wheel to the second
    f = np.cross(a, e)
    r = (between(rng, 0.1, 0.4), between(rng, 0.1, 0.4))
    hinge = pick(rng, "revolute", "revolute", "cylindrical")
    wheel = hang(s, rng, carrier, hinge, at + between(rng, -0.2, 0.2) * a, pick(rng, -1, 1) * a)
    one = f"j{first}" + (".angle" if hinge == "cylindrical" else "")
    two, b = f"j{first + 1}", pick(rng, -1, 1) * a
    if hinge == "cylindrical":
        held(s, rng, wheel)
    g = Gear("g", "gear", (one, two), touch=at + r[0] * e, way=f)
    if kind in ("gear", "planet"):
        if rng.random() < 0.4:  # one within the other
            g.internal, big = True, max(r) + 0.2
            r = pick(rng, (big, min(r)), (min(r), big))
            g.touch = at + r[0] * (e if r[0] > r[1] else -e)
            middle = at + abs(r[0] - r[1]) * e
        else:
            middle = at + (r[0] + r[1]) * e
        other = hang(s, rng, carrier, "revolute", middle + between(rng, -0.2, 0.2) * a, b)
        how = rng.random()
        if how < 0.5:
            g.radii = r
        else:
            teeth = (int(rng.integers(12, 80)), int(rng.integers(12, 80)))
            g.teeth, share = teeth, teeth[0] / (teeth[0] + teeth[1])
            if not g.internal:
                g.touch = at + share * (r[0] + r[1]) * e
            elif teeth[0] == teeth[1]:
                g.teeth = (teeth[0] + 1, teeth[1])
            if g.internal:
                z = g.teeth
                g.touch = at + abs(r[0] - r[1]) * z[0] / (z[0] - z[1]) * e
        if kind == "planet":  # a third wheel on the second, as in a train
            touch = middle - r[1] * f
            hang(s, rng, carrier, "revolute", middle - (r[1] + 0.3) * f, a)
            more = Gear("g2", "gear", (two, f"j{first + 2}"), radii=(r[1], 0.3), touch=touch, way=e)
            s.gears.append(more)
        del other
    elif kind == "rack":
        g.type, g.radius = "rack_and_pinion", r[0]
        place = g.touch + between(rng, -0.3, 0.3) * f + between(rng, -0.2, 0.2) * a
        rack = hang(s, rng, carrier, "prismatic", place, pick(rng, -1, 1) * f)
        held(s, rng, rack)
    elif kind == "bevel":
        g.teeth = (int(rng.integers(12, 50)), int(rng.integers(12, 50)))
        th = between(rng, 0.6, 2.4)  # between the ways from the apex to the wheels
        way = np.cos(th) * a + np.sin(th) * e
        apex = at
        j = s.joints[-1]
        j.at = apex + 0.3 * a
        # pitch cones: sin d1 / sin d2 = z1 / z2, d1 + d2 = th
        z = g.teeth
        d1 = np.arctan2(np.sin(th), z[1] / z[0] + np.cos(th))
        g.touch = apex + 0.4 * (np.cos(d1) * a + np.sin(d1) * e)
        hang(s, rng, carrier, "revolute", apex + 0.4 * way, pick(rng, -1, 1) * way)
    else:
        g.type, g.hand = "worm", pick(rng, "right", "left", None)
        g.teeth, g.way = (int(rng.integers(1, 5)), int(rng.integers(15, 50))), a
        hang(s, rng, carrier, "revolute", at + (0.05 + r[1]) * e, pick(rng, -1, 1) * f)
        g.touch = at + 0.05 * e
    s.gears.append(g)
    k = s.joint(two)
    if k.type == "revolute":
        s.forces.append(Torsion("back", two, decades(rng, 1, 20), between(rng, 0, 0.3)))
    return finished(s, rng, between(rng, 0.3, 2.0))


@family
def flat_joints(rng: Any) -> Drawn:
    """Chains, loops and gears in a plane: solved as such, or in space where all is turned."""
    n, kind = (
        int(rng.integers(1, 4)),
        pick(rng, "chain", "link", "inplane", "gear", "rack", "coupler"),
    )
    s = chain_of(rng, lambda k: pick(rng, *FLAT), n, flat=True)
    last, z = s.bodies[-1], np.array([0.0, 0.0, 1.0])
    p = last.at + level(s, rng.uniform(-0.2, 0.2, 3))
    ends = ("ground", last.name)[:: pick(rng, -1, 1)]
    if kind == "inplane":
        s.joints.append(Joint("close", "inplane", *ends, p, way(rng, s)))
    elif kind == "link":
        points = (p + between(rng, 0.6, 1.2) * way(rng, s), p)
        points = points if ends[0] == "ground" else points[::-1]
        s.joints.append(Joint("close", "link", *ends, points[0], points=points))
    elif kind == "coupler" and len(s.sensors) > 1:
        names = sorted({x.joint for x in s.sensors})
        c = tuple(pick(rng, -1, 1) * decades(rng, 0.2, 3.0) for _ in names)
        s.gears.append(Gear("g", "coupler", tuple(names), coefficients=c))
    elif kind in ("gear", "rack"):
        e, r = way(rng, s), (between(rng, 0.1, 0.4), between(rng, 0.1, 0.4))
        f, first = np.cross(z, e), len(s.bodies)
        hang(s, rng, last.name, "revolute", p, pick(rng, -1, 1) * z)
        g = Gear("g", "gear", (f"j{first}", f"j{first + 1}"), touch=p + r[0] * e, way=f)
        if kind == "gear":
            g.radii = r
            hang(s, rng, last.name, "revolute", p + sum(r) * e, pick(rng, -1, 1) * z)
        else:
            g.type, g.radius = "rack_and_pinion", r[0]
            there = g.touch + between(rng, -0.3, 0.3) * f
            held(s, rng, hang(s, rng, last.name, "prismatic", there, pick(rng, -1, 1) * f))
        s.gears.append(g)
    # in the plane nothing tells forces across it; in space a flat loop has more rows than it needs
    return finished(s, rng, between(rng, 0.3, 2.0), forces=False)
