"""Normal contact laws: penetration and its rate in, force out.

    F = max(0, F_e(d) (1 + chi d' / d0'))        d > 0, otherwise 0

    form 0  hertz      F_e = K d^n                    K in N/m^n    [Hertz1881] [Lankarani1990]
    form 1  cylinder   F_e = K d sqrt(d / (d + c))    K in N/m      [Liu2007] [Pereira2011]
    form 2  table      F_e given by points                          force_tables.py

d > 0 is penetration, d' > 0 approach, d0' > 0 the rate when the contact began, c the radial
clearance of an internal cylinder.  F > 0 pushes the bodies apart; a contact never pulls.

The damping factor chi follows from the restitution c_r.  With u = d'/d0' and any elastic law,

    m d'' = -F   =>   u / chi - ln(1 + chi u) / chi^2   is the same at u = 1 and at u = -e,

so the delivered restitution e depends on chi alone, not on mass, speed, K or n.
"""

from functools import cache
from math import asinh, exp, gamma, inf, pi, sqrt
from typing import NamedTuple

from trsim.kernels.lazy import internal
from trsim.laws.tables import smoothstep

HERTZ, CYLINDER, TABLE = 0, 1, 2  # form
RULES = ("newton", "poisson")  # of impacts that take no time: impact.py


class Pair(NamedTuple):
    """What two surfaces are to each other, as any record with these numbers."""

    stiffness: float  # K, N/m^n (form 0) or N/m (form 1)
    exponent: float  # n of form 0, 3/2 for a sphere or a short cylinder; form 1 has none
    clearance: float  # c, radial, m; > 0, read by form 1 only
    form: int  # 0 hertz, 1 cylinder
    chi: float = 0.0  # damping factor, see `damping_factor`


@internal
def elastic(d, pair):
    """Elastic part of the contact force.

    Parameters
    ----------
    d : float            penetration, m; d <= 0 means no contact
    pair : Pair

    Returns
    -------
    float                force, N

    Notes
    -----
    The cylinder law is an elastic foundation under the arc of contact, whose half angle a has
    cos a = c / (c + d):  F_e = 1/2 pi L E* d sin(a/2), with sin(a/2) = sqrt(d / (2 (c + d))).
    It is Hertz-like (d^1.5) while d << c and linear once d >> c.
    """
    K, n, c = pair.stiffness, pair.exponent, pair.clearance
    if d <= 0.0:
        return 0.0
    if pair.form == CYLINDER:
        return K * d * sqrt(d / (d + c))
    if n == 1.5:  # four times quicker than a general power
        return K * d * sqrt(d)
    return K * d**n


@internal
def stored(d, pair):
    """Elastic energy, the integral of F_e from 0 to d, J.  Parameters as in `elastic`.

    hertz      K d^(n+1) / (n + 1)
    cylinder   K c^2 [s^3 C / 2 - 3/4 s C + 3/4 asinh s]     s = sqrt(d/c), C = sqrt(1 + d/c)
    """
    K, n, c = pair.stiffness, pair.exponent, pair.clearance
    if d <= 0.0:
        return 0.0
    if pair.form == HERTZ:
        if n == 1.5:
            return K * d * d * sqrt(d) / 2.5
        return K * d ** (n + 1.0) / (n + 1.0)
    z = d / c
    s = sqrt(z)
    if z > 0.1:
        C = sqrt(1.0 + z)
        return K * c * c * (0.5 * z * s * C - 0.75 * s * C + 0.75 * asinh(s))
    # the three terms above cancel to z^2.5; the binomial series of z^1.5 / sqrt(1 + z) does not
    term, total = 1.0, 0.4
    for k in range(1, 15):
        term *= -z * (k - 0.5) / k
        total += term / (k + 2.5)
    return K * c * c * z * z * s * total


@internal
def normal_force(d, d_dot, d_dot0, pair):
    """Normal force of a dissipative contact, F = max(0, F_e (1 + chi d'/d0')).

    Parameters
    ----------
    d : float            penetration, m; d <= 0 means no contact
    d_dot : float        penetration rate, m/s; > 0 while approaching
    d_dot0 : float       penetration rate at the start of this contact, m/s; > 0
    pair : Pair

    Returns
    -------
    float                force, N; never negative: a contact does not pull

    Notes
    -----
    In a free impact 1 + chi d'/d0' stays positive.  Bodies torn apart by something else may turn
    it negative; the force is then cut at zero, for the reasons in [ModelicaElastoGap].
    """
    return lossy(elastic(d, pair), d_dot, d_dot0, pair.chi)


