"""Reactions whose extremes are chance: next to a place where rows of joints depend on each other.

With the rows of J dependent at a distance of delta, in units of the least singular value, what they
carry grows like 1/delta: a parallelogram that passes its flat position, a toggle at its dead
centre, or, of redundant rows, those that are solved for while others could hold the same.  The
motion and its accelerations have limits there and are right; a force has none, and its extreme is
that of the nearest place that happened to be looked at, with eps/delta^3 of rounding.

The solver notes the least pivot of J M^-1 J^T, about delta^2, with every extreme (samples.py).
Unequal masses make pivots small everywhere; by how much, the start tells.
"""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from trsim.assemble.linear import SINGULAR
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import project_positions
from trsim.elements.scene import scene
from trsim.solve.locked import dependent
from trsim.solve.outcome import Outcome
from trsim.solve.record import MEETINGS

# pivots: of places that are no extreme, whatever lies beyond; where branches are known to meet, or
# rows are redundant; above which rounding is always below the tolerance
NEAR, KNOWN, FAR = 1e-4, 1e-3, 1e-2
ROUNDING = 1e-14  # 50 times eps: felt 1 / pivot^1.5 times
REGULAR = 1e-3  # least singular value at a start that is no such place itself
OF = ("joints", "drives")
TOLD = 4  # names


def of_extremes(mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """Channels of joints whose extremes are chance, with the largest of them and its time."""
    model, r = mechanism.model, outcome.record
    if r is None or not model.near_rows > 0.0 or not np.min(r.firm, initial=1.0) < FAR:
        return
    known = len(model.redundant) > 0 or r.count[MEETINGS] > 0
    least = max(KNOWN if known else NEAR, min(FAR, (ROUNDING / model.tolerance) ** (2.0 / 3.0)))
    least *= of_masses(mechanism, outcome)
    section = {instance.name: instance.section for instance in mechanism.instances}
    found: dict[str, tuple[float, float, float, str]] = {}
    for column in mechanism.columns:
        name = column.name.split(".")[0]
        if column.unit not in ("N", "N*m") or section.get(name) not in OF or not column.wanted:
            continue
        for c in range(column.start, column.start + column.size):
            for side in (0, 1):
                value, t = outcome.peaks[c, 2 * side : 2 * side + 2].tolist()
                if r.firm[side, c] < least and value != 0.0:
                    one = (abs(value), t, float(r.firm[side, c]), f"{value:.3g} {column.unit}")
                    found[column.name] = max(found.get(column.name, one), one)
    if not found:
        return
    first = max(found, key=lambda name: found[name][0])
    _, t, pivot, value = found[first]
    names = [first, *(name for name in found if name != first)]
    others = f" and {len(names) - TOLD} more" if len(names) > TOLD else ""
    told = ", ".join(names[:TOLD]) + others
    yield (
        f"{section[first.split('.')[0]]}.{first.split('.')[0]}: extremes of {told} are chance: "
        f"{value} of {first} is that of t = {t:.6g} s, {sqrt(pivot):.1g} from where rows of joints "
        "depend on each other, and what they carry grows there like one over the distance.  The "
        "motion is right; for the forces give joints clearance or compliance"
    )


def of_masses(mechanism: Mechanism, outcome: Outcome) -> float:
    """What unequal masses make of the least pivot at the start, 1 at most."""
    regular = dependent(mechanism, 0.0, outcome.start.y)[1]
    if not regular > REGULAR:
        return 1.0
    work = scene(mechanism.model)
    project_positions(work, 0.0, outcome.start.y.copy())
    if work.status[0] == SINGULAR:
        return 1.0
    first = work.column_start[:-1]
    of_rows = work.row[first] < work.m
    pivot = float(np.min(work.value[first][of_rows] / work.first[of_rows], initial=1.0))
    return min(1.0, pivot / regular**2)
