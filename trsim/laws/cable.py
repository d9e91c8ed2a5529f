"""Cable: one gradient-deficient ANCF element, cubic, without shear, twist or rotations.

    r(x)  = S1 r_a + S2 r_xa + S3 r_b + S4 r_xb          e = (r_a, r_xa, r_b, r_xb), 12 numbers
    U     = 1/2 int EA eps^2 + EI kappa^2 dx             0 <= x <= l
    F     = -dU/de - damping                             [BerzeriShabana2000] [Gerstmayr2008]

    strain     eps as in laws/cable_stretch.py, from three places of the element
    curvature  exact         kappa = |r' x r''| / |r'|^3
               gerstmayr     kappa = |r' x r''| / |r'|^2, per undeformed length
               paper         kappa = |r''|, a constant matrix K_t

' is d/dx in the undeformed length.  r' is a parabola in n = x / l - 1/2,

    r' = P_0 + n P_1 + n^2 P_2,     l r'' = P_1 + 2 n P_2

so all strains are functions of the products P_i . P_j, and through them of

    a = r'.r',    b = r'.r'',    c = r''.r''            kappa^2 = (c - b^2 / a) a^-q

with q = 2 exact, 1 gerstmayr; paper: kappa^2 = c.  The force on P_i is -sum_j M_ij P_j with M_ij
symmetric: no rigid motion is resisted, and a planar cable has zeros where it has no z.

Damping is proportional to the stiffness, as in a material of Kelvin and Voigt: the section
carries EA (eps + beta eps') and, on kappa, EI (kappa + beta kappa').  The power is
-beta int EA eps'^2 + EI kappa'^2 dx.  A cable does not know how it spins about itself, so at a
straight place no curvature has a direction, and every one that grows is resisted there:

    EI beta [kappa^2 kappa'^2 + k0^2 |k'|^2] / (kappa^2 + k0^2),      k0 = STRAIGHT / l

with k' = a^(-q/2) (r'' - b/a r')' across the tangent.  The blend makes the force differentiable.
"""

from trsim.kernels.lazy import internal
from trsim.laws.cable_stretch import pulled, squared, stretching_energy

EXACT, GERSTMAYR, PAPER = 0, 1, 2
CURVATURES = {"exact": EXACT, "gerstmayr": GERSTMAYR, "paper": PAPER}

STRAIGHT = 1e-6  # rad, bend of an element below which it counts as straight, for damping alone

# three Gauss points for the bend: n and weight
BEFORE, MIDDLE = (-0.3872983346207417, 5.0 / 18.0), (0.0, 4.0 / 9.0)
BEHIND = (0.3872983346207417, 5.0 / 18.0)


@internal
def dot(x, y):
    """x . y"""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


@internal
def mixed(c, P):
    """c_0 P_0 + c_1 P_1 + c_2 P_2"""
    x, y, z = P
    return (
        c[0] * x[0] + c[1] * y[0] + c[2] * z[0],
        c[0] * x[1] + c[1] * y[1] + c[2] * z[1],
        c[0] * x[2] + c[1] * y[2] + c[2] * z[2],
    )


@internal
def parabola(e, l):
    """P_0, P_1, P_2 of r', each a vector; of the rates of e, their rates."""
    u = 1.0 / l
    g = (
        (u * (e[6] - e[0]), u * (e[7] - e[1]), u * (e[8] - e[2])),
        (e[3], e[4], e[5]),
        (e[9], e[10], e[11]),
    )
    return mixed((1.5, -0.25, -0.25), g), mixed((0.0, -1.0, 1.0), g), mixed((-6.0, 3.0, 3.0), g)


@internal
def products(P, R):
    """(p00, p01, 2 p02 + p11, p12, p22, p11) of p_ij = (P_i . R_j + P_j . R_i) / 2."""
    p11 = dot(P[1], R[1])
    return (
        dot(P[0], R[0]),
        0.5 * (dot(P[0], R[1]) + dot(P[1], R[0])),
        dot(P[0], R[2]) + dot(P[2], R[0]) + p11,
        0.5 * (dot(P[1], R[2]) + dot(P[2], R[1])),
        dot(P[2], R[2]),
        p11,
    )


