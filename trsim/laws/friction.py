"""Friction laws: normal force and sliding speed in, friction force on the moving body out.

    coulomb             F = -mu F_n sign v
    modified_coulomb    F = -mu F_n c_d sign v                         [Ambrosio2003]
                        c_d = clip((|v| - v0) / (v1 - v0), 0, 1)
    bristle             F = -F_n (sigma0 w + s1 w')                    [CanudasDeWit1995]
                        w' = v - sigma0 |v| w / g
                        g  = mu_k + (mu_s - mu_k) exp(-(v / v_s)^2)
                        s1 = sigma1 / (1 + sigma1 |v| / g)

v is the velocity of the moving body along the tangent, relative to what it slides on; F is the
force on that body along the same tangent, the opposite acts on the other.  F_n >= 0 is the
normal force.  w, m, is the mean deflection of the bristles, positive in the direction of v.
"""

from math import exp

from trsim.kernels.lazy import internal

# the word of a scenario -> the code of `friction_force`
CODES = {"none": 0, "coulomb": 1, "modified_coulomb": 2, "sticking": 3}

N_PARAMETERS = 6  # at most
DEAD, ON_RAMP, FULL = 0.0, 1.0, 2.0  # branches of `modified_coulomb`, with the sign of the speed


@internal
def coulomb(F_n, v_t, mu):
    """Dry friction with a jump at rest, for reference.

    Parameters
    ----------
    F_n : float          normal force, N
    v_t : float          sliding velocity, m/s
    mu : float           coefficient of friction

    Returns
    -------
    float                force on the moving body, N; 0 at v_t = 0: this law does not stick
    """
    if v_t == 0.0:
        return 0.0
    return -mu * F_n if v_t > 0.0 else mu * F_n


@internal
def modified_coulomb(F_n, v_t, mu, v0, v1):
    """Dry friction with a dead band and a linear ramp.                    [Ambrosio2003]

    Parameters
    ----------
    F_n : float          normal force, N
    v_t : float          sliding velocity, m/s
    mu : float           coefficient of friction
    v0 : float           speed below which there is no friction, m/s; >= 0
    v1 : float           speed above which friction is full, m/s; > v0

    Returns
    -------
    float                force on the moving body, N; opposes v_t

    Notes
    -----
    A loaded body never stops: it creeps at about v0.  The slope mu F_n / (v1 - v0) limits
    explicit steps.
    """
    s = abs(v_t)
    if s <= v0:
        return 0.0
    F = mu * F_n
    if s < v1:
        F *= (s - v0) / (v1 - v0)
    return -F if v_t > 0.0 else F


@internal
def branch_of(v_t, v0, v1):
    """The branch of `modified_coulomb` at a speed: 0 dead band, 1 ramp, 2 full; with its sign."""
    s = abs(v_t)
    if s <= v0:
        return 0.0
    size = 1.0 if s < v1 else 2.0
    return size if v_t > 0.0 else -size


@internal
def on_branch(branch, F_n, v_t, mu, v0, v1):
    """`modified_coulomb` with one branch drawn on beyond its ends, so that it has no corner.

    Between the corners the two are equal; a solver that locates the corners steps through smooth
    functions only.  branch: as of `branch_of`.  Returns the force on the moving body, N.
    """
    if branch == 0.0:
        return 0.0
    if abs(branch) == 1.0:
        return -mu * F_n * (v_t - branch * v0) / (v1 - v0)
    return -mu * F_n if branch > 0.0 else mu * F_n


@internal
def beyond(branch, v_t, v0, v1):
    """How far a speed has left its branch, m/s: negative inside, zero at a corner."""
    size = abs(branch)
    s = v_t if branch > 0.0 else -v_t
    if size == 0.0:
        return abs(v_t) - v0
    return max(v0 - s, s - v1) if size == 1.0 else v1 - s


@internal
def neighbour(branch, v_t, v0, v1):
    """The branch on the other side of the nearest corner."""
    size = abs(branch)
    if size == 0.0:
        return 1.0 if v_t > 0.0 else -1.0
    sign = 1.0 if branch > 0.0 else -1.0
    if size == 2.0:
        return sign
    return 2.0 * sign if sign * v_t - v0 > v1 - sign * v_t else 0.0


@internal
def bristle(F_n, v_t, w, par):
    """Load-proportional bristle friction, which sticks.                   [CanudasDeWit1995]

    Parameters
    ----------
    F_n : float          normal force, N
    v_t : float          sliding velocity, m/s
    w : float            bristle deflection, m; a state of the run
    par                  parameters of the law, in this order:
        mu_s, mu_k : float   static and kinetic coefficient; mu_s >= mu_k > 0
        v_s : float          Stribeck speed, m/s; > 0
        sigma0 : float       bristle stiffness per normal force, 1/m
        sigma1 : float       bristle damping per normal force, s/m

    Returns
    -------
    (float, float)       force on the moving body, N, and the rate w', m/s

    Notes
    -----
    At rest every |w| <= mu_s / sigma0 is an equilibrium, so a block stays where it is under a
    constant load below mu_s F_n.  Under a load that swings it may drift.  The equation keeps
    |w| <= mu_s / sigma0.

    Deviation from the source: a constant sigma1 may put energy in where sigma1 |v| > 4 g.  With s1
    as above F is a weighted mean of -F_n sigma0 w and -F_n g sign v, hence |F| <= mu_s F_n, and
    at constant F_n   -F v - d/dt (F_n sigma0 w^2 / 2) >= 0:
    the bristles give back no more than they took.  A change of F_n scales the stored energy and
    is outside this bound.

    F_n <= 0: no force, and w is frozen; its owner sets it to 0 when a new contact begins.
    """
    if F_n <= 0.0:
        return 0.0, 0.0
    return part_of_bristle(F_n, v_t, abs(v_t), w, par)


@internal
def part_of_bristle(F_n, v_t, s, w, par):
    """`bristle` in one direction of a surface on which the body slides at the speed s, v_t of it in
    this direction: bristles bend in each, and what they hold together is that of one."""
    mu_s, mu_k, v_s, sigma0, sigma1 = par[0], par[1], par[2], par[3], par[4]
    x = s / v_s
    g = mu_k + (mu_s - mu_k) * exp(-x * x)
    F = -F_n * (sigma0 * w + sigma1 * v_t) / (1.0 + sigma1 * s / g)  # = -F_n (sigma0 w + s1 w')
    return F, v_t - sigma0 * s * w / g


@internal
def friction_force(code, F_n, v_t, w, par):
    """Friction by code: 0 none, 1 coulomb, 2 modified_coulomb, 3 sticking (bristle).

    Parameters
    ----------
    code : int           one of `CODES`
    F_n : float          normal force, N
    v_t : float          sliding velocity, m/s
    w : float            bristle deflection, m; read by code 3 only
    par : (N_PARAMETERS) parameters of the law, in the order it takes them; the rest is not read

    Returns
    -------
    (float, float)       force on the moving body, N, and w', m/s (0 unless code 3)
    """
    if code == 2:
        return modified_coulomb(F_n, v_t, par[0], par[1], par[2]), 0.0
    if code == 3:
        return bristle(F_n, v_t, w, par)
    if code == 1:
        return coulomb(F_n, v_t, par[0]), 0.0
    return 0.0, 0.0
