"""Vectors of three numbers, for compiled code, and for arrays."""

from typing import Any

import numpy as np
from numba import njit

compiled = njit(cache=True, error_model="numpy", no_cfunc_wrapper=True)


@compiled
def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@compiled
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def plus(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@compiled
def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@compiled
def times(f, a):
    return (f * a[0], f * a[1], f * a[2])


@compiled
def three(A, i, k):
    """Three numbers of row i of a table."""
    return (A[i, k], A[i, k + 1], A[i, k + 2])


@compiled
def out_of(R, b, a):
    """From the axes of body b."""
    return (
        R[b, 0, 0] * a[0] + R[b, 0, 1] * a[1] + R[b, 0, 2] * a[2],
        R[b, 1, 0] * a[0] + R[b, 1, 1] * a[1] + R[b, 1, 2] * a[2],
        R[b, 2, 0] * a[0] + R[b, 2, 1] * a[1] + R[b, 2, 2] * a[2],
    )


@compiled
def into(R, b, a):
    return (
        R[b, 0, 0] * a[0] + R[b, 1, 0] * a[1] + R[b, 2, 0] * a[2],
        R[b, 0, 1] * a[0] + R[b, 1, 1] * a[1] + R[b, 2, 1] * a[2],
        R[b, 0, 2] * a[0] + R[b, 1, 2] * a[1] + R[b, 2, 2] * a[2],
    )


@compiled
def smooth(s):
    if s <= 0.0:
        return 0.0, 0.0, 0.0
    if s >= 1.0:
        return 1.0, 0.0, 0.0
    return s * s * (3 - 2 * s), 6 * s * (1 - s), 6 - 12 * s


def crossed(a: Any, b: Any) -> np.ndarray:
    """The product of two arrays of three: numpy's own takes ten times as long."""
    x, y, z = a
    u, v, w = b
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])
