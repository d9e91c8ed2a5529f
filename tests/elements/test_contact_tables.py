"""Contacts whose elastic force is given by points: motions against another program's."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

from trsim.errors import ScenarioError
from trsim.solve.diagnose.doubts import doubts

from ..runs import built, run

SOFT = [(0.0, 0.0), (0.5e-3, 0.4), (1.0e-3, 2.0), (1.5e-3, 40.0), (2.5e-3, 300.0)]
BALL = """
bodies:
  ball: {{mass: 0.1, inertia: 1.6e-5, at: [0, 0.0205], velocity: [{v_x}, -{v}]}}
forces:
  floor: {{type: surface_contact, surface: {{body: ground, shape: plane}},
          ball: {{body: ball, at: [0, 0.0205], radius: 0.02}}}}
contact_laws: {{pad: {{stiffness: table, table: {table}, {law}}}}}
gravity: [0, {g}, 0]
solver: {{end: {end}, tolerance: 1e-9}}
"""


def ball(law, table=SOFT, v=1.5, v_x=0.0, g=0.0, end=0.02, **sets):
    rows = [list(row) for row in table]
    text = BALL.format(law=law, table=rows, v=v, v_x=v_x, g=g, end=end)
    return run(text, *(f"{key.replace('__', '.')}={value}" for key, value in sets.items()))


@pytest.mark.parametrize("method", ["auto", "radau"])
@pytest.mark.parametrize("v", [0.05, 0.4, 3.0])
def test_a_ball_on_a_table_moves_as_another_program_has_it(v, method):
    r = ball("normal: identified, restitution: 1", v=v, end=5e-4 / v + 0.01, solver__method=method)
    force, end = PchipInterpolator(*zip(*SOFT, strict=True)), SOFT[-1]
    slope = float(force.derivative()(end[0]))

    def pushed(_, y):
        d = 0.02 - y[0]
        F = 0.0 if d <= 0 else end[1] + slope * (d - end[0]) if d > end[0] else float(force(d))
        return [y[1], F / 0.1]

    at = r.t[-1]
    other = solve_ivp(pushed, (0.0, at), [0.0205, -v], rtol=1e-11, atol=1e-13, max_step=at / 3000)
    assert r["ball.position"][-1, 1] == pytest.approx(other.y[0, -1], abs=2e-8)
    assert r["ball.velocity"][-1, 1] == pytest.approx(other.y[1, -1], abs=1e-6 * v)
    assert r.outcome.statistics["energy_residual_relative"] < 1e-8


def test_two_rows_are_a_linear_spring():
    k, v = 2e4, 0.5
    r = ball("normal: identified, restitution: 1", [(0, 0), (1e-4, 1e-4 * k)], v=v, end=0.02)
    touch, part = r.events[0, 0], r.events[1, 0]
    assert touch == pytest.approx(5e-4 / v, rel=1e-9)
    assert part - touch == pytest.approx(pi * sqrt(0.1 / k), rel=1e-7)
    assert r.largest("floor.normal_force")[0] == pytest.approx(v * sqrt(0.1 * k), rel=1e-6)


@pytest.mark.parametrize("e", [0.3, 0.8])
def test_the_restitution_is_that_of_the_law_whatever_the_table(e):
    r = ball(f"normal: identified, restitution: {e}, slowest_impact: 1e-4", v=1.5)
    assert r["ball.velocity"][-1, 1] == pytest.approx(1.5 * e, rel=1e-5)
    assert r["energy.work.impacts"][-1] == pytest.approx(-0.05 * 1.5**2 * (1 - e * e), rel=1e-4)


def test_points_of_the_table_are_met_one_by_one():
    r = ball("normal: identified, restitution: 1", v=3.0)
    assert r.largest("floor.penetration")[0] > 2.5e-3
    assert r.outcome.statistics["corners"] == 2 * (len(SOFT) - 1)
    shallow = ball("normal: identified, restitution: 1", v=0.1, end=0.05)
    assert 0.5e-3 < shallow.largest("floor.penetration")[0] < 1e-3
    assert shallow.outcome.statistics["corners"] == 2


def test_points_of_the_table_and_corners_of_friction_together():
    """Friction that stops sliding in the middle of an impact, by hand from momentum."""
    law = ("normal: identified, restitution: 1, friction: "
           "{law: modified_coulomb, coefficient: 0.3, v0: 1e-4, v1: 1e-3}")  # fmt: skip
    hard = [(d / 50, 10 * F) for d, F in SOFT]
    r = ball(law, hard, v=1.5, v_x=0.5)
    I, p = 1.6e-5, 0.1 * 3.0
    stops = 0.5 / (1 / 0.1 + 0.02**2 / I)
    assert stops < 0.3 * p
    assert r["ball.velocity"][-1, 0] == pytest.approx(0.5 - stops / 0.1, abs=3e-3)
    assert r["ball.angular_velocity"][-1, 2] == pytest.approx(-stops * 0.02 / I, abs=0.1)
    assert r.outcome.statistics["energy_residual_relative"] < 1e-7
    assert r.outcome.statistics["corners"] >= 6


def test_the_damper_of_normal_impact_goes_with_a_table():
    r = ball("normal: impact, damping: 2, ramp: 1e-4", v=0.4, end=0.03)
    force = PchipInterpolator(*zip(*SOFT, strict=True))

    def pushed(_, y):
        d = 0.02 - y[0]
        if d <= 0:
            return [y[1], 0.0]
        x = min(d / 1e-4, 1.0)
        return [y[1], max(0.0, float(force(d)) - 2.0 * x * x * (3 - 2 * x) * y[1]) / 0.1]

    other = solve_ivp(pushed, (0.0, 0.03), [0.0205, -0.4], rtol=1e-11, atol=1e-13, max_step=1e-5)
    assert r["ball.velocity"][-1, 1] == pytest.approx(other.y[1, -1], abs=1e-6)


def test_what_rests_on_a_table_rests_where_it_carries():
    r = ball("normal: newton, restitution: 0.5, slowest_impact: 0.02", v=0.0, g=-9.81, end=1.0)
    force = PchipInterpolator(*zip(*SOFT, strict=True))
    depth = r["floor.penetration"][-1]
    assert float(force(depth)) == pytest.approx(0.981, rel=1e-4)
    assert np.all(np.diff(r["energy.work.impacts"]) <= 1e-12)


def test_a_contact_pressed_beyond_its_table_says_so():
    deep = ball("normal: identified, restitution: 1", v=3.0)
    assert deep.largest("floor.penetration")[0] > 2.5e-3
    said = doubts(deep.scenario, deep.mechanism, deep.outcome)
    assert any("beyond the last row of its table" in text for text in said)
    well = ball("normal: identified, restitution: 1", v=0.1)
    said = doubts(well.scenario, well.mechanism, well.outcome)
    assert not any("last row" in text for text in said)


@pytest.mark.parametrize("given, said", [
    ("stiffness: table", "needs table"),
    ("stiffness: 1e5, table: [[0, 0], [1 mm, 5 N]]", "another stiffness"),
    ("stiffness: table, table: [[0, 0], [1 mm, 5 N], [2 mm, 4 N]]", "row 3: the force"),
    ("stiffness: table, table: [[1 mm, 0], [2 mm, 4 N]]", "row 1"),
    ("stiffness: table, table: [[0, 0]]", "2 rows"),
    ("stiffness: table, table: [[0, 0], [1 N, 1 N]]", "m"),
])  # fmt: skip
def test_what_is_no_table_is_refused(given, said):
    text = BALL.format(law="", table="", v=0, v_x=0, g=0, end=1)
    text = text.replace(
        "stiffness: table, table: , ", f"normal: identified, restitution: 1, {given}"
    )
    with pytest.raises(ScenarioError) as caught:
        built(text)
    assert said in caught.value.show()
