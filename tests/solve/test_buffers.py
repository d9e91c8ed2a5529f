"""Room for results: many contacts, many rows in a step, many events in a block, a step limit."""

import numpy as np
import pytest

from trsim.errors import ScenarioError

from ..runs import run

BOUNCING = """
planar: true
gravity: [0, -9.81]
bodies: {{ball: {{mass: 1, inertia: 1, at: [0, 0.01]}}}}
forces: {{{stops}}}
solver: {{{solver}}}
output: {{every: {every}, channels: [ball.position]}}
"""
STOP = """s{n}: {{type: limit_stop, point: {{body: ball, at: [0, 0.01]}}, stiffness: 1e5,
  wall: {{body: ground, at: [0, -{n}], normal: [0, 1]}}}}"""


def bouncing(stops=1, solver="end: 1", every=0.1):
    text = ", ".join(STOP.format(n=n) for n in range(stops))
    return BOUNCING.format(stops=text, solver=solver, every=every)


def test_many_contacts():
    r = run(bouncing(stops=260, solver="end: 0.06"))
    assert r.outcome.status == "done" and len(r.events) > 0


@pytest.mark.parametrize("method, end, most", [("dop853", 30, 512), ("scipy:RK45", 15, 256)])
def test_many_events_between_two_rows(method, end, most):
    r = run(bouncing(solver=f"end: {end}, method: '{method}', tolerance: 1e-4", every=10))
    assert len(r.events) > most  # than the buffer holds, once or twice
    assert np.all(np.diff(r.events[:, 0]) >= 0.0)


def test_many_rows_in_a_fixed_step():
    r = run("""
planar: true
bodies: {mass: {mass: 1, inertia: 1, at: [1, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, mass], axis: [1, 0]}}
forces: {spring: {type: spring_damper, bodies: [ground, mass], points: [[0, 0], [1, 0]],
  stiffness: 1, preload: 0.1}}
solver: {method: rk4, step: 0.05, end: 0.5}
output: {every: 1e-5}
""")
    assert len(r.t) == 50001
    assert r["mass.position"][:, 0] == pytest.approx(0.9 + 0.1 * np.cos(r.t), abs=1e-6)


def test_too_many_rows_in_a_fixed_step_are_refused():
    with pytest.raises(ScenarioError, match="spans more than"):
        run(bouncing(solver="end: 1, method: rk4, step: 0.1", every=1e-6))


@pytest.mark.parametrize("method", ["dop853", "scipy:BDF"])
def test_step_limit_is_exact(method):
    r = run(bouncing(solver=f"end: 1, method: '{method}', max_steps: 3"), fails=True)
    assert "3 steps" in r.outcome.reason
    assert r.outcome.statistics["steps"] == 3


@pytest.mark.parametrize("force, gained", [
    ("1000*(step5(t, 0.5, 0, 0.501, 1) - step5(t, 0.502, 0, 0.503, 1))", 1.0),
    ("1000*((t > 0.5)*(t < 0.502))", 1.0),
])  # fmt: skip
def test_a_pulse_after_a_quiet_time_is_not_stepped_over(force, gained):
    r = run(f"""
planar: true
bodies: {{mass: {{mass: 2, inertia: 1}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, mass], axis: [1, 0]}}}}
forces: {{push: {{type: applied_load, body: mass, direction: [1, 0], force: "{force}"}}}}
solver: {{end: 1}}
""")
    assert r["mass.velocity"][-1, 0] == pytest.approx(gained, rel=1e-5)


def test_a_table_whose_curve_leaves_its_data_is_refused():
    with pytest.raises(ScenarioError, match="reaches -62500 between rows 1 and 2"):
        run("""
planar: true
bodies: {mass: {mass: 2, inertia: 1}}
joints: {slide: {type: prismatic, bodies: [ground, mass], axis: [1, 0]}}
forces: {push: {type: applied_load, body: mass, direction: [1, 0],
  force: {table: [[0, 0], [0.5, 0], [0.501, 1000], [0.502, 1000], [0.503, 0], [1, 0]]}}}
solver: {end: 1}
""")
