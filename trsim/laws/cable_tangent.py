"""Stiffness and damping matrix of one cable element, exact derivatives of `cable.add_force`.

    K = d2U/de2 = sum over points of  W_ij g_i g_j^T + W_i H_i,     i, j of a, b, c
    C = -dF/de'

    assumed stretch:  K = sum U_ij eps_i' eps_j'^T + U_i eps_i'',     i, j of Lobatto's four points

with a = r'.r', b = r'.r'', c = r''.r'', their gradients g_i and constant second derivatives H_i in
the twelve coordinates, and W the energy at the point.  Both matrices are symmetric, C is positive
semidefinite.  What the damping force gains when e changes at fixed rates is not in either.
"""

from trsim.kernels.lazy import internal
from trsim.laws.cable import (
    BEFORE,
    BEHIND,
    EXACT,
    MIDDLE,
    PAPER,
    STRAIGHT,
    bend,
    dot,
    mixed,
    parabola,
)
from trsim.laws.cable_matrices import add_form, add_square, add_units, bends, fill, slopes
from trsim.laws.cable_stretch import (
    ENGINEERING,
    FULL,
    INNER,
    INSIDE,
    OUTER,
    forces,
    gauss,
    stretch,
)


@internal
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


@internal
def add_axial(P, point, bar, G, K):
    """K += stiffness of the stretch at a Gauss point."""
    n, weight = point
    EA = weight * bar.length * bar.EA
    c = slopes(n, 1.0 / bar.length)
    r1 = mixed((1.0, n, n * n), P)
    a = dot(r1, r1)
    eps, turn = stretch(a, bar.strain)
    again = 1.0
    if bar.strain == ENGINEERING:
        again = turn * turn * turn
    fill(G[0], c, r1, c, r1)
    add_square(K, 0.25 * EA * again, G[0])
    add_units(K, 0.5 * EA * eps * turn, c, c)


@internal
def elongation(P, n, bar, row):
    """row <- 2 d eps / de at n; eps, and 2 d eps / da there."""
    r1 = mixed((1.0, n, n * n), P)
    eps, turn = stretch(dot(r1, r1), bar.strain)
    c = slopes(n, 1.0 / bar.length)
    s = mixed((turn, 0.0, 0.0), (r1, r1, r1))
    fill(row, c, s, c, s)
    return eps, turn


@internal
def add_second(n, f, turn, bar, row, K):
    """K += f d2 eps / de2 at n; row: 2 d eps / de."""
    c = slopes(n, 1.0 / bar.length)
    add_units(K, 0.5 * f * turn, c, c)
    if bar.strain == ENGINEERING:
        add_square(K, -0.25 * f * turn, row)


@internal
def add_products(EAl, G, K):
    """K += EA l times the second derivatives of U / (EA l) in the strains with gradients G / 2."""
    for i in range(12):
        a, b, c, d = G[0, i], G[1, i], G[2, i], G[3, i]
        m = OUTER * (a + d) + INNER * (b + c)
        G[0, i], G[1, i], G[2, i] = m, d - a, 0.5 * (a + d) - m
    add_square(K, EAl / 4.0, G[0])
    add_square(K, EAl / 48.0, G[1])
    add_square(K, EAl / 20.0, G[2])


@internal
def add_assumed(P, bar, G, K):
    """K += stiffness of the assumed stretch."""
    a, turn_a = elongation(P, -0.5, bar, G[0])
    b, turn_b = elongation(P, -INSIDE, bar, G[1])
    c, turn_c = elongation(P, INSIDE, bar, G[2])
    d, turn_d = elongation(P, 0.5, bar, G[3])
    f_a, f, f_d = forces(a, b, c, d)
    EAl = bar.EA * bar.length
    add_second(-0.5, EAl * f_a, turn_a, bar, G[0], K)
    add_second(-INSIDE, EAl * f, turn_b, bar, G[1], K)
    add_second(INSIDE, EAl * f, turn_c, bar, G[2], K)
    add_second(0.5, EAl * f_d, turn_d, bar, G[3], K)
    add_products(EAl, G, K)


@internal
def add_bending(P, point, bar, G, K):
    """K += stiffness of the bend at a Gauss point."""
    n, weight = point
    l, curvature = bar.length, bar.curvature
    u, EI = 1.0 / l, weight * l * bar.EI
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


@internal
def add_stiffness(e, bar, G, K):
    """K += d2U/de2 of one element, (12, 12), symmetric.

    Parameters
    ----------
    e, bar               as in `cable.add_force`
    G : (4, 12)          workspace
    K : (12, 12)         added to
    """
    P = parabola(e, bar.length)
    if bar.stretching == FULL:
        for k in range(5):
            add_axial(P, gauss(k), bar, G, K)
    else:
        add_assumed(P, bar, G, K)
    add_bending(P, BEFORE, bar, G, K)
    add_bending(P, MIDDLE, bar, G, K)
    add_bending(P, BEHIND, bar, G, K)


@internal
def add_axial_damping(P, point, bar, G, C):
    """C += damping of the stretch at a Gauss point."""
    n, weight = point
    EA_beta = weight * bar.length * bar.beta * bar.EA
    c = slopes(n, 1.0 / bar.length)
    r1 = mixed((1.0, n, n * n), P)
    _, turn = stretch(dot(r1, r1), bar.strain)
    fill(G[0], c, r1, c, r1)
    add_square(C, 0.25 * EA_beta * turn * turn, G[0])


@internal
def add_assumed_damping(P, bar, G, C):
    """C += damping of the assumed stretch."""
    elongation(P, -0.5, bar, G[0])
    elongation(P, -INSIDE, bar, G[1])
    elongation(P, INSIDE, bar, G[2])
    elongation(P, 0.5, bar, G[3])
    add_products(bar.beta * bar.EA * bar.length, G, C)


@internal
def add_bending_damping(P, point, bar, G, C):
    """C += damping of the bend at a Gauss point."""
    n, weight = point
    l, curvature = bar.length, bar.curvature
    u, EI_beta = 1.0 / l, weight * (bar.beta * l * bar.EI)
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


@internal
def add_damping(e, bar, G, C):
    """C += -dF/de' of one element, (12, 12), symmetric.

    Parameters
    ----------
    e, bar               as in `cable.add_force`
    G : (4, 12)          workspace
    C : (12, 12)         added to
    """
    P = parabola(e, bar.length)
    if bar.stretching == FULL:
        for k in range(5):
            add_axial_damping(P, gauss(k), bar, G, C)
    else:
        add_assumed_damping(P, bar, G, C)
    add_bending_damping(P, BEFORE, bar, G, C)
    add_bending_damping(P, MIDDLE, bar, G, C)
    add_bending_damping(P, BEHIND, bar, G, C)
