"""What the scene does not need is not solved: rows against the rates of all that moves.

Derivatives of rows are against world-axes rates, six of each moving frame: see `world_rates`.
Which rows are redundant: redundant.py.  Whether motion stays in a plane: planar.py.
"""

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.dense import least_squares
from trsim.assemble.equations import constraints, poses
from trsim.assemble.projection import move_all
from trsim.elements.scene import Model, Scene, workspace

Array = NDArray[np.float64]

IN_PLANE = [0, 1, 5]  # of the six world-axes rates of a rigid body
NODE_IN_PLANE = [0, 1, 3, 4]  # and of a node of a beam, see `world_rates`


def jacobian(model: Model, t: float, y: Array) -> tuple[Array, Array, Array]:
    """Phi (m), Phi_t (m) and J (m, 6 (n-1)) against the world-axes rates of the moving frames."""
    w = workspace(model)
    poses(w, y)
    constraints(w, t)
    m = model.m
    J = np.zeros((m, model.n, 6))
    for end, block in ((0, w.J[:m, :6]), (1, w.J[:m, 6:])):
        J[np.arange(m), model.row_frame[:, end]] = block
    return (
        w.phi[:m].copy(),
        w.phi_t[:m].copy(),
        against_rates(w, J[:, 1:].reshape(m, 6 * (model.n - 1))),
    )


def all_rows(work: Scene, y: Array) -> Array:
    """J against the world-axes rates, of the rows of the solve and of the redundant ones."""
    poses(work, y)
    constraints(work, 0.0)
    frames = np.vstack([work.row_frame, work.redundant[:, :2]])
    J = np.zeros((len(frames), work.n, 6))
    for end, block in ((0, work.J[:, :6]), (1, work.J[:, 6:])):
        J[np.arange(len(frames)), frames[:, end]] = block
    return against_rates(work, J[:, 1:].reshape(len(frames), 6 * (work.n - 1)))


def moves(model: Model, planar: bool) -> NDArray[np.bool_]:
    """Which world-axes rates there are (6 (n-1)): in the plane, or all."""
    found = np.ones((model.n - 1, 6), bool)
    if planar:
        found[:] = False
        found[: model.n_r - 1, IN_PLANE] = True
        found[model.n_r - 1 :, NODE_IN_PLANE] = True
    return found.ravel()


def against_rates(work: Scene, rows: Array) -> Array:
    """Rows against world-axes twists (k, 6 (n-1)) as rows against world-axes rates.

    What turns a node of a beam moves its slope g: omega = g x g' / |g|^2; m -> m x g / |g|^2.
    """
    if work.n_r == work.n:
        return rows
    shape = rows.shape
    rows = rows.reshape(len(rows), work.n - 1, 6).copy()
    g = work.G[work.n_r :, :3]
    square = np.sum(g * g, axis=1)[:, None]
    m, on, back = rows[:, work.n_r - 1 :, 3:], [1, 2, 0], [2, 0, 1]
    rows[:, work.n_r - 1 :, 3:] = (m[..., on] * g[:, back] - m[..., back] * g[:, on]) / square
    return rows.reshape(shape)


def along_rates(work: Scene, wrenches: Array) -> Array:
    """Wrenches (n, 6) on the frames, and the elastic forces along the slopes of the workspace, as
    forces along the world-axes rates (6 (n-1))."""
    found = against_rates(work, wrenches[1:].reshape(1, -1)).reshape(-1, 6).copy()
    found[work.n_r - 1 :, 3:] += work.Q[work.n_r :]
    return found.ravel()


def world_rates(model: Model, y: Array) -> Array:
    """Rates of the moving frames, one vector (6 (n-1)): the twist of a rigid body in world axes;
    of a node of a beam those of its place and of its slope."""
    w = workspace(model)
    poses(w, y)
    rates = w.V[1:].copy()
    rates[w.n_r - 1 :, 3:] = w.G[w.n_r :, 3:]
    return rates.ravel()


def weights(model: Model) -> Array:
    """sqrt(M^-1) of the world-axes rates, nearly: positions moved by it cost equal energy."""
    trace = np.maximum(model.inertia[1:, 0] + model.inertia[1:, 4] + model.inertia[1:, 8], 1e-300)
    arm = np.sqrt(trace / np.maximum(model.mass[1:], 1e-300))
    return np.stack([np.ones_like(arm)] * 3 + [1.0 / np.maximum(arm, 1e-9)] * 3, axis=1).ravel()


def displaced(model: Model, y: Array, dx: Array) -> Array:
    """y after small displacements dx (6 (n-1)) along the world-axes rates of the moving frames."""
    y = y.copy()
    w = workspace(model)
    poses(w, y)
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


def closest(
    model: Model,
    t: float,
    y: Array,
    active: NDArray[np.int64] | None = None,
    free: NDArray[np.bool_] | None = None,
    steps: int = 60,
) -> tuple[Array, float]:
    """Newton with least squares onto the constraints; works with redundant rows.

    free: world-axes rates that may move.  Returns y and the largest residual left.
    """
    scale = weights(model)
    free = moves(model, False) if free is None else free
    for _ in range(steps):
        phi, _, J = jacobian(model, t, y)
        if active is not None:
            phi, J = phi[active], J[active]
        worst = float(np.max(np.abs(phi), initial=0.0))
        if worst < 1e-14 * model.size:
            break
        dx = np.zeros(free.size)
        dx[free] = -scale[free] * least_squares(J[:, free] * scale[free], phi, 1e-10)
        # a far start must not overshoot: at most 0.3 rad, or 0.3 of the mechanism's size
        parts = np.abs(dx).reshape(-1, 6)
        far = max(float(np.max(parts[:, :3])) / model.size, float(np.max(parts[:, 3:])))
        y = displaced(model, y, dx * (0.3 / max(far, 0.3)))
    phi = jacobian(model, t, y)[0]
    phi = phi if active is None else phi[active]
    return y, float(np.max(np.abs(phi), initial=0.0))
