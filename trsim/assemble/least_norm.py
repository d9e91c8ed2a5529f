"""Reactions that the motion does not determine: of all that balance it those of least norm.

    R = J^T lam            is the same for  lam + sum_d c_d n_d,      J^T n_d = 0
    n_d = (S^-1 J M^-1 J_d^T, -1)           of each redundant row J_d = sum_k n_dk J_k
    sum_e (n_d . n_e) c_e = -n_d . lam      makes sum_k (u_k lam_k)^2 smallest

u_k makes a moment a force: 1 over the mechanism's size for rows that hold a turn.  It is how joints
of one compliance would share a load.  What the motion does determine stays as it is, and what it
does not is as smooth as the motion, also where the rows of the solve come to depend on each other
and those with the redundant ones do not.
"""

from math import sqrt

from trsim.assemble.linear import SINGULAR, solve
from trsim.assemble.on_beams import STRESS, call_beams
from trsim.elements.contract import SCENE, compiled
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import void
from trsim.kernels.vectors import clear

TWICE = 2  # the second time takes what rounding has left of large multipliers
DEPENDENT = 1e-13  # of its square: what is left of a self-stress when others are taken out

LEAST = void(SCENE)
call_least_norm = caller(LEAST)


@compiled(LEAST)
def least_norm(s):
    """lam of all rows of least norm, with J, its factors and lam of the last evaluation.

    Where rows of the solve depend on each other, multipliers that are limits (beside.py) stay.
    """
    number = s.redundant.shape[0]
    s.gram[number + 1, 0] = 1.0
    if s.status[0] == SINGULAR:
        return
    self_stresses(s)
    products(s, number)
    if not decompose(s, number):
        return
    for _ in range(TWICE):
        share(s, number)


@internal
def firmness_of_all(s, pivot):
    """The pivot that rows have with the redundant ones, of the least pivot of those of the solve.

    Where these alone depend on each other nearly, delta from it, their pivot is delta^2, and a
    self-stress is 1/delta long; where all rows do it stays as it is.
    """
    if s.shared_out == 0:
        return pivot
    return min(1.0, pivot * s.gram[s.redundant.shape[0] + 1, 0])


@internal
def self_stresses(s):
    """s.stress[d] <- n_d of the rows of the solve, for each redundant row d."""
    for d in range(s.redundant.shape[0]):
        x = s.stress[d]
        clear(x)
        row = s.m + d
        for l in range(s.row_start[row], s.row_start[row + 1]):
            f = s.line_frame[l]
            if 0 < f < s.n_r:
                against(s, f, l, x)
        if s.n_r < s.n:
            call_beams(s.on_beams[STRESS], s, x, x, row)
        solve(s, x)


@internal
def against(s, f, l, x):
    """x += J M^-1 J_l^T of what line l of J, that of a redundant row, puts on frame f."""
    J, K, X, B = s.J, s.inertia_inverse, s.X, s.B
    by_mass = s.mass_inverse[f]
    if s.d == 3:
        u0, u1, u2 = J[l, 0] * by_mass, J[l, 1] * by_mass, J[l, 5] * K[f, 8]
        for p in range(s.frame_start[f], s.frame_start[f + 1]):
            x[s.slot_row[p]] += B[p, 0] * u0 + B[p, 1] * u1 + B[p, 2] * u2
        return
    t0, t1, t2 = J[l, 3], J[l, 4], J[l, 5]
    b0 = X[f, 3] * t0 + X[f, 6] * t1 + X[f, 9] * t2
    b1 = X[f, 4] * t0 + X[f, 7] * t1 + X[f, 10] * t2
    b2 = X[f, 5] * t0 + X[f, 8] * t1 + X[f, 11] * t2
    u0, u1, u2 = J[l, 0] * by_mass, J[l, 1] * by_mass, J[l, 2] * by_mass
    u3 = K[f, 0] * b0 + K[f, 1] * b1 + K[f, 2] * b2
    u4 = K[f, 3] * b0 + K[f, 4] * b1 + K[f, 5] * b2
    u5 = K[f, 6] * b0 + K[f, 7] * b1 + K[f, 8] * b2
    for p in range(s.frame_start[f], s.frame_start[f + 1]):
        x[s.slot_row[p]] += (
            B[p, 0] * u0 + B[p, 1] * u1 + B[p, 2] * u2
            + (B[p, 3] * u3 + B[p, 4] * u4 + B[p, 5] * u5)
        )  # fmt: skip


@internal
def square(s, k):
    """u_k^2 of row k."""
    u = s.row_unit[k] / s.size
    return u * u


@internal
def products(s, number):
    """s.gram <- the products of the self-stresses."""
    largest = 1.0
    for d in range(number):
        for e in range(d + 1):
            total = square(s, s.m + d) if d == e else 0.0
            for k in range(s.m):
                total += square(s, k) * s.stress[d, k] * s.stress[e, k]
            s.gram[d, e] = total
        largest = max(largest, s.gram[d, d] / square(s, s.m + d))
    s.gram[number + 1, 0] = largest


@internal
def decompose(s, number):
    """s.gram <- L of L L^T; whether its self-stresses do not depend on each other."""
    G = s.gram
    for d in range(number):
        for e in range(d + 1):
            total = G[d, e]
            for k in range(e):
                total -= G[d, k] * G[e, k]
            if d > e:
                G[d, e] = total / G[e, e]
            elif not total > DEPENDENT * G[d, d]:
                return False
            else:
                G[d, d] = sqrt(total)
    return True


@internal
def share(s, number):
    """lam += sum_d c_d n_d."""
    G, lam, c, m = s.gram, s.lam, s.gram[number], s.m
    for d in range(number):
        c[d] = square(s, m + d) * lam[m + d]  # -n_d . lam
        for k in range(m):
            c[d] -= square(s, k) * s.stress[d, k] * lam[k]
    for d in range(number):
        for e in range(d):
            c[d] -= G[d, e] * c[e]
        c[d] /= G[d, d]
    for d in range(number - 1, -1, -1):
        for e in range(d + 1, number):
            c[d] -= G[e, d] * c[e]
        c[d] /= G[d, d]
    for d in range(number):
        for k in range(m):
            lam[k] += c[d] * s.stress[d, k]
        lam[m + d] -= c[d]
