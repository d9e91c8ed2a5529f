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
cut at these places, or at u* where there are none, and pieces that are long in z are used in
panels.
"""

from math import asinh, sinh, sqrt

from trsim.kernels.lazy import internal

NEAREST = 1e-7  # of the line: what m / |d| is at least: less makes no difference to friction
FAR = 4.0  # lines: where nothing is at rest nearer than that, the rule in u has all digits
PIECES, SLOW = 6, 1  # of a line: up to its slow part, that part, the rest; each in two, at a kink
PANEL = 1.5  # of z: what eight places integrate, e^(5 z) too
CLOSE = 1e-12  # of the line
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
def cuts(part, slides, full, clip, ends):
    """Where the pieces of a line end.

    Parameters
    ----------
    part : (float, float)       where it is pressed, 0 <= u <= 1
    slides : (tuple, tuple)     how its beginning slides, and how much else its end does, in vectors
    full : float                speed v_1 from which friction is full; 0: everywhere
    clip : float                a place at which another law has a kink; any outside of it: none
    ends : (bool, bool)         whether the load begins from nothing at that end

    Returns
    -------
    (float, ...)     low, a, b, high: friction grows between a and b; clip; u* and m / |d|, 0 where
                     pieces are plain in u; 1 for each end from which the load grows, or 0
    """
    low, high = part
    v_0, d = slides
    dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    clip, soft, hard = min(max(clip, low), high), 1.0 * ends[0], 1.0 * ends[1]
    if dd == 0.0:
        return low, high, high, high, clip, 0.0, 0.0, soft, hard
    at = -(v_0[0] * d[0] + v_0[1] * d[1] + v_0[2] * d[2]) / dd
    x, y, z = v_0[0] + at * d[0], v_0[1] + at * d[1], v_0[2] + at * d[2]
    mm = x * x + y * y + z * z
    half = sqrt(max(full * full - mm, 0.0) / dd)
    a, b = min(max(at - half, low), high), min(max(at + half, low), high)
    near = max(sqrt(mm / dd), NEAREST)
    if near + max(low - at, at - high) > FAR:  # and rounding of u* would be felt
        near = 0.0
    return low, a, b, high, clip, at, near, soft, hard


@internal
def piece_of(cuts, piece):
    """The ends of a piece in u, those in z where it is smooth in that, and whether it is."""
    low, a, b, high, clip, at, near, _, _ = cuts
    part = piece // 2
    begin, end = (a, b) if part == SLOW else ((low, a) if part < SLOW else (b, high))
    middle = min(max(clip, begin), end)
    begin, end = (begin, middle) if piece % 2 == 0 else (middle, end)
    if part == SLOW or near == 0.0 or begin == end:
        return begin, end, False
    return asinh((begin - at) / near), asinh((end - at) / near), True


@internal
def panels(cuts, piece):
    """In how many panels Gauss's rule has to be used on a piece: 0 of an empty one."""
    first, last, curved = piece_of(cuts, piece)
    if first == last:
        return 0
    # of the square root of a distance a panel holds less
    more = 2 if cuts[7] + cuts[8] > 0.0 else 1
    return more + int((last - first) / PANEL) if curved else 1


@internal
def node(cuts, piece, panel, k):
    """The k-th place of Gauss's rule on a panel of a piece, and its weight.

    Next to an end from which a load grows by any power of the distance, places are those of the
    square root of the distance.
    """
    low, _, _, high, _, at, near, soft, hard = cuts
    first, last, curved = piece_of(cuts, piece)
    width = last - first
    if curved:
        width /= panels(cuts, piece)
        begin, end = at + near * sinh(first), at + near * sinh(last)
    else:
        begin, end = first, last
    s, weight = NODES[k], WEIGHTS[k]
    left = panel == 0 and soft > 0.0 and begin <= low + CLOSE
    right = panel == panels(cuts, piece) - 1 and hard > 0.0 and end >= high - CLOSE
    if left and right:  # 3 s^2 - 2 s^3
        s, weight = s * s * (3.0 - 2.0 * s), weight * 6.0 * s * (1.0 - s)
    elif left:
        s, weight = s * s, weight * 2.0 * s
    elif right:
        s, weight = 1.0 - (1.0 - s) * (1.0 - s), weight * 2.0 * (1.0 - s)
    place = first + width * (panel + s)
    if not curved:
        return place, width * weight
    z = sinh(place)
    return at + near * z, width * weight * near * sqrt(1.0 + z * z)


@internal
def least_speed(part, v_0, d):
    """The least speed along a part of a line."""
    dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    at = part[0]
    if dd > 0.0:
        at = min(max(-(v_0[0] * d[0] + v_0[1] * d[1] + v_0[2] * d[2]) / dd, part[0]), part[1])
    x, y, z = v_0[0] + at * d[0], v_0[1] + at * d[1], v_0[2] + at * d[2]
    return sqrt(x * x + y * y + z * z)
