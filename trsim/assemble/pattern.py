"""The sparsity of S = J M^-1 J^T and the program of its factorisation L D L^T, made once.

Two rows of J meet in S where they share a moving body: a frame, or the nodes of a beam.  A
minimum-degree order keeps the fill small [George1989]: for an open chain the cost of factorising
grows linearly with its length.  The numeric part (equations.py, linear.py) only walks the index
lists made here, each from its beginning to its end.
"""

from heapq import heapify, heappop, heappush
from typing import Any

import numpy as np


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

    # an entry of S stands in the column of that one of its rows which is eliminated first
    place = {
        (column[0], k): start + p
        for start, column in zip(column_start.tolist(), columns, strict=False)
        for p, k in enumerate(column)
    }
    place |= {(b, a): p for (a, b), p in place.items()}
    target = [
        place[under[last], b]
        for under in below
        for last in reversed(range(len(under)))
        for b in under[: last + 1]
    ]
    entry = [
        place[a, b]
        for members in of_body
        for last, (a, _) in enumerate(members)
        for b, _ in members[: last + 1]
    ]
    return {
        "row_frame": np.array(row_frames, np.int64).reshape(-1, 2),
        "frame_start": np.cumsum([0, *map(len, of_frame)]),
        "slot_row": np.array([k for members in of_frame for k, _ in members], np.int64),
        "slot_column": np.array([c for members in of_frame for _, c in members], np.int64),
        "entry": np.array(entry, np.int64),
        "column_start": column_start,
        "row": np.array(row, np.int64),
        "target": np.array(target, np.int64),
    }
