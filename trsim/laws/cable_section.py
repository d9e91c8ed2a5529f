"""What a cable element has besides its stiffness: shape, mass, loads, and the forces in a section.

    r(x) = S1 r_a + S2 r_xa + S3 r_b + S4 r_xb          cubic Hermite polynomials of xi = x / l
    M_ij = rho A int S_i S_j dx,    F_i = int S_i f dx,    F_i = S_i(xi) f        each times I_3

The mass matrix is constant: there are no terms of velocity.
"""

from math import sqrt

from trsim.kernels.lazy import internal
from trsim.laws.cable import bend, dot, mixed, parabola
from trsim.laws.cable_stretch import stretch


@internal
def shapes(xi, l):
    """S1, -, S2, m, S3, -, S4, m at xi = x / l; they also share a force at xi out."""
    y = 1.0 - xi
    return y * y * (1.0 + 2.0 * xi), l * xi * y * y, xi * xi * (3.0 - 2.0 * xi), -l * xi * xi * y


@internal
def uniform_shares(l):
    """Integrals of S1, m, S2, m^2, S3, m, S4, m^2: of a force per undeformed length."""
    return 0.5 * l, l * l / 12.0, 0.5 * l, -l * l / 12.0


@internal
def mass(l, rho_A):
    """Consistent mass of the four shapes, four rows of four; rho_A in kg/m, l in m."""
    w = rho_A * l / 420.0
    end, off, far, cross = 156.0 * w, 22.0 * w * l, 54.0 * w, 13.0 * w * l
    slope, between = 4.0 * w * l * l, -3.0 * w * l * l
    return (
        (end, off, far, -cross),
        (off, slope, cross, between),
        (far, cross, end, -off),
        (-cross, between, -off, slope),
    )


@internal
def position(e, l, xi):
    """r at xi, m."""
    s1, s2, s3, s4 = shapes(xi, l)
    return (
        s1 * e[0] + s2 * e[3] + s3 * e[6] + s4 * e[9],
        s1 * e[1] + s2 * e[4] + s3 * e[7] + s4 * e[10],
        s1 * e[2] + s2 * e[5] + s3 * e[8] + s4 * e[11],
    )


@internal
def stress(e, bar, xi):
    """Axial force EA eps, N, positive in tension, and moment EI kappa >= 0, N*m, at xi.

    Parameters as in `cable.add_force`; damping is not counted.  The strain is that of the place:
    at the ends and in the middle of an element also the assumed one.
    """
    P, u, n = parabola(e, bar.length), 1.0 / bar.length, xi - 0.5
    r1, r2 = mixed((1.0, n, n * n), P), mixed((0.0, u, 2.0 * n * u), P)
    a, b = dot(r1, r1), dot(r1, r2)
    _, _, _, half = bend(a, b, dot(r2, r2), bar.curvature)
    p = r2
    if half != 0.5:  # not |r''|; the vector does not cancel where the cable is nearly straight
        p = mixed((1.0, -b / a, 0.0), (r2, r1, r1))
    return bar.EA * stretch(a, bar.strain)[0], bar.EI * sqrt(2.0 * half * dot(p, p))
