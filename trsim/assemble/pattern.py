"""The sparsity of S = J M^-1 J^T and the program of its factorisation L D L^T, made once.

Two rows of J meet in S where they share a moving frame.  A minimum-degree order keeps the fill
small [George1989]: for an open chain the cost of factorising grows linearly with its length.
The numeric part (assemble/equations.py) only walks the index lists made here.
"""

from typing import Any

import numpy as np


def slots(row_frames: list[tuple[int, int]]) -> tuple[list[int], list[int], list[int]]:
    """Slots of rows given as pairs of frames (i, j): start of each row, frame, column of J."""
    start, frame, column = [0], [], []
    for i, j in row_frames:
        for f, c in ((i, 0), (j, 6)):
            if f > 0:
                frame.append(f)
                column.append(c)
        start.append(len(frame))
    return start, frame, column


def minimum_degree(neighbours: list[set[int]]) -> list[int]:
    """An elimination order: always the row with the fewest neighbours left, fill included."""
    graph = [set(n) for n in neighbours]
    left, order = set(range(len(graph))), []
    while left:
        k = min(left, key=lambda r: (len(graph[r]), r))
        order.append(k)
        left.remove(k)
        for a in graph[k]:
            graph[a] |= graph[k]
            graph[a] -= {a, k}
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


def pattern(row_frames: list[tuple[int, int]]) -> dict[str, Any]:
    """Index arrays of Model for the given rows; see the comments there."""
    m = len(row_frames)
    start, frame, column = slots(row_frames)
    touching: dict[int, list[tuple[int, int]]] = {}
    for k in range(m):
        for s in range(start[k], start[k + 1]):
            touching.setdefault(frame[s], []).append((k, s))
    neighbours: list[set[int]] = [set() for _ in range(m)]
    for rows in touching.values():
        members = {k for k, _ in rows}
        for k in members:
            neighbours[k] |= members - {k}
    order = minimum_degree(neighbours)
    rank = {row: k for k, row in enumerate(order)}
    below = eliminate(neighbours, order)

    place: dict[tuple[int, int], int] = {}

    def at(a: int, b: int) -> int:
        """Place of the entry of rows a and b (elimination ranks decide which is lower)."""
        key = (a, b) if rank[a] >= rank[b] else (b, a)
        return place.setdefault(key, len(place))

    diagonal = [at(k, k) for k in order]
    below_start, below_place, below_row = [0], [], []
    update_start = [0]
    update: list[tuple[int, int, int]] = []
    for k, under in zip(order, below, strict=True):
        for a_index, a in enumerate(under):
            below_place.append(at(a, k))
            below_row.append(a)
            update += [(at(a, b), at(a, k), at(b, k)) for b in under[: a_index + 1]]
        below_start.append(len(below_place))
        update_start.append(len(update))
    pair = [
        (sa, sb, at(a, b))
        for rows in touching.values()
        for n, (a, sa) in enumerate(rows)
        for b, sb in rows[: n + 1]
    ]
    return {
        "row_start": np.array(start, np.int64),
        "slot_frame": np.array(frame, np.int64),
        "slot_column": np.array(column, np.int64),
        "pair": np.array(pair, np.int64).reshape(-1, 3),
        "n_value": len(place),
        "order": np.array(order, np.int64),
        "diagonal": np.array(diagonal, np.int64),
        "below_start": np.array(below_start, np.int64),
        "below": np.array(below_place, np.int64),
        "below_row": np.array(below_row, np.int64),
        "update_start": np.array(update_start, np.int64),
        "update": np.array(update, np.int64).reshape(-1, 3),
    }
