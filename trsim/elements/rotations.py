"""The turn of one triad of axes against another, as a rotation vector.

    Q = A_i^T A_j = exp([theta]x)            theta the axis times the angle, 0 <= |theta| <= pi
    theta' = H omega,    H = 1 - [theta]x/2 + h [theta]x^2
    h = (1 - a/2 cot(a/2))/a^2               a = |theta|

omega is the angular velocity of j against i.  All of it in the axes i; theta has the same
components in both.  theta is smooth below half a turn, where it jumps to the turn from the other
side; H is regular up to there.  [Cardona1988]

A triad is three unit vectors in world axes.
"""

from math import atan2, sqrt, tan

from trsim.elements.frames import arm, cross, dot
from trsim.kernels.lazy import internal

SMALL = 0.1  # rad: below, h is its series; the first term left out is 5e-15 of it


@internal
def triad(X, i, x, y, z):
    """Three vectors in the axes of body i, world axes."""
    return arm(X, i, x), arm(X, i, y), arm(X, i, z)


@internal
def into(A, v):
    """A^T v: a vector in world axes, in the axes of the triad."""
    return (dot(A[0], v), dot(A[1], v), dot(A[2], v))


@internal
def out_of(A, v):
    """A v: a vector in the axes of the triad, in world axes."""
    return (
        A[0][0] * v[0] + A[1][0] * v[1] + A[2][0] * v[2],
        A[0][1] * v[0] + A[1][1] * v[1] + A[2][1] * v[2],
        A[0][2] * v[0] + A[1][2] * v[1] + A[2][2] * v[2],
    )


@internal
def rotation_vector(A_i, A_j):
    """theta, rad, by the quaternion of Q, taken from its largest component [Shepperd1978]."""
    x, y, z = into(A_i, A_j[0]), into(A_i, A_j[1]), into(A_i, A_j[2])  # columns of Q
    trace = x[0] + y[1] + z[2]
    a, b, c = y[2] - z[1], z[0] - x[2], x[1] - y[0]
    if trace >= max(x[0], y[1], z[2]):
        w, v = 1.0 + trace, (a, b, c)
    elif x[0] >= max(y[1], z[2]):
        w, v = a, (1.0 + x[0] - y[1] - z[2], y[0] + x[1], z[0] + x[2])
    elif y[1] >= z[2]:
        w, v = b, (x[1] + y[0], 1.0 + y[1] - z[2] - x[0], z[1] + y[2])
    else:
        w, v = c, (x[2] + z[0], y[2] + z[1], 1.0 + z[2] - x[0] - y[1])
    if w < 0.0:
        w, v = -w, (-v[0], -v[1], -v[2])
    n = sqrt(dot(v, v))
    factor = 2.0 * atan2(n, w) / n if n > 0.0 else 2.0 / w
    return (factor * v[0], factor * v[1], factor * v[2])


@internal
def gradient(theta, g):
    """H^T g: the moment that does the work of g along theta."""
    angle = sqrt(dot(theta, theta))
    if angle < SMALL:
        s = angle * angle
        h = 1.0 / 12.0 + s * (1.0 / 720.0 + s * (1.0 / 30240.0 + s / 1209600.0))
    else:
        h = (1.0 - 0.5 * angle / tan(0.5 * angle)) / (angle * angle)
    once = cross(theta, g)
    twice = cross(theta, once)
    return (
        g[0] + 0.5 * once[0] + h * twice[0],
        g[1] + 0.5 * once[1] + h * twice[1],
        g[2] + 0.5 * once[2] + h * twice[2],
    )
