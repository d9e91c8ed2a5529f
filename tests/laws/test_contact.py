"""Contact laws: delivered restitution, Hertz impact, energy, and no pulling."""

import csv
import json
from math import exp, inf, log1p
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.integrate import DOP853, quad
from scipy.optimize import brentq

from trsim.laws.contact import (
    CYLINDER,
    HERTZ,
    Pair,
    cylinder_stiffness,
    damping_factor,
    delivered_restitution,
    elastic,
    hertz_contact_time,
    hertz_peak,
    hertz_stiffness,
    impact_force,
    normal_force,
    ramped_beyond,
    ramped_branch_of,
    ramped_damping,
    ramped_neighbour,
    ramped_on_branch,
    stored,
)

DATA = Path(__file__).parents[1] / "data"
COMMERCIAL = json.loads((DATA / "impact_and_bistop.json").read_text())["vectors"]
HERTZ_BALL = json.loads((DATA / "contact_analytic.json").read_text())["hertz"]
LAWS = ("lankarani_nikravesh", "hunt_crossley", "flores", "identified")
C = 3e-4  # m, radial clearance
STEEL = ((207e9, 0.29), (207e9, 0.29))
# K, n, c, form of an impact of 0.2 kg
HERTZ_PAIR = Pair(1.05e10, 1.5, C, HERTZ)
CYLINDER_PAIR = Pair(cylinder_stiffness(15e-3, *STEEL), 1.5, C, CYLINDER)


def restitution_table():
    lines = (DATA / "effective_restitution.csv").read_text().splitlines()
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        e = float(row.pop("nominal"))
        yield from (
            (law, e, float(x)) for law, x in row.items() if not (law == "flores" and e == 0)
        )


def impact(pair, chi, m=0.2, v=0.1):
    """Integrate one impact to separation: rebound / approach speed, duration, largest force."""
    pair = pair._replace(chi=chi)

    def rates(t, y):
        return [y[1], -normal_force(y[0], y[1], v, pair) / m]

    scale = hertz_peak(m, 1e10, 1.5, v)[0]
    solver = DOP853(rates, 0.0, [0.0, v], 1.0, rtol=1e-12, atol=[1e-13 * scale, 1e-13 * v])
    peak = 0.0
    while True:
        solver.step()
        assert solver.status == "running"
        peak = max(peak, elastic(solver.y[0], pair))
        if solver.y[0] <= 0.0:
            break
    dense = solver.dense_output()
    end = brentq(lambda t: dense(t)[0], solver.t_old, solver.t, xtol=1e-18, rtol=1e-14)
    return -dense(end)[1] / v, end, peak


def implicit(chi, u):
    return u / chi - log1p(chi * u) / chi**2


@pytest.mark.parametrize("law, e, delivered", list(restitution_table()))
def test_delivered_restitution_against_table(law, e, delivered):
    assert delivered_restitution(damping_factor(law, e)) == pytest.approx(delivered, abs=1e-11)


@pytest.mark.parametrize("pair", [HERTZ_PAIR, CYLINDER_PAIR], ids=["hertz", "cylinder"])
@pytest.mark.parametrize("e", [0.9, 0.5, 0.2])
@pytest.mark.parametrize("law", LAWS)
def test_one_impact(law, e, pair):
    table = {(law, e): delivered for law, e, delivered in restitution_table()}
    chi = damping_factor(law, e)
    rebound = impact(pair, chi)[0]
    assert rebound == pytest.approx(table.get((law, e), e), abs=1e-4)
    assert rebound == pytest.approx(delivered_restitution(chi), abs=1e-9)


@given(st.floats(0.01, 1.0))
def test_identified_law_delivers_its_restitution(e):
    chi = damping_factor("identified", e)
    assert delivered_restitution(chi) == pytest.approx(e, abs=1e-12)
    assert 0.0 <= chi <= 1 / e


@pytest.mark.parametrize("e", [0.1, 0.3, 0.6, 0.9])
def test_identified_law_fulfils_the_implicit_relation(e):
    chi = damping_factor("identified", e)
    assert implicit(chi, 1.0) == pytest.approx(implicit(chi, -e), rel=1e-12)


def test_identified_law_at_its_limits():
    assert damping_factor("identified", 1.0) == 0.0
    # near 1 the relation gives 3/2 (1 - e) (1 + (1 - e)^2 ...); near 0 it saturates at 1 / e
    e = 1.0 - 1e-6
    assert damping_factor("identified", e) == pytest.approx(
        1.5 * (1 - e) / (1 - e + e * e), rel=1e-5
    )
    assert damping_factor("identified", 0.01) == pytest.approx(100.0 - 101e2 * exp(-101), rel=1e-14)
    assert (delivered_restitution(0.0), delivered_restitution(inf)) == (1.0, 0.0)


