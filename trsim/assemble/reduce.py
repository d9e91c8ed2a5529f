"""What the scene does not need is not solved: rows against the rates of all that moves.

Derivatives of rows are against world-axes rates, six of each moving frame: see `world_rates`.
Which rows are redundant: redundant.py.  Whether motion stays in a plane: planar.py.
"""

from __future__ import annotations

from collections.abc import Callable
from math import tan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import least_squares
from trsim.assemble.equations import constraints, poses
from trsim.assemble.instances import RowName
from trsim.assemble.projection import move_all
from trsim.elements.scene import Model, Scene, workspace

Array = NDArray[np.float64]

IN_PLANE = [0, 1, 5]  # of the six world-axes rates of a rigid body
NODE_IN_PLANE = [0, 1, 3, 4]  # and of a node of a beam, see `world_rates`
STEPS = 60  # of Newton's method
INDEPENDENT = 1e-10  # of the largest row: what must be left of one to be independent of others


class Drawn(NamedTuple):
    """A scene with all its rows, as drawn, and what is asked of it again and again."""

    scene: Scene
    y: Array
    rows: list[RowName]
    phi_t: Array  # of the rows
    J: Array  # against the world-axes rates
    scale: Array  # `weights`

    @classmethod
    def of(cls, full: Scene, y: Array, rows: list[RowName]) -> Drawn:
        return cls(full, y, rows, *jacobian(full, 0.0, y)[1:], weights(full))


def jacobian(model: Model, t: float, y: Array) -> tuple[Array, Array, Array]:
    """Phi (m), Phi_t (m) and J (m, 6 (n-1)) against the world-axes rates of the moving frames."""
    w = workspace(model)
    poses(w, y)
    constraints(w, t)
    m = model.m
    return w.phi[:m].copy(), w.phi_t[:m].copy(), spread_out(w, m)


def all_rows(work: Scene, y: Array) -> Array:
    """J against the world-axes rates, of the rows of the solve and of the redundant ones."""
    poses(work, y)
    constraints(work, 0.0)
    return spread_out(work, len(work.phi))


def spread_out(work: Scene, rows: int) -> Array:
    """The first rows of J of the last evaluation, against the world-axes rates (rows, 6 (n-1))."""
    J, end = np.zeros((rows, work.n, 6)), work.row_start[rows]
    J[work.line_row[:end], work.line_frame[:end]] = work.J[:end]
    return against_rates(work, J[:, 1:].reshape(rows, 6 * (work.n - 1)))


def less_reactions(work: Scene, wrenches: Array, lam: Array, J: Array | None = None) -> None:
    """wrenches (n, 6) -= J^T lam of the rows of the solve, at the last evaluation; or those of some
    states (k, n, 6), with the lines J (k, lines, 6) of each."""
    J = work.J if J is None else J
    number = np.diff(work.row_start[: work.m + 1])
    for place in range(number.max(initial=0)):
        rows = np.flatnonzero(number > place)
        line = work.row_start[rows] + place
        at: Any = (..., work.line_frame[line], slice(None))
        np.subtract.at(wrenches, at, J[..., line, :] * lam[rows, None])


def largest_reaction(work: Scene) -> float:
    """The largest force of a row on a frame along a world axis, at the last evaluation, N."""
    return float(np.abs(work.lam[work.line_row, None] * work.J[:, :3]).max(initial=0.0))


def moves(model: Model, planar: bool) -> NDArray[np.bool_]:
    """Which world-axes rates there are (6 (n-1)): in the plane, or all."""
    found = np.ones((model.n - 1, 6), bool)
    if planar:
        found[:] = False
        found[: model.n_r - 1, IN_PLANE] = True
        found[model.n_r - 1 :, NODE_IN_PLANE] = True
    return found.ravel()


def against_rates(work: Scene, rows: Array, G: Array | None = None) -> Array:
    """Rows against world-axes twists (k, 6 (n-1)) as rows against world-axes rates.

    What turns a node of a beam moves its slope g: omega = g x g' / |g|^2; m -> m x g / |g|^2.
    G: slopes of the workspace, or (k, n, 6) those of each row.
    """
    if work.n_r == work.n:
        return rows
    shape = rows.shape
    rows = rows.reshape(len(rows), work.n - 1, 6).copy()
    g = (work.G if G is None else G)[..., work.n_r :, :3]
    square = np.sum(g * g, axis=-1)[..., None]
    m, on, back = rows[:, work.n_r - 1 :, 3:], [1, 2, 0], [2, 0, 1]
    rows[:, work.n_r - 1 :, 3:] = (m[..., on] * g[..., back] - m[..., back] * g[..., on]) / square
    return rows.reshape(shape)


