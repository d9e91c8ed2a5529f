"""A fill-reducing order of elimination for constrained systems, and the pattern of their factors.

    [ H  B^T ]
    [ B   0  ]

Nodes are small dense blocks: of H bodies and states of elements, then groups of constraint rows.
Always the one with the fewest unknowns left around it goes next [George1989], but a group of
constraints never before all the nodes it acts on.  Every leading part of the matrix is then a
constrained system of its own, complete with the rows on it, and regular where H is positive on its
free motions and the rows are independent: no pivots have to be looked for when numbers come in.

Constraints wait for a body with many of them too, and then meet each other.  Those that are
independent with such hubs held (pattern.py) need not: their leading parts are regular without it.
"""

from collections import Counter
from collections.abc import Collection
from heapq import heapify, heappop, heappush
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Indices = NDArray[np.int64]


class Elimination(NamedTuple):
    """Order and factors, unknown by unknown; L and U have the same pattern, mirrored."""

    rank: Indices  # (N) place of an unknown in the order
    start: Indices  # (N+1) by place: entries of U right of the diagonal
    column: Indices  # their columns, rising: places
    lower_start: Indices  # (N+1) entries of L left of the diagonal
    lower: Indices  # their columns, rising


def order(
    neighbours: list[set[int]],
    size: list[int],
    free: int,
    hubs: Collection[int] = (),
    early: Collection[int] = (),
) -> list[int]:
    """Nodes in the order of elimination; those from `free` on wait for their neighbours below it.

    early: groups of constraints that do not wait for `hubs`.  Changes `neighbours`: in the end
    these are the nodes after each that its elimination touches.
    """
    acts_on = [  # without fill: the groups that wait for a node
        {o for o in n if o >= free and not (k in hubs and o in early)}
        for k, n in enumerate(neighbours[:free])
    ]
    waiting = Counter(o for groups in acts_on for o in groups)
    waits = [waiting[k] for k in range(len(neighbours))]

    def weight(k: int) -> int:
        return sum(size[o] for o in neighbours[k])

    heap = [(weight(k), k) for k in range(len(size)) if waits[k] == 0]
    heapify(heap)
    gone = [False] * len(size)
    found = []
    while heap:
        degree, k = heappop(heap)
        if gone[k] or degree != weight(k):
            continue  # an older entry of the heap
        gone[k] = True
        found.append(k)
        for a in acts_on[k] if k < free else ():
            waits[a] -= 1
        around = neighbours[k]
        for a in around:
            neighbours[a] |= around
            neighbours[a] -= {a, k}
        for a in around:
            if waits[a] == 0:
                heappush(heap, (weight(a), a))
    return found


def elimination(
    neighbours: list[set[int]],
    size: list[int],
    free: int,
    hubs: Collection[int] = (),
    early: Collection[int] = (),
) -> Elimination:
    """Order and pattern of the factors of a matrix of dense blocks.

    neighbours: of each node, both ways; size: unknowns of each node, numbered node by node; free:
    the first group of constraints; hubs, early: nodes, and groups that need not wait for them.
    """
    after = [set(n) for n in neighbours]
    nodes = order(after, size, free, hubs, early)
    first = np.concatenate([[0], np.cumsum(size)])
    at = {}
    place = 0
    for k in nodes:
        at[k] = place
        place += size[k]
    rank = np.zeros(place, np.int64)
    rows: list[list[int]] = []
    for k in nodes:
        rank[first[k] : first[k + 1]] = range(at[k], at[k] + size[k])
        right = sorted(p for a in after[k] for p in range(at[a], at[a] + size[a]))
        rows += [[*range(at[k] + i + 1, at[k] + size[k]), *right] for i in range(size[k])]
    lower: list[list[int]] = [[] for _ in rows]
    for i, row in enumerate(rows):
        for p in row:
            lower[p].append(i)
    return Elimination(rank, *_flat(rows), *_flat(lower))


def _flat(rows: list[list[int]]) -> tuple[Indices, Indices]:
    start = np.concatenate([[0], np.cumsum([len(row) for row in rows])]).astype(np.int64)
    return start, np.array([p for row in rows for p in row], np.int64)