@pytest.mark.parametrize("law", ["flores", "identified"])
def test_infinite_damping_is_refused(law):
    with pytest.raises(ValueError, match=r"infinite damping.*Use a restitution of 0\.01 or more"):
        damping_factor(law, 0.0)


def test_wrong_words_and_numbers_are_refused():
    with pytest.raises(ValueError, match="Known: lankarani_nikravesh"):
        damping_factor("lankarani", 0.5)
    for c_r in (-0.1, 1.1, float("nan")):
        with pytest.raises(ValueError, match="must lie in"):
            damping_factor("flores", c_r)
    with pytest.raises(ValueError, match="0 or more"):
        delivered_restitution(-1.0)
    with pytest.raises(ValueError, match="Known: internal, paper"):
        hertz_stiffness(0.01, 0.009, *STEEL, form="external")
    with pytest.raises(ValueError, match="do not fit"):
        hertz_stiffness(0.009, 0.01, *STEEL)


def test_hertz_impact_against_closed_form():
    m, K, v = HERTZ_BALL["m"], HERTZ_BALL["K_steel_on_steel"], HERTZ_BALL["v0"]
    d, largest = hertz_peak(m, K, 1.5, v)
    assert d == pytest.approx(HERTZ_BALL["delta_max"], rel=1e-12)
    assert largest == pytest.approx(HERTZ_BALL["F_max"], rel=1e-12)
    time = hertz_contact_time(m, K, 1.5, v)
    assert time == pytest.approx(HERTZ_BALL["contact_time"], rel=1e-12)
    rebound, duration, peak = impact(Pair(K, 1.5, C, HERTZ), 0.0, m, v)
    assert (rebound, duration) == pytest.approx((1.0, time), rel=1e-9)
    assert 0.9 * largest < peak <= largest * (1 + 1e-9)


def test_linear_spring_contact_lasts_half_a_period():
    assert hertz_contact_time(2.0, 8.0, 1.0, 3.0) == pytest.approx(3.141592653589793 / 2.0)
    assert hertz_peak(2.0, 8.0, 1.0, 3.0) == pytest.approx((1.5, 12.0))


@pytest.mark.parametrize(
    "c, K_paper, K_internal",
    # independently computed for E 207 GPa, nu 0.29, bearing radius 10 mm
    [
        (1e-4, 1.0627279101106e10, 1.4991622046153e11),
        (3e-4, 1.0572648198462e10, 8.5675424939914e10),
        (5e-4, 1.0516604081493e10, 6.5676171438870e10),
    ],
)
def test_hertz_stiffness(c, K_paper, K_internal):
    assert hertz_stiffness(0.01, 0.01 - c, *STEEL, "paper") == pytest.approx(K_paper, rel=1e-12)
    assert hertz_stiffness(0.01, 0.01 - c, *STEEL) == pytest.approx(K_internal, rel=1e-12)


def test_sphere_on_plane_is_the_limit_of_a_large_socket():
    K = HERTZ_BALL["K_steel_on_steel"]
    E, nu, R = HERTZ_BALL["E"], HERTZ_BALL["nu"], HERTZ_BALL["R"]
    assert hertz_stiffness(1e9 * R, R, (E, nu), (E, nu)) == pytest.approx(K, rel=1e-8)


def test_cylinder_law_is_the_half_angle_formula():
    L, E_star, d = 15e-3, 207e9 / (2 * (1 - 0.29**2)), 2e-5
    F = 0.5 * 3.141592653589793 * L * E_star * d * (d / (2 * (C + d))) ** 0.5
    assert elastic(d, CYLINDER_PAIR) == pytest.approx(F, rel=1e-13)


@pytest.mark.parametrize("pair", [HERTZ_PAIR, Pair(1e8, 1.37, C, HERTZ), CYLINDER_PAIR])
@pytest.mark.parametrize("d", [1e-9, 1e-6, 2.99e-5, 3.01e-5, 1e-4, 1e-2])
def test_force_is_slope_of_energy(pair, d):
    h = 1e-4 * d
    slope = (stored(d + h, pair) - stored(d - h, pair)) / (2 * h)
    assert elastic(d, pair) == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize("z", [1e-8, 1e-3, 0.05, 0.0999, 0.1001, 0.3, 30.0])
