"""Smooth steps, and tables that are cubics between their points.

    smoothstep(x)          3 x^2 - 2 x^3             x clipped to 0..1
    quintic(x)             10 x^3 - 15 x^4 + 6 x^5   x clipped to 0..1
    step(x,x0,h0,x1,h1)    h0 + (h1 - h0) smoothstep((x - x0) / (x1 - x0))
    step5                  h0 + (h1 - h0) quintic((x - x0) / (x1 - x0))

    Akima   f = a + b s + c s^2 + d s^3,  s = x - x_k     on x_k .. x_k+1      [Akima1970]
            slope at x_k:  (|m3 - m2| m1 + |m1 - m0| m2) / (|m3 - m2| + |m1 - m0|)

with m0..m3 the slopes of the four intervals around x_k; beyond the ends slopes are extrapolated
quadratically.  f' is continuous, f'' jumps at the points of the table.

    linear  f = a + b s
    spline  M = f'' is continuous too, and its slope at the second and the last but one point, which
            are no knots:  h_k-1 M_k-1 + 2 (h_k-1 + h_k) M_k + h_k M_k+1 = 6 (m_k - m_k-1)
                                                                                     [deBoor1978]

A table in a flat array is, from its offset,   ends, x (n), then a b c d of each interval.
"""

import math

from trsim.kernels.lazy import internal

ENDS = {"hold": 0, "extrapolate": 1, "refuse": 2}  # outside: end value, straight line, nan
TIED = 1e-9  # two weights this small against the largest of the table are roundoff


@internal
def smoothstep_rates(x):
    """Cubic step from 0 to 1 and its first two derivatives in x."""
    if x <= 0.0:
        return 0.0, 0.0, 0.0
    if x >= 1.0:
        return 1.0, 0.0, 0.0
    return x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x), 6.0 - 12.0 * x


@internal
def quintic_rates(x):
    """Quintic step from 0 to 1 and its first two derivatives in x."""
    if x <= 0.0:
        return 0.0, 0.0, 0.0
    if x >= 1.0:
        return 1.0, 0.0, 0.0
    y = x * (1.0 - x)
    return x**3 * (10.0 + x * (6.0 * x - 15.0)), 30.0 * y * y, 60.0 * y * (1.0 - 2.0 * x)


@internal
def smoothstep(x):
    """Cubic step from 0 at x <= 0 to 1 at x >= 1."""
    return smoothstep_rates(x)[0]


@internal
def quintic(x):
    """Quintic step from 0 at x <= 0 to 1 at x >= 1."""
    return quintic_rates(x)[0]


def _checked(x, y):
    """x and y as arrays; rows are counted from 1 in the messages."""
    import numpy as np

    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if x.ndim != 1 or x.shape != y.shape or x.size < 2:
        raise ValueError("a table needs two columns of the same length, 2 rows or more")
    for name, column in (("first", x), ("second", y)):
        if not np.isfinite(column).all():
            row = int(np.argmin(np.isfinite(column)))
            raise ValueError(f"row {row + 1}: the {name} column is {column[row]}, not a number")
    if not (np.diff(x) > 0.0).all():
        row = int(np.argmin(np.diff(x) > 0.0)) + 1
        raise ValueError(
            f"row {row + 1}: {x[row]:g} does not exceed {x[row - 1]:g} of the row before.  "
            "The first column must increase from row to row."
        )
    return x, y


def _slopes(x, y):
    """Akima's slope at every point, (n,)."""
    import numpy as np

    m = np.diff(y) / np.diff(x)
    if m.size == 1:
        return np.repeat(m, 2)
    left, right = 2 * m[0] - m[1], 2 * m[-1] - m[-2]
    m = np.concatenate(([2 * left - m[0], left], m, [right, 2 * right - m[-1]]))
    change = np.abs(np.diff(m))
    w1, w2 = change[2:], change[:-2]
    total = w1 + w2
    slope = 0.5 * (m[:-3] + m[3:])  # no curvature on either side: the mean
    free = total > TIED * total.max()
    slope[free] = ((w1 * m[1:-2] + w2 * m[2:-1]) / np.where(free, total, 1.0))[free]
    return slope


