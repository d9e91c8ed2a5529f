"""Back to the constraints, along the shortest way in the metric of M.

dq = -M^-1 J^T S^-1 Phi,      dv = -M^-1 J^T S^-1 (J v + Phi_t),      S = J M^-1 J^T
"""

import numpy as np

from trsim.assemble.equations import constraints, poses
from trsim.assemble.linear import refactorise, smallest_pivot, solve
from trsim.assemble.on_beams import PULL, call_beams
from trsim.assemble.schur import pull, velocity_residual
from trsim.elements.contract import SCENE, compiled
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, f8, float64, i8, void
from trsim.kernels.vectors import clear, clear_table

DOUBTFUL = 1e-2  # a pivot, of its diagonal
CLOSED = 1e-14  # of the mechanism's size: as nearly as rows are closed
NEWTON = 8  # steps of Newton's method


@compiled(void(SCENE, A1, A1))
def move_all(s, y, dx):
    """Move all bodies by the small displacements dx (n_v) in the axes of the solve."""
    for f in range(1, s.n_r):
        move(s, y, f, dx[s.d * (f - 1) : s.d * f])
    for k in range(s.v_node, s.n_v):
        y[s.q_node + k - s.v_node] += dx[k]


@internal
def move(s, y, f, dx):
    """Move the rigid body of frame f by the small displacement dx (d) in the axes of the solve."""
    if s.d == 3:
        for a in range(3):
            y[3 * (f - 1) + a] += dx[a]
        return
    q = 7 * (f - 1)
    for a in range(3):
        y[q + a] += dx[a]
    e0, e1, e2, e3 = y[q + 3], y[q + 4], y[q + 5], y[q + 6]
    o0, o1, o2 = 0.5 * dx[3], 0.5 * dx[4], 0.5 * dx[5]
    y[q + 3] = e0 - e1 * o0 - e2 * o1 - e3 * o2
    y[q + 4] = e1 + e0 * o0 + e2 * o2 - e3 * o1
    y[q + 5] = e2 + e0 * o1 + e3 * o0 - e1 * o2
    y[q + 6] = e3 + e0 * o2 + e1 * o1 - e2 * o0
    length = np.sqrt(y[q + 3] ** 2 + y[q + 4] ** 2 + y[q + 5] ** 2 + y[q + 6] ** 2)
    for a in range(4):
        y[q + 3 + a] /= length


@internal
def normalise(s, y):
    """Quaternions back to length one."""
    if s.d == 6:
        for f in range(1, s.n_r):
            q = 7 * (f - 1) + 3
            length = np.sqrt(y[q] ** 2 + y[q + 1] ** 2 + y[q + 2] ** 2 + y[q + 3] ** 2)
            for a in range(4):
                y[q + a] /= length


POSITIONS = float64(SCENE, f8, A1)
call_positions = caller(POSITIONS)
STATE = void(SCENE, f8, A1)
call_state = caller(STATE)


@internal
def newton_step(s, t, y):
    """`project_positions` called by its address: compiled once, not into every caller."""
    return call_positions(s.newton_step, s, t, y)


@compiled(POSITIONS)
def project_positions(s, t, y):
    """One Newton step of Phi(q, t) = 0, nearest in the metric of M.  Returns the largest |Phi|.

    dq = -M^-1 J^T S^-1 Phi.  Uses and refreshes J and S at the given y.
    """
    poses(s, y)
    constraints(s, t)
    refactorise(s)
    worst = 0.0
    for k in range(s.m):
        s.x[k] = s.phi[k]
        worst = max(worst, abs(s.phi[k]))
    if worst == 0.0:
        return worst
    solve(s, s.x)
    dx = s.free
    clear_table(dx)
    for f in range(1, s.n_r):
        pull(s, f, s.x)
        move(s, y, f, dx[f])
    if s.n_r < s.n:
        call_beams(s.on_beams[PULL], s, s.x, s.x, 0)
        for k in range(s.n_v - s.v_node):
            y[s.q_node + k] += dx[s.n_r + k // s.d_node, k % s.d_node]
    return worst


@compiled(float64(SCENE, f8, A1, f8, i8))
def close_positions(s, t, y, near, steps):
    """Newton's steps of Phi(q, t) = 0 until all of it is below `near`; the largest |Phi| at last.

    steps: at most so many, at least one.  What is returned was there before the last of them.
    """
    worst = 0.0
    for _ in range(steps):
        worst = newton_step(s, t, y)
        if not worst > near:
            break
    return worst


@internal
def brought_back(s, y, first):
    """y[first:] -= M^-1 J^T S^-1 x of rigid bodies, with the factors at hand; x, and then S^-1 x,
    is in s.x."""
    solve(s, s.x)
    clear_table(s.free)
    for f in range(1, s.n_r):
        pull(s, f, s.x)
        for a in range(s.d):
            y[first + s.d * (f - 1) + a] += s.free[f, a]


@internal
def onto_rows(s, w):
    """w -= M^-1 J^T S^-1 J w: what the rows allow of rates of bodies, nearest in the metric of M.

    With the factors at hand; in mechanisms with beams w stays as it is.
    """
    if s.m == 0 or s.n_r < s.n:
        return
    clear(s.x)
    for f in range(1, s.n_r):
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for a in range(s.d):
                s.x[s.slot_row[p]] += s.B[p, a] * w[s.d * (f - 1) + a]
    brought_back(s, w, 0)


@internal
def set_poses_and_rows(s, t, y):
    """`poses_and_rows` called by its address."""
    call_state(s.poses_and_rows, s, t, y)


@compiled(STATE)
def poses_and_rows(s, t, y):
    """The poses of y, for its velocities; where rows nearly depend on each other its rows too.

    Those of the last Newton step are of the place before it.  Such a step moves bodies by many
    times what rows are open by, rounding included, and velocities off the rows by as much are felt
    as many times over again.  In open chains only masses make pivots small.
    """
    poses(s, y)
    if s.near == 0.0 and s.redundant.shape[0] == 0:
        return
    if smallest_pivot(s) > DOUBTFUL:
        return
    constraints(s, t)
    refactorise(s)


@internal
def put_on_rows(s, t, y):
    """Bring a state to the rows, its velocities too, as closely as rounding lets."""
    call_state(s.on_rows, s, t, y)


@compiled(STATE)
def on_rows(s, t, y):
    """`put_on_rows`, compiled once."""
    close_positions(s, t, y, CLOSED * s.size, NEWTON)
    set_poses_and_rows(s, t, y)
    project_velocities(s, y)


@compiled(float64(SCENE, A1))
def project_velocities(s, y):
    """v -= M^-1 J^T S^-1 (J v + Phi_t), with J, S and V of the last evaluation.

    Returns the largest |Phi'| found.  Call after `project_positions` or `derivative`; V is stale
    afterwards.
    """
    worst = 0.0
    for k in range(s.m):
        s.x[k] = velocity_residual(s, k)
        worst = max(worst, abs(s.x[k]))
    brought_back(s, y, s.n_q)
    if s.n_r < s.n:
        call_beams(s.on_beams[PULL], s, s.x, s.x, 0)
        for k in range(s.n_v - s.v_node):
            y[s.n_q + s.v_node + k] += s.free[s.n_r + k // s.d_node, k % s.d_node]
    return worst
