"""Stiffness and damping matrix of one cable element, exact derivatives of `cable.add_force`.

    K = d2U/de2 = sum over points of  W_ij g_i g_j^T + W_i H_i,     i, j of a, b, c
    C = -dF/de'

with a = r'.r', b = r'.r'', c = r''.r'', their gradients g_i and constant second derivatives H_i in
the twelve coordinates, and W the energy at the point.  Both matrices are symmetric, C is positive
semidefinite.  What the damping force gains when e changes at fixed rates is not in either.
"""

from trsim.laws import law
from trsim.laws.cable import (
    BENDING,
    BENDING_WEIGHT,
    ENGINEERING,
    EXACT,
    FAR,
    FAR_WEIGHT,
    MIDDLE_OF_3,
    MIDDLE_OF_5,
    NEAR,
    NEAR_WEIGHT,
    PAPER,
    STRAIGHT,
    bend,
    dot,
    mixed,
    parabola,
    stretch,
)


@law
def slopes(n, u):
    """Coefficients of r_a, r_xa, r_b, r_xb in r' at n = x / l - 1/2; u = 1 / l."""
    chord = u * (1.5 - 6.0 * n * n)
    return -chord, n * (3.0 * n - 1.0) - 0.25, chord, n * (3.0 * n + 1.0) - 0.25


@law
def bends(n, u):
    """Coefficients of r_a, r_xa, r_b, r_xb in r'' at n = x / l - 1/2; u = 1 / l."""
    chord = -12.0 * n * u * u
    return -chord, u * (6.0 * n - 1.0), chord, u * (6.0 * n + 1.0)


@law
def place(row, k, x, y, v, w):
    """row[3 k ... 3 k + 2] <- x v + y w."""
    row[3 * k] = x * v[0] + y * w[0]
    row[3 * k + 1] = x * v[1] + y * w[1]
    row[3 * k + 2] = x * v[2] + y * w[2]


@law
def fill(row, c, v, d, w):
    """row (12,) <- c_k v + d_k w for the four nodes k."""
    place(row, 0, c[0], d[0], v, w)
    place(row, 1, c[1], d[1], v, w)
    place(row, 2, c[2], d[2], v, w)
    place(row, 3, c[3], d[3], v, w)


@law
def add_square(M, h, x):
    """M += h x x^T."""
    for i in range(12):
        for j in range(12):
            M[i, j] += h * (x[i] * x[j])


@law
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


@law
def add_units(M, h, c, d):
    """M += h (c_k d_m + d_k c_m) times a unit matrix in each of the blocks k, m of nodes."""
    add_unit_row(M, 0, h, c[0], d[0], c, d)
    add_unit_row(M, 3, h, c[1], d[1], c, d)
    add_unit_row(M, 6, h, c[2], d[2], c, d)
    add_unit_row(M, 9, h, c[3], d[3], c, d)


@law
def add_unit_row(M, row, h, x, y, c, d):
    """The three rows of one node in `add_units`."""
    for i in range(3):
        M[row + i, i] += h * (x * d[0] + y * c[0])
        M[row + i, i + 3] += h * (x * d[1] + y * c[1])
        M[row + i, i + 6] += h * (x * d[2] + y * c[2])
        M[row + i, i + 9] += h * (x * d[3] + y * c[3])


@law
def bend_again(a, b, c, curvature):
    """Second derivatives of kappa^2 / 2: aa, ab, ac, bb; bc and cc are 0."""
    if curvature == PAPER:
        return 0.0, 0.0, 0.0, 0.0
    q, g = 1.0, 1.0 / a
    if curvature == EXACT:
        q, g = 2.0, g / a
    g /= a
    bb = b * b / a
    aa = (q + 1.0) * g / a * (0.5 * q * (c - bb) - bb)
    return aa, (q + 1.0) * g * b / a, -0.5 * q * g, -g


@law
def add_axial(n, P, l, EA, strain, G, K):
    """K += stiffness of the stretch at n; EA with the weight of the point."""
    u = 1.0 / l
    c = slopes(n, u)
    r1 = mixed((1.0, n, n * n), P)
    a = dot(r1, r1)
    eps, turn = stretch(a, strain)
    again = 1.0
    if strain == ENGINEERING:
        again = turn * turn * turn
    fill(G[0], c, r1, c, r1)
    add_square(K, 0.25 * EA * again, G[0])
    add_units(K, 0.5 * EA * eps * turn, c, c)


