"""The sparsity of S = J M^-1 J^T and the program of its factorisation L D L^T, made once.

Two rows of J meet in S where they share a moving body: a frame, or the nodes of a beam.  A
minimum-degree order keeps the fill small [George1989]: for an open chain the cost of factorising
grows linearly with its length.  The numeric part (equations.py, linear.py) only walks the index
lists made here, each from its beginning to its end.
"""

from heapq import heapify, heappop, heappush
from typing import Any

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]


def slots(row_frames: list[tuple[int, int]], n: int) -> list[list[tuple[int, int]]]:
    """For each of n frames its slots: (row, column of J) of the rows between frames (i, j)."""
    found: list[list[tuple[int, int]]] = [[] for _ in range(n)]
    for k, (i, j) in enumerate(row_frames):
        for f, column in ((i, 0), (j, 6)):
            if f > 0:
                found[f].append((k, column))
    return found


def minimum_degree(neighbours: list[set[int]]) -> list[int]:
    """An elimination order: always the row with the fewest neighbours left, fill included.

    Among these the one whose neighbours were eliminated longest ago: its pivot waits for no other,
    so a chain is taken from both ends in turn, and the processor works on both at once.
    """
    graph = [set(n) for n in neighbours]
    waiting = [(len(g), 0, k) for k, g in enumerate(graph)]
    valid = list(waiting)
    heapify(waiting)
    order: list[int] = []
    while waiting:
        found = heappop(waiting)
        k = found[2]
        if found != valid[k]:
            continue
        order.append(k)
        for a in graph[k]:
            graph[a] |= graph[k]
            graph[a] -= {a, k}
            valid[a] = (len(graph[a]), len(order), a)
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


def pattern(
    row_frames: list[tuple[int, int]], n: int, beams: list[tuple[int, int]] | None = None
) -> dict[str, Any]:
    """Index arrays of Model for rows between pairs of its n frames; see the comments there.

    beams: first frame and number of nodes of each; they follow the rigid bodies.
    """
    of_frame = slots(row_frames, n)
    spans = [of_frame[first : first + nodes] for first, nodes in beams or []]
    rigid = of_frame[: n - sum(map(len, spans))]
    of_body = [*rigid, *([slot for node in span for slot in node] for span in spans)]
    neighbours: list[set[int]] = [set() for _ in row_frames]
    for members in of_body:
        rows = {k for k, _ in members}
        for k in rows:
            neighbours[k] |= rows - {k}
    order = minimum_degree(neighbours)
    below = eliminate(neighbours, order)
    columns = [[k, *under] for k, under in zip(order, below, strict=True)]
    row = [k for column in columns for k in column]
    column_start = np.cumsum([0, *map(len, columns)])

    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    ranks = [rank[column] for column in columns]  # rising
    target = [triangle(under[1:], ranks, column_start)[::-1] for under in ranks]
    lower = [np.tril(np.ones((len(t), len(t)), bool))[::-1] for t in target]
    entry = [
        triangle(rank[[k for k, _ in members]], ranks, column_start)[np.tril_indices(len(members))]
        for members in of_body
    ]
    return {
        "row_frame": np.array(row_frames, np.int64).reshape(-1, 2),
        "frame_start": np.cumsum([0, *map(len, of_frame)]),
        "slot_row": np.array([k for members in of_frame for k, _ in members], np.int64),
        "slot_column": np.array([c for members in of_frame for _, c in members], np.int64),
        "entry": np.concatenate([*entry, np.zeros(0, np.int64)]),
        "column_start": column_start,
        "row": np.array(row, np.int64),
        "target": np.concatenate(
            [*(t[own] for t, own in zip(target, lower, strict=True)), np.zeros(0, np.int64)]
        ),
    }
