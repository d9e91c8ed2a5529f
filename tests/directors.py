"""The chain of thin rods in other coordinates, by another integrator: the independent check of P5.

Each axisymmetric rod is its unit vector d_k alone: nothing can twist it, so its spin s_k about
itself is constant.  With r_k = L sum_{j<k} d_j + L/2 d_k and C = dr/dd the kinetic energy is
1/2 sum A_jk d_j' . d_k',  A = m C^T C + J_t 1,  and the motion is

    A d'' = G + J_a s_k (d_k x d_k') + lambda_k d_k        d_k . d_k'' = -|d_k'|^2

with A constant: lambda solves (A^-1)_jk (d_j . d_k) lambda_k = -|d_j'|^2 - d_j . (A^-1 (...))_j.
"""

import numpy as np
from scipy.integrate import DOP853

from benchmarks.problems import ABOUT, ACROSS, LENGTH, MASS


def tip(rods, end=0.2, tolerance=1e-13):
    """Tip (3,) m of a chain of rods (angle in the plane, turn about y, spin about itself)."""
    n = len(rods)
    angle, turn, spin = np.array(rods).T
    d = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(n)])
    y_axis = np.array([0.0, 1.0, 0.0])
    rate = np.cross(turn[:, None] * y_axis, d)
    spin = spin + turn * d[:, 1]
    C = LENGTH * (np.tri(n, k=-1) + 0.5 * np.eye(n))
    A_inverse = np.linalg.inv(MASS * C.T @ C + ACROSS * np.eye(n))
    G = -9.81 * MASS * C.sum(axis=0)[:, None] * y_axis

    def rates(t, y):
        d, v = y.reshape(2, n, 3)
        a = A_inverse @ (G + ABOUT * spin[:, None] * np.cross(d, v))
        right = -np.sum(v * v, axis=1) - np.sum(d * a, axis=1)
        pull = np.linalg.solve(A_inverse * (d @ d.T), right)
        return np.concatenate([v, a + A_inverse @ (pull[:, None] * d)]).ravel()

    y = np.concatenate([d, rate]).ravel()
    solver = DOP853(rates, 0.0, y, end, rtol=tolerance, atol=tolerance)
    while solver.status == "running":
        solver.step()
    return LENGTH * solver.y.reshape(2, n, 3)[0].sum(axis=0)
