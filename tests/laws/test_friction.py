"""Friction laws: they oppose sliding, take energy, and the bristle law sticks."""

from math import atan, cos, degrees, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from trsim.laws.friction import (
    CODES,
    N_PARAMETERS,
    bristle,
    coulomb,
    friction_force,
    modified_coulomb,
)
from trsim.scenario.contact_law import Friction

MU, V0, V1 = 0.3, 1e-4, 1e-3
BRISTLE = dict(mu_s=0.4, mu_k=0.3, v_s=0.01, sigma0=1e5, sigma1=300.0)
G = 9.81

load = st.floats(0.0, 1e5)
speed = st.floats(-10.0, 10.0)


@pytest.mark.parametrize(
    "v, share", [(0.0, 0), (V0, 0), (0.5 * (V0 + V1), 0.5), (V1, 1), (3.0, 1), (0.5 * V0, 0)]
)
def test_modified_coulomb_exact_at_its_corners(v, share):
    assert modified_coulomb(50.0, v, MU, V0, V1) == pytest.approx(-share * MU * 50.0, abs=1e-12)
    assert modified_coulomb(50.0, -v, MU, V0, V1) == pytest.approx(share * MU * 50.0, abs=1e-12)


@given(load, speed)
def test_power_of_speed_laws_is_never_positive(F_n, v):
    for F in (coulomb(F_n, v, MU), modified_coulomb(F_n, v, MU, V0, V1)):
        assert F * v <= 0.0
        assert abs(F) <= MU * F_n
    assert coulomb(F_n, 0.0, MU) == 0.0
    if abs(v) > V1:
        assert modified_coulomb(F_n, v, MU, V0, V1) == coulomb(F_n, v, MU)


@given(
    st.floats(1e-3, 1e5),
    speed,
    st.floats(-1, 1),
    st.floats(0.05, 1.0),
    st.floats(1.0, 2.0),
    st.floats(0.0, 1e5),
)
def test_bristle_is_passive_and_bounded(F_n, v, share, mu_k, ratio, sigma1):
    mu_s, sigma0 = mu_k * ratio, 1e5
    w = share * mu_s / sigma0
    F, w_dot = bristle(F_n, v, w, (mu_s, mu_k, 0.01, sigma0, sigma1))
    lost = -F * v - F_n * sigma0 * w * w_dot
    assert lost >= -1e-12 * F_n * (abs(v) * mu_s)
    assert abs(F) <= mu_s * F_n * (1 + 1e-12)
    if abs(share) == 1.0:  # the largest deflection is not left outwards
        assert w * w_dot <= 1e-12 * abs(w * v)


@given(st.floats(0.001, 10.0), st.sampled_from([-1.0, 1.0]))
def test_bristle_steady_sliding_is_the_stribeck_curve(s, sign):
    mu_s, mu_k, v_s, sigma0, _ = BRISTLE.values()
    g = mu_k + (mu_s - mu_k) * np.exp(-((s / v_s) ** 2))
    force, w_dot = bristle(20.0, sign * s, sign * g / sigma0, tuple(BRISTLE.values()))
    assert w_dot == pytest.approx(0.0, abs=1e-12 * s)
    assert force == pytest.approx(-sign * 20.0 * g)


def test_bristle_is_the_documented_equation():
    mu_s, mu_k, v_s, sigma0, sigma1 = BRISTLE.values()
    v, w, F_n = 0.004, 2e-6, 7.0
    g = mu_k + (mu_s - mu_k) * np.exp(-((v / v_s) ** 2))
    w_dot = v - sigma0 * v * w / g
    F = -F_n * (sigma0 * w + sigma1 / (1 + sigma1 * v / g) * w_dot)
    assert bristle(F_n, v, w, tuple(BRISTLE.values())) == pytest.approx((F, w_dot), rel=1e-13)


def test_bristle_without_load_is_frozen():
    assert bristle(0.0, 1.0, 1e-6, tuple(BRISTLE.values())) == (0.0, 0.0)


def slide(angle, end):
    """A block of 2 kg let go on an incline: its place at end / 2 and end, and its last speed.

    LSODA, because scipy's Radau grows its difference steps without bound once nothing moves.
    """
    F_n = 2.0 * G * cos(angle)

    def rates(t, y):
        F, w_dot = bristle(F_n, y[1], y[2], tuple(BRISTLE.values()))
        return [y[1], G * sin(angle) + F / 2.0, w_dot]

    run = solve_ivp(rates, (0, end), [0, 0, 0], "LSODA", [end / 2, end], rtol=1e-9, atol=1e-14)
    return run.y[0, 0], run.y[0, 1], run.y[1, 1]


def test_bristle_holds_a_block_below_the_friction_angle():
    angle = radians(15.0)
    assert degrees(angle) < degrees(atan(BRISTLE["mu_k"]))
    middle, last, v = slide(angle, 50.0)
    # the bristles carry the weight after a deflection of tan(angle) / sigma0, micrometres
    assert 0.0 < last < 3.0 * np.tan(angle) / BRISTLE["sigma0"]
    assert last == pytest.approx(middle, abs=1e-12)
    assert abs(v) < 1e-12


def test_modified_coulomb_creeps_where_bristle_holds():
    angle, F_n = radians(15.0), 2.0 * G * cos(radians(15.0))
    v = V0 + (V1 - V0) * np.tan(angle) / MU
    assert modified_coulomb(F_n, v, MU, V0, V1) == pytest.approx(-2.0 * G * sin(angle))


def test_bristle_lets_go_above_the_friction_angle():
    angle = radians(30.0)
    last, v = slide(angle, 1.0)[1:]
    # soon it slides at the kinetic coefficient
    a = G * (sin(angle) - BRISTLE["mu_k"] * cos(angle))
    assert (last, v) == pytest.approx((a / 2, a), rel=2e-2)


def test_dispatch_reads_the_parameters_of_a_scenario():
    sticking = dict(static_coefficient=0.4, stribeck_speed=0.01, bristle_stiffness=1e5)
    given = dict(coefficient=MU, v0=V0, v1=V1, bristle_damping=300.0, **sticking)
    w, v, F_n = 1e-6, 5e-4, 40.0
    expected = {
        "none": (0.0, 0.0),
        "coulomb": (coulomb(F_n, v, MU), 0.0),
        "modified_coulomb": (modified_coulomb(F_n, v, MU, V0, V1), 0.0),
        "sticking": bristle(F_n, v, w, tuple(BRISTLE.values())),
    }
    assert {*expected} == {*CODES}
    for law, force in expected.items():
        code, par = Friction(law=law, **given).numbers
        assert len(par) == N_PARAMETERS
        assert friction_force(code, F_n, v, w, np.array(par)) == force
