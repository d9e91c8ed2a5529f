"""Integrals of functions of a sensor, against their antiderivatives."""

import math

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator

from trsim.expressions import parse
from trsim.laws.functions import expression, table
from trsim.laws.quadrature import integral


@pytest.mark.parametrize(
    "text, exact",
    [
        ("300*x + 50*x**3", lambda x: 150 * x**2 + 12.5 * x**4),
        ("100*max(x - 0.3, 0)", lambda x: 50 * max(x - 0.3, 0) ** 2),
        ("5*(x > 0.25)", lambda x: 5 * max(x - 0.25, 0)),
        ("exp(x)*cos(9*x)", lambda x: np.real(np.exp((1 + 9j) * x) / (1 + 9j))),
        ("abs(x)*x", lambda x: abs(x) ** 3 / 3),
        ("7", lambda x: 7 * x),
        ("sin(100*x)", lambda x: -math.cos(100 * x) / 100),
    ],
)
@pytest.mark.parametrize("end", [1.7, 0.3014, -0.9, 0.0, 12.0])
def test_against_the_antiderivative(text, exact, end):
    tab, S = np.array(expression(parse(text), {"x": 1})), np.array([[0.0, 0.0], [7.0, 3.0]])
    expected = exact(end) - exact(0.0)
    size = max(abs(expected), abs(exact(end)), 1e-3)
    assert integral(tab, 0, S, 1, 0.0, end) == pytest.approx(expected, abs=2e-11 * size)
    assert S.tolist() == [[0.0, 0.0], [7.0, 3.0]]


def test_a_table_inside_and_beyond_its_ends():
    x, y = [-1.0, 0.0, 0.5, 2.0, 3.0], [-4.0, 1.0, 0.0, 2.0, 7.0]
    f = Akima1DInterpolator(x, y)
    F, slope = f.antiderivative(), f.derivative()
    S = np.zeros((1, 2))
    for ends, bent in (("hold", 0.0), ("extrapolate", 1.0)):
        tab = np.array([0.0, *table(x, y, 0, ends)])
        for a, b in ((-1, 3), (0.2, 1.7), (2.5, -0.3)):
            assert integral(tab, 1, S, 0, a, b) == pytest.approx(F(b) - F(a), rel=1e-13)
        above = F(3) - F(0) + 2 * 7 + bent * 2 * slope(3)
        assert integral(tab, 1, S, 0, 0.0, 5.0) == pytest.approx(above, rel=1e-13)
        below = F(-1) - F(0) + 2 * 4 + bent * 2 * slope(-1)
        assert integral(tab, 1, S, 0, 0.0, -3.0) == pytest.approx(below, rel=1e-13)
    tab = np.array(table(x, y, 0, "refuse"))
    assert math.isnan(integral(tab, 0, S, 0, 0.0, 3.1))
