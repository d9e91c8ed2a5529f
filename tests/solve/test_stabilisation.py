"""Constraint drift: projection removes it, Baumgarte holds it, without either it grows."""

import numpy as np
import pytest

from trsim.assemble.reduce import jacobian

from ..linkages import four_bar
from ..runs import energy_error, run

FALLING = "gravity: [3, -9.81]"


def falling(stabilisation, more=""):
    text = four_bar("true", FALLING, end=3).replace("1e-10", "1e-7")
    return run(text.replace("solver: {", f"solver: {{stabilisation: {stabilisation}{more}, "))


def drift(r):
    """Largest constraint residual at the end, m."""
    return np.abs(jacobian(r.mechanism.model, 0.0, r.outcome.record.y)[0]).max()


def test_three_ways():
    projected = falling("projection")
    baumgarte = falling("baumgarte", ", baumgarte: {alpha: 20, beta: 20}")
    free = falling("none")
    assert drift(projected) < 1e-12
    assert drift(baumgarte) < 1e-6
    assert drift(free) > 30 * max(drift(baumgarte), drift(projected))
    exact = run(four_bar("true", FALLING, end=3).replace("1e-10", "1e-12"))
    for r in (projected, baumgarte):
        assert r["coupler.position"] == pytest.approx(exact["coupler.position"], abs=2e-4)
    assert energy_error(projected) < 1e-6
    for r in (baumgarte, free):  # what a run says of itself
        assert r.outcome.statistics["position_residual"] >= drift(r) > 0.0
        assert r.outcome.statistics["joints_open_relative"] > 0.0
