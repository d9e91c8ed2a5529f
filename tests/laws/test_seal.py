"""The load along a seal, against adaptive quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad

from trsim.laws.seal import line_load, pressed_part


@pytest.mark.parametrize("n", [1.0, 1.2, 2.5])
def test_against_quadrature(n):
    rng = np.random.default_rng(4)
    ends = [*rng.uniform(-1, 2, (40, 2)), (1.0, 1.0), (1.0, 1.2), (1.0, 0.8001), (1e-9, 2), (0, 1)]
    for x_0, x_1 in ends:
        low, high = pressed_part(x_0, x_1)

        def q(u, at=(x_0, x_1)):
            return max(at[0] + u * (at[1] - at[0]), 0.0) ** n

        want = [
            quad(f, low, high, epsabs=1e-14, limit=200)[0]
            for f in (
                q,
                lambda u: u * q(u),
                lambda u, at=(x_0, x_1): q(u) * (at[0] + u * (at[1] - at[0])) / (n + 1),
            )
        ]
        assert line_load(x_0, x_1, n) == pytest.approx(want, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("x_0, x_1, part", [
    (-1, -2, (0, 0)), (0, 0, (0, 0)), (1, 2, (0, 1)), (1, -1, (0, 0.5)), (-1, 3, (0.25, 1)),
    (0, 1, (0, 1)),
])  # fmt: skip
def test_which_part_is_pressed(x_0, x_1, part):
    assert pressed_part(float(x_0), float(x_1)) == pytest.approx(part)


def test_turned_round_it_is_the_same():
    Q_0, Q_1, E = line_load(-0.3, 1.0, 1.2)
    R_0, R_1, F = line_load(1.0, -0.3, 1.2)
    assert pytest.approx((Q_0, Q_0 - Q_1, E)) == (R_0, R_1, F)
