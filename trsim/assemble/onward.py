"""Velocities that go on, at a position where branches of the motion meet.

Lying flat, the rows of a parallelogram allow more velocities than either of its branches has: of
these v = v_0 + N z, N the null space of J, an acceleration J a = gamma(v) exists where

    w . gamma(v_0 + N z) = 0        for every self-stress w of the rows, w^T J = 0

quadratic in z.  The smallest z is taken: the branch nearest to the velocities asked for.  Elsewhere
redundant rows have stresses too, and then this holds for every z.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import constraints, derivative, poses
from trsim.assemble.linear import SOUND
from trsim.assemble.reduce import all_rows, in_solve_axes, weights
from trsim.elements.scene import Scene

Array = NDArray[np.float64]

DEPENDENT = 1e-9  # singular values, of the largest
HOLDS = 1e-9  # of the largest term of gamma
ROUNDING = 1e-14  # of the products of rates that gamma is made of
PLAINLY = 1e-3  # the same, and of what forces do to free bodies: more than a rounded drawing's
TAKES_PART = 0.1  # of the largest entry of a self-stress
MOST = 40  # motions that are looked at
STARTS, STEPS = 16, 60  # of Newton's method; its steps
IDLE = 8  # of them that do not halve what is left: it leads nowhere
LAST = 1e-12  # of z: a step so short is the last


def undecided(work: Scene, y: Array) -> list[int]:
    """Rows that depend on each other at a start from rest whose forces ask for no single branch.

    A motion from rest goes by a t^2 / 2 at first, so accelerations must go on as velocities do;
    those that the forces ask for are the answer only if they do.
    """
    if not work.m or work.n > work.n_r:
        return []
    derivative(work, 0.0, y, np.zeros_like(y))
    moving = np.any(work.V)
    if moving or not (len(work.redundant) or work.status[0] != SOUND):
        return []
    unit = np.tile([work.size] * 3 + [1.0] * 3, work.n - 1)
    push = np.abs(work.F[1:]).ravel() * weights(work) ** 2 / np.repeat(work.mass[1:], 6)
    a = np.nan_to_num(work.A[1:].ravel())
    rows = list(range(work.m + len(work.redundant)))
    branches = Branches(work, y, rows)
    a = branches.motions @ (branches.free.T @ (a / branches.scale))
    if not np.max(np.abs(a) / unit) > PLAINLY * np.max(push / unit, initial=0.0):
        return []
    if not branches.stresses.shape[1]:
        return []
    off, largest = np.max(np.abs(branches.left(a))), np.max(np.abs(work.gamma))
    if off <= max(PLAINLY * largest * np.max(np.abs(branches.stresses)), branches.noise(a)):
        return []
    part = np.max(np.abs(branches.stresses) * branches.length[:, None], axis=1)[: work.m]
    return np.flatnonzero(part > TAKES_PART * part.max(initial=0.0)).tolist()


class Branches:
    """What rows of a workspace allow at one position."""

    def __init__(
        self, work: Scene, y: Array, rows: list[int], wishes: Array | None = None,
        moving: NDArray[np.bool_] | None = None, C: Array | None = None,
    ) -> None:  # fmt: skip
        """rows: those of the workspace that count; wishes: gradients of rates that stay as they
        are; moving: rates that there are; C: `roots`, where the nearest is that in the metric of
        M."""
        J = all_rows(work, y)[rows]
        self.work, self.y, self.rows = work, y.copy(), rows
        self.moving = np.ones(J.shape[1], bool) if moving is None else moving
        self.scale = weights(work)[self.moving]
        R = J[:, self.moving] * self.scale
        length = np.linalg.norm(R, axis=1)
        length[length == 0.0] = 1.0
        R, self.length = R / length[:, None], length
        u, s, vt = np.linalg.svd(R)
        rank = int(np.sum(s > DEPENDENT * s.max(initial=0.0)))
        self.stresses = u[:, rank:] / length[:, None]  # columns
        if wishes is not None and len(wishes) and self.stresses.shape[1]:
            _, s, vt = np.linalg.svd(np.vstack([R, wishes[:, self.moving] * self.scale]))
            rank = int(np.sum(s > DEPENDENT * s.max(initial=0.0)))
        self.free = vt[rank:].T
        self.motions = np.zeros((J.shape[1], self.free.shape[1]))
        self.motions[self.moving] = self.scale[:, None] * self.free
        if C is not None and self.stresses.shape[1]:
            # the same motions, orthonormal in M: C^-1 motions = Q U
            at = np.linalg.pinv(C, 1e-100) @ self.motions.reshape(*C.shape[:2], -1)
            U = np.linalg.qr(at.reshape(self.motions.shape))[1]
            self.motions = np.linalg.solve(U.T, self.motions.T).T

    def onward(self, v: Array, at_rest: bool = True) -> Array:
        """The world-axes rates nearest to v that the rows allow, and that go on.

        at_rest: whether nothing may be the answer.  Returns v itself where it goes on, or where no
        others that do are found.
        """
        if not self.stresses.shape[1] or not 0 < self.free.shape[1] <= MOST or self.goes_on(v):
            return v
        forms = self.quadratic(v)
        if not at_rest:
            forms = as_fast(*forms, self.free.T @ (v[self.moving] / self.scale))
        z = nearest_root(*forms)
        found = v if z is None else v + self.motions @ z
        return found if self.goes_on(found) else v

    def left(self, v: Array) -> Array:
        """w . gamma at the velocities v."""
        work = self.work
        poses(work, self.y)  # whose axes those of the solve are
        self.y[work.n_q : work.n_q + work.n_v] = in_solve_axes(work, v)
        poses(work, self.y)
        constraints(work, 0.0)
        return np.asarray(self.stresses.T @ work.gamma[self.rows])

    def goes_on(self, v: Array) -> bool:
        """Whether an acceleration exists."""
        off = self.left(v)
        gamma = np.abs(self.work.gamma[self.rows])
        terms = float(np.max(np.abs(self.stresses) * gamma[:, None]))
        return bool(np.all(np.abs(off) <= max(HOLDS * terms, self.noise(v), 1e-300)))

    def noise(self, v: Array) -> float:
        """What rounding leaves of w . gamma where it is zero, as along a screw: gamma is made of
        products of rates, which may cancel in all rows."""
        along, turning = (np.max(np.abs(v.reshape(-1, 6)[:, k])) for k in (slice(3), slice(3, 6)))
        most = turning * (along + turning * max(self.work.size, 1.0))
        return float(ROUNDING * most * np.max(np.abs(self.stresses), initial=0.0))

    def quadratic(self, v: Array) -> tuple[Array, Array, Array]:
        """c (w), b (w, n), B (w, n, n) of w . gamma(v + N z) = c + b z + z B z."""
        motions, n = self.motions, self.motions.shape[1]
        c = self.left(v)
        ends = [[self.left(v + sign * way) for sign in (1, -1)] for way in motions.T]
        b = np.array([0.5 * (ahead - back) for ahead, back in ends]).T
        B = np.zeros((len(c), n, n))
        for i in range(n):
            B[:, i, i] = 0.5 * (ends[i][0] + ends[i][1]) - c
        for i in range(n):
            for j in range(i):
                both = self.left(v + motions[:, i] + motions[:, j])
                mixed = both - c - b[:, i] - b[:, j] - B[:, i, i] - B[:, j, j]
                B[:, i, j] = B[:, j, i] = 0.5 * mixed
        return c, b, B


def as_fast(c: Array, b: Array, B: Array, at: Array) -> tuple[Array, Array, Array]:
    """`quadratic` with |at + z|^2 = |at|^2 as well: rest, which goes on for ever, is no answer."""
    size = float(np.abs(c).max() / max(at @ at, 1e-300))
    n = len(at)
    return (
        np.append(c, 0.0),
        np.vstack([b, 2.0 * size * at]),
        np.concatenate([B, size * np.eye(n)[None]]),
    )


def nearest_root(c: Array, b: Array, B: Array) -> Array | None:
    """The smallest z with c + b z + z B z = 0 of those that Newton's steps of least norm find."""
    rng = np.random.default_rng(0)
    n = b.shape[1]
    reach = np.sqrt(np.abs(c).max() / max(float(np.abs(B).max(initial=0.0)), 1e-300))
    best = None
    for k in range(STARTS):
        z = np.zeros(n) if k == 0 else rng.normal(size=n) * reach
        least, idle = np.inf, 0
        for _ in range(STEPS):
            by_z = B @ z
            off = c + (b + by_z) @ z
            left = np.abs(off).max()
            least, idle = (left, 0) if left < 0.5 * least else (least, idle + 1)
            if idle > IDLE:
                break
            slope = b + 2.0 * by_z
            step = np.linalg.lstsq(slope, -off, rcond=1e-12)[0]
            z = z + step
            if step @ step <= LAST * LAST * (z @ z):
                break
        off = c + (b + B @ z) @ z
        solved = np.abs(off).max() <= 1e-10 * np.abs(c).max()
        if solved and (best is None or np.linalg.norm(z) < np.linalg.norm(best)):
            best = z
    return best
