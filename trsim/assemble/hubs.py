"""Which bodies are hubs: their motion an unknown of the solve, see pattern.py.

A body with many rows is one where the operations of a solve, counted on the pattern, become clearly
fewer.  Mechanisms without such a body keep S = J M^-1 J^T as it is.
"""

from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.mechanism import RowName
from trsim.assemble.pattern import Hubs, structure
from trsim.assemble.rank import dependent_rows, of_length_one, plainly_independent
from trsim.assemble.reduce import jacobian, moves, weights
from trsim.elements.scene import Model

Array = NDArray[np.float64]

MANY = 2  # rows for each direction a body moves in: fewer are never worth it
WORTH = 0.8  # of the operations: what may be left of them
TRIED = 16  # bodies
LEAST = 1e-2  # of a row left after the others are taken out, hubs held: with less it comes later


def hubs(
    full: Model,
    y6: Array,
    rows: list[RowName],
    kept: list[RowName],
    planar: bool,
    beams: list[tuple[int, int]],
) -> Hubs:
    """The hubs of a mechanism.  rows: those of `full`; kept: of these the ones in the solve."""
    frames, d = [r.frames for r in kept], 3 if planar else 6
    count = Counter(f for pair in frames for f in pair if 0 < f < full.n_r)
    found, many = Hubs(), [f for f, n in count.most_common(TRIED) if n > MANY * d]
    if not many:
        return found
    number = {row: k for k, row in enumerate(rows)}
    J = jacobian(full, 0.0, y6)[2][[number[row] for row in kept]]
    least = structure(frames, full.n, beams).operations(found)
    for f in many:
        held = (*found.frames, f)
        trial = Hubs(d, held, late_rows(full, J, frames, held, planar))
        operations = structure(frames, full.n, beams, trial).operations(trial)
        if operations < WORTH * least:
            found, least = trial, operations
    return found


def late_rows(
    full: Model, J: Array, frames: list[tuple[int, int]], held: tuple[int, ...], planar: bool
) -> frozenset[int]:
    """Rows that depend on others while some bodies are held; of these rather the rows on them."""
    keep = moves(full, planar).reshape(-1, 6).copy()
    keep[[f - 1 for f in held]] = False
    J, scale = J[:, keep.ravel()], weights(full)[keep.ravel()]
    still = {0, *held}
    moved = [k for k, pair in enumerate(frames) if not still.issuperset(pair)]
    late = frozenset(range(len(frames))).difference(moved)
    if plainly_independent(of_length_one(J[moved], scale)):
        return late
    order: Any = sorted(moved, key=lambda k: (not still.isdisjoint(set(frames[k]) - {0}), k))
    return late | dependent_rows(J, scale, order, LEAST)
