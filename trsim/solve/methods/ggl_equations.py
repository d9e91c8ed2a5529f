"""Equations of motion stabilised as by Gear, Gupta and Leimkuhler.

    x' = v - M^-1 B^T mu        M v' = f(x, v, z, t) - B^T lam        z' = g(x, v, z, t)
    0 = Phi(x, z, t)            0 = B v + Phi_t                       [GearGuptaLeimkuhler1985]

index 2, with positions and velocities on their constraints at every stage of a method; mu is zero
but for the error of the method.  x are displacements, B the rows of J in the axes of the solve.
Friction made by reactions is that of lam as it stands: f depends on lam too.
"""

from trsim.assemble.beams import divide_by_mass, slope_force, times_mass
from trsim.assemble.equations import (
    call_derivative,
    constraints,
    forces,
    free_accelerations,
    poses,
)
from trsim.assemble.schur import rows
from trsim.elements.contract import DRIVES, N_BOOK
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import clear
from trsim.solve.methods.displacements import first_of, frame_of, moved_by, part_of, width_of


@internal
def pull(s, t, y, lam, out):
    """out (n_w) <- loads less B^T lam in the axes of the solve, then z'.

    Poses, Phi, Phi_t, B and W = M^-1 B^T stay in the scene; the power of drives is in zd.
    """
    poses(s, y)
    forces(s, t)
    free_accelerations(s)
    constraints(s, t)
    if s.rubs_with != 0:
        call_derivative(s.rubs_with, s, t, lam, lam)
        free_accelerations(s)
    for f in range(s.n_r, s.n):
        v, width = first_of(s, f), s.d_node // 2
        for c in range(width):
            out[v + c], out[v + width + c] = s.F[f, c], slope_force(s, f, c)
    for f in range(1, s.n_r):
        v, a = s.d * (f - 1), s.free[f]
        if s.d == 3:
            out[v], out[v + 1], out[v + 2] = s.F[f, 0], s.F[f, 1], s.F[f, 5]
        else:
            I = s.inertia[f]
            for c in range(3):
                out[v + c] = s.F[f, c]
                out[v + 3 + c] = I[3 * c] * a[3] + I[3 * c + 1] * a[4] + I[3 * c + 2] * a[5]
    rows(s)
    for k in range(s.m):
        s.zd[DRIVES] += lam[k] * s.phi_t[k]
    away(s, s.B, lam, out)
    for k in range(N_BOOK, s.n_z):
        out[s.n_v + k - N_BOOK] = s.zd[k]


@internal
def moving(s, y, x, out):
    """out (n_q) <- rates of the coordinates y where the bodies' velocities are x (n_v)."""
    for q in range(s.n_q):
        out[q] = moved_by(s, y, q, x)


@internal
def block_times(s, m, I, x, v, out):
    """out <- the block of M of a rigid body, or of M^-1, times x; the parts of both begin at v.

    m, I: mass and moments of inertia, or the inverses of these.
    """
    if s.d == 3:
        out[v], out[v + 1], out[v + 2] = m * x[v], m * x[v + 1], I[8] * x[v + 2]
        return
    for i in range(3):
        out[v + i] = m * x[v + i]
        out[v + 3 + i] = I[3 * i] * x[v + 3] + I[3 * i + 1] * x[v + 4] + I[3 * i + 2] * x[v + 5]


@internal
def mass_times(s, x, out):
    """out (n_v) <- M x."""
    if s.n_r < s.n:
        times_mass(s, s.v_node, x, s.v_node, out)
    for f in range(1, s.n_r):
        block_times(s, s.mass[f], s.inertia[f], x, s.d * (f - 1), out)


@internal
def unweighed(s, x, out):
    """out (n_v) <- M^-1 x."""
    if s.n_r < s.n:
        for k in range(s.v_node, s.n_v):
            s.moved[frame_of(s, k), part_of(s, k)] = x[k]
        divide_by_mass(s, s.moved)
        for k in range(s.v_node, s.n_v):
            out[k] = s.moved[frame_of(s, k), part_of(s, k)]
    for f in range(1, s.n_r):
        block_times(s, s.mass_inverse[f], s.inertia_inverse[f], x, s.d * (f - 1), out)


@internal
def add_product(s, at, part, x, out):
    """out (m) += part times A x, with A (m, n_v) kept slot by slot in `at`."""
    for f in range(1, s.n):
        v, width = first_of(s, f), width_of(s, f)
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            total = 0.0
            for k in range(width):
                total += at[p, k] * x[v + k]
            out[s.slot_row[p]] += part * total


@internal
def away(s, at, mu, x):
    """x (n_v) <- x - A^T mu, with A^T kept slot by slot in `at`."""
    for f in range(1, s.n):
        v, width = first_of(s, f), width_of(s, f)
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for k in range(width):
                x[v + k] -= at[p, k] * mu[s.slot_row[p]]


@internal
def across(s, at, weighed, mu, x):
    """x (n_v) <- x - M^-1 A^T mu, with A^T slot by slot in `at`; weighed: M^-1 A^T, of the rigid
    bodies, whose M is a block for each frame."""
    for f in range(1, s.n_r):
        v = s.d * (f - 1)
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for k in range(s.d):
                x[v + k] -= weighed[p, k] * mu[s.slot_row[p]]
    if s.n_r == s.n:
        return
    for f in range(s.n_r, s.n):
        clear(s.moved[f])
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            for c in range(s.d_node):
                s.moved[f, c] += at[p, c] * mu[s.slot_row[p]]
    divide_by_mass(s, s.moved)
    for k in range(s.v_node, s.n_v):
        x[k] -= s.moved[frame_of(s, k), part_of(s, k)]
