"""The integral of a function of one sensor, as exact as numbers are.

    I = integral of f(x) dx from a to b        Gauss-Lobatto, 7 nodes, on parts of their own length

A part is taken where its integral and that of its two halves differ by rounding only, otherwise it
is halved: corners and jumps of f cost a few parts more, and need not be known.  Both ends of a part
are nodes, as a corner next to an end would be seen by no other.  Tables are integrated cubic by
cubic.
"""

from math import nan, sqrt

from trsim.kernels.lazy import internal
from trsim.laws.functions import OF_TABLE, POINTS, TABLE, value
from trsim.laws.tables import table_integral

N = 7
_near, _far = (sqrt(5.0 / 11.0 + side * 2.0 / 11.0 * sqrt(5.0 / 3.0)) for side in (-1.0, 1.0))
_of_near, _of_far = ((124.0 + side * 7.0 * sqrt(15.0)) / 350.0 for side in (1.0, -1.0))
NODES = (-1.0, -_far, -_near, 0.0, _near, _far, 1.0)
WEIGHTS = (1.0 / 21.0, _of_far, _of_near, 256.0 / 525.0, _of_near, _of_far, 1.0 / 21.0)
ENOUGH = 1e-14  # of the integral of |f|
FINEST = 1e-13  # of the whole: a part is no shorter
MOST = 10_000  # parts that are looked at


@internal
def part(tab, o, S, k, low, h):
    """The integral over [low, low + h], and that of |f| about."""
    total = size = 0.0
    for m in range(N):
        S[k, 0] = low + 0.5 * h * (1.0 + NODES[m])
        f = value(tab, o, 0.0, S)
        total += WEIGHTS[m] * f
        size += WEIGHTS[m] * abs(f)
    return 0.5 * h * total, abs(0.5 * h * size)


@internal
def integral(tab, o, S, k, a, b):
    """The integral of function o of `tab` over what sensor k shows, from a to b.

    Parameters
    ----------
    tab, o                   as in `functions.value`; of no time, and of no other sensor
    S : (n_s, 2)             k is put back
    k : int                  row of S
    a, b : float

    Returns
    -------
    float                    nan where f has more corners than anybody draws
    """
    if tab[o] == TABLE:
        n, o = int(tab[o + POINTS]), o + OF_TABLE
        return table_integral(tab, o, n, b) - table_integral(tab, o, n, a)
    shown = S[k, 0]
    x, h, total = a, b - a, 0.0
    size = part(tab, o, S, k, a, h)[1]
    for _looked in range(MOST):
        if (b - x) * (b - a) <= 0.0:
            S[k, 0] = shown
            return total
        whole = part(tab, o, S, k, x, h)[0]
        left, s_left = part(tab, o, S, k, x, 0.5 * h)
        right, s_right = part(tab, o, S, k, x + 0.5 * h, 0.5 * h)
        size = max(size, s_left + s_right)
        if abs(left + right - whole) > ENOUGH * size and abs(h) > FINEST * abs(b - a):
            h *= 0.5
            continue
        total += left + right
        x = b if h == b - x else x + h
        h = 2.0 * h if abs(2.0 * h) < abs(b - x) else b - x
    S[k, 0] = shown
    return nan
