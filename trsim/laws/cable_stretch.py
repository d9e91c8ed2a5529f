"""Stretching of one cable element: its axial strain, assumed or taken everywhere.

    green         eps = (r'.r' - 1) / 2
    engineering   eps = |r'| - 1

    assumed   the parabola with the strain of both ends, eps_a and eps_d, and the mean strain m,
              U = 1/2 EA l [m^2 + (eps_d - eps_a)^2 / 12 + ((eps_a + eps_d) / 2 - m)^2 / 5]
              m = (eps_a + 5 eps_b + 5 eps_c + eps_d) / 12, by Lobatto's four points
    full      1/2 EA int eps^2 dx by five Gauss points

A cubic element cannot bend without stretching somewhere.  Where that is resisted everywhere, a
slender bar is too stiff (membrane locking).  Three strains of an element ask no more than it can
give: n elements in a plane have 4 n + 4 coordinates, 2 n + 1 strains (neighbours share that of
their node) and 3 rigid motions, which leaves 2 n to bend.  The strain of small displacements is a
parabola, so these are the same in both; and a mean that is exact makes that of a taut string exact.
[SimoHughes1986]
"""

from math import sqrt

from trsim.kernels.lazy import internal

GREEN, ENGINEERING = 0, 1
ASSUMED, FULL = 0, 1
STRAINS = {"green": GREEN, "engineering": ENGINEERING}  # the words of a scenario
STRETCHINGS = {"assumed": ASSUMED, "full": FULL}

INSIDE = 0.22360679774997896  # Lobatto's points b and c at n = -+sqrt(1/20), a and d at -+1/2
OUTER, INNER = 1.0 / 12.0, 5.0 / 12.0  # their weights

# five Gauss points -+n and the middle, with their weights
FAR, FAR_WEIGHT = 0.453089922969332, 0.11846344252809454
NEAR, NEAR_WEIGHT = 0.26923465505284155, 0.23931433524968324
MIDDLE_OF_5 = 64.0 / 225.0


@internal
def squared(p, n):
    """a = r'.r' at n from `cable.products`."""
    return p[0] + n * (2.0 * p[1] + n * (p[2] + n * (2.0 * p[3] + n * p[4])))


@internal
def sampled(p):
    """r'.r' at Lobatto's four points from `cable.products`."""
    ends, skew = p[0] + 0.25 * p[2] + 0.0625 * p[4], p[1] + 0.25 * p[3]
    inside, aside = p[0] + 0.05 * p[2] + 0.0025 * p[4], 2.0 * INSIDE * (p[1] + 0.05 * p[3])
    return ends - skew, inside - aside, inside + aside, ends + skew


@internal
def stretch(a, strain):
    """Axial strain eps of a = r'.r', and 2 d eps / da."""
    if strain == GREEN:
        return 0.5 * (a - 1.0), 1.0
    s = sqrt(a)
    return s - 1.0, 1.0 / s


@internal
def damped(a, a_dot, beta, strain):
    """eps + beta eps' of r'.r' and r'.(r')', and 2 d eps / da."""
    eps, turn = stretch(a, strain)
    return eps + beta * turn * a_dot, turn


@internal
def forces(a, b, c, d):
    """Derivatives of U / (EA l) of the assumed strain in those of Lobatto's four points."""
    m, difference = OUTER * (a + d) + INNER * (b + c), d - a
    curved = 0.1 * (a + d) - 0.2 * m
    ends = OUTER * m + INNER * curved
    return ends - OUTER * difference, INNER * (m - curved), ends + OUTER * difference


@internal
def pulled(p, p_dot, bar, beta):
    """What the stretch adds to M of `cable.add_force`: m00, m01, m02, m11, m12, m22, N*m."""
    EAl, strain = bar.EA * bar.length, bar.strain
    if bar.stretching == FULL:
        return pulled_everywhere(p, p_dot, EAl, beta, strain)
    x = sampled(p)
    if beta > 0.0:
        v = sampled(p_dot)
        a, turn_a = damped(x[0], v[0], beta, strain)
        b, turn_b = damped(x[1], v[1], beta, strain)
        c, turn_c = damped(x[2], v[2], beta, strain)
        d, turn_d = damped(x[3], v[3], beta, strain)
    else:
        a, turn_a = stretch(x[0], strain)
        b, turn_b = stretch(x[1], strain)
        c, turn_c = stretch(x[2], strain)
        d, turn_d = stretch(x[3], strain)
    f_a, f, f_d = forces(a, b, c, d)
    f_a, f_b, f_c, f_d = EAl * f_a * turn_a, EAl * f * turn_b, EAl * f * turn_c, EAl * f_d * turn_d
    ends, between = 0.25 * (f_a + f_d), 0.05 * (f_b + f_c)
    skew, aside = 0.5 * (f_d - f_a), INSIDE * (f_c - f_b)
    m02 = ends + between
    return (
        (f_a + f_d) + (f_b + f_c),
        skew + aside,
        m02,
        m02,
        0.25 * skew + 0.05 * aside,
        0.25 * ends + 0.05 * between,
    )


@internal
def pulled_everywhere(p, p_dot, EAl, beta, strain):
    """`pulled` of five Gauss points."""
    m00, m01, m02, m12, m22 = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(5):
        n, weight = gauss(k)
        eps, turn = damped(squared(p, n), squared(p_dot, n), beta, strain)
        f = EAl * weight * eps * turn
        m00, m01, m02 = m00 + f, m01 + n * f, m02 + n * n * f
        m12, m22 = m12 + n * n * n * f, m22 + n * n * n * n * f
    return m00, m01, m02, m02, m12, m22


@internal
def gauss(k):
    """Place and weight of the k-th of five Gauss points."""
    if k < 2:
        return (2 * k - 1) * FAR, FAR_WEIGHT
    if k < 4:
        return (2 * k - 5) * NEAR, NEAR_WEIGHT
    return 0.0, MIDDLE_OF_5


@internal
def stretching_energy(p, bar):
    """Energy of the stretch from `cable.products`, J."""
    l, EA, strain = bar.length, bar.EA, bar.strain
    total = 0.0
    if bar.stretching == FULL:
        for k in range(5):
            n, weight = gauss(k)
            total += weight * stretch(squared(p, n), strain)[0] ** 2
        return 0.5 * EA * l * total
    x = sampled(p)
    a, b = stretch(x[0], strain)[0], stretch(x[1], strain)[0]
    c, d = stretch(x[2], strain)[0], stretch(x[3], strain)[0]
    f_a, f, f_d = forces(a, b, c, d)
    return 0.5 * EA * l * (f_a * a + f * (b + c) + f_d * d)
