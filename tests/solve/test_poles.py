"""Functions that have no value somewhere: a run ends there, and no motion is told behind it."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trsim.solve.methods import scipy_ivp

from ..runs import run

METHODS = ("auto", "radau", "rk4, step: 2e-3", "scipy:RK45", "generalized_alpha, tolerance: 1e-6")

# one metre per second to the right: a load so small that x = t to 1e-5
TEXT = """
bodies: {{b: {{mass: 1, inertia: 0.01, velocity: [1, 0]}}}}
joints: {{g: {{type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}}}
sensors: {{x: {{joint: g}}}}
forces: {{p: {{type: applied_load, body: b, direction: [1, 0], force: "{0}"}}}}
gravity: [0, 0, 0]
solver: {{end: 2, method: {1}}}
output: {{every: 0.1}}
"""
# load -> when it has no value, what is said of it
ENDS = {
    "1e-3/(t - 0.5003)": (0.5003, "divides by t - 0.5003"),
    "1e-9/(x - 1.0007)": (1.0007, "divides by x - 1.0007"),
    "1e-12/(x - 1.0007)**2": (1.0007, "divides by (x - 1.0007)**2"),
    "1e-12*(x - 1.0007)**-2": (1.0007, "a power of x - 1.0007"),
    "1e-9/(sin(3*x) - 0.5)": (np.pi / 18, "divides by sin(3*x) - 0.5"),
    "1e-6*tan(3*t)": (np.pi / 6, "tan(3*t)"),
    "1e-9*tan(3*x)": (np.pi / 6, "tan(3*x)"),
    "1e-6*log((t - 1.0003)**2 - 1e-8)": (1.0002, "log is taken of (t - 1.0003)**2 - 1e-08"),
    "1e-6*sqrt((x - 1.0003)**2 - 1e-8)": (1.0002, "sqrt is taken of (x - 1.0003)**2 - 1e-08"),
    "1e-6*asin(1.0000001*sin(3*x))": (np.arcsin(1 / 1.0000001) / 3, "beyond -1 or 1"),
    "1e-6*(1.5001 - x)**0.5": (1.5001, "a power is taken of 1.5001 - x"),
    "1e-9*x/(x - 1.0007)*(t > 0.3)": (1.0007, "divides by x - 1.0007"),
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("load", ENDS)
def test_a_run_ends_where_a_load_has_no_value(load, method, monkeypatch):
    monkeypatch.setattr(scipy_ivp, "SLOWLY", 500)  # steps before a pole that move nothing
    when, said = ENDS[load]
    there = run(TEXT.format(load, method), fails=True)
    reason = there.outcome.reason
    assert reason.startswith("forces.p.force") and said in reason
    assert float(reason.split("t = ")[1].split()[0]) == pytest.approx(when, abs=3e-6)
    assert there.t[-1] <= when


GOES_ON = (
    "1e-2/(0.1 + abs(x - 1))",
    "1e-2*(x - 1)/sqrt((x - 1)*(x - 1) + 1e-6)",
    "1e-2*atan2(x - 1, t - 1)",
    "1e-2*log(1 + t*t)",
    "1e-2*sqrt(t)",
    "1e-2*sqrt(x + 1e-3)",
    "1e-2*asin(sin(3*x))",
    "1e-2*sqrt(1 - sin(3*x)**2)",
    "1e-2*sin(x - 1.0007)/(x - 1.0007)",
    "1e-2*sin(t - 0.5003)/(t - 0.5003)",
    "1e-2*(t**2 - 1.0007**2)/(t - 1.0007)",
    "1e-3/(0.01 + (x - 1)**2)",
    "1e-2*exp(-1e-3/(t - 1.0007)**2)",
    "1e-2*atan2(1, x - 1.0007)",
    "1e-2/(1 + 1/(x - 1.0007)**2)",
    "1e-2*tan(0.7*x)",
    "1e-2*max(2 - x, 0)**0.5",
    "1e-2*log(2.5 - x)",
)


@cache
def true_end(load):
    """Where it is at the end, by scipy."""
    words = {w: getattr(np, w) for w in ("sqrt", "log", "sin", "tan", "exp", "abs")}
    words |= {"atan2": np.arctan2, "asin": np.arcsin, "max": max}
    force = eval(f"lambda t, x: {load}", words)  # noqa: S307
    rates = lambda t, y: [y[1], force(t, max(y[0], 0.0))]  # noqa: E731
    true = solve_ivp(rates, (0, 2), [0, 1], rtol=1e-10, atol=1e-12, max_step=1e-2)
    return true.y[0, -1]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("load", GOES_ON)
def test_what_is_bounded_goes_on(load, method):
    there = run(TEXT.format(load, method))
    assert there["x"][-1] == pytest.approx(true_end(load), abs=1e-5)


def test_a_motion_that_has_no_value():
    text = """
bodies: {b: {mass: 1, inertia: 0.01}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
drives: {d: {joint: g, position: "1e-6/(t - 0.50013) + 1e-6/0.50013"}}
solver: {end: 1, method: rk4, step: 1e-3}
"""
    reason = run(text, fails=True).outcome.reason
    assert reason.startswith("drives.d.position") and "t = 0.50013 s it divides by" in reason


@pytest.mark.parametrize("end", [0.4, 1.0])
def test_the_time_of_a_motion_that_an_event_sets(end):
    """It counts from the event on: a pole 0.5 s after t = 0.3 s is met at 0.8 s, or not at all."""
    text = f"""
bodies: {{b: {{mass: 1, inertia: 0.01}}}}
joints: {{g: {{type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}}}
drives: {{d: {{joint: g, velocity: 0.1}}}}
events:
  go: {{when: t, value: 0.3, do: {{set: {{d: {{velocity: "0.1 + 1e-9/(t - 0.5)"}}}}}}}}
  stop: {{when: t, value: {end}, do: {{end: true}}}}
solver: {{end: 2, method: rk4, step: 1e-3}}
"""
    if end < 0.8:
        assert run(text).outcome.time == pytest.approx(0.4)
        return
    reason = run(text, fails=True).outcome.reason
    assert "divides by t - 0.5" in reason


def test_a_spring_whose_force_has_a_pole():
    text = """
bodies: {b: {mass: 1, inertia: 0.01, at: [1, 0], velocity: [1, 0]}}
joints: {g: {type: prismatic, bodies: [ground, b], axis: [1, 0, 0]}}
forces:
  s: {type: spring, bodies: [ground, b], points: [[0, 0], [1, 0]],
      elastic: "1e-9/(stretch - 0.5003)"}
gravity: [0, 0, 0]
solver: {end: 1, method: rk4, step: 1e-3}
"""
    reason = run(text, fails=True).outcome.reason
    assert reason.startswith("forces.s") and "0.5003" in reason
