"""Stiffness and time scales of a start: what an explicit method will meet, before it meets it.

    motion    eigenvalues of the linearised motion, contacts as they are at the start
    contact   k = n K d^(n-1),  1/m = g Z Z^T g^T,  half a period pi sqrt(m / k)
    impact    time from touch to separation at the slowest impact        laws/contact.py
    friction  ramp of modified Coulomb friction: mu F / (v1 - v0) / m_t, 1/s

g is the gradient of the gap against the twists, Z the free motions: m is the mass a contact really
moves, with all joints and drives in force.  d is the penetration expected at the forces of the
start, or at the slowest impact where that is more.  An explicit step h is stable where h lambda
lies in the method's region; that of rk4 ends at 2.785 on the real axis and at 2.828 on the
imaginary one.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import gaps, poses
from trsim.assemble.mechanism import Instance, Mechanism
from trsim.assemble.reduce import against_rates
from trsim.elements.clearance_joint import FRICTION_LAW, FRICTION_PAR, R_B, C
from trsim.elements.scene import Scene, scene
from trsim.laws.contact import hertz_contact_time
from trsim.laws.friction import CODES
from trsim.solve.diagnose.linearised import Linearised, linearised, rounding
from trsim.solve.start.consistent import Start
from trsim.solve.start.velocities import twist_gradient

Array = NDArray[np.float64]

REAL, IMAGINARY = 2.785, 2.828  # where the stability region of rk4 ends
LARGEST = 600  # velocities of a mechanism with flexible bars that is linearised: some seconds
SLOWEST = 1e-3  # m/s: speed of an impact where none is given
DIRECTIONS = 8  # of the normal of a journal that touches nothing yet
IMMOVABLE = 1e-4  # of what the bodies alone would give: a contact that joints and drives fix


@dataclass(frozen=True)
class ContactScale:
    """Time scales of one contact."""

    name: str
    closed: bool  # at the start
    depth: float  # m or rad
    force: float  # N or N*m, elastic, at this depth
    stiffness: float  # N/m or N*m/rad, tangent there
    mass: float  # kg or kg*m^2 that it moves; inf where drives and joints fix it
    half_period: float  # s, at this stiffness; inf where it moves nothing
    impact_time: float  # s, at the slowest impact
    friction_rate: float  # 1/s, 0 without a ramp
    unit: str  # of the force: N or N*m


@dataclass(frozen=True)
class Scales:
    """What is fast and what is slow."""

    eigenvalues: tuple[complex, ...]  # 1/s, largest first, zeros left out
    zeros: int  # eigenvalues that are zero: free motions, or held by friction only
    decay: float  # 1/s, largest -Re
    growth: float  # 1/s, largest Re
    frequency: float  # rad/s, largest |Im|
    natural_time: float  # s: slowest period, or size over speed where nothing swings
    contacts: tuple[ContactScale, ...]
    fastest: float  # 1/s, of all of these
    fastest_is: str  # in words
    explicit_step: float  # s, largest stable step of rk4; inf where nothing is fast


def scales(scenario: Any, mechanism: Mechanism, begun: Start) -> Scales:
    """Time scales of a mechanism at its start."""
    if mechanism.beams and mechanism.model.n_v > LARGEST:
        return of_meshes(scenario, mechanism, begun)
    linear = linearised(mechanism, begun)
    natural = float(begun.speed / begun.length)
    every = np.linalg.eigvals(linear.A) if linear.A.size else np.zeros(0)
    least = rounding(every, begun)
    some = sorted((x for x in every.tolist() if abs(x) > least), key=rank)
    contacts = tuple(contact_scales(mechanism, begun, linear))
    swings = [abs(x.imag) for x in some if abs(x.imag) > least]
    limits = list(bounds(some, contacts))
    step, fastest, words = min(limits, default=(np.inf, 0.0, ""))
    return Scales(
        eigenvalues=tuple(complex(x) for x in some),
        zeros=len(every) - len(some),
        decay=max((-x.real for x in some if -x.real > least), default=0.0),
        growth=max((x.real for x in some if x.real > least), default=0.0),
        frequency=max(swings, default=0.0),
        natural_time=2.0 * pi / min(swings) if swings else 1.0 / natural,
        contacts=contacts,
        fastest=fastest,
        fastest_is=words,
        explicit_step=step,
    )


def of_meshes(scenario: Any, mechanism: Mechanism, begun: Start) -> Scales:
    """What is known without a linearisation, which so many nodes would make slow."""
    from trsim.solve.diagnose.bar_scales import bar_scales

    step, name = min((bar.explicit_step, bar.name) for bar in bar_scales(scenario, mechanism, ()))
    return Scales(
        eigenvalues=(),
        zeros=0,
        decay=0.0,
        growth=0.0,
        frequency=IMAGINARY / step,
        natural_time=float(begun.length / begun.speed),
        contacts=(),
        fastest=IMAGINARY / step,
        fastest_is=f"the mesh of '{name}'",
        explicit_step=step,
    )


def rank(x: complex) -> tuple[float, float]:
    """Largest first; of a pair the one above the real axis."""
    return -abs(x), -x.imag


def bounds(
    some: list[complex], contacts: tuple[ContactScale, ...]
) -> Iterator[tuple[float, float, str]]:
    """Stable step, rate and name of everything that limits an explicit method."""
    for x in some:
        if x.real <= abs(x.imag):  # what only grows limits the error, not the stability
            end = REAL if -x.real > abs(x.imag) else IMAGINARY
            yield end / abs(x), abs(x), "the linearised motion at the start"
    for contact in contacts:
        omega = pi / contact.half_period
        if omega > 0.0:
            yield IMAGINARY / omega, omega, f"{contact.name} in contact"
        if contact.friction_rate > 0.0:
            rate = contact.friction_rate
            yield REAL / rate, rate, f"friction of {contact.name}"


def contact_scales(
    mechanism: Mechanism, begun: Start, linear: Linearised
) -> Iterator[ContactScale]:
    """Every contact, pressed as the forces of the start would."""
    w = scene(mechanism.model)
    w.branch[:] = begun.branch
    poses(w, begun.y)
    gaps(w, 0.0)
    closed = w.gap[:, 0] > 0.0
    unit = {column.name: column.unit for column in mechanism.columns}
    for c, e in enumerate(mechanism.model.contact.tolist()):
        instance = mechanism.instances[e]
        K, n, alone, _, slowest, *_ = w.contact_par[c].tolist()
        d = float(begun.depth[c])
        if instance.element.key == "clearance_joint":
            poses(w, begun.y)
            inverse, sliding = journal(w, e, linear.twists, bool(closed[e]))
        else:
            inverse, sliding = along(w, begun.y, e, instance, linear.twists), 0.0
        free = inverse * alone > IMMOVABLE
        mass = 1.0 / inverse if free else np.inf
        k, force = n * K * d ** (n - 1.0), K * d**n
        v = slowest or SLOWEST
        yield ContactScale(
            name=instance.name,
            closed=bool(closed[e]),
            depth=d,
            force=force,
            stiffness=k,
            mass=mass,
            half_period=pi * sqrt(mass / k) if free else np.inf,
            impact_time=hertz_contact_time(mass, K, n, v) if free else np.inf,
            friction_rate=ramp(w, e, instance.element.key) * force * sliding,
            unit=unit.get(f"{instance.name}.normal_force", "N"),
        )


def along(w: Scene, y: Array, e: int, instance: Instance, twists: Array) -> float:
    """g Z Z^T g^T of a gap, 1/kg."""

    def rate(moving: Array) -> float:
        poses(w, moving)
        gaps(w, 0.0)
        return float(w.gap[e, 1])

    frames = instance.element.acts_on(instance.row)
    return float(np.sum((twist_gradient(w, y, rate, frames) @ twists) ** 2))


def journal(w: Scene, e: int, twists: Array, closed: bool) -> tuple[float, float]:
    """Inverse masses of a journal in its bearing, along the normal and along the tangent, 1/kg.

    The largest over the directions in which it may touch; where it touches, that one.
    """
    i, j = w.con[e, 0], w.con[e, 1]
    R_i, R_j = (w.X[f, 3:].reshape(3, 3) for f in (i, j))
    p_i, p_j = R_i @ w.par[e, 0:3], R_j @ w.par[e, 3:6]
    u, v, a = (R_i @ w.par[e, 6 + 3 * k : 9 + 3 * k] for k in range(3))
    d = w.X[j, :3] + p_j - w.X[i, :3] - p_i
    angles = pi * np.arange(DIRECTIONS) / DIRECTIONS
    if closed:
        angles = np.array([np.arctan2(v @ d, u @ d)])
    reach = w.par[e, R_B] - w.par[e, C]
    normal = tangent = 0.0
    for angle in angles:
        for sign in (1.0,) if closed else (1.0, -1.0):
            n = sign * (np.cos(angle) * u + np.sin(angle) * v)
            g = gradient(w, i, j, p_i + d, p_j, n)
            g_t = gradient(w, i, j, p_i + d + reach * n, p_j + reach * n, np.cross(a, n))
            normal = max(normal, float(np.sum((g @ twists) ** 2)))
            tangent = max(tangent, float(np.sum((g_t @ twists) ** 2)))
    return normal, tangent


def gradient(w: Scene, i: int, j: int, c_i: Array, c_j: Array, n: Array) -> Array:
    """n . (v_j - v_i) of two points, arms c_i and c_j, against all world-axes rates."""
    g = np.zeros(6 * w.n)
    g[6 * i : 6 * i + 6] -= np.concatenate([n, np.cross(c_i, n)])
    g[6 * j : 6 * j + 6] += np.concatenate([n, np.cross(c_j, n)])
    return against_rates(w, g[None, 6:])[0]


def ramp(w: Scene, e: int, key: str) -> float:
    """mu / (v1 - v0) of modified Coulomb friction, s/m; 0 for other laws."""
    if key != "clearance_joint" or w.con[e, FRICTION_LAW] != CODES["modified_coulomb"]:
        return 0.0
    mu, v0, v1 = w.par[e, FRICTION_PAR : FRICTION_PAR + 3].tolist()
    return float(mu / (v1 - v0))
