"""The sparsity of S = J M^-1 J^T and the program of its factorisation L D L^T, made once.

Two rows of J meet in S where they share a moving body: a frame, or the nodes of a beam.  A
minimum-degree order keeps the fill small [George1989]: for an open chain the cost of factorising
grows linearly with its length.  The numeric part (equations.py, linear.py) only walks the index
lists made here, each from its beginning to its end.

All rows of one body meet each other, and those of a body with many are as dense as S can be: for n
chains on one body the cost would grow with n^3.  Such a hub h is taken out of S = S_0 + B M_h^-1
B^T, with B the rows on it, and what multipliers do to it, u = M_h^-1 B^T lam, becomes an unknown

    [ S_0   B   ] [ lam ]   [ b ]
    [ B^T  -M_h ] [ u   ] = [ 0 ]

whose rows the chains share instead of all of theirs.  Where S_0 is positive definite such a matrix
is quasi-definite: it has factors L D L^T in every order, and D has the signs of its diagonal
[Vanderbei1995].  Rows that depend on others while the hubs are held (those on hubs only, to begin
with) are eliminated after all hubs, when S_0 has become S.  hubs.py says which bodies are hubs.
"""

from collections.abc import Sequence
from functools import lru_cache
from heapq import heapify, heappop, heappush
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]
Rows = Sequence[tuple[int, ...]]  # frames that each row names, each once
KEPT = 8  # of the last mechanisms: the start of a run assembles the same rows several times


class Hubs(NamedTuple):
    """Bodies whose motion is an unknown of the solve, of d numbers each."""

    d: int = 0
    frames: tuple[int, ...] = ()
    late: frozenset[int] = frozenset()  # rows that depend on others while these bodies are held


