"""Polynomials through a few values: what is found of their top, against many places of them."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from trsim.elements.contract import compiled
from trsim.kernels.packed import A1, f8, i8
from trsim.kernels.signatures import void
from trsim.solve.march import polynomials
from trsim.solve.march import record as rec
from trsim.solve.march.record import PARTS, POINTS

from ..runs import built
from ..small import SLIDER_CRANK


@compiled(void(rec.BUFFERS, i8, f8, A1))
def found(b, n, wanted, out):
    """The top between the first two nodes: place and value; what it reaches, above and below."""
    polynomials.lay(b, n)
    polynomials.invert(b, n)
    polynomials.differences(b, n)
    end, start = b.node[0, 0], b.node[0, 1]
    out[0], out[1] = polynomials.top(b, n, start, end, wanted)
    out[2], out[3] = polynomials.reach(b, n)


@compiled(void(f8, f8, f8, A1))
def lacking(last, second, third, out):
    out[0] = polynomials.lacking(last, second, third)


@compiled(void(rec.BUFFERS, i8, A1))
def steady(b, n, out):
    """Whether it goes one way between the first two nodes."""
    out[0] = 1.0 if polynomials.one_way(b, n) else 0.0


class Drawn:
    """A polynomial by its values at n nodes, the first two at the ends of 0.3 .. 0.7."""

    def __init__(self, seed, n):
        rng = np.random.default_rng(seed)
        self.n, self.b = n, rec.fresh_buffers(built(SLIDER_CRANK).model, 1, 1, 1)
        more = np.concatenate((rng.uniform(-0.5, 0.2, POINTS), rng.uniform(0.8, 1.5, POINTS)))
        self.times = np.array([0.7, 0.3, *rng.permutation(more)[: n - 2]])
        self.p = Polynomial(rng.normal(size=n))
        self.b.node[0, :n], self.b.node[1, :n] = self.times, self.p(self.times)
        self.b.doubt = 0.0
        self.lattice = self.p(0.3 + 0.4 * np.arange(PARTS + 1) / PARTS)
        self.many = self.p(np.linspace(0.3, 0.7, 20_001))
        self.bend = np.abs(np.diff(self.lattice, 2)).max()

    def top(self, wanted=-1e300):
        """Place and value of the top, what is reached above and below."""
        out = np.empty(4)
        found(self.b, self.n, wanted, out)
        return out


CASES = [(seed, n) for n in range(3, POINTS + 1) for seed in range(8)]


@pytest.mark.parametrize("at", [0.3 + 1e-5, 0.3 + 3e-4, 0.7 - 1e-5, 0.7 - 3e-4])
def test_a_vertex_next_to_an_end(at):
    """Nearer to it than the last of the places where the top is looked for."""
    one = Drawn(0, 3)
    one.b.node[1, :3] = 2.0 - (one.times - at) ** 2
    place, best = one.top()[:2]
    assert place == pytest.approx(at, abs=1e-9) and best == pytest.approx(2.0, abs=1e-15)


@pytest.mark.parametrize("seed, n", CASES)
def test_top_is_the_largest_value(seed, n):
    one = Drawn(seed, n)
    place, best = one.top()[:2]
    extent = np.ptp(one.many)
    assert best == pytest.approx(one.many.max(), abs=1e-6 * extent + 1e-12)
    assert one.p(place) == pytest.approx(best, abs=1e-9)
    assert 0.3 <= place <= 0.7


@pytest.mark.parametrize("seed, n", CASES)
def test_what_plainly_is_not_large_enough_is_not_looked_for(seed, n):
    one = Drawn(seed, n)
    bound, least = one.lattice.max() + 0.25 * one.bend, 1e-6 * np.ptp(one.many)
    _, rough = one.top(bound + least)[:2]
    assert rough == pytest.approx(one.lattice.max(), abs=1e-12)
    _, best = one.top(bound - least)[:2]
    assert best == one.top()[1]


@pytest.mark.parametrize("seed, n", CASES)
def test_reach_is_the_bound_it_says(seed, n):
    one = Drawn(seed, n)
    above, below = one.top()[2:]
    assert above == pytest.approx(one.lattice.max() + 0.25 * one.bend, abs=1e-11)
    assert below == pytest.approx(one.lattice.min() - 0.25 * one.bend, abs=1e-11)
    assert above >= one.many.max() and below <= one.many.min()


@pytest.mark.parametrize("seed, n", CASES)
def test_doubt_is_on_top(seed, n):
    """What stands for the last divided difference adds to the top, as its product says."""
    one = Drawn(seed, n)
    doubted = Drawn(seed, n)
    doubted.b.doubt = 0.5
    x = np.linspace(0.3, 0.7, 20_001)
    product = np.prod([x - t for t in one.times[: n - 1]], axis=0)
    many = one.many + 0.5 * np.abs(product)
    assert doubted.top()[1] == pytest.approx(many.max(), abs=1e-6 * np.ptp(many) + 1e-12)
    assert doubted.top()[2] >= many.max()
    assert doubted.top()[3] <= (one.many - 0.5 * np.abs(product)).min()


@pytest.mark.parametrize("seed, n", CASES)
def test_one_way_is_proved(seed, n):
    one, out = Drawn(seed, n), np.empty(1)
    one.top()
    steady(one.b, n, out)
    rising = np.diff(one.many)
    if out[0]:
        assert np.all(rising > 0.0) or np.all(rising < 0.0)
    # a straight line with a little of it always does
    one.b.node[1, :n] = 5.0 * one.times + 1e-3 * one.p(one.times)
    one.top()
    steady(one.b, n, out)
    assert out[0] == 1.0


def test_what_a_series_lacks():
    out = np.empty(1)
    for last, second, third, lacks in (
        (1.0, 2.0, 4.0, 2.0),  # falls by 1/2: the rest is as much as the last
        (0.0, 2.0, 4.0, 2.0),  # small by chance: it counts as what is expected
        (2.0, 2.0, 2.0, 20.0),  # falls no faster than SLOWEST
        (1.0, 4.0, 0.0, 4.0 / 3.0),
        (0.0, 0.0, 0.0, 0.0),
    ):
        lacking(last, second, third, out)
        assert out[0] == pytest.approx(lacks, rel=1e-12), (last, second, third)
