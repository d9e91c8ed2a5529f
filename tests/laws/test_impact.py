"""Impacts that take no time: closed forms of one contact, and no gain of energy in any."""

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.laws.contact import RULES
from trsim.laws.impact import NoImpact, impact

from ..sizes import size

SLANTED = 0.5, 1.2  # kg, m: mass and length of a slender rod


def rod(angle, m=SLANTED[0], length=SLANTED[1]):
    """Inverse masses at the lower end of a free rod that leans by an angle from the horizontal."""
    x, y = -0.5 * length * cos(angle), -0.5 * length * sin(angle)  # from the centre of mass
    by_turn = 12.0 / (m * length**2)
    G = np.zeros((3, 3))
    G[0, 0], G[1, 1] = 1 / m + by_turn * x * x, 1 / m + by_turn * y * y
    G[0, 1] = G[1, 0] = -by_turn * x * y
    return G


def gained(u, G, blow):
    """The energy that an impact gives, by the mean of the velocities before and after, J."""
    return float(0.5 * (u + blow.velocity) @ blow.impulse)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("e", [0.0, 0.3, 1.0])
def test_without_friction_both_rules_deliver_the_restitution(rule, e):
    u, G = np.array((-2.0, 0.7, -0.4)), rod(0.9)
    blow = impact(u, G, (0.0, 0.0), e, rule)
    assert blow.velocity[0] == pytest.approx(2.0 * e, abs=1e-14)
    assert blow.impulse == pytest.approx([(1 + e) * 2.0 / G[0, 0], 0.0, 0.0])
    assert gained(u, G, blow) == pytest.approx(-0.5 * (1 - e * e) * 4.0 / G[0, 0])


@pytest.mark.parametrize("rule", RULES)
def test_a_ball_that_slides_all_along_and_one_that_sticks(rule):
    # a uniform ball of 1 kg: 7/2 of its inverse mass across the normal
    G, e = np.diag((1.0, 3.5, 3.5)), 0.6
    u = np.array((-1.0, 3.0, 4.0))
    slides = impact(u, G, (0.1, 0.1), e, rule)
    p = 1.6
    assert slides.velocity == pytest.approx([0.6, 3.0 - 0.6 * 0.35 * p, 4.0 - 0.8 * 0.35 * p])
    sticks = impact(u, G, (0.95, 0.95), e, rule)
    assert sticks.velocity == pytest.approx([0.6, 0.0, 0.0], abs=1e-12)
    assert sticks.impulse == pytest.approx([p, -3.0 / 3.5, -4.0 / 3.5])


def test_a_slanted_rod_that_sticks_by_the_rule_of_poisson():
    # it comes to rest across the normal in compression and stays so: by hand, in two lines
    G, mu, e = rod(0.35), 1.5, 0.5
    u = np.array((-1.0, 0.2, 0.0))
    blow = impact(u, G, (mu, mu), e, "poisson")
    slide = G[0, 0] - mu * G[0, 1], G[0, 1] - mu * G[1, 1]
    p_1 = -u[1] / slide[1]
    u_1 = u[0] + slide[0] * p_1
    held = G[0, 0] - G[0, 1] ** 2 / G[1, 1]
    p_c = p_1 - u_1 / held
    assert 0 < p_1 < p_c
    assert abs(G[0, 1] / G[1, 1]) < mu
    assert blow.impulse[0] == pytest.approx((1 + e) * p_c)
    assert blow.velocity[:2] == pytest.approx([held * e * p_c, 0.0], abs=1e-14)