@internal
def invariants(p, n, u):
    """a = r'.r', b = r'.r'', c = r''.r'' at n from `products`; u = 1 / l."""
    b = p[1] + n * (p[2] + n * (3.0 * p[3] + n * 2.0 * p[4]))
    c = p[5] + 4.0 * n * (p[3] + n * p[4])
    return squared(p, n), u * b, u * u * c


@internal
def bend(a, b, c, curvature):
    """kappa^2 and the derivatives of kappa^2 / 2 in a, b and c; 1/m^2, ..."""
    if curvature == PAPER:
        return c, 0.0, 0.0, 0.5
    y = 1.0 / a
    s = b * y
    across = max(c - b * s, 0.0)
    q = 1.0
    weight = y
    if curvature == EXACT:
        q = 2.0
        weight = y * y
    return weight * across, 0.5 * weight * (s * s - q * across * y), -weight * s, 0.5 * weight


@internal
def flexed(p, p_dot, point, bar, beta):
    """EI l times the derivatives of kappa^2 / 2 at a Gauss point, damped and weighed: of r'.r',
    2 r'.r'' / l, r''.r'' / l^2.

    Each twice: they are what r' feels of r', r' of r'' and r'' of r''.
    """
    n, weight = point
    u, EI = 1.0 / bar.length, weight * bar.length * bar.EI
    a, b, c = invariants(p, n, u)
    kk, k_a, k_b, k_c = bend(a, b, c, bar.curvature)
    if beta > 0.0:
        a_dot, b_dot, c_dot = invariants(p_dot, n, u)
        k0 = STRAIGHT * u
        EI *= 1.0 + 2.0 * beta * (k_a * a_dot + k_b * b_dot + k_c * c_dot) / (kk + k0 * k0)
    return 2.0 * EI * k_a, EI * u * k_b, 2.0 * EI * u * u * k_c


@internal
def bent(p, p_dot, bar, beta):
    """What the bend adds to M: m00, m01, m02, m11, m12, m22, N*m."""
    n = BEHIND[0]
    x0, y0, z0 = flexed(p, p_dot, BEFORE, bar, beta)
    x, y, z = flexed(p, p_dot, MIDDLE, bar, beta)
    x1, y1, z1 = flexed(p, p_dot, BEHIND, bar, beta)
    m02 = n * (n * (x0 + x1) + 2.0 * (y1 - y0))
    return (
        x + (x0 + x1),
        n * (x1 - x0) + y + (y0 + y1),
        m02,
        m02 + z + (z0 + z1),
        n * (n * (n * (x1 - x0) + 3.0 * (y0 + y1)) + 2.0 * (z1 - z0)),
        n * n * (m02 + 2.0 * n * (y1 - y0) + 4.0 * (z0 + z1)),
    )


@internal
def straight_resistance(P, P_dot, point, bar):
    """Forces on r' and r'' of the damping that straight places have alone, N and N*m."""
    n, weight = point
    u, EI_beta = 1.0 / bar.length, weight * bar.length * bar.EI * bar.beta
    r1, r2 = mixed((1.0, n, n * n), P), mixed((0.0, u, 2.0 * n * u), P)
    v1, v2 = mixed((1.0, n, n * n), P_dot), mixed((0.0, u, 2.0 * n * u), P_dot)
    a, b = dot(r1, r1), dot(r1, r2)
    kk, _, _, half = bend(a, b, dot(r2, r2), bar.curvature)
    k0 = STRAIGHT * STRAIGHT * u * u
    m = 2.0 * half * EI_beta * k0 / (kk + k0)
    s = b / a
    along = (dot(r1, v2) - s * dot(r1, v1)) / a
    grown = 0.0
    if bar.curvature == PAPER:  # its kappa counts what r'' has along the tangent too
        grown = m * (dot(r1, v2) + dot(r2, v1)) / a
    f2 = mixed((m, -m * s, -m * along), (v2, v1, r1))
    f1 = mixed((-s, grown, 0.0), (f2, r2, r2))
    return f1, mixed((1.0, grown, 0.0), (f2, r1, r1))