def along_rates(work: Scene, wrenches: Array) -> Array:
    """Wrenches (n, 6) on the frames, and the elastic forces along the slopes of the workspace, as
    forces along the world-axes rates (6 (n-1))."""
    return along_rates_of(work, wrenches[None], work.G[None], work.Q[None])[0]


def along_rates_of(work: Scene, wrenches: Array, G: Array, Q: Array) -> Array:
    """`along_rates` of some states at once (k, 6 (n-1)): their wrenches (k, n, 6), G and Q."""
    found = against_rates(work, wrenches[:, 1:].reshape(len(wrenches), -1), G)
    found = found.reshape(len(wrenches), -1, 6).copy()
    found[:, work.n_r - 1 :, 3:] += Q[:, work.n_r :]
    return found.reshape(len(wrenches), -1)


def world_rates(model: Model, y: Array) -> Array:
    """Rates of the moving frames, one vector (6 (n-1)): the twist of a rigid body in world axes;
    of a node of a beam those of its place and of its slope."""
    w = workspace(model)
    poses(w, y)
    rates = w.V[1:].copy()
    rates[w.n_r - 1 :, 3:] = w.G[w.n_r :, 3:]
    return rates.ravel()


def weights(model: Model) -> Array:
    """Units of the world-axes rates in which rows are judged: a length, a turn by a body's arm."""
    trace = np.maximum(model.inertia[1:, 0] + model.inertia[1:, 4] + model.inertia[1:, 8], 1e-300)
    arm = np.sqrt(trace / np.maximum(model.mass[1:], 1e-300))
    return np.stack([np.ones_like(arm)] * 3 + [1.0 / np.maximum(arm, 1e-9)] * 3, axis=1).ravel()


def roots(model: Model, y: Array, planar: bool) -> Array:
    """C (n-1, 6, 6) with C C^T = M^-1 against the world-axes rates, in the plane or all.

    Steps C x are compared by |x|.  The mass of a node of a beam is taken as lumped.
    """
    work = workspace(model)
    poses(work, y)
    C = np.zeros((work.n - 1, 6, 6))
    bodies, nodes = C[: work.n_r - 1], C[work.n_r - 1 :]
    place, turn = np.arange(3), np.arange(3, 6)
    C[:, place, place] = 1.0 / np.sqrt(work.mass[1:, None])
    nodes[:, turn, turn] = 1.0 / np.sqrt(work.inertia[work.n_r :, 0::4])
    R = work.X[1 : work.n_r, 3:].reshape(-1, 3, 3)
    if planar:
        I = work.inertia[1 : work.n_r].reshape(-1, 3, 3)
        bodies[:, 5, 5] = 1.0 / np.sqrt(np.einsum("fi,fij,fj->f", R[:, 2], I, R[:, 2]))
        there = moves(model, True).reshape(-1, 6)
        return C * (there[:, :, None] & there[:, None, :])
    inverse = work.inertia_inverse[1 : work.n_r].reshape(-1, 3, 3)
    bodies[:, 3:, 3:] = np.einsum("fij,fjk->fik", R, lower(inverse))
    return C


def lower(A: Array) -> Array:
    """L with L L^T = A of positive definite matrices (k, 3, 3), lower triangular."""
    L = np.zeros_like(A)
    for i in range(3):
        for j in range(i + 1):
            left = A[:, i, j] - np.sum(L[:, i, :j] * L[:, j, :j], axis=1)
            if i == j:  # rounding must not make it negative
                L[:, i, i] = np.sqrt(np.maximum(left, 1e-16 * A[:, i, i]))
            else:
                L[:, i, j] = left / L[:, j, j]
    return L


def times_roots(J: Array, C: Array) -> Array:
    """J C, of rows against world-axes rates (k, 6 (n-1))."""
    return np.einsum("kfi,fij->kfj", J.reshape(len(J), *C.shape[:2]), C).reshape(J.shape)


