"""Numbers of contacts with surfaces and of seals for engine.py, and kinks of their forces."""

from typing import Any

import numpy as np
from scipy.optimize import brentq

from . import engine as e
from . import touches as t
from .scene import Grip, Scene, Seal

SHAPES = {
    "plane": t.PLANE, "sphere": t.BALL, "cylinder": t.PIPE, "polygon": t.POLYGON, "line": t.LINE,
    "ellipse": t.ELLIPSE,
}  # fmt: skip
LAWS = {"none": t.NO_FRICTION, "modified_coulomb": t.RAMPED, "sticking": t.BRISTLES}


def loss_factor(law: Grip) -> float:
    """What the elastic force is multiplied by, per speed of the impact."""
    r = law.restitution
    if law.normal == "identified":
        # 1 - x r = (1 + x) exp(-x (1 + r)): with this x a free impact has the restitution r
        return float(brentq(lambda x: 1 - x * r - (1 + x) * np.exp(-x * (1 + r)), 1e-4, 1 / r))
    return {
        "impact": 0.0,
        "lankarani_nikravesh": 0.75 * (1 - r * r),
        "hunt_crossley": 1.5 * (1 - r),
        "flores": 1.6 * (1 / r - 1),
    }[law.normal]


def numbers_of(
    s: Scene, f: Any, first: int, state: int
) -> tuple[list[float], list[tuple[int, float]], float]:
    """Columns behind the arms, kinks (what is watched, its value), and how far bristles bend."""
    p = np.zeros(t.WIDTH)
    if isinstance(f, Seal):
        p[6:9] = f.normal / np.linalg.norm(f.normal)
        p[[t.LOAD, t.EXPONENT, t.MARK, t.HEIGHT, t.AT]] = f.load, f.exponent, 1, f.height, f.depth
        p[[t.LOSS, t.RUB, t.FULL, t.SPRINGS]] = f.damping, f.friction, f.full, f.springs or 0
        p[t.ALONG : t.ALONG + 3] = f.last - f.centre
        return p[6:].tolist(), [(e.W_END, 0.0), (e.W_END, 1.0)], 0.0
    law = next(x for x in s.laws if x.name == f.law)
    p[6:9], p[t.X_AXIS : t.X_AXIS + 3], p[t.Z_AXIS : t.Z_AXIS + 3] = f.axes[1], f.axes[0], f.axes[2]
    impact = law.normal == "impact"
    p[[t.K, t.EXPONENT, t.CHI]] = law.K, law.exponent, loss_factor(law)
    p[[t.MARK, t.SLOWEST]] = (1, 0) if impact else (0, law.slowest)
    p[[t.DAMPING, t.RAMP]] = (law.damping, law.ramp) if impact else (0, 0)
    p[[t.SHAPE, t.RADIUS, t.FREE, t.BALLS]] = SHAPES[f.shape], f.radius, 1 - 2 * f.hollow, f.ball
    p[t.ROUND] = f.radius if f.shape == "polygon" else 0.0
    if f.shape == "ellipse":
        p[[t.RADIUS, t.OTHER]] = f.other
    p[[t.FIRST, t.LAST]] = first, first + len(f.core())
    p[[t.LAW, t.MU, t.V0, t.V1]] = LAWS[law.friction], law.mu, law.v0, law.v1
    p[[t.ROLLING, t.SPINNING]] = f.rolling, f.spinning
    kinks = []
    if law.friction == "modified_coulomb":
        for kind, there in ((e.W_SLIP, law.mu), (e.W_ROLL, f.rolling), (e.W_SPIN, f.spinning)):
            kinks += [(kind, law.v0), (kind, law.v1)] if there else []
    if impact and law.damping:
        kinks += [(e.W_WHOLE, 0.0), (e.W_PULL, 0.0)]
    bent = 0.0
    if law.friction == "sticking":
        p[[t.MU_S, t.V_S, t.SIGMA0, t.SIGMA1, t.STATE]] = (
            law.mu_s, law.v_s, law.sigma0, law.sigma1, state,
        )  # fmt: skip
        bent = law.mu_s / law.sigma0
    return p[6:].tolist(), kinks, bent
