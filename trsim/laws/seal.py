"""The load of a seal along a straight line whose compression changes linearly from end to end.

    x(u) = x_0 + u (x_1 - x_0),   0 <= u <= 1,        q = x^n where x > 0, otherwise 0

    Q_0 = integral of q du,   Q_1 = integral of u q du,   E = integral of x^(n+1) / (n + 1) du

with a < b the least and the largest of x above zero, and h = |x_1 - x_0|:

    h Q_0 = (b^(n+1) - a^(n+1)) / (n + 1)

and so on.  Where a and b are nearly the same Gauss's rule has all digits that differences lose.
"""

from trsim.kernels.lazy import internal

ALIKE = 0.2  # of b: less apart than that are nearly the same
# of Gauss and Legendre, on 0 .. 1
NODES = (
    *(0.0198550717512319, 0.1016667612931866, 0.2372337950418355, 0.4082826787521751),
    *(0.5917173212478249, 0.7627662049581645, 0.8983332387068134, 0.9801449282487681),
)
WEIGHTS = (
    *(0.0506142681451881, 0.1111905172266872, 0.1568533229389436, 0.1813418916891810),
    *(0.1813418916891810, 0.1568533229389436, 0.1111905172266872, 0.0506142681451881),
)


@internal
def pressed_part(x_0, x_1):
    """Between which u a line is pressed; twice the same where it is nowhere."""
    if x_0 <= 0.0 and x_1 <= 0.0:
        return 0.0, 0.0
    if x_0 > 0.0 and x_1 > 0.0:
        return 0.0, 1.0
    zero = x_0 / (x_0 - x_1)
    return (0.0, zero) if x_0 > 0.0 else (zero, 1.0)


@internal
def line_load(x_0, x_1, n):
    """Q_0, Q_1 and E.

    Parameters
    ----------
    x_0, x_1 : float     compression at both ends, in any unit; <= 0: not pressed
    n : float            exponent, > 0

    Returns
    -------
    (float, float, float)
    """
    low, high = pressed_part(x_0, x_1)
    if low == high:
        return 0.0, 0.0, 0.0
    a, b, h = max(min(x_0, x_1), 0.0), max(x_0, x_1), x_1 - x_0
    Q_0 = Q_1 = E = 0.0
    if b - a < ALIKE * b:
        for k in range(len(NODES)):
            u = low + (high - low) * NODES[k]
            x = x_0 + u * h
            q = (high - low) * WEIGHTS[k] * x**n
            Q_0, Q_1, E = Q_0 + q, Q_1 + q * u, E + q * x / (n + 1.0)
        return Q_0, Q_1, E
    size = abs(h)
    once = (b ** (n + 1.0) - a ** (n + 1.0)) / (n + 1.0)
    twice = (b ** (n + 2.0) - a ** (n + 2.0)) / (n + 2.0)
    # u = (x - x_0) / h
    return once / size, (twice - x_0 * once) / (size * h), twice / (size * (n + 1.0))
