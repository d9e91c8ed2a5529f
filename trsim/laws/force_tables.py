"""Elastic forces of contacts given by points: monotone cubics between them.          [Fritsch1984]

    F = a + b s + c s^2 + d s^3,  s = d - x_k          on x_k .. x_k+1;  F' is continuous
    slope at x_k:  (w_1 + w_2) / (w_1 / m_k-1 + w_2 / m_k),  w_1 = 2 h_k + h_k-1
                                                             w_2 = h_k + 2 h_k-1
with h the lengths and m the slopes of the intervals.  At both ends it is that of the parabola
through three points, 0 to three times the slope of the interval.  Behind the last point F goes
straight on.  F rises wherever the points do.

In a flat array it is, from its offset,   n, x (n), then a b c d E of each piece, the last one the
straight line; E is the energy stored up to x_k.
"""

from trsim.kernels.lazy import internal

WIDTH = 5  # numbers of a piece
PIECE = 16.0  # between branches of friction on one piece of a table and those on the next


def rising(x, y):
    """The numbers of a table, and its largest slope.

    x, y: (n,) depths, m, and forces, N, from 0, 0 on, n >= 2.  Raises ValueError with the number of
    the offending row, counted from 1.
    """
    import numpy as np

    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.size < 2:
        raise ValueError("a table of forces needs 2 rows or more")
    if x[0] != 0.0 or y[0] != 0.0:
        raise ValueError(f"row 1: it begins at 0, 0, got {x[0]:g}, {y[0]:g}")
    for name, column in (("depth", x), ("force", y)):
        if not (np.diff(column) > 0.0).all():
            k = int(np.argmin(np.diff(column) > 0.0)) + 1
            raise ValueError(f"row {k + 1}: the {name} {column[k]:g} does not exceed "
                             f"{column[k - 1]:g} of the row before")  # fmt: skip
    h, m = np.diff(x), np.diff(y) / np.diff(x)
    b = slopes(h, m)
    c, d = (3 * m - 2 * b[:-1] - b[1:]) / h, (b[:-1] + b[1:] - 2 * m) / h**2
    pieces = np.zeros((x.size, WIDTH))
    pieces[:, 0], pieces[:, 1] = y, b
    pieces[:-1, 2], pieces[:-1, 3] = c, d
    whole = h * (y[:-1] + h * (b[:-1] / 2 + h * (c / 3 + h * d / 4)))
    pieces[1:, 4] = np.cumsum(whole)
    return [float(x.size), *x.tolist(), *pieces.ravel().tolist()], steepest(h, b, c, d)


def slopes(h, m):
    """The slope at every point."""
    import numpy as np

    if m.size == 1:
        return np.repeat(m, 2)
    w_1, w_2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    inner = (w_1 + w_2) / (w_1 / m[:-1] + w_2 / m[1:])
    return np.concatenate(([at_end(h, m)], inner, [at_end(h[::-1], m[::-1])]))


def at_end(h, m):
    """The slope at the first of three points or more."""
    slope = ((2 * h[0] + h[1]) * m[0] - h[0] * m[1]) / (h[0] + h[1])
    return min(max(slope, 0.0), 3.0 * m[0])


def steepest(h, b, c, d):
    """The largest slope of all pieces."""
    found = [float(max(b))]
    for length, first, second, third in zip(h, b, c, d, strict=False):
        if third != 0.0 and 0.0 < -second / (3.0 * third) < length:
            found.append(float(first - second * second / (3.0 * third)))
    return max(found)


@internal
def piece_at(tab, o, depth):
    """Which piece a depth is on."""
    k = 0
    for i in range(1, int(tab[o])):
        if depth >= tab[o + 1 + i]:
            k = i
    return k


@internal
def on_piece(tab, o, k, depth):
    """F of piece k, drawn on beyond its ends, N."""
    n = int(tab[o])
    s, p = depth - tab[o + 1 + k], o + 1 + n + WIDTH * k
    return tab[p] + s * (tab[p + 1] + s * (tab[p + 2] + s * tab[p + 3]))


@internal
def stored_in(tab, o, depth):
    """The integral of F from 0 to a depth, J."""
    if depth <= 0.0:
        return 0.0
    n, k = int(tab[o]), piece_at(tab, o, depth)
    s, p = depth - tab[o + 1 + k], o + 1 + n + WIDTH * k
    grown = tab[p + 1] / 2.0 + s * (tab[p + 2] / 3.0 + s * tab[p + 3] / 4.0)
    return tab[p + 4] + s * (tab[p] + s * grown)


@internal
def beyond_piece(tab, o, k, depth):
    """How far a depth has left piece k, m; below its first point is a separation."""
    n = int(tab[o])
    beyond = -1.0
    if k > 0:
        beyond = max(beyond, tab[o + 1 + k] - depth)
    if k < n - 1:
        beyond = max(beyond, depth - tab[o + 2 + k])
    return beyond


@internal
def next_piece(tab, o, k, depth):
    """The piece on the other side of the nearer end of piece k."""
    n = int(tab[o])
    if k == 0:
        return 1
    if k == n - 1:
        return n - 2
    return k + 1 if depth - tab[o + 2 + k] > tab[o + 1 + k] - depth else k - 1


@internal
def piece_of(branch):
    """The piece of a table that goes with a branch: a number of branches of friction for each."""
    return int((branch + 0.5 * PIECE) // PIECE)


@internal
def rub_of(branch):
    """The branch of friction of it."""
    return branch - PIECE * piece_of(branch)
