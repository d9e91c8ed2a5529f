"""Impacts that take no time: velocities and inverse masses at a contact in, impulses out.

    u' = G (1, f)         over the impulse p of the normal force              [Routh1905]
    f  = -mu u_t / |u_t|  while it slides; at rest what holds it there, if mu_s is enough

u = (u_n, u_t) is the velocity of body j against body i at the contact, u_n < 0 on approach, and G
what impulses there change it by, with all joints.  Compression ends where u_n = 0, at p = p_c,
and the work W of the normal force is then at its lowest.  Restitution ends, by its rule, where

    newton     u_n = -e u_n0
    poisson    p   = (1 + e) p_c

and in any case where W comes back to zero, so that no impact gives energy: friction takes some,
and the normal force gives back what it took at most.  Without friction, or where sliding keeps its
direction, both rules are the same.

Along a straight way of sliding, and at rest, u is linear in p; where sliding turns it is followed
over s, dp = |u_t| ds, in which it stays smooth as it dies out.
"""

from collections.abc import Callable
from math import cos, inf, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Friction = tuple[float, float]  # static and kinetic coefficient

STRAIGHT = 1e-12  # of its size: by as much a way turns that is straight
NOTHING = 1e-12  # of the inverse mass along the normal: none
AT_REST = 1e-10  # of the speed before: no sliding
STEP = 0.05  # of the time in which sliding that turns dies out
MOST = 100_000  # pieces of one impact
LOOKS = 720  # directions of sliding from rest
HALVINGS = 60


class Blow(NamedTuple):
    """What an impact does."""

    impulse: Array  # (3) along the normal and across it, on body j, N*s
    velocity: Array  # (3) after it, m/s
    work: float  # of the normal force, J; never positive


class NoImpact(Exception):
    """Nothing gives way to an impulse there."""


def impact(u: Array, G: Array, friction: Friction, e: float, rule: str) -> Blow:
    """The impact of a contact with the velocity u (3), u[0] < 0, and inverse masses G (3, 3).

    friction: static and kinetic coefficient; e: restitution.  Raises NoImpact where G is none.
    """
    return _Impact(u, G, friction, e, rule).blow()


