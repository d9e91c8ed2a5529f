"""The sparse Jacobian of the stabilised equations: differences, many columns at a time.

Two columns are found by one difference where no row depends on both [CurtisPowellReid1974].  Steps
are those of jacobian.py.
"""

from math import sqrt

from trsim.assemble.equations import evaluate, set_poses, stiffnesses
from trsim.assemble.linear import substitute
from trsim.assemble.schur import velocity_residual
from trsim.elements.contract import Pair
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear, copy_to
from trsim.solve.march.norm import weight_of
from trsim.solve.march.record import FRESH
from trsim.solve.methods.auto import ITERATIONS, grown, sown
from trsim.solve.methods.displacements import (
    active,
    displace,
    first_of,
    part_of,
    place_of,
    w_index,
    width_of,
)
from trsim.solve.methods.ggl_equations import across, add_product, pull, unweighed
from trsim.solve.methods.jacobian import PART


@internal
def sparse_jacobian(s, r, b, setting, trial, lam):
    """The derivatives of `pull`, B and Phi_z at the state of the record.

    trial, lam: scratch (n_y).
    """
    t, tolerance = r.t, setting.step_error
    evaluate(s, t, r.y, trial)
    copy_to(lam, s.lam)
    pull(s, t, r.y, lam, b.pull0)
    for p in range(s.slot_row.size):
        for c in range(6):
            r.at_rows[p, c] = r.at_push[p, c] = s.B[p, c]
    for j in range(s.m):
        b.rate0[j] = velocity_residual(s, j)
    for k in range(b.state_row.shape[0]):
        r.at_state[k] = -s.phi[b.state_row[k, 0]]
    for g in range(b.group_start.size - 1):
        first, end = b.group_start[g], b.group_start[g + 1]
        if b.group[first] < s.n_v:
            copy_to(trial, r.y)
            for q in range(first, end):
                displace(s, trial, b.group[q], step_of_place(s, r, tolerance, b.group[q]))
            pull(s, t, trial, lam, b.pull)
            for q in range(first, end):
                k = b.group[q]
                divide(b, r.at_place, k, step_of_place(s, r, tolerance, k))
            turning(s, r, b, g, part_of(s, b.group[first]), tolerance)
        copy_to(trial, r.y)
        for q in range(first, end):
            i = w_index(s, b.group[q])
            trial[i] += step_of_rate(s, r, tolerance, i)
        pull(s, t, trial, lam, b.pull)
        for q in range(first, end):
            k = b.group[q]
            i = w_index(s, k)
            divide(b, r.at_rate, k, trial[i] - r.y[i])
            for e in range(b.state_row.shape[0]):
                if b.state_row[e, 1] == k:
                    change = r.at_state[e] + s.phi[b.state_row[e, 0]]
                    r.at_state[e] = change / (trial[i] - r.y[i])
    for k in range(s.rubbing.shape[0]):
        rubbing(s, r, b, t, lam, k)
    if s.n_r < s.n:
        elastic(s, r, b, t)
    r.jacobian = FRESH
    r.jacobians += 1


@internal
def elastic(s, r, b, t):
    """The columns of nodes on which nothing but their beam acts, from its tangent."""
    for k in range(s.v_node, s.n_v):
        if b.in_group[k] < 0:
            for e in range(b.column_start[k], b.column_start[k + 1]):
                r.at_place[e], r.at_rate[e] = 0.0, 0.0
    set_poses(s, r.y)
    stiffnesses(s, t)
    for n in range(b.entry_beam.shape[0]):
        for i in range(12):
            for j in range(12):
                e = b.entry_beam[n, 12 * i + j]
                if e >= 0:
                    r.at_place[e] -= s.tangent[12 * n + i, j]
                    r.at_rate[e] -= s.viscous[12 * n + i, j]


@internal
def rubbing(s, r, b, t, lam, k):
    """What the k-th friction takes from B^T, by differences: it goes with lam of its joint."""
    first, end = s.rubbing[k, 2], s.rubbing[k, 2] + s.rubbing[k, 3]
    own = Pair(s, s.rubbing[k, 0])
    size = 0.0
    for c in range(first, end):
        j = s.con[s.rubbing[k, 1], c]
        size = max(size, abs(lam[j]) if j >= 0 else 0.0)
    step = PART * size if size > 0.0 else PART
    for c in range(first, end):
        j = s.con[s.rubbing[k, 1], c]
        if j < 0:
            continue
        before = lam[j]
        lam[j] += step
        pull(s, t, r.y, lam, b.pull)
        lam[j] = before
        for f in (own.i, own.j):
            for p in range(s.frame_start[f], s.frame_start[f + 1]):
                for a in range(width_of(s, f) if s.slot_row[p] == j and f > 0 else 0):
                    v = first_of(s, f) + a
                    r.at_push[p, a] = (b.pull0[v] - b.pull[v]) / step


@internal
def turning(s, r, b, g, a, tolerance):
    """Change of Phi' with the a-th displacement of the bodies of a group, at the same v."""
    for f in range(1, s.n):
        k = first_of(s, f) + a
        if a < width_of(s, f) and b.in_group[k] == g:
            for p in range(s.frame_start[f], s.frame_start[f + 1]):
                j = s.slot_row[p]
                change = velocity_residual(s, j) - b.rate0[j]
                r.at_turn[p, a] = change / step_of_place(s, r, tolerance, k)


@internal
def step_of_place(s, r, tolerance, k):
    """Step of the k-th displacement: a part of the unit of its velocity's partner."""
    turns = s.d == 6 and k < s.v_node and k % 6 > 2
    half = 2.0 if turns else 1.0  # half a turn vector makes a quaternion
    return PART * half / (weight_of(s, r, tolerance, place_of(s, k)) * tolerance)


@internal
def step_of_rate(s, r, tolerance, i):
    weight = weight_of(s, r, tolerance, i)
    return PART / (weight * tolerance) if weight > 0.0 else PART


@internal
def divide(b, at, k, step):
    """Column k of a Jacobian from the loads before and after."""
    for e in range(b.column_start[k], b.column_start[k + 1]):
        i = b.row[e]
        at[e] = (b.pull[i] - b.pull0[i]) / step


@internal
def fastest(s, r, b):
    """Largest eigenvalue of the linearised motion, 1/s, as auto.implicit_rate finds it."""
    n = active(s)
    x, w, u, v = b.move[0], b.pull, b.pull0, b.move[1]
    sown(s, n, x, w)
    product = 1.0
    for turn in range(ITERATIONS):
        clear(u)
        for k in range(n):
            for e in range(b.column_start[k], b.column_start[k + 1]):
                u[b.row[e]] += r.at_rate[e] * w[k]
                if k < s.n_v:
                    u[b.row[e]] += r.at_place[e] * x[k]
        unweighed(s, u, v)
        mu = b.mu[0]
        clear(mu)
        add_product(s, r.at_rows, 1.0, v, mu)
        substitute(s, b.schur, mu)
        across(s, r.at_rows, b.across, mu, v)
        copy_to(u, v)
        growth = grown(s, n, x, w, u)
        if growth == 0.0:
            return 0.0
        if turn >= ITERATIONS - 4:
            product *= growth
    return sqrt(sqrt(product))
