"""Which bodies are hubs: their motion an unknown of the solve, see pattern.py.

It pays where the operations of a solve, counted on the pattern, become fewer by half of those
that eliminating all rows of the body takes.  For chains of three bodies in space, as measured, this
begins with three of them.  Mechanisms without such a body keep S = J M^-1 J^T as it is.
"""

from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.instances import RowName
from trsim.assemble.pattern import Hubs, Rows, structure
from trsim.assemble.rank import dependent_rows, of_length_one, plainly_independent
from trsim.assemble.reduce import Drawn, moves, weights
from trsim.elements.scene import Model

Array = NDArray[np.float64]

MANY = 3  # rows for each direction a body moves in: with fewer the gain is not worth the lists
WORTH = 0.5  # of the operations its rows take if they all meet: what must be saved of them
TRIED = 16  # bodies
LEAST = 1e-2  # of a row left after the others are taken out, hubs held: with less it comes later


def hubs(drawn: Drawn, kept: list[RowName], planar: bool, beams: list[tuple[int, int]]) -> Hubs:
    """The hubs of a mechanism.  kept: of the rows as drawn those in the solve."""
    full = drawn.scene
    frames, d = [r.frames for r in kept], 3 if planar else 6
    count = Counter(f for named in frames for f in named if 0 < f < full.n_r)
    found, many = Hubs(), [f for f, n in count.most_common(TRIED) if n > MANY * d]
    if not many:
        return found
    number = {row: k for k, row in enumerate(drawn.rows)}
    J = drawn.J[[number[row] for row in kept]]
    least = structure(frames, full.n, beams).operations(found)
    for f in many:
        held = (*found.frames, f)
        trial = Hubs(d, held, late_rows(full, J, frames, held, planar))
        operations = structure(frames, full.n, beams, trial).operations(trial)
        if least - operations < WORTH * clique(count[f]):
            break  # the next one has no more rows
        found, least = trial, operations
    return found


def clique(rows: int) -> int:
    """Operations of eliminating rows that all meet each other, as `structure` counts them."""
    return sum(k * (k + 5) // 2 for k in range(rows))


def late_rows(
    full: Model, J: Array, frames: Rows, held: tuple[int, ...], planar: bool
) -> frozenset[int]:
    """Rows that depend on others while some bodies are held; of these rather the rows on them."""
    keep = moves(full, planar).reshape(-1, 6).copy()
    keep[[f - 1 for f in held]] = False
    J, scale = J[:, keep.ravel()], weights(full)[keep.ravel()]
    still = {0, *held}
    moved = [k for k, named in enumerate(frames) if not still.issuperset(named)]
    late = frozenset(range(len(frames))).difference(moved)
    if plainly_independent(of_length_one(J[moved], scale)):
        return late
    order: Any = sorted(moved, key=lambda k: (not still.isdisjoint(set(frames[k]) - {0}), k))
    return late | dependent_rows(J, scale, order, LEAST)