@internal
def add_to_ends(G, l, F):
    """F -= forces G on P_0, P_1, P_2, as felt by the twelve coordinates."""
    chord = mixed((1.5, 0.0, -6.0), G)
    at_a, at_b = mixed((-0.25, -1.0, 3.0), G), mixed((-0.25, 1.0, 3.0), G)
    u = 1.0 / l
    F[0] += u * chord[0]
    F[1] += u * chord[1]
    F[2] += u * chord[2]
    F[3] -= at_a[0]
    F[4] -= at_a[1]
    F[5] -= at_a[2]
    F[6] -= u * chord[0]
    F[7] -= u * chord[1]
    F[8] -= u * chord[2]
    F[9] -= at_b[0]
    F[10] -= at_b[1]
    F[11] -= at_b[2]


@internal
def add_straight_damping(P, P_dot, point, bar, F):
    """F += what straight places add to the damping, at a Gauss point."""
    n, l = point[0], bar.length
    u = 1.0 / l
    f1, f2 = straight_resistance(P, P_dot, point, bar)
    G = f1, mixed((n, u, 0.0), (f1, f2, f2)), mixed((n * n, 2.0 * n * u, 0.0), (f1, f2, f2))
    add_to_ends(G, l, F)


@internal
def add_force(e, v, bar, beta, F):
    """F += elastic and damping force of one element.

    Parameters
    ----------
    e : (12,)            r_a, r_xa, r_b, r_xb: positions, m, and slopes
    v : (12,)            their rates; of no influence where beta is 0
    bar                  what the element is part of, a record of
        length : float       undeformed, of the element, m
        EA, EI : float       stiffness against stretching, N, and bending, N*m^2
        beta : float         damping / stiffness, s; a straight bar's damping ratio is
                             beta omega / 2
        strain : int         GREEN or ENGINEERING
        curvature : int      EXACT, GERSTMAYR or PAPER
        stretching : int     ASSUMED or FULL
    beta : float         that of the bar, or 0 for the elastic force alone
    F : (12,)            generalised force, N and N*m, added to

    Notes
    -----
    Three Gauss points for the bend.  Where r' vanishes F is not finite.
    """
    l = bar.length
    P = parabola(e, l)
    p = p_dot = products(P, P)
    if beta > 0.0:
        P_dot = parabola(v, l)
        p_dot = products(P, P_dot)
        add_straight_damping(P, P_dot, BEFORE, bar, F)
        add_straight_damping(P, P_dot, MIDDLE, bar, F)
        add_straight_damping(P, P_dot, BEHIND, bar, F)
    x = pulled(p, p_dot, bar, beta)
    y = bent(p, p_dot, bar, beta)
    m00, m01, m02 = x[0] + y[0], x[1] + y[1], x[2] + y[2]
    m11, m12, m22 = x[3] + y[3], x[4] + y[4], x[5] + y[5]
    G = mixed((m00, m01, m02), P), mixed((m01, m11, m12), P), mixed((m02, m12, m22), P)
    add_to_ends(G, l, F)


@internal
def energies(e, bar):
    """Energy of the stretch and of the bend, J.  Parameters as in `add_force`."""
    l, curvature = bar.length, bar.curvature
    P = parabola(e, l)
    p = products(P, P)
    u = 1.0 / l
    a, b, c = invariants(p, 0.0, u)
    flexed = MIDDLE[1] * bend(a, b, c, curvature)[0]
    for n, weight in (BEFORE, BEHIND):
        a, b, c = invariants(p, n, u)
        flexed += weight * bend(a, b, c, curvature)[0]
    return stretching_energy(p, bar), 0.5 * bar.EI * l * flexed