@internal
def lossy(F_e, d_dot, d_dot0, chi):
    """`normal_force` of any elastic force F_e, N."""
    return max(0.0, F_e * (1.0 + chi * d_dot / d_dot0))


@internal
def impact_force(d, d_dot, pair):
    """Normal force of a contact whose damper fades in with depth, whatever the impact was.

        F = max(0, K d^n + c smoothstep(d / ramp) d')        d > 0, otherwise 0

    Parameters
    ----------
    d, d_dot : float     penetration, m, and its rate, m/s
    pair                 as of `elastic`, with `damping` c, N*s/m, and `ramp`, m; > 0

    Returns
    -------
    float                force, N; the function IMPACT of commercial programs, with the damper of
                         its STEP: d at x1 - x, d' = -x'
    """
    return damped(elastic(d, pair), d, d_dot, pair)


@internal
def damped(F_e, d, d_dot, pair):
    """`impact_force` of any elastic force F_e, N."""
    if d <= 0.0:
        return 0.0
    return max(0.0, F_e + pair.damping * smoothstep(d / pair.ramp) * d_dot)


@internal
def ramped_damping(pen, pen_dot, k, c, ramp):
    """Force of a stop or seat: a linear spring whose damper fades in over the first ramp metres.

        F = max(0, k pen + c smoothstep(pen / ramp) pen')        pen > 0, otherwise 0

    Parameters
    ----------
    pen, pen_dot : float penetration, m or rad, and its rate; > 0 while approaching
    k : float            stiffness, N/m or N*m/rad
    c : float            damping once the ramp is passed, N*s/m or N*m*s/rad
    ramp : float         penetration at which damping is complete, m or rad; 0 means at once

    Returns
    -------
    float                force, N or N*m; continuous if ramp > 0
    """
    if pen <= 0.0:
        return 0.0
    return max(0.0, uncut(pen, pen_dot, k, c, ramp))


@internal
def uncut(pen, pen_dot, k, c, ramp):
    """Force of a stop or seat before it is cut at zero, N or N*m; where pen < 0 of the spring."""
    return k * pen + c * smoothstep(pen / ramp) * pen_dot


@internal
def ramped_branch_of(pen, pen_dot, k, c, ramp):
    """The branch of `ramped_damping` that a penetration and its rate are on.

    0: the damper fades in; 1: it is complete; 2: the force would pull, and is zero.
    """
    if uncut(pen, pen_dot, k, c, ramp) < 0.0 < pen:
        return 2.0
    return 0.0 if pen < ramp else 1.0


@internal
def ramped_on_branch(branch, pen, pen_dot, k, c, ramp):
    """`ramped_damping` with one branch drawn on beyond its ends, so that it has no corner, N."""
    if branch == 2.0:
        return 0.0
    if branch == 1.0:
        return k * pen + c * pen_dot
    x = pen / ramp
    return k * pen + (c * x * x * (3.0 - 2.0 * x) * pen_dot if x > 0.0 else 0.0)


@internal
def pulling(pen_dot, k, c, ramp):
    """Between which penetrations, of the ramp, the force of `ramped_damping` would pull.

    While bodies part, with a = k ramp / (c |pen'|): a x = 3 x^2 - 2 x^3 below 1, x = 1 / a above.
    Both are 3/4 where it pulls nowhere; the third result says by how much a is too large then.
    """
    a = min(k * ramp / (c * -pen_dot), 1e6) if pen_dot < 0.0 else 1e6
    if a >= 1.125:
        return 0.75, 0.75, a - 1.125
    root = sqrt(9.0 - 8.0 * a)
    return 0.25 * (3.0 - root), 1.0 / a if a <= 1.0 else 0.25 * (3.0 + root), 0.0


