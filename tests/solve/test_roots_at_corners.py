"""Roots and broken powers of what is never negative: steps end at their corner, and look beyond."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ..runs import run

TEXT = """
bodies: {{b: {{mass: 1, inertia: 0.01, velocity: [1.1, 0]}}}}
joints: {{g: {{type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: g}}}}
forces:
  k: {{type: spring_damper, bodies: [ground, b], points: [[-9, 0], [0, 0]], stiffness: 10}}
  p: {{type: applied_load, body: b, direction: [1, 0], force: "{}"}}
solver: {{end: 3, method: {}}}
output: {{every: 0.25}}
"""

# the force, where it has its corner
LOADS = {
    "-20*max(x, 0)**1.5": (lambda x: -20 * max(x, 0.0) ** 1.5, 0.0),
    "-20*max(x - 0.1, 0)**1.5": (lambda x: -20 * max(x - 0.1, 0.0) ** 1.5, 0.1),
    "20*(2*max(-0.1 - x, 0))**0.5": (lambda x: 20 * (2 * max(-0.1 - x, 0.0)) ** 0.5, -0.1),
    "-20*x*sqrt(abs(x))": (lambda x: -20 * x * abs(x) ** 0.5, 0.0),
    "-5*(2*(x > 0) - 1)*abs(x)**0.5": (lambda x: -5 * np.sign(x) * abs(x) ** 0.5, 0.0),
}


def true(f, corner, t):
    """x at the times, with a step that ends at each pass of the corner."""
    y, begun, found = np.array([0.0, 1.1]), 0.0, np.zeros(len(t))
    while begun < t[-1]:
        passes = lambda _, y: y[0] - corner  # noqa: E731
        passes.terminal = 1 if abs(y[0] - corner) > 1e-12 else 2
        part = solve_ivp(lambda t, y: [y[1], f(t, y[0]) - 10 * y[0]], (begun, t[-1]), y,
                         events=passes, method="DOP853", rtol=1e-12, atol=1e-13,
                         dense_output=True)  # fmt: skip
        now = (t >= begun) & (t <= part.t[-1])
        found[now] = part.sol(t[now])[0]
        begun, y = part.t[-1], part.y[:, -1]
    return found


@pytest.mark.parametrize("method", ["auto", "radau"])
@pytest.mark.parametrize("load", LOADS)
def test_motion_through_the_corner(load, method):
    there, (f, corner) = run(TEXT.format(load, method)), LOADS[load]
    right = true(lambda _, x: f(x), corner, there.t)
    np.testing.assert_allclose(there["x"], right, rtol=0, atol=1e-6)


# with an exponent that varies: of t, of what is raised, between 0 and 1
VARYING = {
    "-30*max(x, 0)**(1 + 0.5*t)": lambda t, x: -30 * max(x, 0.0) ** (1 + 0.5 * t),
    "-30*max(x, 0)**(1 + x)": lambda t, x: -30 * max(x, 0.0) ** (1 + x),
    "-5*(2*(x > 0) - 1)*abs(x)**(1.5 + sin(t))": lambda t, x: (
        -5 * np.sign(x) * abs(x) ** (1.5 + np.sin(t))
    ),
    "-30*max(x, 0)**(0.6 + 0.2*sin(3*t))": lambda t, x: (
        -30 * max(x, 0.0) ** (0.6 + 0.2 * np.sin(3 * t))
    ),
}


@pytest.mark.parametrize("method", ["auto", "radau"])
@pytest.mark.parametrize("load", VARYING)
def test_an_exponent_that_varies(load, method):
    there, f = run(TEXT.format(load, method)), VARYING[load]
    np.testing.assert_allclose(there["x"], true(f, 0.0, there.t), rtol=0, atol=1e-6)


def test_rates_of_a_power_of_zero_are_finite():
    """As a motion of t needs them: x, x' and x'' of max(t - 1, 0)**(3 + t)."""
    text = """
bodies: {b: {mass: 1, inertia: 0.01}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
drives: {d: {joint: g, position: "max(t - 1, 0)**(3 + t)"}}
sensors: {x: {joint: g}}
solver: {end: 2}
output: {every: 0.25}
"""
    there = run(text)
    np.testing.assert_allclose(there["x"], np.maximum(there.t - 1, 0) ** (3 + there.t), atol=1e-9)
    assert there["b.acceleration"][-1, 0] == pytest.approx(22.0, rel=1e-6)  # (u^2 + u') x, u = x'/x


def test_what_may_be_negative_has_no_root():
    """Nothing is drawn on where a user takes the root of a negative number."""
    there = run(TEXT.format("-20*x**1.5", "auto"), fails=True)
    assert there.outcome.reason.startswith("forces.p")
    assert "at t = 0.7153" in there.outcome.reason
    assert "a power is taken of x, which becomes negative" in there.outcome.reason
