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
        part = solve_ivp(lambda _, y: [y[1], f(y[0]) - 10 * y[0]], (begun, t[-1]), y, events=passes,
                         method="DOP853", rtol=1e-12, atol=1e-13, dense_output=True)  # fmt: skip
        now = (t >= begun) & (t <= part.t[-1])
        found[now] = part.sol(t[now])[0]
        begun, y = part.t[-1], part.y[:, -1]
    return found


@pytest.mark.parametrize("method", ["auto", "radau"])
@pytest.mark.parametrize("load", LOADS)
def test_motion_through_the_corner(load, method):
    there = run(TEXT.format(load, method))
    np.testing.assert_allclose(there["x"], true(*LOADS[load], there.t), rtol=0, atol=1e-6)


def test_what_may_be_negative_has_no_root():
    """Nothing is drawn on where a user takes the root of a negative number."""
    there = run(TEXT.format("-20*x**1.5", "auto"), fails=True)
    assert "not finite" in there.outcome.reason
