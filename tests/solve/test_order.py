"""Every integrator converges at the order it claims, on a pendulum with an exact solution."""

import importlib

import numpy as np
import pytest

from ..mechanisms import torsion_pendulum
from ..runs import run

END = 0.4  # s: 8 rad of a swing
STEPS = {"rk4": (64, 91, 128, 181, 256), "dop853": (7, 8, 10, 12, 14)}
SPREAD = {"rk4": 0.15, "dop853": 0.3}


def error_at_end(method, count):
    """|angle - exact| after `count` equal steps, rad."""
    h = END / count
    fixed = f"step: {h}" if method == "rk4" else f"first_step: {h}, max_step: {h}, tolerance: 0.1"
    text, angle = torsion_pendulum(solver=f"method: {method}, end: {END}, {fixed}")
    r = run(text, f"output.every={END}")  # a step spans no more outputs than a block holds
    assert r.outcome.statistics["steps"] == count
    return abs(r["angle"][-1] - angle(END))


@pytest.mark.parametrize("method", STEPS)
def test_order(method):
    claimed = importlib.import_module(f"trsim.solve.{method}").ORDER
    errors = [error_at_end(method, count) for count in STEPS[method]]
    observed = -np.polyfit(np.log(STEPS[method]), np.log(errors), 1)[0]
    assert observed == pytest.approx(claimed, abs=SPREAD[method]), f"errors {errors}"


def test_error_falls_with_the_tolerance():
    def error(tolerance):
        text, angle = torsion_pendulum(solver=f"end: {END}, tolerance: {tolerance}")
        r = run(text)
        return np.abs(r["angle"] - angle(r.t)).max()

    tolerances = np.array([1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12])
    errors = [error(tolerance) for tolerance in tolerances]
    slope = np.polyfit(np.log(tolerances), np.log(errors), 1)[0]
    assert 0.6 < slope < 1.2, errors
    assert errors[-1] < 1e-11


@pytest.mark.parametrize("method", ["scipy:RK45", "scipy:Radau", "scipy:BDF"])
def test_independent_methods_agree(method):
    text, angle = torsion_pendulum(solver=f"method: '{method}', end: 0.2, tolerance: 1e-7")
    r = run(text)
    assert r["angle"] == pytest.approx(angle(r.t), abs=1e-5)
