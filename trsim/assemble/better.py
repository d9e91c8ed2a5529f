"""Which of rows that depend on each other to solve at a position, where those at hand are weak.

Of a slider-crank in space three rows are left out as redundant.  A tilt of a hinge can stand for
one of them while its axis is across a bar; along it, it holds nothing of the kind, and the rows
that are left nearly depend on each other: accelerations lose the digits of their least singular
value squared.  Others are then taken, the best first: rows of drives, then in steps of what is left
of a row when the rows before it are taken out, and in each step those of joints before locks,
forces before moments.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.instances import Instance, RowName
from trsim.assemble.rank import of_length_one
from trsim.assemble.reduce import all_rows, moves, weights
from trsim.elements.scene import Scene

Array = NDArray[np.float64]

BETTER = 3.0  # times the least singular value of the rows at hand: other rows are worth a change
STEPS = (0.5, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-5)  # of a row of length one


def better(
    work: Scene, y: Array, kept: Sequence[RowName], dropped: Sequence[RowName],
    instances: Sequence[Instance],
) -> list[RowName] | None:  # fmt: skip
    """The rows to leave out at y; None where that is no better.  work: a scene with these rows."""
    if not dropped:
        return None
    keep = moves(work, work.d == 3)
    rows = [*kept, *dropped]
    R = of_length_one(all_rows(work, y)[:, keep], weights(work)[keep])
    section = [instances[row.instance].section for row in rows]
    driven = [k for k in range(len(rows)) if section[k] == "drives"]
    others = [k for k in range(len(rows)) if section[k] != "drives"]
    others.sort(key=lambda k: (section[k] == "events", rows[k].rotation, rows[k].instance,
                               rows[k].index))  # fmt: skip
    chosen = strongest(R, driven, others, len(kept))
    if len(chosen) < len(kept) or not set(driven) <= set(chosen):
        return None
    if weakest(R[chosen]) <= BETTER * weakest(R[: len(kept)]):
        return None
    return [rows[k] for k in sorted(set(range(len(rows))) - set(chosen))]


def strongest(R: Array, first: list[int], others: list[int], number: int) -> list[int]:
    """Rows of R, of length one, that depend on each other least: `first`, then some of the others
    in their order, as many as there are to be."""
    basis = np.zeros((number, R.shape[1]))
    chosen: list[int] = []
    for least in (0.0, *STEPS):
        for k in first if least == 0.0 else others:
            if k in chosen or len(chosen) == number:
                continue
            row = R[k]
            for _ in range(2):
                row = row - (basis[: len(chosen)] @ row) @ basis[: len(chosen)]
            left = np.linalg.norm(row)
            if left > max(least, 1e-12):
                basis[len(chosen)] = row / left
                chosen.append(k)
    return chosen


def weakest(R: Array) -> float:
    """The least singular value."""
    return float(np.linalg.svd(R, compute_uv=False)[-1]) if len(R) else 0.0