def test_cylinder_energy_keeps_its_digits(z):
    K = CYLINDER_PAIR[0]
    # x = s^2 takes the root out of the integrand
    work = quad(lambda s: 2 * K * s**4 / (s * s + C) ** 0.5, 0.0, (z * C) ** 0.5, epsrel=1e-13)[0]
    assert stored(z * C, CYLINDER_PAIR) == pytest.approx(work, rel=2e-13)


@given(st.floats(-1e-3, 1e-3), st.floats(-10, 10), st.floats(0.01, 10), st.floats(0, 20))
def test_a_contact_never_pulls(d, d_dot, d_dot0, chi):
    for pair in (HERTZ_PAIR, CYLINDER_PAIR):
        force = normal_force(d, d_dot, d_dot0, pair._replace(chi=chi))
        assert force >= 0.0
        if d <= 0.0:
            assert (force, elastic(d, pair), stored(d, pair)) == (0, 0, 0)
        elif chi * d_dot > -d_dot0:
            assert force == pytest.approx(elastic(d, pair) * (1 + chi * d_dot / d_dot0))


def test_ramped_damping():
    k, c, ramp = 1e6, 400.0, 5e-5
    assert ramped_damping(-1e-9, 1.0, k, c, ramp) == 0.0
    assert ramped_damping(2.5e-5, 0.2, k, c, ramp) == pytest.approx(25.0 + 0.5 * 80.0)
    assert ramped_damping(1.25e-5, 0.2, k, c, ramp) == pytest.approx(12.5 + 0.15625 * 80.0)
    assert ramped_damping(1e-4, 0.2, k, c, ramp) == pytest.approx(100.0 + 80.0)
    assert ramped_damping(1e-4, -1.0, k, c, ramp) == 0.0
    assert ramped_damping(1e-12, 1.0, k, c, 0.0) == pytest.approx(400.0)


@given(st.floats(1e-4, 3.0), st.floats(-3.0, 3.0), st.floats(0.05, 30.0))
def test_branches_of_ramped_damping(x, v, ratio):
    """Inside its branch the law is the branch; how far it has been left changes its sign at the
    corners only, and the neighbour is where one then is."""
    k, ramp = 1e6, 5e-5
    c = ratio * k * ramp
    rest = (k, c, ramp)
    branch = ramped_branch_of(x * ramp, v, *rest)
    assert ramped_beyond(branch, x * ramp, v, *rest) <= 1e-12
    whole = ramped_damping(x * ramp, v, *rest)
    assert ramped_on_branch(branch, x * ramp, v, *rest) == pytest.approx(whole, rel=1e-12, abs=1e-9)
    for other in {0.0, 1.0, 2.0} - {branch}:
        assert ramped_beyond(other, x * ramp, v, *rest) >= -1e-12


@given(st.floats(-3.0, 3.0), st.floats(0.05, 30.0))
@example(-1.0, 1.0)  # it begins to pull where the ramp ends
def test_neighbours_of_branches_of_ramped_damping(v, ratio):
    k, ramp = 1e6, 5e-5
    rest = (v, k, ratio * k * ramp, ramp)
    x = np.linspace(1e-3, 3.0, 3001)
    branches = [ramped_branch_of(a * ramp, *rest) for a in x]
    for i in np.flatnonzero(np.diff(branches)):
        before, after = branches[i], branches[i + 1]
        assert ramped_neighbour(before, x[i + 1] * ramp, *rest) == after
        assert ramped_neighbour(after, x[i] * ramp, *rest) == before


class Fading(NamedTuple):
    """A pair of IMPACT: K d^n, and a damper that a STEP fades in."""

    stiffness: float
    exponent: float
    damping: float
    ramp: float
    clearance: float = C
    form: int = HERTZ


@pytest.mark.parametrize("name, args, wanted", COMMERCIAL)
def test_impact_and_bistop_of_commercial_programs(name, args, wanted):
    """Their x is a coordinate, and x1, x2 where it meets the stops; here d is how far beyond one it
    is, and d' > 0 on approach.  A BISTOP is two of them.  Near a stop x1 - x has no rounding; what
    is left is that of a power, and where the parts cancel that of 100 N."""
    x, rate, low, *rest = args
    high, *law = rest if name == "BISTOP" else (inf, *rest)
    pair = Fading(*(law[0], law[1], law[2], law[3]))
    force = impact_force(low - x, -rate, pair) - impact_force(x - high, rate, pair)
    assert force == pytest.approx(wanted, rel=1e-12, abs=1e-12)