class Structure(NamedTuple):
    """The unknowns of the solve, rows and then hubs, in the order of elimination."""

    bodies: list[list[tuple[int, int]]]  # slots of each body; a beam is one
    order: list[int]
    below: list[list[int]]  # for each step the unknowns below the pivot, in elimination order

    def operations(self, hubs: Hubs) -> int:
        """Multiplications of filling the matrix, factorising and solving, roughly."""
        under = sum(len(b) * (len(b) + 5) // 2 for b in self.below)
        pairs = sum(
            len(b) if f in hubs.frames else len(b) * (len(b) + 1) // 2
            for f, b in enumerate(self.bodies)
        )
        return under + 3 * pairs


def slots(row_frames: Rows, n: int) -> list[list[tuple[int, int]]]:
    """For each of n frames its slots: (row, line of J) of the rows that name it."""
    found: list[list[tuple[int, int]]] = [[] for _ in range(n)]
    line = 0
    for k, frames in enumerate(row_frames):
        for f in frames:
            if f > 0:
                found[f].append((k, line))
            line += 1
    return found


def lines(row_frames: Rows) -> dict[str, Indices]:
    """The lines of J: of each row one for every frame it names."""
    number = [len(frames) for frames in row_frames]
    return {
        "row_start": np.cumsum([0, *number]),
        "line_row": np.repeat(np.arange(len(number)), number),
        "line_frame": np.array([f for frames in row_frames for f in frames], np.int64),
    }


def minimum_degree(
    neighbours: list[set[int]],
    wide: frozenset[int] = frozenset(),
    width: int = 1,
    late: frozenset[int] = frozenset(),
) -> list[int]:
    """An elimination order: always the row with the fewest neighbours left, fill included.

    Among these the one whose neighbours were eliminated longest ago: its pivot waits for no other,
    so a chain is taken from both ends in turn, and the processor works on both at once.
    wide: nodes that count as `width` rows; late: nodes that come after all others.
    """
    graph = [set(n) for n in neighbours]

    def degree(k: int) -> tuple[bool, int]:
        return k in late, len(graph[k]) + (width - 1) * len(wide & graph[k])

    waiting = [(*degree(k), 0, k) for k in range(len(graph))]
    valid = list(waiting)
    heapify(waiting)
    order: list[int] = []
    while waiting:
        found = heappop(waiting)
        k = found[3]
        if found != valid[k]:
            continue
        order.append(k)
        for a in graph[k]:
            graph[a] |= graph[k]
            graph[a] -= {a, k}
            valid[a] = (*degree(a), len(order), a)
            heappush(waiting, valid[a])
        graph[k] = set()
    return order


def eliminate(neighbours: list[set[int]], order: list[int]) -> list[list[int]]:
    """For each step the rows below the pivot, in elimination order."""
    graph = [set(n) for n in neighbours]
    rank = {row: k for k, row in enumerate(order)}
    below = []
    for k in order:
        rows = sorted(graph[k], key=rank.__getitem__)
        below.append(rows)
        for a in rows:
            graph[a] |= graph[k]
            graph[a] -= {a, k}
    return below


def triangle(members: Indices, ranks: list[Indices], column_start: Indices) -> Indices:
    """Places of the entries of S between rows, told by their ranks; (n, n), symmetric.

    An entry stands in the column of that one of its rows which is eliminated first.
    """
    found = np.zeros((len(members), len(members)), np.int64)
    for k, b in enumerate(members.tolist()):
        after = members >= b
        places = column_start[b] + np.searchsorted(ranks[b], members[after])
        found[after, k] = found[k, after] = places
    return found


def structure(
    row_frames: Rows,
    n: int,
    beams: list[tuple[int, int]] | None = None,
    hubs: Hubs = Hubs(),  # noqa: B008 - nothing in it can change
) -> Structure:
    """Which unknowns meet, and in which order they are eliminated."""
    return _structure(tuple(row_frames), n, tuple(beams or ()), hubs)


@lru_cache(maxsize=KEPT)
def _structure(
    row_frames: tuple[tuple[int, ...], ...], n: int, beams: tuple[tuple[int, int], ...], hubs: Hubs
) -> Structure:
    m, of_frame = len(row_frames), slots(row_frames, n)
    spans = [of_frame[first : first + nodes] for first, nodes in beams]
    rigid = of_frame[: n - sum(map(len, spans))]
    of_body = [*rigid, *([slot for node in span for slot in node] for span in spans)]
    neighbours: list[set[int]] = [set() for _ in range(m + len(hubs.frames))]
    for f, members in enumerate(of_body):
        rows = {k for k, _ in members}
        if f in hubs.frames:
            hub = m + hubs.frames.index(f)
            neighbours[hub] = rows
            for k in rows:
                neighbours[k].add(hub)
            continue
        for k in rows:
            neighbours[k] |= rows - {k}
    wide = frozenset(range(m, len(neighbours)))
    nodes = minimum_degree(neighbours, wide, hubs.d, hubs.late)
    numbers = [[k] if k < m else [m + (k - m) * hubs.d + c for c in range(hubs.d)]
               for k in range(len(neighbours))]  # fmt: skip
    order, below = [], []
    for k, under in zip(nodes, eliminate(neighbours, nodes), strict=True):
        after = [i for o in under for i in numbers[o]]
        for c, i in enumerate(numbers[k]):
            order.append(i)
            below.append([*numbers[k][c + 1 :], *after])
    return Structure(of_body, order, below)


def no_pattern(m: int, n: int) -> dict[str, Any]:
    """The pattern of a model whose equations nobody solves: only its m rows are looked at."""
    none = np.zeros(0, np.int64)
    return {
        "frame_start": np.zeros(n + 1, np.int64),
        "hub": np.full(n, -1, np.int64),
        "column_start": np.zeros(m + 1, np.int64),
        **dict.fromkeys(("slot_row", "slot_line", "entry", "row", "target"), none),
    }


def pattern(
    row_frames: Rows,
    n: int,
    beams: list[tuple[int, int]] | None = None,
    hubs: Hubs = Hubs(),  # noqa: B008 - nothing in it can change
) -> dict[str, Any]:
    """Index arrays of Model for rows over its n frames; see the comments there.

    beams: first frame and number of nodes of each; they follow the rigid bodies.
    """
    return {**_pattern(tuple(row_frames), n, tuple(beams or ()), hubs)}


@lru_cache(maxsize=KEPT)
def _pattern(
    row_frames: tuple[tuple[int, ...], ...], n: int, beams: tuple[tuple[int, int], ...], hubs: Hubs
) -> dict[str, Any]:
    of_body, order, below = _structure(row_frames, n, beams, hubs)
    of_frame = slots(row_frames, n)
    columns = [[k, *under] for k, under in zip(order, below, strict=True)]
    row = [k for column in columns for k in column]
    column_start = np.cumsum([0, *map(len, columns)])

    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    ranks = [rank[column] for column in columns]  # rising
    target = [triangle(under[1:], ranks, column_start)[::-1] for under in ranks]
    lower = [np.tril(np.ones((len(t), len(t)), bool))[::-1] for t in target]
    first = np.full(n, -1, np.int64)
    first[list(hubs.frames)] = len(row_frames) + hubs.d * np.arange(len(hubs.frames))
    entry = []
    for f, members in enumerate(of_body):
        hub = rank[first[f] : first[f] + hubs.d] if f in hubs.frames else None
        entry += places(rank[[k for k, _ in members]], hub, ranks, column_start)
    return {
        "frame_start": np.cumsum([0, *map(len, of_frame)]),
        "slot_row": np.array([k for members in of_frame for k, _ in members], np.int64),
        "slot_line": np.array([l for members in of_frame for _, l in members], np.int64),
        "hub": first,
        "entry": np.concatenate([*entry, np.zeros(0, np.int64)]),
        "column_start": column_start,
        "row": np.array(row, np.int64),
        "target": np.concatenate(
            [*(t[own] for t, own in zip(target, lower, strict=True)), np.zeros(0, np.int64)]
        ),
    }


def places(
    rows: Indices, hub: Indices | None, ranks: list[Indices], column_start: Indices
) -> list[Indices]:
    """Places of what a body adds to the matrix; ranks of its rows, and of its unknowns as a hub."""
    if hub is None:
        return [triangle(rows, ranks, column_start)[np.tril_indices(len(rows))]]
    own = triangle(hub, ranks, column_start)[masses_of(len(hub))]
    return [spread(rows, hub, ranks, column_start), own]


def spread(rows: Indices, unknowns: Indices, ranks: list[Indices], column_start: Indices) -> Any:
    """Places of the entries between rows and the unknowns of their hub, told by their ranks."""
    pairs = [sorted((k, c)) for k in rows.tolist() for c in unknowns.tolist()]
    places = [column_start[a] + np.searchsorted(ranks[a], b) for a, b in pairs]
    return np.array(places, np.int64)


def masses_of(d: int) -> tuple[list[int], list[int]]:
    """Entries of the mass matrix of a body, row by row: the mass, then what turns."""
    return ([0, 1, 2], [0, 1, 2]) if d == 3 else ([0, 1, 2, 3, 4, 4, 5, 5, 5],
                                                  [0, 1, 2, 3, 3, 4, 3, 4, 5])  # fmt: skip
