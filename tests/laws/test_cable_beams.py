"""Cable elements put together: elastica, frequencies of a beam, a flexible pendulum."""

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

from trsim.laws.cable import EXACT, GERSTMAYR, PAPER, add_force
from trsim.laws.cable_section import mass, uniform_shares
from trsim.laws.cable_stretch import ASSUMED, ENGINEERING, FULL, GREEN
from trsim.laws.cable_tangent import add_damping, add_stiffness

from ..bars import Bar

DATA = Path(__file__).parents[1] / "data"
BETA_L = (1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349, 14.1371683910)
STIFF = 1.2e7  # EA L^2 / EI of a beam that hardly stretches


def table(name):
    lines = [s for s in (DATA / name).read_text().splitlines() if s[0] in "-0123456789"]
    return np.array([[float(x) for x in line.split(",")] for line in lines])


def straight(n):
    """A cable of n elements and length 1 along x."""
    q = np.zeros(6 * (n + 1))
    q[0::6], q[3::6] = np.linspace(0.0, 1.0, n + 1), 1.0
    return q


def tangent_system(q, n, EA, EI, form):
    """Force and stiffness of n elements with a total length of 1."""
    F, K, workspace = np.zeros(q.size), np.zeros((q.size, q.size)), np.zeros((4, 12))
    bar = Bar(1 / n, float(EA), float(EI), 0.0, *form)
    for k in range(n):
        at, add = slice(6 * k, 6 * k + 12), np.zeros((12, 12))
        add_force(q[at], q[at], bar, 0.0, F[at])
        add_stiffness(q[at], bar, workspace, add)
        K[at, at] += add
    return F, K


def mass_matrix(n, rho_A):
    M = np.zeros((6 * (n + 1), 6 * (n + 1)))
    for k in range(n):
        at = slice(6 * k, 6 * k + 12)
        M[at, at] += np.kron(np.array(mass(1 / n, rho_A)), np.eye(3))
    return M


def clamped(n):
    """Planar coordinates that are free when r_a and the direction of r_xa are held."""
    return np.array([k for k in range(6 * (n + 1)) if k % 3 != 2 and k not in (0, 1, 4)])


def pushed(q, P):
    """A dead transverse force at the tip, and its derivative."""
    Q = np.zeros(q.size)
    Q[-5] = P
    return Q, np.zeros((q.size, q.size))


def twisted(q, T):
    """A moment at the tip: it turns the slope, T d atan2(r_xy, r_xx), and its derivative."""
    Q, D = np.zeros(q.size), np.zeros((q.size, q.size))
    x, y = q[-3], q[-2]
    s = x * x + y * y
    Q[-3], Q[-2] = -T * y / s, T * x / s
    D[-3:-1, -3:-1] = np.array([[2 * x * y, y * y - x * x], [y * y - x * x, -2 * x * y]]) * T / s**2
    return Q, D


def settled(q, n, EA, form, load, values):
    """q <- equilibrium of a cantilever with EI = 1 under the last of the increasing loads."""
    free = clamped(n)
    for value in values:
        for _ in range(60):
            F, K = tangent_system(q, n, EA, 1.0, form)
            Q, D = load(q, value)
            change = np.linalg.solve((K - D)[np.ix_(free, free)], (F + Q)[free])
            q[free] += change * min(1.0, 0.2 / abs(change).max())
            if abs(change).max() < 1e-9:
                break
        else:
            raise AssertionError(f"no equilibrium at {value}")


def bent(n, EA, form, load, values):
    """Tip x, y and angle of the cantilever under each of the increasing loads."""
    q, last, shapes = straight(n), 0.0, []
    for value in values:
        steps = np.linspace(last, value, int(np.ceil(value - last)) + 1)[1:]
        settled(q, n, EA, form, load, steps)
        last = value
        shapes.append((q[-6], q[-5], np.arctan2(q[-2], q[-3])))
    return np.array(shapes)


def worst(n, EA, form, rows):
    """Largest error of the tip's place under the tip forces rows[:, 0]."""
    found = bent(n, EA, form, pushed, rows[:, 0])
    return max(abs(found[:, 1] - rows[:, 1]).max(), abs(1 - found[:, 0] - rows[:, 2]).max())


def extensible(EA):
    rows = table("elastica_extensible.csv")
    return rows[rows[:, 0] == EA][:, 1:]