def test_sliding_that_turns_against_an_integrator():
    rng = np.random.default_rng(3)
    A = rng.normal(size=(3, 3))
    G, u, mu, e = A @ A.T + 0.5 * np.eye(3), np.array((-1.0, 1.5, -0.8)), 0.25, 0.7
    blow = impact(u, G, (mu, mu), e, "poisson")

    def slope(_, y):
        return G @ (1.0, *(-mu * y[1:] / np.hypot(*y[1:])))

    def rest(_, y):
        return y[0]

    rest.terminal = True
    into = solve_ivp(slope, (0, 50), u, events=rest, rtol=1e-11, atol=1e-13)
    p_c = into.t[-1]
    out = solve_ivp(slope, (p_c, (1 + e) * p_c), into.y[:, -1], rtol=1e-11, atol=1e-13)
    assert min(np.hypot(*into.y[1:])) > 0.05, "it slides all along"
    assert blow.velocity == pytest.approx(out.y[:, -1], abs=1e-7)
    assert G @ blow.impulse == pytest.approx(blow.velocity - u, abs=1e-7)


@pytest.mark.parametrize("rule", RULES)
def test_no_impact_of_a_rod_gives_energy(rule):
    # Kane's: with friction the rule of Newton alone gives some here
    rng = np.random.default_rng(5)
    most = 0.0
    for _ in range(400):
        G = rod(rng.uniform(0.02, 0.5 * pi))
        u = np.array((-rng.uniform(0.01, 2.0), rng.normal(), 0.0))
        mu, e = rng.uniform(0.0, 2.0), rng.uniform(0.0, 1.0)
        blow = impact(u, G, (mu, mu), e, rule)
        here = abs(u[0]) * blow.impulse[0] + abs(u[1] * blow.impulse[1])
        most = max(most, gained(u, G, blow) / here)
        assert blow.work <= 1e-12 * here
        assert blow.velocity[0] >= -1e-9
        assert abs(blow.impulse[1]) <= mu * blow.impulse[0] * (1 + 1e-12)
    assert most <= 1e-12


def test_newton_alone_would_give_the_normal_force_more_than_it_took():
    """That the test above has something to find."""
    G, mu, e = rod(0.9), 0.5, 1.0
    found = []
    for sliding in np.linspace(-1.0, 1.0, 41):
        u = np.array((-1.0, sliding, 0.0))
        kept = impact(u, G, (mu, mu), e, "newton")
        found.append(kept.velocity[0] < 1.0 - 1e-6)
    assert any(found), "nowhere is less delivered than was asked for"


@pytest.mark.parametrize("rule", RULES)
def test_no_impact_in_space_gives_energy(rule):
    rng = np.random.default_rng(7)
    for _ in range(size(30, 100)):
        A = rng.normal(size=(3, 3))
        G, u = A @ A.T + 0.1 * np.eye(3), rng.normal(size=3)
        u[0] = -abs(u[0]) - 0.01
        mu = rng.uniform(0.0, 1.5)
        blow = impact(u, G, (1.2 * mu, mu), rng.uniform(0.0, 1.0), rule)
        here = np.abs(u) @ np.abs(blow.impulse)
        assert gained(u, G, blow) <= 1e-9 * here
        assert blow.work <= 1e-9 * here
        assert G @ blow.impulse == pytest.approx(blow.velocity - u, abs=1e-8)
        assert np.hypot(*blow.impulse[1:]) <= 1.2 * mu * blow.impulse[0] * (1 + 1e-9)


def test_sliding_begins_where_friction_does_not_hold():
    # pressed sideways by its own shape, from rest: dv_t is along the sliding, friction against it
    A = np.array(((1.0, 0.0, 0.0), (0.9, 0.4, 0.0), (-0.5, 0.2, 0.3)))
    G, mu = A @ A.T, 0.3
    u = np.array((-1.0, 0.0, 0.0))
    blow = impact(u, G, (mu, mu), 0.0, "poisson")
    d = blow.velocity[1:] / np.hypot(*blow.velocity[1:])
    assert blow.impulse[1:] == pytest.approx(-mu * blow.impulse[0] * d, abs=1e-9)
    assert G @ blow.impulse == pytest.approx(blow.velocity - u, abs=1e-9)


def test_what_does_not_give_way_has_no_impact():
    with pytest.raises(NoImpact):
        impact(np.array((-1.0, 0.0, 0.0)), np.zeros((3, 3)), (0.0, 0.0), 1.0, "newton")