class _Impact:
    """An impact while it goes on; y = (u, p, W) with the impulses p (3)."""

    def __init__(self, u: Array, G: Array, friction: Friction, e: float, rule: str) -> None:
        if not G[0, 0] > 0.0:
            raise NoImpact
        self.G = np.where(np.abs(G) > NOTHING * np.max(np.abs(G)), G, 0.0)
        self.static, self.kinetic = friction
        self.y = np.array([*u, 0.0, 0.0, 0.0, 0.0])
        self.e, self.rule, self.u_0 = e, rule, float(u[0])
        self.slow = AT_REST * sqrt(float(u @ u))
        self.p_c, self.left = 0.0, MOST
        # a way that turns is hundreds of steps long: what they share is found once
        self.straight = STRAIGHT * float(np.max(np.abs(self.G)))
        pulls, holds = (float(np.linalg.norm(part)) for part in (self.G[1:, 0], self.G[1:, 1:]))
        dies_out = pulls + self.kinetic * holds
        self.step = STEP / dies_out if dies_out > 0.0 else inf

    def blow(self) -> Blow:
        """Compression, then restitution."""
        self.follow(lambda y: y[0], self.until_rest)
        self.p_c = float(self.y[3])
        if self.e > 0.0:
            self.follow(self.beyond, self.until_parted)
        return Blow(self.y[3:6].copy(), self.y[:3].copy(), float(self.y[6]))

    # what ends a part of it: how far beyond its end y is, and the impulse to it along a line

    def until_rest(self, slope: float) -> float:
        return -self.y[0] / slope if slope > 0.0 else inf

    def beyond(self, y: Array) -> float:
        """Above zero behind the end of restitution, in units of speed or of impulse."""
        back = y[6] if y[6] > 0.0 else -1.0
        if y[0] < 0.0:  # pressed together again
            return 1.0
        if self.rule == "newton":
            return max(y[0] + self.e * self.u_0, back)
        return max(y[3] - (1.0 + self.e) * self.p_c, back)

    def until_parted(self, slope: float) -> float:
        """The least impulse to an end of restitution where u_n rises by a slope."""
        u, work = float(self.y[0]), float(self.y[6])
        ends = [(1.0 + self.e) * self.p_c - float(self.y[3])] if self.rule == "poisson" else []
        if self.rule == "newton" and slope > 0.0:
            ends.append((-self.e * self.u_0 - u) / slope)
        if slope < 0.0:
            ends.append(-u / slope)
        square = u * u - 2.0 * slope * work  # W + u p + slope p^2 / 2 = 0
        if square >= 0.0 and u + sqrt(square) > 0.0:
            ends.append(-2.0 * work / (u + sqrt(square)))
        return max(min(ends, default=inf), 0.0)

    # the ways that y goes

    def follow(self, beyond: Callable[[Array], float], until: Callable[[float], float]) -> None:
        """Go on until a part of the impact is over."""
        while self.left > 0:
            self.left -= 1
            d = self.sliding()
            if d is None:
                f, gone = self.holding(), inf
            else:
                f = -self.kinetic * d
                along = self.G[1:, 0] + self.G[1:, 1:] @ f
                if self.turns(along, d):
                    if self.curve(beyond):
                        return
                    continue
                rate = float(along @ d)
                speed = float(self.y[1:3] @ d)
                stops = self.kinetic > 0.0 and rate < 0.0
                gone = speed / -rate if stops else inf
            end = until(float(self.G[0] @ (1.0, *f)))
            if min(end, gone) == inf:
                raise NoImpact
            self.line(f, min(end, gone))
            if end <= gone:
                return
            self.y[1:3] = 0.0
        raise NoImpact

    def sliding(self) -> Array | None:
        """The direction of sliding now, or of that which begins; None where it rests."""
        u = self.y[1:3]
        speed = sqrt(float(u @ u))
        if speed > self.slow:
            return np.array(u / speed)
        if self.kinetic == 0.0:
            return np.array((1.0, 0.0))
        u[:] = 0.0
        hold = self.holding()
        if hold @ hold <= self.static**2:
            return None
        return self.starts()

    def holding(self) -> Array:
        """Friction, of the normal force, with which what rests goes on resting."""
        return -np.linalg.pinv(self.G[1:, 1:], rcond=1e-10, hermitian=True) @ self.G[1:, 0]

    def starts(self) -> Array:
        """The direction in which sliding begins and goes on: u' = G (1, -mu d) is along d."""

        def along(angle: float) -> tuple[float, float]:
            d = np.array((cos(angle), sin(angle)))
            a = self.G[1:, 0] - self.kinetic * self.G[1:, 1:] @ d
            return float(d[0] * a[1] - d[1] * a[0]), float(d @ a)

        if self.G[1, 1] == 0.0 or self.G[2, 2] == 0.0:  # one direction is left
            k = int(self.G[1, 1] == 0.0)
            d = np.zeros(2)
            d[k] = np.sign(self.G[1 + k, 0])
            return d
        for k in range(LOOKS):
            low, high = 2.0 * pi * k / LOOKS, 2.0 * pi * (k + 1) / LOOKS
            (f, rate), (g, _) = along(low), along(high)
            if (f > 0.0) == (g > 0.0) or rate <= 0.0:
                continue
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                low, high = (
                    (middle, high) if (along(middle)[0] > 0.0) == (f > 0.0) else (low, middle)
                )
            return np.array((cos(low), sin(low)))
        raise NoImpact

    def turns(self, along: Array, d: Array) -> bool:
        """Whether sliding turns."""
        if self.kinetic == 0.0:
            return False
        across = abs(float(d[0] * along[1] - d[1] * along[0]))
        moved = self.y[1:3] @ self.y[1:3] > self.slow**2
        return bool(moved and across > self.straight)

    def line(self, f: Array, p: float) -> None:
        """Go on by the impulse p of the normal force, with the friction f of it."""
        slope = self.G @ (1.0, *f)
        self.y[6] += self.y[0] * p + 0.5 * slope[0] * p * p
        self.y[:3] += slope * p
        self.y[3:6] += p * np.array((1.0, *f))

    def curve(self, beyond: Callable[[Array], float]) -> bool:
        """A step along a way that turns; whether the part of the impact ends in it."""
        after = self.stepped(self.step)
        if beyond(after) < 0.0:
            self.y = after
            return False
        low, high = 0.0, self.step
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if beyond(self.stepped(middle)) < 0.0 else (low, middle)
        self.y = self.stepped(low)
        return True

    def stepped(self, h: float) -> Array:
        """y after a step of the classical method of Runge and Kutta."""
        a = self.rate(self.y)
        b = self.rate(self.y + 0.5 * h * a)
        c = self.rate(self.y + 0.5 * h * b)
        return np.asarray(self.y + h / 6.0 * (a + 2.0 * b + 2.0 * c + self.rate(self.y + h * c)))

    def rate(self, y: Array) -> Array:
        """Of y over s.  Thousands are asked for in one impact: nothing is made twice."""
        slid = y[1:3]
        found = np.empty(7)
        p = found[3:6]
        p[0] = speed = sqrt(slid @ slid)
        np.multiply(slid, -self.kinetic, out=p[1:])
        np.matmul(self.G, p, out=found[:3])
        found[6] = y[0] * speed
        return found