@law
def add_bending(n, P, l, EI, curvature, G, K):
    """K += stiffness of the bend at n; EI with the weight of the point."""
    u = 1.0 / l
    c1, c2 = slopes(n, u), bends(n, u)
    r1, r2 = mixed((1.0, n, n * n), P), mixed((0.0, u, 2.0 * n * u), P)
    a, b, c = dot(r1, r1), dot(r1, r2), dot(r2, r2)
    _, k_a, k_b, k_c = bend(a, b, c, curvature)
    if curvature != PAPER:
        aa, ab, ac, bb = bend_again(a, b, c, curvature)
        fill(G[0], c1, r1, c1, r1)
        fill(G[1], c1, r2, c2, r1)
        fill(G[2], c2, r2, c2, r2)
        add_form(K, EI * aa, EI * ab, EI * ac, EI * bb, G)
        add_units(K, EI * k_a, c1, c1)
        add_units(K, EI * k_b, c1, c2)
    add_units(K, EI * k_c, c2, c2)


@law
def add_stiffness(e, l, EA, EI, strain, curvature, G, K):
    """K += d2U/de2 of one element, (12, 12), symmetric.

    Parameters
    ----------
    e, l, EA, EI, strain, curvature    as in `cable.add_force`
    G : (3, 12)                        workspace
    K : (12, 12)                       added to
    """
    P = parabola(e, l)
    add_axial(-FAR, P, l, FAR_WEIGHT * l * EA, strain, G, K)
    add_axial(-NEAR, P, l, NEAR_WEIGHT * l * EA, strain, G, K)
    add_axial(0.0, P, l, MIDDLE_OF_5 * l * EA, strain, G, K)
    add_axial(NEAR, P, l, NEAR_WEIGHT * l * EA, strain, G, K)
    add_axial(FAR, P, l, FAR_WEIGHT * l * EA, strain, G, K)
    add_bending(-BENDING, P, l, BENDING_WEIGHT * l * EI, curvature, G, K)
    add_bending(0.0, P, l, MIDDLE_OF_3 * l * EI, curvature, G, K)
    add_bending(BENDING, P, l, BENDING_WEIGHT * l * EI, curvature, G, K)


@law
def add_axial_damping(n, P, l, EA_beta, strain, G, C):
    """C += damping of the stretch at n."""
    c = slopes(n, 1.0 / l)
    r1 = mixed((1.0, n, n * n), P)
    _, turn = stretch(dot(r1, r1), strain)
    fill(G[0], c, r1, c, r1)
    add_square(C, 0.25 * EA_beta * turn * turn, G[0])


@law
def add_bending_damping(n, P, l, EI_beta, curvature, G, C):
    """C += damping of the bend at n."""
    u = 1.0 / l
    c, d = slopes(n, u), bends(n, u)
    r1, r2 = mixed((1.0, n, n * n), P), mixed((0.0, u, 2.0 * n * u), P)
    a, b = dot(r1, r1), dot(r1, r2)
    kk, k_a, k_b, k_c = bend(a, b, dot(r2, r2), curvature)
    k0 = STRAIGHT * STRAIGHT * u * u
    m, s = EI_beta / (kk + k0), b / a
    # gradient of kappa^2 / 2: what multiplies r' and r'' there
    to_r1 = mixed((2.0 * k_a, k_b, 0.0), (r1, r2, r2))
    to_r2 = mixed((k_b, 2.0 * k_c, 0.0), (r1, r2, r2))
    fill(G[0], c, to_r1, d, to_r2)
    add_square(C, m, G[0])
    # what straight places add
    m *= 2.0 * k_c * k0
    across = d[0] - s * c[0], d[1] - s * c[1], d[2] - s * c[2], d[3] - s * c[3]
    fill(G[1], across, r1, across, r1)
    add_units(C, 0.5 * m, across, across)
    add_square(C, -0.25 * m / a, G[1])
    if curvature == PAPER:
        fill(G[2], c, r2, d, r1)
        add_square(C, m / a, G[2])


@law
def add_damping(e, l, EA, EI, beta, strain, curvature, G, C):
    """C += -dF/de' of one element, (12, 12), symmetric.

    Parameters
    ----------
    e, l, EA, EI, beta, strain, curvature    as in `cable.add_force`
    G : (3, 12)                              workspace
    C : (12, 12)                             added to
    """
    P = parabola(e, l)
    x, y = beta * l * EA, beta * l * EI
    add_axial_damping(-FAR, P, l, FAR_WEIGHT * x, strain, G, C)
    add_axial_damping(-NEAR, P, l, NEAR_WEIGHT * x, strain, G, C)
    add_axial_damping(0.0, P, l, MIDDLE_OF_5 * x, strain, G, C)
    add_axial_damping(NEAR, P, l, NEAR_WEIGHT * x, strain, G, C)
    add_axial_damping(FAR, P, l, FAR_WEIGHT * x, strain, G, C)
    add_bending_damping(-BENDING, P, l, BENDING_WEIGHT * y, curvature, G, C)
    add_bending_damping(0.0, P, l, MIDDLE_OF_3 * y, curvature, G, C)
    add_bending_damping(BENDING, P, l, BENDING_WEIGHT * y, curvature, G, C)
