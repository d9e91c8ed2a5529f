"""What a contact does to an explicit method: its stiffness, its time, the mass it moves."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import gaps, poses
from trsim.assemble.instances import Instance
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.reduce import against_rates
from trsim.elements.contract import ContactNumbers
from trsim.elements.rows import Axes
from trsim.elements.scene import Scene, scene
from trsim.laws.contact import hertz_contact_time
from trsim.solve.diagnose.linearised import Linearised
from trsim.solve.start.consistent import Start
from trsim.solve.start.velocities import gap_gradient

Array = NDArray[np.float64]

SLOWEST = 1e-3  # m/s: speed of an impact where none is given
DIRECTIONS = 8  # of the normal of a journal that touches nothing yet
IMMOVABLE = 1e-4  # of what the bodies alone would give: a contact that joints and drives fix


@dataclass(frozen=True)
class ContactScale:
    """How fast a contact is, pressed as the largest force of the start would.

    name           joint or stop
    closed         whether it is in touch at the start
    depth          penetration, m or rad
    force          N or N*m
    stiffness      tangent, N/m or N*m/rad
    mass           that moves, with all joints and drives in force, kg or kg*m^2; none: nothing can
    half_period    of its vibration, s; none where nothing can move
    impact_time    from touch to separation at the slowest impact, s; none where nothing can move
    friction_rate  1/s, of the ramp of modified Coulomb friction; 0 without one
    unit           of the force, N or N*m
    """

    name: str
    closed: bool
    depth: float
    force: float
    stiffness: float
    mass: float
    half_period: float
    impact_time: float
    friction_rate: float
    unit: str


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
        own = ContactNumbers(w, c)
        K, n, alone = float(own.stiffness), float(own.exponent), float(own.mass)
        d, slope = float(begun.depth[c]), instance.row.contact.slope
        if own.clearance < np.inf:
            poses(w, begun.y)
            inverse, sliding = journal(w, e, instance, linear.twists, bool(closed[e]))
        else:
            inverse, sliding = along(w, begun.y, e, instance, linear.twists), 0.0
        free = inverse * alone > IMMOVABLE
        mass = 1.0 / inverse if free else np.inf
        k, force = n * K * d ** (n - 1.0), K * d**n
        v = float(own.slowest_impact) or SLOWEST
        yield ContactScale(
            name=instance.name,
            closed=bool(closed[e]),
            depth=d,
            force=force,
            stiffness=k,
            mass=mass,
            half_period=pi * sqrt(mass / k) if free else np.inf,
            impact_time=hertz_contact_time(mass, K, n, v) if free else np.inf,
            friction_rate=slope * force * sliding,
            unit=unit.get(f"{instance.name}.normal_force", "N"),
        )


def along(w: Scene, y: Array, e: int, instance: Instance, twists: Array) -> float:
    """g Z Z^T g^T of a gap, 1/kg."""
    return float(np.sum((gap_gradient(w, y, instance, e) @ twists) ** 2))


def journal(
    w: Scene, e: int, instance: Instance, twists: Array, closed: bool
) -> tuple[float, float]:
    """Inverse masses of a journal in its bearing, along the normal and along the tangent, 1/kg.

    The largest over the directions in which it may touch; where it touches, that one.
    """
    own = Axes(w, e)
    i, j = own.i, own.j
    R_i, R_j = (w.X[f, 3:].reshape(3, 3) for f in (i, j))
    p_i, p_j = R_i @ own.p_i, R_j @ own.p_j
    u, v, a = (R_i @ axis for axis in (own.u_i, own.w_i, own.a_i))
    d = w.X[j, :3] + p_j - w.X[i, :3] - p_i
    angles = pi * np.arange(DIRECTIONS) / DIRECTIONS
    if closed:
        angles = np.array([np.arctan2(v @ d, u @ d)])
    contact: Any = instance.row.contact
    reach = contact.radius - contact.clearance
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
