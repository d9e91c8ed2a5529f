"""Nodes of polynomials through samples of channels, and through places looked at between them."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from trsim.solve.march import record as rec
from trsim.solve.march.peaks import guessed
from trsim.solve.march.polynomials import polynomial
from trsim.solve.march.samples import NOT_LAID, bounds, nodes, push, through

from ..pieces import nothing, piece

TIMES = np.array([0.0, 0.09, 0.2, 0.33, 0.4, 0.52, 0.6])


class Sampled:
    """Samples of one channel that is a polynomial of time, and places between two of them."""

    def __init__(self, p, found=()):
        n = rec.POINTS
        self.p = p
        self.r = SimpleNamespace(
            sampled=np.zeros(n), sample=np.zeros((n, 1)), slope=np.zeros((n, 1)),
            newest=0, n_samples=0, peak=np.zeros((4, 1)),
        )  # fmt: skip
        self.b = SimpleNamespace(
            node=np.zeros((5, n)), lattice=np.zeros((n, 1 + rec.PARTS)), along=np.zeros(9),
            inverse=np.zeros((n, n)), bound=np.zeros((2, 1)), found=np.zeros(rec.FOUND),
            inside=np.zeros((rec.FOUND, 1)), n_found=0, laid=NOT_LAID, doubt=0.0, full=None,
        )  # fmt: skip
        gather = piece(push, gather=self.gather, square=nothing)
        for t in TIMES:
            gather(None, self.r, self.b, t, p(t))
        for k, t in enumerate(found):
            self.b.found[k], self.b.inside[k, 0] = t, p(t)
        self.b.n_found = len(found)

    @staticmethod
    def gather(s, full, values, sample):
        sample[0] = values


@pytest.mark.parametrize("found", [(), (0.45,), (0.45, 0.42, 0.5)])
def test_nodes_are_both_ends_the_places_between_and_the_samples_around(found):
    """Each once, the nearest samples first; the newest is one of those around older neighbours."""
    one = Sampled(Polynomial([1.0]), found)
    n = piece(nodes)(one.r, one.b, 1)
    assert n == rec.POINTS
    around = [0.6, 0.33, 0.2, 0.09][: n - 2 - len(found)]
    assert one.b.node[0, :n] == pytest.approx([0.52, 0.4, *found, *around])


@pytest.mark.parametrize("many", [1, rec.POINTS - 2, rec.POINTS - 1, rec.POINTS, 20])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_polynomial_of_low_degree_is_met_through_any_number_of_places(many, sign):
    """More than it can go through are the ones around the best."""
    p = Polynomial([0.2, -1.0, 3.0, 2.0])
    one = Sampled(p, 0.4 + 0.12 * (1 + np.random.default_rng(0).permutation(many)) / (many + 1))
    piece(bounds)(one.r, one.b, 1)
    n = piece(through)(one.r, one.b, 1, 0, sign)
    assert n == rec.POINTS and len(set(one.b.node[0])) == n
    for t in np.linspace(0.4, 0.52, 7):
        assert piece(polynomial)(one.b.node, n, t, 0.0) == pytest.approx(sign * p(t), abs=1e-9)


def test_what_plainly_goes_one_way_is_not_looked_at():
    """A slope, though it is beyond the extremes that are known so far; a bow is."""
    for p, looked_at in ((Polynomial([0.0, 5.0, 0.1]), False), (Polynomial([0, 0, 50.0]), True)):
        centred = Polynomial([-0.46, 1.0])
        one = Sampled(p(centred), (0.46,))
        piece(bounds)(one.r, one.b, 1)
        s = SimpleNamespace(sought=np.array([0]))
        one.r.peak[rec.PEAK_MAX], one.r.peak[rec.PEAK_MIN] = 1e300, 1e-3
        assert piece(guessed)(s, one.r, one.b, 1, 0) == (False, looked_at)