def shortest(J: Array, C: Array, rate: Array) -> Array:
    """The step nearest to none, in the metric of M, with J dx = rate; C: `roots`."""
    rows = times_roots(J, C)
    length = np.sqrt(np.sum(rows * rows, axis=1))
    # rows of heavy bodies count like others; those of nothing that moves remain nothing
    length[length <= INDEPENDENT * length.max(initial=0.0)] = 1.0
    x = least_squares(rows / length[:, None], rate / length, INDEPENDENT)
    return np.einsum("fij,fj->fi", C, x.reshape(C.shape[:2])).ravel()


def displaced(model: Model, y: Array, dx: Array) -> Array:
    """y after displacements dx (6 (n-1)) along the world-axes rates of the moving frames.

    Turns are those of dx, below half a turn, in space as in the plane.
    """
    y = y.copy()
    w = workspace(model)
    poses(w, y)
    if w.d == 6:
        dx = dx.reshape(-1, 6).copy()
        turns = dx[: w.n_r - 1, 3:]
        half = 0.5 * np.sqrt(np.sum(turns * turns, axis=1))
        # `move` turns by twice the arc tangent of half of what it is given
        turns *= np.array([tan(x) / x if x else 1.0 for x in half.tolist()])[:, None]
        dx = dx.ravel()
    move_all(w, y, in_solve_axes(w, dx))
    return y


def in_solve_axes(work: Scene, dx: Array) -> Array:
    """World-axes rates (6 (n-1)) in the axes of the solve (n_v), at the poses of the workspace."""
    steps = dx.reshape(-1, 6)
    bodies, nodes = steps[: work.n_r - 1], steps[work.n_r - 1 :]
    if work.d == 3:
        return np.concatenate([bodies[:, IN_PLANE].ravel(), nodes[:, NODE_IN_PLANE].ravel()])
    R = work.X[1 : work.n_r, 3:].reshape(-1, 3, 3)
    turned = np.hstack([bodies[:, :3], np.einsum("fij,fi->fj", R, bodies[:, 3:])])
    return np.concatenate([turned.ravel(), nodes.ravel()])


def closest(model: Model, t: float, y: Array) -> tuple[Array, float]:
    """Newton onto the constraints by the nearest way in the metric of M; works with redundant rows.

    Returns y and the largest residual left.
    """
    work = workspace(model)  # one for all evaluations

    def step(y: Array, J: Array, phi: Array) -> Array:
        return shortest(J, roots(work, y, work.d == 3), phi)

    return _newton(work, t, y, None, step)


def closed(
    model: Model, y: Array, rows: NDArray[np.int64], free: NDArray[np.bool_]
) -> tuple[Array, float]:
    """A place brought onto some rows by motions along the rates `free`, the nearest in the units of
    `weights`: for rows that are judged, whatever the inertias."""
    scale = weights(model)[free]

    def step(_: Array, J: Array, phi: Array) -> Array:
        dx = np.zeros(free.size)
        dx[free] = scale * least_squares(J[:, free] * scale, phi, INDEPENDENT)
        return dx

    return _newton(workspace(model), 0.0, y, rows, step)


def _newton(
    model: Scene, t: float, y: Array, rows: NDArray[np.int64] | None,
    step: Callable[[Array, Array, Array], Array],
) -> tuple[Array, float]:  # fmt: skip
    """y with Phi = 0, or nearly, of some rows or of all; and the largest residual left."""
    some = slice(None) if rows is None else rows
    for _ in range(STEPS):
        phi, _, J = jacobian(model, t, y)
        phi, J = phi[some], J[some]
        worst = float(np.max(np.abs(phi), initial=0.0))
        if worst < 1e-14 * model.size:
            break
        dx = -step(y, J, phi)
        # a far start must not overshoot: at most 0.3 rad, or 0.3 of the mechanism's size
        ways = np.sqrt(np.sum(np.square(dx.reshape(-1, 2, 3)), axis=2))
        far = max(float(np.max(ways[:, 0])) / model.size, float(np.max(ways[:, 1])))
        y = displaced(model, y, dx * (0.3 / max(far, 0.3)))
    phi = jacobian(model, t, y)[0][some]
    return y, float(np.max(np.abs(phi), initial=0.0))
