"""The values of a grid between which something changes: `refine`.

Every so manieth value of each axis is run first, and the last one.  They cut the grid into cells.
Neighbours differ where their runs ended in different ways (status), where one alone has a number,
or where

    |x - y| > width        of a share:  width = share * max(|x|, |y|)

Neighbours are cases of one cell, its edges included, with no case between them along an axis, and
the same values of the others.  A cell is halved along each axis along which two of it differ: a
slope is followed along itself.  Where no value lies between two that differ, there is a step, and
the cell is halved along all axes, to follow the step across them.  Its edges belong to a cell since
a finer one beside it may have shown there what its own corners did not.  What begins and ends
between two neighbours that are alike is not found.  Of a key without `every` each value has cells
of its own.
"""

from collections.abc import Iterator
from itertools import pairwise, product

import numpy as np

from trsim.arrays import Array
from trsim.errors import listed
from trsim.scenario.adaptive import Refine, Width
from trsim.sweeps.choosing import Choosing, Part, Results, how_many

Cell = tuple[tuple[int, int], ...]  # first and last place on every axis


def refined(part: Part, results: Results) -> Choosing:
    """The corners of coarse cells, and then of the halves of those that are not alike."""
    rule = part.sweep.refine
    assert rule is not None  # noqa: S101 - adaptive.rule
    own = [axis for axis in part.sweep.axes if not axis.same_as]
    shape = tuple(len(axis.values) for axis in own)
    every = dict(rule.every)
    cells: list[Cell] = list(product(*(coarse(len(a.values), every.get(a.key, 0)) for a in own)))
    seen, order = Seen(shape, rule), np.arange(len(part.cases)).reshape(shape)
    while True:
        wanted = sorted({int(order[at]) for cell in cells for at in product(*cell)}
                        - {*order[seen.known].tolist()})  # fmt: skip
        if wanted:
            yield wanted
            for word, width in rule.by:
                results.check(tuple(part.cases[k] for k in wanted), word, width)
            for k in wanted:
                numbers = [results.number(part.cases[k], word) for word, _ in rule.by]
                seen.learn(
                    tuple(map(int, np.unravel_index(k, shape))),
                    results.status(part.cases[k]),
                    numbers,
                )
        halved = [half for cell in cells for half in halves(cell, seen.differing(cell))]
        if len(halved) == len(cells):
            return _told(part, rule, int(seen.known.sum()))
        cells = halved


def coarse(n: int, every: int) -> list[tuple[int, int]]:
    """The sides of cells on an axis of n values; each value by itself where `every` is 0."""
    if not every:
        return [(k, k) for k in range(n)]
    ends = sorted({*range(0, n, every), n - 1})
    return list(pairwise(ends))


def halves(cell: Cell, along: list[int]) -> Iterator[Cell]:
    """A cell halved along axes; along all of them where there is nothing between on one of these.

    A cell that is alike, `along` no axis, is left as it is.
    """
    steps = any(cell[k][1] - cell[k][0] == 1 for k in along)
    sides = [
        [(a, (a + b) // 2), ((a + b) // 2, b)] if b - a > 1 and (steps or k in along) else [(a, b)]
        for k, (a, b) in enumerate(cell)
    ]
    return product(*sides)


class Seen:
    """What is known of the cases of a grid, by their places on the axes."""

    def __init__(self, shape: tuple[int, ...], rule: Refine) -> None:
        self.widths = [width for _, width in rule.by]
        self.known = np.zeros(shape, bool)
        self.ends, self.words = np.zeros(shape, int), dict[str, int]()
        self.numbers = np.full((*shape, len(rule.by)), np.nan)

    def learn(self, at: tuple[int, ...], status: str, numbers: list[float]) -> None:
        self.known[at] = True
        self.ends[at] = self.words.setdefault(status, len(self.words))
        self.numbers[at] = numbers

    def differing(self, cell: Cell) -> list[int]:
        """The axes along which two neighbours of a cell differ."""
        block = tuple(slice(a, b + 1) for a, b in cell)
        known = self.known[block]
        at = np.argwhere(known)  # (cases, axes)
        ends, numbers = self.ends[block][known], self.numbers[block][known]
        found = []
        for k in range(len(cell)):
            others = np.delete(at, k, axis=1)
            order = np.lexsort((at[:, k], *others.T))
            row = (others[order[1:]] == others[order[:-1]]).all(axis=1)
            i, j = order[1:][row], order[:-1][row]
            if (ends[i] != ends[j]).any() or self._apart(numbers[i], numbers[j]):
                found.append(k)
        return found

    def _apart(self, x: Array, y: Array) -> bool:
        """Whether numbers (pairs, words) differ by more than their widths."""
        return any(apart(x[:, k], y[:, k], width) for k, width in enumerate(self.widths))


def apart(x: Array, y: Array, width: Width) -> bool:
    """Whether any two numbers of pairs differ; nan is a number that there is not."""
    one = np.isnan(x) != np.isnan(y)
    largest = np.maximum(np.abs(x), np.abs(y))
    wide = [width.of(size) for size in largest.tolist()]
    return bool((one | (np.abs(x - y) > wide)).any())


def _told(part: Part, rule: Refine, n: int) -> str:
    what = ["status", *(f"{word} by more than {width.text}" for word, width in rule.by)]
    text = f"neighbours that differ in {listed(what)} are next to each other on the axes"
    return f"{how_many(n, len(part.cases))}: {text}"