@pytest.mark.parametrize("strain", [GREEN, ENGINEERING])
@pytest.mark.parametrize("curvature", [EXACT, GERSTMAYR, PAPER])
def test_elastica(strain, curvature):
    rows = table("elastica_tip_force.csv")
    bends = rows[(rows[:, 0] <= 10) & (rows[:, 0] >= 1)]
    assert worst(16, STIFF, (strain, curvature, ASSUMED), bends) < 1e-5


@pytest.mark.parametrize("EA", [1.2e6, 1.2e7])
@pytest.mark.parametrize("curvature", [EXACT, GERSTMAYR])
def test_slender_beams_do_not_lock(curvature, EA):
    """P L^2 / EI = 3: errors of order 4, and the same at every slenderness."""
    rows = table("elastica_tip_force.csv")
    rows = rows[rows[:, 0] == 3]
    stretched = 8.0 / EA  # the elastica of the table is inextensible
    for n, bound in ((4, 4e-4), (8, 2.7e-5), (16, 1.8e-6)):
        assert worst(n, EA, (GREEN, curvature, ASSUMED), rows) < bound + stretched


def test_full_stretching_locks():
    """What it is for: meshes of other programs.  Errors fall slowly, from a large one."""
    rows = table("elastica_tip_force.csv")
    form = (ENGINEERING, GERSTMAYR, FULL)
    coarse, fine = (worst(n, 1.2e7, form, rows[rows[:, 0] == 3]) for n in (4, 16))
    assert coarse > 5e-3 and fine > 1e-4


@pytest.mark.parametrize("strain", [GREEN, ENGINEERING])
@pytest.mark.parametrize("EA", [1200, 4800, 30000, 120000])
def test_extensible_elastica(strain, EA):
    """The moment goes with the change of angle per undeformed length: the gerstmayr form."""
    assert worst(16, EA, (strain, GERSTMAYR, ASSUMED), extensible(EA)) < 1e-4


def test_other_curvatures_are_other_beams_where_much_is_stretched():
    assert worst(16, 1200, (GREEN, EXACT, ASSUMED), extensible(1200)) == pytest.approx(
        4.6e-3, rel=0.02
    )
    assert worst(16, 120000, (GREEN, EXACT, ASSUMED), extensible(120000)) < 6e-5
    assert worst(16, 1200, (GREEN, PAPER, ASSUMED), extensible(1200)) == pytest.approx(
        3.7e-3, rel=0.02
    )


def test_tip_moment_bends_a_circle():
    rows = table("elastica_tip_moment.csv")[:5]
    found = bent(16, STIFF, (ENGINEERING, GERSTMAYR, ASSUMED), twisted, rows[:, 0] * 2 * np.pi)
    assert abs(found[:, 0] - 1 - rows[:, 1]).max() < 1e-4
    assert abs(found[:, 1] - rows[:, 2]).max() < 1e-4


def test_elastica_converges():
    """Order 4 as soon as the mesh resolves the bend."""
    rows = extensible(1200)[-1:]
    coarse, fine = (worst(n, 1200, (ENGINEERING, GERSTMAYR, ASSUMED), rows) for n in (4, 8))
    assert np.log2(coarse / fine) > 3.5


def frequencies(n, form):
    """Of a cantilever with EI = rho A = 1 across its axis."""
    across = np.array([k for k in range(6 * (n + 1)) if k % 3 == 1 and k not in (1, 4)])
    K = tangent_system(straight(n), n, 1.0, 1.0, form)[1]
    M = mass_matrix(n, 1.0)
    pick = np.ix_(across, across)
    return np.sqrt(eigh(K[pick], M[pick], eigvals_only=True)[:5])


@pytest.mark.parametrize("curvature", [EXACT, GERSTMAYR, PAPER])
def test_cantilever_frequencies(curvature):
    exact = np.square(BETA_L)
    errors = {n: frequencies(n, (ENGINEERING, curvature, ASSUMED)) / exact - 1 for n in (8, 16, 32)}
    assert abs(errors[32]).max() < 1e-4
    assert np.log2(errors[8] / errors[16])[2:].min() > 3.8


FORMS = [(s, c, ASSUMED) for s in (GREEN, ENGINEERING) for c in (EXACT, GERSTMAYR, PAPER)]


@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize("form", FORMS, ids=str)
def test_only_rigid_motions_are_free(form, n):
    """A straight beam in space: three places and two turns; it has no spin."""
    values = np.linalg.eigvalsh(tangent_system(straight(n), n, 1e4, 1.0, form)[1])
    # rounding of eigenvalues is n eps times the largest; the softest bend is far above it
    assert (abs(values[:5]) < 1e-13 * values[-1]).all() and values[5] > 1e-9 * values[-1]