@internal
def ramped_beyond(branch, pen, pen_dot, k, c, ramp):
    """How far a branch has been left, of the ramp: negative inside, zero at a corner."""
    if branch == 2.0:
        low, high, nowhere = pulling(pen_dot, k, c, ramp)
        return max(low - pen / ramp, pen / ramp - high) + nowhere
    pull = -uncut(pen, pen_dot, k, c, ramp) / (k * ramp)
    along = pen / ramp - 1.0
    if pen <= 0.0:  # a separation is an event of its own
        return along if branch == 0.0 else -along
    return max(pull, along if branch == 0.0 else -along)


@internal
def ramped_neighbour(branch, pen, pen_dot, k, c, ramp):
    """The branch on the other side of the nearest corner."""
    along = pen / ramp - 1.0
    if branch == 2.0:
        return 0.0 if along < 0.0 else 1.0
    pull = -uncut(pen, pen_dot, k, c, ramp) / (k * ramp)
    beside = along if branch == 0.0 else -along
    return 2.0 if pull > min(beside, 0.0) else 1.0 - branch


def _residual(chi, e):
    """Positive below the true chi (or e), negative above; zero where both fit.

        g = 1 - chi e - (1 + chi) exp(-x),  x = chi (1 + e)

    is the implicit relation without its logarithm; g / chi^2 has no double root at chi = 0.
    """
    x = chi * (1.0 + e)
    if x > 0.5:
        return (1.0 - chi * e - (1.0 + chi) * exp(-x)) / (chi * chi)
    # g = chi^2 (1 + e) [1 - (1 + chi) (1 + e) f],  f = (exp(-x) - 1 + x) / x^2, as a series
    term, f = 0.5, 0.5
    for k in range(3, 20):
        term *= -x / k
        f += term
    return (1.0 + e) * (1.0 - (1.0 + chi) * (1.0 + e) * f)


def _root(f, low, high):
    """Root of f, positive at low and negative at high, by halving to the last bit."""
    mid = 0.5 * (low + high)
    while low < mid < high:
        low, high = (mid, high) if f(mid) > 0.0 else (low, mid)
        mid = 0.5 * (low + high)
    return mid


@cache  # cases of a sweep have the same few
def delivered_restitution(chi):
    """Restitution that a damping factor truly delivers in a free impact.

    Parameters
    ----------
    chi : float          damping factor, >= 0; inf is allowed

    Returns
    -------
    float                separation speed / approach speed, 0..1
    """
    if not chi >= 0.0:
        raise ValueError(f"the damping factor must be 0 or more, got {chi}")
    if chi in (0.0, inf):
        return 1.0 if chi == 0.0 else 0.0
    return _root(lambda e: _residual(chi, e), 0.0, 1.0)


LAWS = {
    "lankarani_nikravesh": lambda c_r: 0.75 * (1.0 - c_r * c_r),
    "hunt_crossley": lambda c_r: 1.5 * (1.0 - c_r),
    "flores": lambda c_r: 1.6 * (1.0 - c_r) / c_r,
    # the force would pull beyond chi = 1 / c_r
    "identified": lambda c_r: _root(lambda chi: _residual(chi, c_r), 0.0, 1.0 / c_r),
}


def damping_factor(law, c_r):
    """Damping factor chi of a named law.

        lankarani_nikravesh   3/4 (1 - c_r^2)           [Lankarani1990]
        hunt_crossley         3/2 (1 - c_r)             [HuntCrossley1975]
        flores                8 (1 - c_r) / (5 c_r)     [Flores2011]
        identified            the chi whose delivered restitution is c_r

    Parameters
    ----------
    law : str            one of the names above
    c_r : float          coefficient of restitution, 0..1

    Returns
    -------
    float                chi, >= 0

    Notes
    -----
    The first three are approximations: they deliver `delivered_restitution(chi)`, e.g. 0.725,
    0.663 and 0.470 for c_r = 0.5.  The identified factor is within 1e-12 for c_r >= 0.01.
    """
    if law not in LAWS:
        raise ValueError(f"no contact law named '{law}'.  Known: {', '.join(LAWS)}.")
    if not 0.0 <= c_r <= 1.0:
        raise ValueError(f"the restitution must lie in 0..1, got {c_r}")
    if c_r == 0.0 and law in ("flores", "identified"):
        raise ValueError(
            f"law '{law}' would need infinite damping for restitution 0.  "
            "Use a restitution of 0.01 or more, or law 'hunt_crossley'."
        )
    return 0.0 if c_r == 1.0 else LAWS[law](c_r)


