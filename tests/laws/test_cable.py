"""Cable element: gradients, rigid motions, damping, mass, loads, what is in a section."""

import numpy as np
import pytest

from trsim.laws.cable import EXACT, GERSTMAYR, PAPER, add_force, energies
from trsim.laws.cable_section import (
    mass,
    position,
    shapes,
    stress,
    uniform_shares,
)
from trsim.laws.cable_stretch import ASSUMED, ENGINEERING, FULL, GREEN
from trsim.laws.cable_tangent import add_damping, add_stiffness

from ..bars import Bar

L, EA, EI, BETA = 0.1, 40.0, 0.1, 1e-3  # m, N, N*m^2, s
STRAINS, CURVATURES = (GREEN, ENGINEERING), (EXACT, GERSTMAYR, PAPER)
FORMS = [(s, c, w) for s in STRAINS for c in CURVATURES for w in (ASSUMED, FULL)]
LOBATTO = (0.0, 0.5 - 0.05**0.5, 0.5 + 0.05**0.5, 1.0)  # x / l
each_form = pytest.mark.parametrize("form", FORMS, ids=str)


def bar(form):
    return Bar(L, EA, EI, BETA, *form)


def strained(rng, planar=False):
    """Coordinates of an element bent and stretched by tenths."""
    e = np.array([0, 0, 0, 1, 0, 0, L, 0, 0, 1, 0, 0]) + rng.normal(size=12) * 0.1 * np.tile(
        [L, L, L, 1, 1, 1], 2
    )
    if planar:
        e[2::3] = 0.0
    return e


def force(e, v, form, beta=0.0):
    F = np.zeros(12)
    add_force(e, v, bar(form), beta, F)
    return F


def stiffness(e, form):
    K = np.zeros((12, 12))
    add_stiffness(e, bar(form), np.zeros((4, 12)), K)
    return K


def damping(e, form):
    C = np.zeros((12, 12))
    add_damping(e, bar(form), np.zeros((4, 12)), C)
    return C


def differences(f, x, h=1e-5):
    """df/dx, column by column, of order 4."""
    columns = []
    for k in range(x.size):
        d = np.zeros(x.size)
        d[k] = h
        columns.append((8 * (f(x + d) - f(x - d)) - (f(x + 2 * d) - f(x - 2 * d))) / (12 * h))
    return np.array(columns).T


def rotation(rng):
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return Q * np.linalg.det(Q)


def moved(e, R, shift=(0, 0, 0)):
    """The element after a rigid motion."""
    return np.concatenate([R @ e[:3] + shift, R @ e[3:6], R @ e[6:9] + shift, R @ e[9:]])


@each_form
def test_force_is_the_gradient_of_the_energy(form, rng):
    for _ in range(5):
        e = strained(rng)
        F = force(e, e, form)
        gradient = differences(lambda x: np.array(sum(energies(x, bar(form)))), e, 1e-4)
        assert abs(F + gradient).max() < 1e-7 * abs(F).max()


@each_form
def test_stiffness_is_the_gradient_of_the_force(form, rng):
    for _ in range(5):
        e = strained(rng)
        K = stiffness(e, form)
        numeric = -differences(lambda x: force(x, x, form), e)
        assert abs(K - numeric).max() < 1e-8 * abs(K).max()
        assert (K == K.T).all()


@each_form
def test_rigid_motions_are_free(form, rng):
    straight = np.array([0, 0, 0, 1, 0, 0, L, 0, 0, 1, 0, 0])
    for _ in range(10):
        e = moved(straight, rotation(rng), rng.normal(size=3))
        assert abs(force(e, e, form)).max() < 1e-12 * EA


@each_form
def test_forces_turn_with_the_element(form, rng):
    e, v, R = strained(rng), rng.normal(size=12), rotation(rng)
    F = force(e, v, form, BETA)
    turned = force(moved(e, R, (0.3, -0.2, 0.5)), moved(v, R), form, BETA)
    assert abs(turned - moved(F, R)).max() < 1e-12 * abs(F).max()
    assert abs(F[:3] + F[6:9]).max() == 0.0


@each_form
def test_rigid_velocities_are_not_damped(form, rng):
    """Also of a bent element and about any axis; what is left is the blend at k0."""
    for _ in range(10):
        e, omega = strained(rng), rng.normal(size=3)
        v = np.cross(omega, e.reshape(4, 3)).ravel() + np.tile([1.0, -2.0, 0.5, 0, 0, 0], 2)
        damped = force(e, v, form, BETA) - force(e, v, form)
        assert abs(damped).max() < 1e-12 * EA


def rates(e, v, form, xi, h=1e-6):
    """Rates of axial force and moment at xi, by differences."""
    ahead, behind = (stress(e + s * v, bar(form), xi) for s in (h, -h))
    return (np.array(ahead) - behind) / (2 * h)


