"""Ranges of operations hold whatever lies inside them, values and rates."""

import math

import numpy as np
import pytest

from trsim.kernels import plain
from trsim.laws import operations as op
from trsim.laws.ranges import ALL, ROUNDING, ranged, widened

TWO = {
    op.ADD: (lambda a, b: a + b, lambda a, b: (1.0, 1.0)),
    op.SUB: (lambda a, b: a - b, lambda a, b: (1.0, -1.0)),
    op.MUL: (lambda a, b: a * b, lambda a, b: (b, a)),
    op.DIV: (lambda a, b: a / b, lambda a, b: (1 / b, -a / b**2)),
    op.POW: (lambda a, b: a**b, lambda a, b: (b * a ** (b - 1), a**b * math.log(a))),
    op.MIN: (min, lambda a, b: (1.0, 0.0) if a < b else (0.0, 1.0)),
    op.MAX: (max, lambda a, b: (1.0, 0.0) if a > b else (0.0, 1.0)),
    op.ATAN2: (math.atan2, lambda a, b: (b / (a * a + b * b), -a / (a * a + b * b))),
    op.LT: (lambda a, b: float(a < b), None),
    op.GE: (lambda a, b: float(a >= b), None),
}
ONE = {
    op.NEG: (lambda a: -a, lambda a: -1.0),
    op.ABS: (abs, lambda a: math.copysign(1.0, a)),
    op.SQRT: (math.sqrt, lambda a: 0.5 / math.sqrt(a)),
    op.SIN: (math.sin, math.cos),
    op.COS: (math.cos, lambda a: -math.sin(a)),
    op.TAN: (math.tan, lambda a: 1 + math.tan(a) ** 2),
    op.EXP: (math.exp, math.exp),
    op.LOG: (math.log, lambda a: 1 / a),
    op.SMOOTHSTEP: (
        lambda a: np.clip(a, 0, 1) ** 2 * (3 - 2 * np.clip(a, 0, 1)),
        lambda a: 6 * np.clip(a, 0, 1) * (1 - np.clip(a, 0, 1)),
    ),
    op.QUINTIC: (
        lambda a: np.clip(a, 0, 1) ** 3 * (10 + np.clip(a, 0, 1) * (6 * np.clip(a, 0, 1) - 15)),
        lambda a: 30 * (np.clip(a, 0, 1) * (1 - np.clip(a, 0, 1))) ** 2,
    ),
    op.ASIN: (math.asin, lambda a: 1 / math.sqrt(1 - a * a)),
    op.ACOS: (math.acos, lambda a: -1 / math.sqrt(1 - a * a)),
    op.FLOOR: (lambda a: float(math.floor(a)), None),
    op.SIGN: (lambda a: float(np.sign(a)), None),
}
POSITIVE, ARC = (op.SQRT, op.LOG), (op.ASIN, op.ACOS)
INTO = plain.plain(ranged.python)
WIDTHS = (0.0, 0.01, 0.3, 2.0)


def interval(rng, width, low=-3.0, high=3.0):
    a = rng.uniform(low, high)
    return a, min(a + width * rng.uniform(), high)


def within(rng, x, n=30):
    return np.concatenate([x, rng.uniform(*x, size=n)])


def holds(x, value):
    return x[0] - 1e-12 * (1 + abs(value)) <= value <= x[1] + 1e-12 * (1 + abs(value))


@pytest.mark.parametrize("code", ONE)
@pytest.mark.parametrize("width", WIDTHS)
def test_of_one_number(code, width):
    rng, (f, f_a) = np.random.default_rng(code), ONE[code]
    low, high = (0.01, 3.0) if code in POSITIVE else (-0.99, 0.99) if code in ARC else (-3.0, 3.0)
    for _ in range(60):
        x, rate = interval(rng, width, low, high), interval(rng, width)
        value, of_rate = INTO(code, (x, rate), ((0.0, 0.0), (0.0, 0.0)), op.FREE)
        for a in within(rng, x):
            assert holds(value, f(a))
            for a_rate in rate if f_a else ():
                assert holds(of_rate, f_a(a) * a_rate)


@pytest.mark.parametrize("code", TWO)
@pytest.mark.parametrize("width", WIDTHS)
def test_of_two_numbers(code, width):
    rng, (f, f_ab) = np.random.default_rng(code), TWO[code]
    for _ in range(60):
        low = 0.05 if code == op.POW else -3.0
        x, y = interval(rng, width, low), interval(rng, width)
        x_rate, y_rate = interval(rng, width), interval(rng, width)
        value, rate = INTO(code, (x, x_rate), (y, y_rate), op.FREE)
        for a, b in zip(within(rng, x), within(rng, y), strict=True):
            if code == op.ATAN2 and a == 0.0:
                continue
            assert holds(value, f(a, b))
            of_a, of_b = f_ab(a, b) if f_ab else (0.0, 0.0)
            for a_rate, b_rate in zip(x_rate, y_rate, strict=True) if f_ab else ():
                assert holds(rate, of_a * a_rate + of_b * b_rate)


@pytest.mark.parametrize("code", ARC)
@pytest.mark.parametrize("x", [(0.5, 1.1), (-1.0001, 0.0), (-2.0, 2.0), (1.5, 1.6)])
def test_an_arc_that_may_have_no_value_has_no_range(code, x):
    value, rate = INTO(code, (x, (1.0, 1.0)), ((0.0, 0.0), (0.0, 0.0)), op.FREE)
    assert value == rate == (-math.inf, math.inf)


@pytest.mark.parametrize("code, x", [(op.FLOOR, (0.9, 1.1)), (op.SIGN, (-0.1, 0.1)),
                                     (op.FLOOR, (-0.1, 0.0)), (op.SIGN, (0.0, 0.1))])  # fmt: skip
def test_what_jumps_has_any_rate_where_it_may(code, x):
    _, rate = INTO(code, (x, (1.0, 1.0)), ((0.0, 0.0), (0.0, 0.0)), op.FREE)
    assert rate == (-math.inf, math.inf)


@pytest.mark.parametrize("code, x, held", [(op.FLOOR, (0.9, 1.1), 1.0), (op.FLOOR, (-2, 2), -1.0),
                                           (op.SIGN, (-0.1, 0.1), op.ABOVE),
                                           (op.FLOOR, (1.2, 1.9), op.FREE),
                                           (op.SIGN, (-2, -1), op.FREE)])  # fmt: skip
def test_held_or_beside_its_jumps_it_stays(code, x, held):
    value, rate = INTO(code, (x, (1.0, 1.0)), ((0.0, 0.0), (0.0, 0.0)), held)
    assert value[0] == value[1] and rate == (0.0, 0.0)


@pytest.mark.parametrize("low, high", [(-3.0, -1.0), (-1.0, 3.0), (1.0, 3.0), (-1e9, -1e9)])
def test_an_interval_is_widened_on_both_sides(low, high):
    for wide, end, way in zip(widened.python(low, high), (low, high), (-1, 1), strict=True):
        assert way * (wide - end) == pytest.approx(ROUNDING * abs(end), rel=0.2)


def test_what_is_no_interval_has_no_bounds():
    none = widened.python(1.0, -1.0), widened.python(math.nan, 1.0)
    assert none == (ALL, ALL) == ((-math.inf, math.inf),) * 2
