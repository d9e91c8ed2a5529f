"""Mechanisms with rows that depend on each other, some of which move and some of which do not."""

from itertools import pairwise

import numpy as np

Z = (0.0, 0.0, 1.0)
ORDINARY = np.eye(3)
# how a run may be made, as --set words
METHODS = {
    "auto": (),
    "dop853": ("solver.method=dop853",),
    "radau": ("solver.method=radau",),
    "ggl": ("solver.method=radau", "solver.formulation=ggl"),
    "generalized_alpha": ("solver.method=generalized_alpha", "solver.tolerance=1e-6"),
    "rk4": ("solver.method=rk4", "solver.step=1e-3"),
    "scipy": ("solver.method=scipy:RK45", "solver.tolerance=1e-6"),
}


def rotation(axis, angle):
    """Rotation matrix about an axis."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


TILTED = rotation((1, 2, 3), 0.7)


def numbers(v):
    return "[" + ", ".join(repr(float(x)) for x in v) + "]"


def text(parts, more="", R=ORDINARY, planar="false", end=1.0, tolerance=1e-8, size=1.0):
    """A scenario of (bodies {name: place}, joints {name: (i, j, place, axis, type)}), turned by R.

    A joint without an axis is spherical; one without a type is a hinge.
    """
    bodies, joints = parts
    R = np.asarray(R) * size
    lines = [f"planar: {planar}", "bodies:"]
    mass = f"mass: 1, inertia: {numbers(np.array([0.1, 0.12, 0.15]) * size**2)}"
    lines += [
        f"  {n}: {{{mass}, at: {numbers(R @ np.array(p, float))}}}" for n, p in bodies.items()
    ]
    lines.append("joints:")
    for name, (i, j, at, axis, *kind) in joints.items():
        word = kind[0] if kind else "spherical" if axis is None else "revolute"
        keys = [f"type: {word}", f"bodies: [{i}, {j}]"]
        keys += [f"at: {numbers(R @ np.array(at, float))}"] if word != "prismatic" else []
        keys += [f"axis: {numbers(R @ np.array(axis, float))}"] if axis is not None else []
        lines.append(f"  {name}: {{{', '.join(keys)}}}")
    return "\n".join([*lines, more, f"solver: {{end: {end}, tolerance: {tolerance}}}", ""])


def chain(points, axis=Z):
    """Bars from point to point; both ends at the ground."""
    points = [np.array((*p, 0.0, 0.0)[:3], float) for p in points]
    bars = [f"bar{k}" for k in range(1, len(points))]
    names = ["ground", *bars, "ground"]
    bodies = {bar: (points[k] + points[k + 1]) / 2 for k, bar in enumerate(bars)}
    return bodies, {f"J{k}": (names[k], names[k + 1], p, axis) for k, p in enumerate(points)}


def cranks(lengths, places, angle, top=1.0):
    """A plate on cranks that are parallel as drawn; crank k ends at (places[k], top)."""
    along = np.array([np.cos(angle), np.sin(angle), 0.0])
    bodies, joints = {"plate": (np.mean(places), top, 0.0)}, {}
    for k, (length, x) in enumerate(zip(lengths, places, strict=True)):
        tip = np.array([x, top, 0.0])
        bodies[f"crank{k}"] = tip - length * along / 2
        joints[f"F{k}"] = ("ground", f"crank{k}", tip - length * along, Z)
        joints[f"T{k}"] = (f"crank{k}", "plate", tip, Z)
    return bodies, joints


def loop(hinges):
    """A closed chain of (point, axis), body k between hinges k and k+1; the last is the ground."""
    names = [*(f"link{k}" for k in range(1, len(hinges))), "ground"]
    joints = {f"H{k}": (names[k - 1], names[k], p, axis) for k, (p, axis) in enumerate(hinges)}
    ends = pairwise(hinges)
    return {names[k]: (p + q) / 2 for k, ((p, _), (q, _)) in enumerate(ends)}, joints


def by_angles(links):
    """Hinges of a chain (angle, length, twist) [DenavitHartenberg1955], and how far it is open."""
    frame, hinges = np.eye(4), []
    for angle, length, twist in links:
        hinges.append((frame[:3, 3].copy(), frame[:3, 2].copy()))
        c, s, ct, st = np.cos(angle), np.sin(angle), np.cos(twist), np.sin(twist)
        frame = frame @ np.array(
            [[c, -s * ct, s * st, length * c], [s, c * ct, -c * st, length * s], [0, st, ct, 0],
             [0, 0, 0, 1]]
        )  # fmt: skip
    return hinges, float(np.abs(frame - np.eye(4)).max())


def bennett(angle=1.1, a=1.0, b=0.6, alpha=0.9):
    """Bennett's four hinges: sin(alpha)/a = sin(beta)/b."""
    beta = np.arcsin(b * np.sin(alpha) / a)
    ratio = np.sin((beta + alpha) / 2) / np.sin((beta - alpha) / 2)
    other = 2 * np.arctan(ratio / np.tan(angle / 2))
    hinges, left = by_angles(
        [(angle, a, alpha), (other, b, beta), (-angle, a, alpha), (-other, b, beta)]
    )
    assert left < 1e-14
    return loop(hinges)


