"""The load along a seal, against adaptive quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad

from trsim.laws.seal import NODES, PIECES, cuts, least_speed, line_load, node, pressed_part


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


def rubbed(at, q, v_0, d, full):
    """The friction of a line of load q(u) that slides by v_0 + u d, by the pieces of these cuts."""
    places = [node(at, piece, k) for piece in range(PIECES) for k in range(len(NODES))]
    v = np.array([v_0 + u * d for u, _ in places])
    speed = np.maximum(np.linalg.norm(v, axis=1), 1e-300)
    weights = [weight * q(u) * min(1.0, s / full) / s
               for (u, weight), s in zip(places, speed, strict=True)]  # fmt: skip
    return np.array(weights) @ v


@pytest.mark.parametrize("where", [-0.4, 0.0, 0.3, 0.9, 1.0, 1.7, 300.0, -1e6])
def test_friction_of_a_line_that_pivots(where):
    """Sliding is slowest at any place of it, or beside it, and there nearly or quite at rest."""
    rng = np.random.default_rng(7)
    for _ in range(30):
        part = tuple(np.sort(rng.uniform(0, 1, 2))) if rng.random() < 0.5 else (0.0, 1.0)
        d = rng.normal(size=3) * 10.0 ** rng.uniform(-3, 2)
        turn = np.linalg.norm(d)
        across = np.cross(d, rng.normal(size=3))
        least = turn * 10.0 ** rng.uniform(-6, 1) * (rng.random() < 0.8)
        v_0 = -where * d + least * across / np.linalg.norm(across)
        full = turn * 10.0 ** rng.uniform(-3, 1)
        n = rng.uniform(1, 3)

        def q(u, n=n):
            return (0.3 + u) ** n

        half = np.sqrt(max(full**2 - least**2, 0.0)) / turn
        places = [where + x for x in (-half, 0.0, half, -least / turn, least / turn)]
        places = [x for x in places if part[0] < x < part[1]]

        def of(u, c, v_0=v_0, d=d, full=full):
            v = v_0 + u * d
            return q(u) * v[c] / max(np.linalg.norm(v), full)

        want = [quad(of, *part, args=(c,), points=places or None, limit=400)[0] for c in range(3)]
        found = rubbed(cuts(part, tuple(v_0), tuple(d), full), q, v_0, d, full)
        assert found == pytest.approx(want, abs=1e-6 * quad(q, *part)[0])


def test_the_slowest_place():
    v_0, d = np.array([1.0, 0.5, 0.0]), np.array([-2.0, 0.0, 0.0])
    for part in ((0.0, 1.0), (0.0, 0.2), (0.8, 1.0)):
        u = np.linspace(*part, 100_001)
        least = np.linalg.norm(v_0 + u[:, None] * d, axis=1).min()
        assert least_speed(part, tuple(v_0), tuple(d)) == pytest.approx(least, rel=1e-9)
    assert least_speed((0.3, 0.7), (3.0, 4.0, 0.0), (0.0, 0.0, 0.0)) == 5.0
