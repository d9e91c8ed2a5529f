"""The load of a seal along a straight line whose compression changes linearly from end to end.

    x(u) = x_0 + u (x_1 - x_0),   0 <= u <= 1,        q = x^n where x > 0, otherwise 0

    Q_0 = integral of q du,   Q_1 = integral of u q du,   E = integral of x^(n+1) / (n + 1) du

with a < b the least and the largest of x above zero, and h = |x_1 - x_0|:

    h Q_0 = (b^(n+1) - a^(n+1)) / (n + 1)

and so on.  Where a and b are nearly the same Gauss's rule has all digits that differences lose.

Its friction, where sliding changes linearly along it, v(u) = v_0 + u d, with its slowest place u*
and the speed m there:

    integral of q mu min(1, |v| / v_1) v / |v| du

Between the places at which |v| = v_1 the integrand is q times a linear function; beyond them it is
smooth in z, u = u* + (m / |d|) sinh z, however near to rest the slowest place is.  So the line is
cut at these places, or at u* where there are none.
"""

from math import asinh, sinh, sqrt

from trsim.kernels.lazy import internal

NEAREST = 1e-9  # of the line: what m / |d| is at least, so that z stays below 24
FAR = 4.0  # lines: where nothing is at rest nearer than that, the rule in u has all digits
PIECES, SLOW = 5, 2  # of a line: two halves in z up to its slow part, that part, two halves beyond
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


@internal
def whole_of(part):
    """The cuts of a part that is one piece, plain in u."""
    low, high = part
    return low, high, high, high, 0.0, 0.0


@internal
def cuts(part, v_0, d, full):
    """Where the pieces of a line end: low, a, b, high, then u* and m / |d|, which is 0 where pieces
    are plain in u.

    Parameters
    ----------
    part : (float, float)                where it is pressed, 0 <= u <= 1
    v_0, d : (float, float, float)       how its beginning slides, and what its end does otherwise
    full : float                         speed v_1 from which friction is full; 0: everywhere

    Returns
    -------
    (float, float, float, float, float, float)
    """
    low, high = part
    dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    if dd == 0.0:
        return whole_of(part)
    at = -(v_0[0] * d[0] + v_0[1] * d[1] + v_0[2] * d[2]) / dd
    x, y, z = v_0[0] + at * d[0], v_0[1] + at * d[1], v_0[2] + at * d[2]
    mm = x * x + y * y + z * z
    half = sqrt(max(full * full - mm, 0.0) / dd)
    a, b = min(max(at - half, low), high), min(max(at + half, low), high)
    near = max(sqrt(mm / dd), NEAREST)
    if near + max(low - at, at - high) > FAR:  # and rounding of u* would be felt
        near = 0.0
    return low, a, b, high, at, near


@internal
def node(cuts, piece, k):
    """The k-th place of Gauss's rule on a piece, and its weight."""
    low, a, b, high, at, near = cuts
    slow, second = piece == SLOW, piece == 1 or piece == PIECES - 1
    begin, end = (a, b) if slow else ((low, a) if piece < SLOW else (b, high))
    if slow or near == 0.0 or begin == end:
        weight = 0.0 if second else WEIGHTS[k]
        return begin + (end - begin) * NODES[k], (end - begin) * weight
    first, last = asinh((begin - at) / near), asinh((end - at) / near)
    first, last = (0.5 * (first + last), last) if second else (first, 0.5 * (first + last))
    z = sinh(first + (last - first) * NODES[k])
    return at + near * z, (last - first) * WEIGHTS[k] * near * sqrt(1.0 + z * z)


@internal
def least_speed(part, v_0, d):
    """The least speed along a part of a line."""
    dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    at = part[0]
    if dd > 0.0:
        at = min(max(-(v_0[0] * d[0] + v_0[1] * d[1] + v_0[2] * d[2]) / dd, part[0]), part[1])
    x, y, z = v_0[0] + at * d[0], v_0[1] + at * d[1], v_0[2] + at * d[2]
    return sqrt(x * x + y * y + z * z)
