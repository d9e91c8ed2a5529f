"""Mechanisms of one angle that pass singular places: the truth from that angle alone.

Every body is at  c + u cos theta + s sin theta  and turned by  k theta:

    M theta'' + M' theta'^2 / 2 = Q        M = sum of m p'^2 + I k^2,  Q = sum of m g p' + torque

which is regular where the rows of the joints depend on each other.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from .reference import (
    ACCELERATION,
    APART,
    RATE,
    TURNING,
    Channel,
    Truth,
    lightest,
    scales,
    size,
)
from .scene import LENGTH, MOMENT, NONE, SPEED, Scene


@dataclass
class Carried:
    """One body: place and turn by the angle; mass and inertia about z."""

    name: str
    m: float
    I: float
    c: np.ndarray
    u: np.ndarray
    s: np.ndarray
    k: float

    def place(self, a: Any) -> Any:
        return self.c + np.multiply.outer(np.cos(a), self.u) + np.multiply.outer(np.sin(a), self.s)

    def slope(self, a: Any) -> Any:
        return np.multiply.outer(np.cos(a), self.s) - np.multiply.outer(np.sin(a), self.u)


@dataclass
class OneAngle:
    bodies: list[Carried]
    begin: tuple[float, float]
    gravity: np.ndarray
    spring: float = 0.0  # torque -spring (theta - begin)
    driven: bool = False  # at a constant rate

    def terms(self, a: float) -> tuple[float, float, float]:
        """M, M'/2, Q."""
        M, half, Q = 0.0, 0.0, -self.spring * (a - self.begin[0])
        for b in self.bodies:
            p, pp = b.slope(a), b.c - b.place(a)
            M += b.m * (p @ p) + b.I * b.k**2
            half += b.m * (p @ pp)
            Q += b.m * (self.gravity @ p)
        return M, half, Q

    def turned(self, t: float, y: np.ndarray) -> list[float]:
        M, half, Q = self.terms(y[0])
        return [y[1], 0.0 if self.driven else (Q - half * y[1] ** 2) / M]

    def run(self, times: np.ndarray, rtol: float, factor: float = 1.0) -> np.ndarray:
        start = (self.begin[0], self.begin[1] * factor)
        y = solve_ivp(
            self.turned, (0, times[-1]), start, "DOP853", times, rtol=rtol, atol=1e-14
        ).y.T
        return np.column_stack([y, [self.turned(0, one)[1] for one in y]])

    def channels(self, s: Scene, y: np.ndarray) -> dict[str, Channel]:
        a, w, e = y.T
        found: dict[str, Channel] = {}
        for b in self.bodies:
            p, pp = b.slope(a), b.c - b.place(a)
            v = p * w[:, None]
            gain = p * e[:, None] + pp * w[:, None] ** 2
            z, zero = np.array([0, 0, b.k]), np.zeros(len(a))
            d = b.k * (a - self.begin[0])
            R = [np.cos(d), -np.sin(d), zero, np.sin(d), np.cos(d), zero, zero, zero, zero + 1]
            name = b.name
            found[f"{name}.position"] = Channel(b.place(a), LENGTH, True, "place")
            found[f"{name}.velocity"] = Channel(v, SPEED, True, "speed")
            found[f"{name}.angular_velocity"] = Channel(np.outer(w, z), RATE, True, "spin")
            found[f"{name}.acceleration"] = Channel(gain, ACCELERATION, True, "gain")
            found[f"{name}.angular_acceleration"] = Channel(np.outer(e, z), TURNING, True, "twist")
            found[f"{name}.rotation"] = Channel(np.column_stack(R), NONE, False, "matrix")
        found["angle"] = Channel((a - self.begin[0])[:, None], NONE, False, "angle")
        found["angle.rate"] = Channel(w[:, None], RATE, False, "spin")
        if self.driven:
            terms = [self.terms(x) for x in a]
            needed = [half * x * x - Q for x, (_, half, Q) in zip(w, terms, strict=True)]
            found["motor.force"] = Channel(np.array(needed)[:, None], MOMENT, False, "moment")
        return found

    def truth(self, s: Scene) -> Truth:
        rows = np.arange(s.rows + 1) * s.end / s.rows
        y = self.run(rows, 1e-12)
        t = Truth(rows, self.channels(s, y), [], [], size=size(s), mass=lightest(s), end=s.end)
        top = t.top = scales(t)
        away = np.zeros(len(rows))
        sure = np.zeros(len(rows))
        for other, out, by in (
            (self.run(rows, 1e-12, 1 + APART), away, APART),
            (self.run(rows, 1e-10), sure, 1.0),
        ):
            for name, c in self.channels(s, other).items():
                if c.kind in ("place", "speed", "spin", "angle"):
                    d = np.abs(c.values - t.channels[name].values).max(axis=1) / top[c.kind] / by
                    np.maximum(out, d, out=out)
        t.growth, t.sure = np.maximum.accumulate(away), np.maximum.accumulate(sure)
        return t