def bricard(angle=2.0):
    """Bricard's orthogonal chain of six hinges, threefold: c1 c2 + c1 + c2 = 0 of both angles."""
    other = np.arccos(-np.cos(angle) / (1 + np.cos(angle)))
    for second in (other, -other):
        ways = [(angle, 1.0, np.pi / 2), (second, 1.0, -np.pi / 2)] * 3
        hinges, left = by_angles(ways)
        if left < 1e-13:
            return loop(hinges)
    raise AssertionError(left)


def sarrus(height=0.7):
    """Two plates on two pairs of hinged links at a right angle: the upper one rises straight."""
    out, joints, bodies = np.sqrt(1 - height**2 / 4), {}, {"top": (0, 0, height)}
    for k, (side, axis) in enumerate((((1, 0, 0), (0, 1, 0)), ((0, 1, 0), (-1, 0, 0)))):
        low = np.array(side, float)
        high = low + np.array([0, 0, height])
        knee = (low + high) / 2 + low * out
        bodies |= {f"low{k}": (low + knee) / 2, f"high{k}": (knee + high) / 2}
        joints[f"A{k}"] = ("ground", f"low{k}", low, axis)
        joints[f"B{k}"] = (f"low{k}", f"high{k}", knee, axis)
        joints[f"C{k}"] = (f"high{k}", "top", high, axis)
    return bodies, joints


def slider_crank_at_dead_centre():
    """Crank of 0.3 and rod of 1 on one line."""
    bodies = {"crank": (0.15, 0, 0), "rod": (0.8, 0, 0), "slider": (1.3, 0, 0)}
    return bodies, {
        "A": ("ground", "crank", (0, 0, 0), Z),
        "B": ("crank", "rod", (0.3, 0, 0), Z),
        "C": ("rod", "slider", (1.3, 0, 0), Z),
        "track": ("ground", "slider", (1.3, 0, 0), (1, 0, 0), "prismatic"),
    }


def framework(nodes, bars, held):
    """Bars between nodes of a plane; `held` nodes belong to the ground."""
    at = {k: np.array((*p, 0.0)) for k, p in enumerate(nodes)}
    bodies = {f"bar{n}": (at[i] + at[j]) / 2 for n, (i, j) in enumerate(bars)}
    joints = {}
    for k, place in at.items():
        meet = ["ground"] * (k in held) + [f"bar{n}" for n, ends in enumerate(bars) if k in ends]
        for other in meet[1:]:
            joints[f"N{k}_{other}"] = (meet[0], other, place, Z)
    return bodies, joints
