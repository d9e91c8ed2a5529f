"""Extremes of channels between the places of a static path.

A polynomial through the places around tells how far a channel may go between two neighbours; the
term it may do without tells how sure that is.  Where it promises more than the extreme so far, the
balance is solved for at the place where it promises most, and the polynomial goes through that too,
until it promises nothing more.  What is kept is always a value of a place in balance.

Two neighbours are looked at when the next place is known, or at the end of a smooth piece, which
alone has polynomials.  What a place was held on (contacts, pieces of functions) is held still then,
and friction is against the way that was taken from the same place as before.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import isnan

import numpy as np
from numpy.typing import NDArray

from trsim.solve.path.extremes import LOOKS, promised
from trsim.solve.path.place import Place
from trsim.solve.path.results import Results

Array = NDArray[np.float64]

POINTS = 7  # places a polynomial goes through, at most
FEWEST = 4  # of a piece: fewer say too little, and more are solved for
TRIES = 10  # places solved for between two neighbours
SMALL = 0.01  # of what may be missed of the largest channel of its kind: less is no extreme
ROUNDING = 1e-13  # of the largest of its kind: differences of places in balance


@dataclass
class Known:
    """A place with its channels, and the works on the way there; whether friction turns round
    there, so that its forces are those of the way to it."""

    place: Place
    values: Array
    works: Array
    turned: bool


class Between:
    """The last places of a smooth piece, and what may lie between two of them."""

    def __init__(self, results: Results, missed: float) -> None:
        self.results, self.missed = results, missed
        w = results.w
        told = ~(results.rates | results.energies)[w.sought]
        self.sought, self.kin, self.lever = w.sought[told], w.kin[told], w.lever[told]
        self.least = np.asarray(w.least)[told]
        self.largest = np.zeros(int(w.kin.max(initial=-1)) + 1)
        self.room = np.zeros((4, max(LOOKS + 1, POINTS + TRIES)))
        self.known: list[Known] = []
        self.solve: Callable[[Place, Place, float], Place | None] = lambda a, b, t: None

    def add(self, place: Place) -> None:
        """Take the next place of the piece, which is the one that was kept last."""
        kept = self.results
        one = Known(place, self.wanted(), kept.works.copy(), kept.turned)
        if self.known and place.t <= self.known[-1].place.t:  # the same, behind a change
            self.known[-1] = one
            return
        self.known.append(one)
        if len(self.known) > FEWEST - 1:
            self.look(len(self.known) - 3)
        del self.known[:-POINTS]

    def end(self) -> None:
        """The piece ends at the last place."""
        many = len(self.known)
        first = 0 if many < FEWEST else many - 2
        for k in range(first, many - 1):
            self.look(k)
        self.known = []

    def wanted(self) -> Array:
        """What is looked at, of the channels taken last; the sizes of those of one kind follow."""
        found = self.results.full[self.sought]
        np.maximum.at(self.largest, self.kin, np.abs(found) * self.lever)
        return np.asarray(found)

    def look(self, k: int) -> None:
        """Look between the k-th known place and the next."""
        if k == 1 and len(self.known) == FEWEST:  # of a piece, whose first ones were too few before
            self.search(0)
        self.search(k)

    def search(self, k: int) -> None:
        """Solve for places between two neighbours as long as an extreme is promised there."""
        inside: list[Known] = []
        first, last = self.known[k], self.known[k + 1]
        a, b = first.place.t, last.place.t
        for _ in range(TRIES):
            if len(self.known) + len(inside) < FEWEST:
                t = a + (b - a) * (len(inside) + 1.0) / (FEWEST - len(self.known) + 1.0)
            else:
                at = self.promised(k, inside)
                if at is None:
                    return
                t = at
            place = self.solve(first.place, last.place, t)
            if place is None:
                return
            inside.append(self.seen(first, place))

    def seen(self, first: Known, place: Place) -> Known:
        """A place between, as channels are there, taken into the extremes."""
        kept, after = self.results, self.results.works
        forces = place if first.turned else None
        kept.works = first.works + kept.works_between(first.place, place, forces)
        out = kept.relative(kept.out(place, np.zeros_like(place.v)))
        kept.take(place.t, out, False, False)
        one = Known(place, self.wanted(), kept.works, False)
        kept.works = after
        return one

    def promised(self, k: int, inside: list[Known]) -> float | None:
        """Where between two neighbours a channel may go furthest beyond its extremes; None where
        all stay within what may be missed."""
        nodes = [self.known[k], self.known[k + 1], *inside]
        middle = 0.5 * (nodes[0].place.t + nodes[1].place.t)
        others = [one for i, one in enumerate(self.known) if i not in (k, k + 1)]
        others.sort(key=lambda one: abs(one.place.t - middle))
        nodes = (nodes + others)[: max(POINTS, len(nodes))]
        times = np.array([one.place.t for one in nodes])
        high, low = self.results.peak[0, self.sought], self.results.peak[2, self.sought]
        of_kind = self.largest[self.kin] / self.lever
        enough = self.missed * np.maximum(high - low, SMALL * of_kind) + ROUNDING * of_kind + 1e-300
        limits = np.array([high, low, enough, self.least])
        values = np.array([one.values for one in nodes])
        at = promised(times, values, limits, self.room, float(len(inside)))
        return None if isnan(at) else at
