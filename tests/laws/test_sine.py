"""Sine and cosine beside sixty decimal digits of each."""

from decimal import Decimal, getcontext
from math import cos, inf, isnan, nan, pi, sin, ulp

import numpy as np
import pytest

from trsim.laws.sine import FARTHEST, sine_cosine

PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459230781640628620900")


def exact(x):
    """sin x and cos x of the double x."""
    getcontext().prec = 70
    angle = Decimal(x) % (2 * PI)
    sums = [Decimal(0), Decimal(0)]
    term, k = Decimal(1), 0
    while abs(term) > Decimal("1e-60") or k < abs(angle):
        sums[k % 2] += term if k % 4 < 2 else -term
        k += 1
        term *= angle / k
    return sums[1], sums[0]


def angles():
    rng = np.random.default_rng(0)
    yield from rng.uniform(-8.0, 8.0, 400)
    yield from rng.choice([-1, 1], 400) * 10.0 ** rng.uniform(-9, 6, 400)
    for k in (1, 2, 3, 4, 5, 7, 16, 355, 710, 1001, 103993, 636619):  # doubles next to zeros
        for side in (-1, 0, 1):
            x = k * pi / 2
            yield x + side * ulp(x)


def test_within_a_unit_of_the_last_place():
    worst = 0.0
    for x in angles():
        for found, true in zip(sine_cosine(x), exact(x), strict=True):
            worst = max(worst, float(abs(Decimal(found) - true) / Decimal(ulp(float(true)))))
    print(f"worst {worst:.3f} ulp")
    assert worst < 1.0


def test_odd_and_even_and_exact_at_zero():
    assert sine_cosine(0.0) == (0.0, 1.0)
    for x in (1e-300, 0.3, 1.0, 2.5, 1e5):
        s, c = sine_cosine(x)
        assert sine_cosine(-x) == (-s, c)


@pytest.mark.parametrize("x", [FARTHEST, -3.7e6, 1e15, 1e300])
def test_far_away_it_is_that_of_the_library(x):
    assert sine_cosine(x) == (sin(x), cos(x))


def test_what_is_no_number_stays_none():
    for x in (nan, inf, -inf):
        assert all(isnan(v) for v in sine_cosine(x))
