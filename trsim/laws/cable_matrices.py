"""Matrices of one cable element put together from gradients: sums of products and of unit blocks.

A strain is a function of products of r' and r''.  Its gradient in the coordinates is a row of
coefficients of the nodes times a vector; the second derivatives of a product are unit matrices.
"""

from trsim.kernels.lazy import internal


@internal
def slopes(n, u):
    """Coefficients of r_a, r_xa, r_b, r_xb in r' at n = x / l - 1/2; u = 1 / l."""
    chord = u * (1.5 - 6.0 * n * n)
    return -chord, n * (3.0 * n - 1.0) - 0.25, chord, n * (3.0 * n + 1.0) - 0.25


@internal
def bends(n, u):
    """Coefficients of r_a, r_xa, r_b, r_xb in r'' at n = x / l - 1/2; u = 1 / l."""
    chord = -12.0 * n * u * u
    return -chord, u * (6.0 * n - 1.0), chord, u * (6.0 * n + 1.0)


@internal
def place(row, k, x, y, v, w):
    """row[3 k ... 3 k + 2] <- x v + y w."""
    row[3 * k] = x * v[0] + y * w[0]
    row[3 * k + 1] = x * v[1] + y * w[1]
    row[3 * k + 2] = x * v[2] + y * w[2]


@internal
def fill(row, c, v, d, w):
    """row (12,) <- c_k v + d_k w for the four nodes k."""
    place(row, 0, c[0], d[0], v, w)
    place(row, 1, c[1], d[1], v, w)
    place(row, 2, c[2], d[2], v, w)
    place(row, 3, c[3], d[3], v, w)


@internal
def add_square(M, h, x):
    """M += h x x^T."""
    for i in range(12):
        for j in range(12):
            M[i, j] += h * (x[i] * x[j])


@internal
def add_form(M, aa, ab, ac, bb, G):
    """M += aa a a^T + ab (a b^T + b a^T) + ac (a c^T + c a^T) + bb b b^T, a, b, c the rows of G."""
    a, b, c = G[0], G[1], G[2]
    for i in range(12):
        x, y, z = a[i], b[i], c[i]
        for j in range(12):
            M[i, j] += (
                aa * (x * a[j])
                + ab * (x * b[j] + y * a[j])
                + ac * (x * c[j] + z * a[j])
                + bb * (y * b[j])
            )


@internal
def add_units(M, h, c, d):
    """M += h (c_k d_m + d_k c_m) times a unit matrix in each of the blocks k, m of nodes."""
    add_unit_row(M, 0, h, (c[0], d[0]), c, d)
    add_unit_row(M, 3, h, (c[1], d[1]), c, d)
    add_unit_row(M, 6, h, (c[2], d[2]), c, d)
    add_unit_row(M, 9, h, (c[3], d[3]), c, d)


@internal
def add_unit_row(M, row, h, own, c, d):
    """The three rows of one node in `add_units`; own: its c and d."""
    x, y = own
    for i in range(3):
        M[row + i, i] += h * (x * d[0] + y * c[0])
        M[row + i, i + 3] += h * (x * d[1] + y * c[1])
        M[row + i, i + 6] += h * (x * d[2] + y * c[2])
        M[row + i, i + 9] += h * (x * d[3] + y * c[3])