def akima_coefficients(x, y):
    """Cubics of an Akima interpolant.

    Parameters
    ----------
    x : (n,)             abscissae, strictly increasing; n >= 2
    y : (n,)             ordinates

    Returns
    -------
    (n - 1, 4)           a, b, c, d of a + b s + c s^2 + d s^3 with s = x - x_k

    Raises
    ------
    ValueError           with the number of the offending row, counted from 1

    Notes
    -----
    Two points give a straight line, three a parabola.
    """
    import numpy as np

    x, y = _checked(x, y)
    h, m, b = np.diff(x), np.diff(y) / np.diff(x), _slopes(x, y)
    c = (3 * m - 2 * b[:-1] - b[1:]) / h
    d = (b[:-1] + b[1:] - 2 * m) / h**2
    return np.column_stack((y[:-1], b[:-1], c, d))


def linear_coefficients(x, y):
    """The same of straight lines from point to point."""
    import numpy as np

    x, y = _checked(x, y)
    m = np.diff(y) / np.diff(x)
    return np.column_stack((y[:-1], m, 0.0 * m, 0.0 * m))


def spline_coefficients(x, y):
    """The same of the cubic spline that is smooth to its second derivative, without a knot at the
    second and the last but one point.  Two points give a straight line, three a parabola."""
    import numpy as np

    x, y = _checked(x, y)
    h = np.diff(x)
    m = np.diff(y) / h
    bend = _bends(h, 6.0 * np.diff(m))
    slope = m - h * (2.0 * bend[:-1] + bend[1:]) / 6.0
    return np.column_stack((y[:-1], slope, 0.5 * bend[:-1], np.diff(bend) / (6.0 * h)))


def _bends(h, r):
    """f'' at every point, from the lengths of intervals and the right-hand sides of inner ones."""
    import numpy as np

    n = h.size + 1
    if n == 2:
        return np.zeros(2)
    if n == 3:
        return np.full(3, r[0] / (3.0 * (h[0] + h[1])))
    below, above = h[:-1].copy(), h[1:].copy()
    middle = 2.0 * (below + above)
    # M goes straight on from the second point to the first, and so at the other end
    first, last = h[0] / h[1], h[-1] / h[-2]
    middle[0] += h[0] * (1.0 + first)
    above[0] -= h[0] * first
    middle[-1] += h[-1] * (1.0 + last)
    below[-1] -= h[-1] * last
    r = r.copy()
    for k in range(1, n - 2):
        w = below[k] / middle[k - 1]
        middle[k] -= w * above[k - 1]
        r[k] -= w * r[k - 1]
    bend = np.zeros(n)
    for k in range(n - 3, -1, -1):
        bend[k + 1] = (r[k] - (above[k] * bend[k + 2] if k < n - 3 else 0.0)) / middle[k]
    bend[0] = bend[1] + first * (bend[1] - bend[2])
    bend[-1] = bend[-2] + last * (bend[-2] - bend[-3])
    return bend


COEFFICIENTS = {
    "akima": akima_coefficients, "linear": linear_coefficients, "spline": spline_coefficients,
}  # fmt: skip


def cubics(x, y, ends="hold", interpolation="akima"):
    """The numbers that `akima` reads: code of the ends, x, then a b c d of each interval.

    Parameters
    ----------
    x, y : (n,)          the points
    ends : str           outside the table: 'hold' the end value, 'extrapolate' along the end
                         slope, or 'refuse' (nan)
    interpolation : str  'akima', 'linear' or 'spline'

    Returns
    -------
    list[float]          5 n - 3 numbers
    """
    if ends not in ENDS:
        raise ValueError(f"no end behaviour named '{ends}'.  Known: {', '.join(ENDS)}.")
    if interpolation not in COEFFICIENTS:
        known = ", ".join(COEFFICIENTS)
        raise ValueError(f"no interpolation named '{interpolation}'.  Known: {known}.")
    coefficients = COEFFICIENTS[interpolation](x, y)
    return [float(ENDS[ends]), *map(float, x), *coefficients.ravel().tolist()]


