"""Every integrator converges at the order it claims, also through located events."""

import numpy as np
import pytest

from trsim.scenario.methods import METHODS

from ..mechanisms import central_impact, torsion_pendulum
from ..runs import run

END = 0.4  # s: 8 rad of a swing
STEPS = {
    "rk4": (64, 91, 128, 181, 256),
    "dop853": (7, 8, 10, 12, 14),
    "radau": (32, 45, 64, 91, 128),
    "generalized_alpha": (128, 181, 256, 362, 512),
}
# loose enough to accept every step of the given length (steps are held to half of it), tight
# enough for Newton's method
TOLERANCE = {"dop853": 0.1, "radau": 2e-3, "generalized_alpha": 0.1}
SPREAD = {"rk4": 0.15, "dop853": 0.3, "radau": 0.15, "generalized_alpha": 0.15}


def equal_steps(method, h):
    """The solver's words for steps of one length."""
    if method == "rk4":
        return f"method: rk4, step: {h}, locate_events: true"
    return f"method: {method}, first_step: {h}, max_step: {h}, tolerance: {TOLERANCE[method]}"


def order(counts, errors):
    return -np.polyfit(np.log(counts), np.log(errors), 1)[0]


def error_at_end(method, count):
    """|angle - exact| after `count` equal steps, rad."""
    text, angle = torsion_pendulum(solver=f"end: {END}, {equal_steps(method, END / count)}")
    r = run(text, f"output.every={END}")  # a step spans no more outputs than a block holds
    assert r.outcome.statistics["steps"] == count
    return abs(r["angle"][-1] - angle(END))


@pytest.mark.parametrize("method", STEPS)
def test_order(method):
    claimed = METHODS[method].order
    errors = [error_at_end(method, count) for count in STEPS[method]]
    observed = order(STEPS[method], errors)
    assert observed == pytest.approx(claimed, abs=SPREAD[method]), f"errors {errors}"


GAP, SPEED, K, MASS = 0.0113, 1.7, 4e5, 1.3  # m, m/s, N/m, kg
REBOUND = f"""
planar: true
bodies: {{block: {{mass: {MASS}, inertia: 1, velocity: [{SPEED}, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, block], axis: [1, 0, 0]}}}}
forces:
  spring: {{type: spring_damper, bodies: [ground, block], points: [[-1, 0], [0, 0]],
           stiffness: 5000, free_length: 1}}
  wall: {{type: limit_stop, joint: slide, upper: {GAP}, stiffness: {K}}}
"""


def rebound(t):
    """Place of the block after one touch of the wall: three arcs of harmonic motion."""
    k = 5000.0
    w = np.sqrt(k / MASS)
    touch = np.arcsin(GAP * w / SPEED) / w
    v = SPEED * np.cos(w * touch)
    # in touch: m x'' = -k x - K (x - GAP)
    W = np.sqrt((k + K) / MASS)
    rest = K * GAP / (k + K)
    a, b = GAP - rest, v / W
    turn = 2 * np.arctan2(b, a)  # a cos + b sin is back at its start
    apart = touch + turn / W
    return GAP * np.cos(w * (t - apart)) - v / w * np.sin(w * (t - apart))


LAST = 0.04  # s


def error_after_rebound(method, count):
    r = run(REBOUND + f"solver: {{end: {LAST}, {equal_steps(method, LAST / count)}}}",
            f"output.every={LAST}")  # fmt: skip
    assert len(r.events) == 2
    return abs(r["block.position"][-1, 0] - rebound(LAST))


@pytest.mark.parametrize("method", STEPS)
def test_order_is_kept_through_located_events(method):
    counts = {"rk4": (96, 136, 192, 272, 384), "dop853": (16, 19, 23, 27, 32, 38),
              "radau": (64, 91, 128, 181, 256),
              "generalized_alpha": (192, 272, 384, 543, 768)}[method]  # fmt: skip
    claimed = METHODS[method].order
    errors = [error_after_rebound(method, count) for count in counts]
    observed = order(counts, errors)
    print(f"{method}: order {observed:.2f} through a touch and a separation")
    # the steps that events cut are shorter: the order seen may be better than claimed
    assert observed > claimed - SPREAD[method], f"errors {errors}"


def test_hertz_contact_limits_fixed_steps():
    """Force grows like t^1.5 from the touch: no fixed step does better than order 2.5."""
    counts = np.array([300, 424, 600, 848, 1200, 1697, 2400])
    exact = run(central_impact(), "solver.tolerance=1e-12", "output.every=6e-3")
    errors = [
        abs(run(central_impact(), "solver.method=rk4", f"solver.step={6e-3 / count}",
                "solver.locate_events=true", "output.every=6e-3")["slider.velocity"][-1, 0]
            - exact["slider.velocity"][-1, 0])
        for count in counts
    ]  # fmt: skip
    observed = order(counts, errors)
    print(f"rk4 through a Hertz contact with located events: order {observed:.2f}")
    assert 2.0 < observed < 3.2, errors


@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_error_falls_with_the_tolerance(method):
    def error(tolerance):
        text, angle = torsion_pendulum(
            solver=f"method: {method}, end: {END}, tolerance: {tolerance}"
        )
        r = run(text)
        return np.abs(r["angle"] - angle(r.t)).max()

    tolerances = np.array([1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11])
    errors = [error(tolerance) for tolerance in tolerances]
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert 0.8 < slope < 1.35, errors
    assert errors[-1] < 1e-10


@pytest.mark.parametrize("method", ["scipy:RK45", "scipy:Radau", "scipy:BDF"])
def test_independent_methods_agree(method):
    text, angle = torsion_pendulum(solver=f"method: '{method}', end: 0.2, tolerance: 1e-7")
    r = run(text)
    assert r["angle"] == pytest.approx(angle(r.t), abs=1e-5)


def test_a_fall_needs_few_steps_of_order_two():
    """Its first difference is that of the speed, and no error."""
    r = run("""
bodies: {ball: {mass: 1, inertia: 0.01, velocity: [3, 4]}}
gravity: [0, -9.81]
solver: {method: generalized_alpha, end: 0.3, tolerance: 1e-6}
""")
    assert r.outcome.statistics["steps"] < 30
    np.testing.assert_allclose(r["ball.position"][:, 1], 4 * r.t - 4.905 * r.t**2, atol=1e-12)


def test_what_bends_slowly_errs_by_no_more_than_is_asked():
    """m v' = -c v over half of its time: v = exp(-c t / m)."""
    r = run("""
bodies: {block: {mass: 1, inertia: 0.01, velocity: [3, 0]}}
joints: {slide: {type: prismatic, bodies: [ground, block], axis: [1, 0]}}
forces: {oil: {type: joint_spring, joint: slide, damper: rate}}
solver: {method: generalized_alpha, end: 0.5, tolerance: 1e-5}
""")
    length = r.outcome.record.length
    error = r["block.position"][:, 0] - 3 * (1 - np.exp(-r.t))
    assert np.abs(error).max() < 1e-5 * length
