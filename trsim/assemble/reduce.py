"""What the scene does not need is not solved: planarity, redundant rows, mobility.

Planarity is read off the numbers: a row whose derivatives against z', omega_x, omega_y vanish is in
the plane; one whose derivatives against x', y', omega_z vanish is out of it.  Rows are judged
redundant by rank, at several consistent positions near the drawn one: what is dependent only at
the drawn position (a dead centre, a parallelogram lying flat) is singular, not redundant, and kept.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import constraints, poses
from trsim.assemble.projection import move_all
from trsim.assemble.rank import DEPENDENT, dependent_rows
from trsim.elements.scene import Model, workspace

Array = NDArray[np.float64]

IN_PLANE, OUT_OF_PLANE = [0, 1, 5], [2, 3, 4]
NEARLY = 1e-6  # the same at nearby positions, where an error of the drawing has grown
SAMPLES = 4
SPREAD = 0.03  # of the mechanism's size and rad: how far positions are perturbed


@dataclass(frozen=True)
class Dependence:
    """One dependent row."""

    row: int
    everywhere: bool  # at all nearby positions: redundant; only as drawn: singular


def jacobian(model: Model, t: float, y: Array) -> tuple[Array, Array, Array]:
    """Phi (m), Phi_t (m) and J (m, 6 (n-1)) against the world-axes twists of the moving frames."""
    w = workspace(model)
    poses(w, y)
    constraints(w, t)
    J = np.zeros((model.m, model.n, 6))
    for end, block in ((0, w.J[:, :6]), (1, w.J[:, 6:])):
        J[np.arange(model.m), model.row_frame[:, end]] = block
    return w.phi.copy(), w.phi_t.copy(), J[:, 1:].reshape(model.m, 6 * (model.n - 1))


def weights(model: Model) -> Array:
    """sqrt(M^-1) of the world-axes twists, nearly: positions moved by it cost equal energy."""
    trace = np.maximum(model.inertia[1:, 0] + model.inertia[1:, 4] + model.inertia[1:, 8], 1e-300)
    arm = np.sqrt(trace / np.maximum(model.mass[1:], 1e-300))
    return np.stack([np.ones_like(arm)] * 3 + [1.0 / np.maximum(arm, 1e-9)] * 3, axis=1).ravel()


def displaced(model: Model, y: Array, dx: Array) -> Array:
    """y after small world-axes displacements dx (6 (n-1)) of the moving frames."""
    y = y.copy()
    w = workspace(model)
    steps = dx.reshape(-1, 6)
    if model.d == 3:
        steps = steps[:, IN_PLANE]
    else:
        poses(w, y)
        R = w.X[1:, 3:].reshape(-1, 3, 3)
        steps = np.hstack([steps[:, :3], np.einsum("fij,fi->fj", R, steps[:, 3:])])
    move_all(w, y, np.ascontiguousarray(steps).ravel())
    return y


def closest(model: Model, t: float, y: Array, active: NDArray[np.int64] | None = None,
            columns: list[int] | None = None, steps: int = 60) -> tuple[Array, float]:  # fmt: skip
    """Newton with least squares onto the constraints; works with redundant rows.

    columns: twist components (0..5) that may move.  Returns y and the largest residual left.
    """
    scale = weights(model)
    allowed = np.zeros((model.n - 1, 6), bool)
    allowed[:, columns if columns is not None else range(6)] = True
    free = allowed.ravel()
    for _ in range(steps):
        phi, _, J = jacobian(model, t, y)
        if active is not None:
            phi, J = phi[active], J[active]
        worst = float(np.max(np.abs(phi), initial=0.0))
        if worst < 1e-14 * model.size:
            break
        dx = np.zeros(free.size)
        dx[free] = -scale[free] * np.linalg.lstsq(J[:, free] * scale[free], phi, rcond=1e-10)[0]
        # a far start must not overshoot: at most 0.3 rad, or 0.3 of the mechanism's size
        parts = np.abs(dx).reshape(-1, 6)
        far = max(float(np.max(parts[:, :3])) / model.size, float(np.max(parts[:, 3:])))
        y = displaced(model, y, dx * (0.3 / max(far, 0.3)))
    phi = jacobian(model, t, y)[0]
    phi = phi if active is None else phi[active]
    return y, float(np.max(np.abs(phi), initial=0.0))


def dependences(model: Model, y: Array, columns: list[int], order: list[int],
                geometric: list[int]) -> list[Dependence]:  # fmt: skip
    """Dependent rows as drawn, and whether they stay so at nearby consistent positions.

    order: priority of the rows; geometric: the rows positions must keep to when perturbed (all
    but the drives).
    """
    keep = np.array([6 * f + c for f in range(model.n - 1) for c in columns], int)
    scale = weights(model)[keep]
    here = dependent_rows(jacobian(model, 0.0, y)[2][:, keep], scale, order)
    if not here:
        return []
    always = None
    for near in nearby(model, y, columns, geometric):
        J = jacobian(model, 0.0, near)[2][:, keep]
        there = dependent_rows(J, scale, order, NEARLY)
        if len(there) > len(here):  # no rank is lower there: these rows are nearly parallel
            there = dependent_rows(J, scale, order)
        always = there if always is None else always & there
    if always is None:
        always = here
    return [Dependence(k, k in always) for k in sorted(here | always)]


def nearby(model: Model, y: Array, columns: list[int], geometric: list[int]) -> Iterator[Array]:
    """Consistent positions around y, SPREAD away in the twist components of `columns`.

    geometric: the rows positions keep to.  At most SAMPLES; always the same ones.  They are reached
    along motions the rows allow: from elsewhere Newton follows the nearly dependent directions of
    redundant rows far away, to where these rows happen to be independent.  Where such a motion ends
    at once (a dead centre, nothing moves) they are reached from anywhere.
    """
    rng = np.random.default_rng(0)
    keep = np.array([6 * f + c for f in range(model.n - 1) for c in columns], int)
    rows = np.array(geometric, np.int64)
    scale = weights(model)[keep]
    J = jacobian(model, 0.0, y)[2][rows][:, keep]
    size = np.where(np.array(columns) < 3, model.size, 1.0)
    for _ in range(SAMPLES):
        way = SPREAD * (rng.normal(size=(model.n - 1, len(columns))) * size).ravel()
        free = way - scale * np.linalg.lstsq(J * scale, J @ way, rcond=DEPENDENT)[0]
        far = np.max(np.abs(free.reshape(-1, len(columns)) / size))
        for step in (free * (SPREAD / max(far, 1e-3 * SPREAD)), way):
            dx = np.zeros((model.n - 1, 6))
            dx[:, columns] = step.reshape(-1, len(columns))
            near, left = closest(model, 0.0, displaced(model, y, dx.ravel()), rows, columns)
            moved = np.max(np.abs((near - y)[: model.n_q]).reshape(model.n - 1, -1) / shape(model))
            if left <= 1e-9 * model.size and (moved > 0.1 * SPREAD or step is way):
                yield near
                break


def shape(model: Model) -> Array:
    """Units of the positions of one body: the mechanism's size, and 1 for its orientation."""
    return np.concatenate([np.full(2 if model.d == 3 else 3, model.size),
                           np.ones(1 if model.d == 3 else 4)])  # fmt: skip