def dissipation(e, v, form):
    """beta int EA eps'^2 + EI kappa'^2 dx, W."""
    power = 0.0
    for which, points, k in ((0, 5, EA), (1, 3, EI)):
        xi, weights = np.polynomial.legendre.leggauss(points)
        xi, weights = (xi + 1) / 2, weights / 2
        rate = np.array([rates(e, v, form, x)[which] for x in xi])
        if which == 0 and form[2] == ASSUMED:
            rate = assumed(*(rates(e, v, form, x)[0] for x in LOBATTO), xi)
        power += L * weights @ rate**2 / k
    return BETA * power


def assumed(a, b, c, d, xi):
    """The parabola with a and d at its ends and the mean of Lobatto's four values."""
    mean = (a + 5 * b + 5 * c + d) / 12
    middle = (6 * mean - a - d) / 4
    return np.polyval(np.polyfit([0, 0.5, 1], [a, middle, d], 2), xi)


@each_form
def test_damping_dissipates_at_the_rate_of_its_strains(form, rng):
    for _ in range(10):
        e, v = strained(rng), rng.normal(size=12)
        power = v @ (force(e, v, form, BETA) - force(e, v, form))
        assert power == pytest.approx(-dissipation(e, v, form), rel=1e-5)
        assert power == pytest.approx(-v @ damping(e, form) @ v, rel=1e-10)


@each_form
def test_a_straight_element_has_damping_proportional_to_its_stiffness(form):
    e = np.array([0, 0, 0, 1, 0, 0, L, 0, 0, 1, 0, 0])
    K = stiffness(e, form)
    assert abs(damping(e, form) - BETA * K).max() < 1e-14 * abs(K).max()


@each_form
@pytest.mark.parametrize("bend", [0.0, 1e-7, 1e-6, 1e-5, 1e-2])
def test_damping_matrix_is_that_of_the_force(form, bend, rng):
    e = np.array([0, 0, 0, 1, 0, 0, L, 0, 0, 1 + 1e-5, bend, 0.3 * bend])  # not evenly stretched
    still = force(e, np.zeros(12), form)
    columns = [still - force(e, row, form, BETA) for row in np.eye(12)]
    C = damping(e, form)
    assert abs(np.array(columns).T - C).max() < 1e-12 * abs(C).max()
    assert np.linalg.eigvalsh(C).min() > -1e-12 * abs(C).max()


@each_form
def test_a_plane_is_a_plane(form, rng):
    """Planar motion stays planar, and turning its plane changes nothing."""
    e, v = strained(rng, planar=True), rng.normal(size=12)
    v[2::3] = 0.0
    F = force(e, v, form, BETA)
    assert (F[2::3] == 0.0).all()
    R = rotation(rng)
    assert (
        abs(force(moved(e, R), moved(v, R), form, BETA) - moved(F, R)).max() < 1e-12 * abs(F).max()
    )


@pytest.fixture
def rng():
    return np.random.default_rng(20)


def test_mass_is_the_integral_of_the_shapes():
    M, points = np.zeros((4, 4)), zip(*np.polynomial.legendre.leggauss(4), strict=True)
    for x, w in points:
        S = np.array(shapes((x + 1) / 2, L))
        M += 0.5 * w * L * 0.7 * np.outer(S, S)
    assert np.array(mass(L, 0.7)) == pytest.approx(M, rel=1e-13)


def test_uniform_shares_are_the_integrals_of_the_shapes():
    points = zip(*np.polynomial.legendre.leggauss(2), strict=True)
    total = sum(0.5 * w * L * np.array(shapes((x + 1) / 2, L)) for x, w in points)
    assert np.array(uniform_shares(L)) == pytest.approx(total, rel=1e-14)


def test_position_and_its_slope(rng):
    e = strained(rng)
    assert position(e, L, 0.0) == pytest.approx(e[:3])
    assert position(e, L, 1.0) == pytest.approx(e[6:9])
    for xi, slope in ((0.0, e[3:6]), (1.0, e[9:])):
        ahead, behind = np.array(position(e, L, xi + 1e-6)), np.array(position(e, L, xi - 1e-6))
        assert (ahead - behind) / (2e-6 * L) == pytest.approx(slope, rel=1e-8)


@pytest.mark.parametrize("curvature, power", [(EXACT, 0), (GERSTMAYR, 1), (PAPER, 2)])
def test_stress_in_a_stretched_arc(curvature, power):
    """A small part of a circle of radius R, stretched by lambda: 1/R, lambda/R, lambda^2/R."""
    R, stretched = 2.0, 1.1
    angle = stretched * L / R
    e = np.array([R, 0, 0, 0, stretched, 0, *(R * np.cos(angle), R * np.sin(angle), 0), 0, 0, 0])
    e[9:11] = -stretched * np.sin(angle), stretched * np.cos(angle)
    N, M = stress(e, bar((ENGINEERING, curvature, ASSUMED)), 0.5)
    assert pytest.approx(EA * 0.1, rel=1e-5) == N
    assert pytest.approx(EI / R * stretched**power, rel=1e-3) == M
