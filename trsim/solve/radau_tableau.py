"""Radau IIA of three stages: nodes, weights, the real form of A^-1, weights of the error estimate.

T^-1 A^-1 T = diag(gamma, [[alpha, -beta], [beta, alpha]])                [HairerWanner1996]
"""

from math import sqrt

import numpy as np

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
    """Real basis T with T^-1 A^-1 T = diag(gamma, [[alpha, -beta], [beta, alpha]])."""
    values, vectors = np.linalg.eig(np.linalg.inv(A))
    real = int(np.argmin(np.abs(values.imag)))
    pair = int(np.argmax(values.imag))
    # columns Re u, -Im u of A^-1 u = (alpha + i beta) u give that block
    T = np.column_stack([vectors[:, real].real, vectors[:, pair].real, -vectors[:, pair].imag])
    return T, np.linalg.inv(T), values[real].real, values[pair].real, values[pair].imag


T, T_INVERSE, GAMMA, ALPHA, BETA = _transformed()
E = np.array([-13.0 - 7.0 * _S6, -13.0 + 7.0 * _S6, -1.0]) / 3.0  # of the error estimate