@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize("form", FORMS, ids=str)
def test_only_rigid_velocities_of_a_bent_beam_in_a_plane_are_free(form, n):
    """A velocity that changes no strain is not damped: the damping matrix knows them all."""
    rng = np.random.default_rng(4)
    q = straight(n)
    q[1::6] += rng.normal(size=n + 1) * 0.3 / n
    q[3::6], q[4::6] = 1 + 0.1 * rng.normal(size=(2, n + 1))
    C = np.zeros((q.size, q.size))
    for k in range(n):
        at, add = slice(6 * k, 6 * k + 12), np.zeros((12, 12))
        add_damping(q[at], Bar(1 / n, 100.0, 1.0, 1.0, *form), np.zeros((4, 12)), add)
        C[at, at] += add
    plane = np.array([k for k in range(q.size) if k % 3 != 2])
    values = np.linalg.eigvalsh(C[np.ix_(plane, plane)])
    assert (abs(values[:3]) < 1e-10 * values[-1]).all() and values[3] > 1e-6 * values[-1]


def test_the_axial_motion_is_that_of_full_integration():
    """All frequencies of a straight mesh, up to the highest, which bounds explicit steps."""
    M = mass_matrix(6, 1.0)
    a, b = (
        eigh(tangent_system(straight(6), 6, 1e4, 1.0, (GREEN, EXACT, f))[1], M, eigvals_only=True)
        for f in (ASSUMED, FULL)
    )
    assert a[-1] == pytest.approx(b[-1], rel=1e-12)
    assert a == pytest.approx(b, abs=1e-12 * b[-1])


def test_frequencies_of_a_bent_beam_in_space():
    """Around the equilibrium under a tip force: none that a finer mesh does not have."""

    def found(n):
        q, form = straight(n), (GREEN, EXACT, ASSUMED)
        held = np.array([k for k in range(q.size) if k not in (0, 1, 2, 4, 5)])
        settled(q, n, STIFF, form, pushed, np.linspace(0, 5, 7)[1:])
        K, M = tangent_system(q, n, STIFF, 1.0, form)[1], mass_matrix(n, 1.0)
        pick = np.ix_(held, held)
        return np.sqrt(eigh(K[pick], M[pick], eigvals_only=True)[:8])

    assert found(8) == pytest.approx(found(24), rel=5e-3)


def pendulum(n, end, h):
    """Tip and mid-point every 10 ms of a flexible spatial pendulum, by Runge and Kutta's method."""
    E, A, I, rho = 1.6e6, 2.5e-5, 5e-3**4 / 12, 320.0
    q, v, gravity = straight(n), np.zeros(6 * (n + 1)), np.zeros(6 * (n + 1))
    v[2::6], v[5::6] = -4.0 * q[0::6], -4.0
    for k in range(n):
        gravity[6 * k + 1 : 6 * k + 12 : 3] -= 9.81 * rho * A * np.array(uniform_shares(1 / n))
    bar = Bar(1 / n, E * A, E * I, 0.0, ENGINEERING, GERSTMAYR, FULL)
    inverse = np.zeros((q.size, q.size))
    inverse[3:, 3:] = np.linalg.inv(mass_matrix(n, rho * A)[3:, 3:])

    def rates(y):
        F = gravity.copy()
        for k in range(0, 6 * n, 6):
            e = y[0, k : k + 12]
            add_force(e, e, bar, 0.0, F[k : k + 12])
        return np.array([y[1], inverse @ F])

    y, rows = np.array([q, v]), []
    for k in range(1, round(end / h) + 1):
        k1 = rates(y)
        k2 = rates(y + h / 2 * k1)
        k3 = rates(y + h / 2 * k2)
        k4 = rates(y + h * k3)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if k % round(0.01 / h) == 0:
            rows.append([*y[0, -6:-3], *y[0, 3 * n : 3 * n + 3]])
    return np.array(rows)


def test_flexible_pendulum():
    """The same mesh, computed independently: says strain, curvature and Gauss points.

    That computation integrates the stretch fully.
    """
    reference = table("p2_pendulum_8_elements.csv")[1:, 1:]
    assert abs(pendulum(8, 2.0, 2.5e-4) - reference).max() < 1e-7
