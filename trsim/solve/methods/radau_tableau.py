"""Radau IIA of three stages: nodes, weights, the real form of A^-1, weights of the error estimate.

T^-1 A^-1 T = diag(gamma, [[alpha, -beta], [beta, alpha]])                [HairerWanner1996]
"""

from math import sqrt

import numpy as np

from trsim.assemble.dense import inverse

_S6 = sqrt(6.0)
C = np.array([(4.0 - _S6) / 10.0, (4.0 + _S6) / 10.0, 1.0])
A = np.array(
    [
        [(88.0 - 7.0 * _S6) / 360.0, (296.0 - 169.0 * _S6) / 1800.0, (-2.0 + 3.0 * _S6) / 225.0],
        [(296.0 + 169.0 * _S6) / 1800.0, (88.0 + 7.0 * _S6) / 360.0, (-2.0 - 3.0 * _S6) / 225.0],
        [(16.0 - _S6) / 36.0, (16.0 + _S6) / 36.0, 1.0 / 9.0],
    ]
)


def _transformed():
    """Real basis T with T^-1 A^-1 T = diag(gamma, [[alpha, -beta], [beta, alpha]]).

    The eigenvalues of A^-1 are the roots of x^3 - 9 x^2 + 36 x - 60 [HairerWanner1996 IV.8].
    """
    third = 3.0 ** (1.0 / 3.0)
    gamma = 3.0 + third * third - third
    alpha, beta = 3.0 + 0.5 * (third - third * third), 0.5 * sqrt(3.0) * (third * third + third)
    u, w = _vector(1.0 / gamma), _vector(1.0 / complex(alpha, beta))
    # columns Re w, -Im w of A^-1 w = (alpha + i beta) w give that block
    T = np.column_stack([u.real, w.real, -w.imag])
    return T, inverse(T), gamma, alpha, beta


def _vector(value):
    """Of unit length, with A x = value x, by Cramer's rule with the last entry 1."""
    (a, b, e), (c, d, f) = A[:2].tolist()
    a, d = a - value, d - value
    x = np.array([b * f - e * d, e * c - a * f, a * d - b * c])
    return x / sqrt(float(np.sum(x.real**2 + x.imag**2)))


T, T_INVERSE, GAMMA, ALPHA, BETA = _transformed()
E = np.array([-13.0 - 7.0 * _S6, -13.0 + 7.0 * _S6, -1.0]) / 3.0  # of the error estimate