@internal
def outside(f, f_x, s, ends):
    """Value and derivatives a distance s beyond an end with value f and slope f_x."""
    if ends == 0.0:
        return f, 0.0, 0.0
    if ends == 1.0:
        return f + f_x * s, f_x, 0.0
    return math.nan, math.nan, math.nan


@internal
def akima(tab, o, n, x):
    """Value and first two derivatives in x of the table at tab[o:], of n points.

    Parameters
    ----------
    tab : (n_tab,)       flat array
    o : int              offset of the table, made by `cubics`
    n : int              number of points
    x : float            where

    Returns
    -------
    (float, float, float)    f, f', f''; the end points belong to the table
    """
    k = interval(tab, o, n, x)
    first, last = tab[o + 1], tab[o + n]
    s = min(max(x, first), last) - tab[o + k]
    f, f_x, f_xx = cubic(tab, o, n, k, s)
    if x < first:
        return outside(f, f_x, x - first, tab[o])
    if x > last:
        return outside(f, f_x, x - last, tab[o])
    return f, f_x, f_xx


@internal
def interval(tab, o, n, x):
    """Between which points x lies: 1 for the first and the second; beyond the ends the nearest."""
    low, high = 1, n
    while high - low > 1:
        mid = (low + high) // 2
        if x < tab[o + mid]:
            high = mid
        else:
            low = mid
    return low


@internal
def cubic(tab, o, n, k, s):
    """Value and two derivatives of the k-th cubic, at a distance s from its first point."""
    p = o + 1 + n + 4 * (k - 1)
    a, b, c, d = tab[p], tab[p + 1], tab[p + 2], tab[p + 3]
    f, f_x = a + s * (b + s * (c + s * d)), b + s * (2.0 * c + s * 3.0 * d)
    return f, f_x, 2.0 * c + 6.0 * s * d


@internal
def interval_at(tab, o, n, x):
    """The piece of the table x is on: -1 below its first point, k as in `interval`, n above.

    The last point belongs to what comes after it, but where a table refuses what lies outside.
    """
    if x < tab[o + 1]:
        return -1.0
    last = tab[o + n]
    if x > last or (x == last and tab[o] != 2.0):
        return float(n)
    return float(interval(tab, o, n, x))


@internal
def interval_ends(tab, o, n, held):
    """Between which x such a piece lies."""
    if held < 0.0:
        return -math.inf, tab[o + 1]
    k = int(held)
    return tab[o + k], math.inf if k == n else tab[o + k + 1]


@internal
def held_cubic(tab, o, n, x, held):
    """Value and two derivatives of such a piece, drawn on beyond its ends."""
    if held < 0.0:
        f, f_x, _ = cubic(tab, o, n, 1, 0.0)
        return outside(f, f_x, x - tab[o + 1], tab[o])
    k = int(held)
    if k == n:
        f, f_x, _ = cubic(tab, o, n, n - 1, tab[o + n] - tab[o + n - 1])
        return outside(f, f_x, x - tab[o + n], tab[o])
    return cubic(tab, o, n, k, x - tab[o + k])


@internal
def table_integral(tab, o, n, x):
    """The integral of the table at tab[o:] from its first point to x."""
    first, last = tab[o + 1], tab[o + n]
    if x < first:
        f, f_x, _ = cubic(tab, o, n, 1, 0.0)
        return beyond_end(f, f_x, x - first, tab[o])
    total = 0.0
    for k in range(1, n):
        if x <= tab[o + k]:
            break
        s = min(x, tab[o + k + 1]) - tab[o + k]
        p = o + 1 + n + 4 * (k - 1)
        a, b, c, d = tab[p], tab[p + 1], tab[p + 2], tab[p + 3]
        total += s * (a + s * (b / 2.0 + s * (c / 3.0 + s * d / 4.0)))
    if x > last:
        f, f_x, _ = cubic(tab, o, n, n - 1, last - tab[o + n - 1])
        total += beyond_end(f, f_x, x - last, tab[o])
    return total


@internal
def beyond_end(f, f_x, s, ends):
    """The integral over a distance s beyond an end with value f and slope f_x."""
    if ends == 2.0:
        return math.nan
    return s * f if ends == 0.0 else s * (f + 0.5 * f_x * s)
