"""Turns in space as unit quaternions (x, y, z, w), as glTF has them; arrays (..., 4).

q = (sin(|d|/2) d/|d|, cos(|d|/2))         of the rotation vector d
p after q:  p q                            v turned by q:  q v q*
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STILL = np.array([0.0, 0.0, 0.0, 1.0])
TINY = 1e-12  # |d|, below which sin(|d|/2)/|d| is 1/2


def product(p: Array, q: Array) -> Array:
    """The turn q followed by the turn p, (..., 4)."""
    a, b = p[..., :3], q[..., :3]
    v = p[..., 3:] * b + q[..., 3:] * a + np.cross(a, b)
    w = p[..., 3] * q[..., 3] - np.sum(a * b, axis=-1)
    return np.concatenate([v, w[..., None]], axis=-1)


def turned(q: Array, v: Array) -> Array:
    """Vectors v (..., 3) turned by q: v + 2 a x (a x v + w v) with q = (a, w)."""
    a = q[..., :3]
    return v + 2.0 * np.cross(a, np.cross(a, v) + q[..., 3:] * v)


def back(q: Array) -> Array:
    """The turn back."""
    return q * np.array([-1.0, -1.0, -1.0, 1.0])


def of_vector(d: Array) -> Array:
    """The turn by |d| rad about d, (..., 4)."""
    size = np.linalg.norm(d, axis=-1, keepdims=True)
    part = np.where(size > TINY, np.sin(0.5 * size) / np.maximum(size, TINY), 0.5)
    return np.concatenate([part * d, np.cos(0.5 * size)], axis=-1)


def of_matrices(R: Array) -> Array:
    """The turns of rotation matrices (n, 3, 3), without jumps of sign from one to the next.

    Each of the four numbers has a formula that divides by it; the largest is taken.
    """
    xx, yy, zz = R[:, 0, 0], R[:, 1, 1], R[:, 2, 2]
    x = np.stack([1 + xx - yy - zz, R[:, 0, 1] + R[:, 1, 0], R[:, 0, 2] + R[:, 2, 0],
                  R[:, 2, 1] - R[:, 1, 2]], axis=1)  # fmt: skip
    y = np.stack([x[:, 1], 1 - xx + yy - zz, R[:, 1, 2] + R[:, 2, 1], R[:, 0, 2] - R[:, 2, 0]], 1)
    z = np.stack([x[:, 2], y[:, 2], 1 - xx - yy + zz, R[:, 1, 0] - R[:, 0, 1]], axis=1)
    w = np.stack([x[:, 3], y[:, 3], z[:, 3], 1 + xx + yy + zz], axis=1)
    forms = np.stack([x, y, z, w], axis=1)
    squares = np.stack([x[:, 0], y[:, 1], z[:, 2], w[:, 3]], axis=1)
    q = forms[np.arange(len(R)), squares.argmax(axis=1)]
    return steady(q / np.linalg.norm(q, axis=1, keepdims=True))


def steady(q: Array) -> Array:
    """These turns (n, 4), each with the sign that is nearer to the one before."""
    away = np.sum(q[1:] * q[:-1], axis=1) < 0.0
    signs = np.cumprod(np.concatenate([[1.0], np.where(away, -1.0, 1.0)]))
    return q * signs[:, None]


def composed(steps: Array) -> Array:
    """The turns after each of the steps (n, 4), one after the other, by doubling."""
    q, reach = steps.copy(), 1
    while reach < len(q):
        q[reach:] = product(q[reach:], q[:-reach])
        reach *= 2
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def shortest(a: Array, b: Array) -> Array:
    """The smallest turn of the direction of a (..., 3) to that of b."""
    a, b = np.broadcast_arrays(a, b)
    sizes = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
    q = np.concatenate([np.cross(a, b), (sizes + np.sum(a * b, axis=-1))[..., None]], axis=-1)
    size = np.linalg.norm(q, axis=-1, keepdims=True)
    # opposite directions: half a turn about anything across, z where a lies in the plane
    across = np.cross(a, np.eye(3)[np.abs(a).argmin(axis=-1)])
    half = np.concatenate([across, np.zeros((*across.shape[:-1], 1))], axis=-1)
    flat = (np.abs(a[..., 2:]) == 0.0) & (np.abs(b[..., 2:]) == 0.0)
    half = np.where(flat, [0.0, 0.0, 1.0, 0.0], half)
    opposite = size <= 1e-9 * sizes[..., None]
    q = np.where(opposite, half, q)
    size = np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(size > 0.0, q / np.where(size > 0.0, size, 1.0), STILL)


def steps(time: Array, omega: Array, alpha: Array | None) -> Array:
    """The turns from each row to the next, (n - 1, 4), of angular velocities (n, 3), world axes.

    d = h/2 (w0 + w1) + h^2/12 (a0 - a1) + h^2/12 w1 x w0         order 4 (Magnus, Hermite)
    """
    h = np.diff(time)[:, None]
    d = 0.5 * h * (omega[:-1] + omega[1:]) + h**2 / 12.0 * np.cross(omega[1:], omega[:-1])
    if alpha is not None:
        d += h**2 / 12.0 * (alpha[:-1] - alpha[1:])
    return of_vector(d)