def _compliance(of_i, of_j):
    """s_i + s_j = 1 / E*, 1/Pa."""
    (E_i, nu_i), (E_j, nu_j) = of_i, of_j
    if E_i <= 0.0 or E_j <= 0.0:
        raise ValueError(f"Young's moduli must be positive, got {E_i} and {E_j}")
    return (1.0 - nu_i * nu_i) / E_i + (1.0 - nu_j * nu_j) / E_j


def hertz_stiffness(R_i, R_j, of_i, of_j, form="internal"):
    """Hertz stiffness K of F = K d^1.5 between a bearing i and a journal j.

        K = 4 / (3 (s_i + s_j)) sqrt(R_i R_j / (R_i -+ R_j)),     s = (1 - nu^2) / E

    Parameters
    ----------
    R_i, R_j : float     radius of bearing and journal, m; R_i > R_j for 'internal'
    of_i, of_j           E, nu of each: Young's modulus, Pa, and Poisson's ratio
    form : str           'internal' (R_i - R_j) or 'paper' (R_i + R_j, as often printed)

    Returns
    -------
    float                K, N/m^1.5

    Notes
    -----
    For a pin in a hole 'internal' is the right curvature, 6 to 14 times stiffer at the usual
    clearances; 'paper' reproduces published runs.  Neither knows the width of the bearing.
    """
    if form not in ("internal", "paper"):
        raise ValueError(f"no stiffness form named '{form}'.  Known: internal, paper.")
    if R_j <= 0.0 or R_i <= (R_j if form == "internal" else 0.0):
        raise ValueError(f"radii {R_i} m of the bearing and {R_j} m of the journal do not fit")
    R = R_i - R_j if form == "internal" else R_i + R_j
    return 4.0 / (3.0 * _compliance(of_i, of_j)) * sqrt(R_i * R_j / R)


def cylinder_stiffness(width, of_i, of_j):
    """Stiffness K of the cylinder law F = K d sqrt(d / (d + c)).

        K = pi L E* / (2 sqrt 2),     1 / E* = s_i + s_j,     s = (1 - nu^2) / E

    from F = pi L E* / 2 d^n sqrt(1 / (2 (c + d))) with n = 3/2.  [Liu2007] [Pereira2011]

    Parameters
    ----------
    width : float        bearing width L, m
    of_i, of_j           E, nu of bearing and journal, as in `hertz_stiffness`

    Returns
    -------
    float                K, N/m
    """
    if width <= 0.0:
        raise ValueError(f"the bearing width must be positive, got {width} m")
    return pi * width / (2.0 * sqrt(2.0) * _compliance(of_i, of_j))


def ball_stiffness(radius, curvature, of_i, of_j):
    """Hertz stiffness K of F = K d^1.5 of a ball on a surface that is alike in all directions.

        K = 4 / (3 (s_i + s_j)) / sqrt(1 / R + curvature)

    curvature: of the surface, 1/m: 0 of a plane, 1 / R_i of a ball, -1 / R_i of a hollow one; of_i,
    of_j: E and nu of both.
    Raises ValueError where the ball does not fit.
    """
    if radius <= 0.0 or 1.0 / radius + curvature <= 0.0:
        raise ValueError(f"a ball of radius {radius:g} m does not fit there")
    return 4.0 / (3.0 * _compliance(of_i, of_j)) / sqrt(1.0 / radius + curvature)


def hertz_peak(m, K, n, v):
    """Largest penetration, m, and force, N, of an elastic impact at speed v.

    m v^2 / 2 = K d^(n+1) / (n + 1);  m is m_i m_j / (m_i + m_j) between two free bodies, kg.
    """
    d = ((n + 1.0) * m * v * v / (2.0 * K)) ** (1.0 / (n + 1.0))
    return d, K * d**n


def hertz_contact_time(m, K, n, v):
    """Time from touch to separation of an elastic impact at speed v, s.

    T = 2 d / v * sqrt(pi) Gamma(1 + p) / Gamma(1/2 + p),     p = 1 / (n + 1),  d the peak
    """
    p = 1.0 / (n + 1.0)
    return 2.0 * hertz_peak(m, K, n, v)[0] / v * sqrt(pi) * gamma(1.0 + p) / gamma(0.5 + p)
