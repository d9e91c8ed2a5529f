"""The load along a seal, against adaptive quadrature."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from trsim.laws.seal import (
    NODES,
    PIECES,
    cuts,
    least_speed,
    line_load,
    node,
    panels,
    pressed_part,
)


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


def integrals(at, f):
    """Of a function of u and of u times it, by the pieces of these cuts."""
    every = [
        node(at, piece, panel, k)
        for piece in range(PIECES)
        for panel in range(panels(at, piece))
        for k in range(len(NODES))
    ]
    values = np.array([weight * f(u) for u, weight in every])
    return np.concatenate([values.sum(axis=0), np.array([u for u, _ in every]) @ values])


@pytest.mark.parametrize("where", [-0.4, 0.0, 0.3, 0.9, 1.0, 1.7, 300.0, -1e6])
@pytest.mark.parametrize("grows", ["all along", "from one end", "from the other"])
def test_friction_of_a_line_that_pivots(where, grows):
    """Sliding is slowest at any place of it, or beside it, and there nearly or quite at rest; the
    load is a power of a compression that may fall to nothing at one end."""
    rng = np.random.default_rng(7)
    for trial in range(25):
        part = tuple(np.sort(rng.uniform(0, 1, 2))) if rng.random() < 0.5 else (0.0, 1.0)
        d = rng.normal(size=3) * 10.0 ** rng.uniform(-3, 2)
        turn = np.linalg.norm(d)
        across = np.cross(d, rng.normal(size=3))
        least = turn * 10.0 ** rng.uniform(-7, 1) * (rng.random() < 0.8)
        v_0 = -where * d + least * across / np.linalg.norm(across)
        full = turn * 10.0 ** rng.uniform(-6, 1) * (trial % 5 > 0)
        n, clip = rng.uniform(1, 3), rng.uniform(-0.5, 1.5)

        def q(u, n=n, part=part):
            x = {"all along": 0.3 + u, "from one end": u - part[0],
                 "from the other": part[1] - u}[grows]  # fmt: skip
            return max(x, 0.0) ** n

        half = np.sqrt(max(full**2 - least**2, 0.0)) / turn
        places = [where + x for x in (-half, 0.0, half, clip - where)]
        places += [where + s * 10.0**-k for k in range(9) for s in (-1, 1)]
        places = sorted({*part, *(x for x in places if part[0] < x < part[1])})

        def of(u, v_0=v_0, d=d, full=full, clip=clip, q=q):
            v = v_0 + u * d
            by = v / max(np.linalg.norm(v), full, 1e-300)
            return q(u) * np.array([*by, max(u - clip, -0.2)])

        ends = (grows == "from one end", grows == "from the other")
        found = integrals(cuts(part, (tuple(v_0), tuple(d)), full, clip - 0.2, ends), of)
        want = np.zeros(8)
        for a, b in pairwise(places):
            if a < clip - 0.2 < b:
                want += gauss(of, a, clip - 0.2) + gauss(of, clip - 0.2, b)
            else:
                want += gauss(of, a, b)
        size = quad(q, *part)[0]
        assert found == pytest.approx(want, abs=2e-6 * size), (trial, part, where, least, full)


def gauss(f, a, b):
    """Integrals of a function of u and of u times it; also next to ends where powers begin."""
    x, w = np.polynomial.legendre.leggauss(40)
    s = 0.5 * (x + 1.0)
    u, weight = a + (b - a) * s**2 * (3 - 2 * s), 0.5 * w * (b - a) * 6.0 * s * (1 - s)
    values = np.array([f(one) for one in u])
    return np.concatenate([weight @ values, (weight * u) @ values])


def test_the_slowest_place():
    v_0, d = np.array([1.0, 0.5, 0.0]), np.array([-2.0, 0.0, 0.0])
    for part in ((0.0, 1.0), (0.0, 0.2), (0.8, 1.0)):
        u = np.linspace(*part, 100_001)
        least = np.linalg.norm(v_0 + u[:, None] * d, axis=1).min()
        assert least_speed(part, tuple(v_0), tuple(d)) == pytest.approx(least, rel=1e-9)
    assert least_speed((0.3, 0.7), (3.0, 4.0, 0.0), (0.0, 0.0, 0.0)) == 5.0