def is_planar(model: Model, y: Array, sample: Any) -> tuple[bool, bool]:
    """(in one plane, held there by the joints): rows separate, loads stay in the plane.

    sample(y) -> wrenches F (n, 6) of the force elements at a state.
    """
    rng = np.random.default_rng(1)
    m = model.n - 1
    tilted = False  # moments that turn bodies out of the plane, unless something holds them
    for _ in range(2):
        dx = np.zeros((m, 6))
        dx[:, IN_PLANE] = 0.05 * rng.normal(size=(m, 3))
        near = displaced(model, y, dx.ravel())
        near[model.n_q : model.n_q + model.n_v].reshape(m, 6)[:, IN_PLANE] = rng.normal(size=(m, 3))
        J = jacobian(model, 0.0, near)[2].reshape(model.m, m, 6)
        inside = np.abs(J[:, :, IN_PLANE]).max(axis=(1, 2), initial=0.0)
        outside = np.abs(J[:, :, OUT_OF_PLANE]).max(axis=(1, 2), initial=0.0)
        if np.any((inside > 1e-9) & (outside > 1e-9 * np.maximum(1.0, model.size))):
            return False, False
        F = sample(near)[1:]
        if np.abs(F[:, 2]).max(initial=0.0) > 1e-9 * max(1.0, np.abs(F).max(initial=0.0)):
            return False, False
        tilt = np.abs(F[:, 3:5]).max(initial=0.0)
        tilted = tilted or tilt > 1e-9 * max(1.0, np.abs(F).max(initial=0.0))
    outside_rows = jacobian(model, 0.0, y)[2].reshape(model.m, m, 6)[:, :, OUT_OF_PLANE]
    outside_rows = outside_rows.reshape(model.m, 3 * m)
    held = np.linalg.matrix_rank(outside_rows, tol=1e-8) == 3 * m if model.m else m == 0
    if tilted and not held:
        return False, False
    return True, bool(held)
