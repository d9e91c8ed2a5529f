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
from typing import Any

import numpy as np

from trsim.assemble.instances import Column
from trsim.assemble.linear import SINGULAR, smallest_pivot
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import project_positions
from trsim.elements.scene import Model, scene
from trsim.errors import some
from trsim.solve.diagnose.locked import dependent
from trsim.solve.outcome import Outcome

# pivots below which an extreme is none: where branches are known to meet or rows are redundant; by
# methods that nobody looks for such places with; anywhere; and above which rounding is no reason
KNOWN, UNSEEN, NEAR, FAR = 1e-3, 1e-4, 1e-6, 1e-2
ROUNDING = 1e-14  # 50 times eps: felt 1 / pivot^1.5 times
REGULAR = 1e-3  # least singular value at a start that is no such place itself
OF = ("joints", "drives")
TOLD = 4  # names
GIVEN = 1e-2  # of the largest energy, by projection: more, and the motion is another one
# tolerances, of it: where steps are controlled projection does a quarter of one at most [of 237
# drawn scenes], and thousands in a storm of short steps next to where branches of the motion meet
GIVEN_IN_TOLERANCES = 30.0


def of_extremes(scenario: Any, mechanism: Mechanism, outcome: Outcome) -> Iterator[str]:
    """Channels of joints whose extremes are chance, with the largest of them and its time."""
    model, r = mechanism.model, outcome.record
    if not closes(model) or not np.min(r.firm, initial=1.0) < FAR:
        return
    regular = dependent(mechanism, 0.0, outcome.start.y)[1]
    least = min(FAR, (ROUNDING / model.tolerance) ** (2.0 / 3.0))
    least = max(least, certain(mechanism, outcome, regular))
    least *= of_masses(mechanism, outcome, regular)
    sizes = [(c, forces(mechanism, outcome, c)) for c in of_joints(mechanism)]
    enough = model.tolerance * max((max(largest) for _, largest in sizes), default=0.0)
    found: dict[str, tuple[float, float, float, str]] = {}
    for column, largest in sizes:
        for k, much in enumerate(largest):
            c, side = column.start + k // 2, k % 2
            if r.firm[side, c] < least and much > enough:
                value, t = outcome.peaks[c, 2 * side : 2 * side + 2].tolist()
                one = (much, t, float(r.firm[side, c]), f"{value:.3g} {column.unit}")
                found[column.name] = max(found.get(column.name, one), one)
    if found:
        motion = "For" if astray(scenario, outcome) else "The motion is right; for"
        remedy = f"{motion} the forces give joints clearance or compliance"
        yield f"{sentence(mechanism, found)}  {remedy}"


def closes(model: Model) -> bool:
    """Whether rows of joints may come to depend on each other somewhere on the way."""
    return bool(model.near_rows > 0.0 or len(model.looped))


def sentence(mechanism: Mechanism, found: dict[str, tuple[float, float, float, str]]) -> str:
    """The largest first: its size, when it was, the pivot there, its value in words."""
    first = max(found, key=lambda name: found[name][0])
    _, t, pivot, value = found[first]
    names = [first, *(name for name in found if name != first)]
    part = first.split(".")[0]
    section = next(i.section for i in mechanism.instances if i.name == part)
    return (
        f"{section}.{part}: extremes of {some(names, TOLD)} are chance: {value} of "
        f"{first} is that of t = {t:.6g} s, {sqrt(pivot):.1g} from where rows of joints depend on "
        "each other, and what they carry grows there like one over the distance."
    )


def astray(scenario: Any, outcome: Outcome) -> bool:
    """Whether the motion changed its branch there, or lost its energy, as is told elsewhere."""
    return too_much_given(scenario, outcome) or bool(outcome.record.crossings > 0)


def too_much_given(scenario: Any, outcome: Outcome) -> bool:
    """Whether projection did more work than the motion can bear."""
    asked = GIVEN_IN_TOLERANCES * scenario.solver.tolerance
    given = outcome.statistics.get("work_of_projection_relative", 0.0)
    return bool(given > (GIVEN if scenario.solver.step else min(GIVEN, asked)))


def of_joints(mechanism: Mechanism) -> list[Column]:
    """What joints and drives carry."""
    names = {instance.name for instance in mechanism.instances if instance.section in OF}
    return [
        c for c in mechanism.columns
        if c.unit in ("N", "N*m") and c.wanted and c.name.split(".")[0] in names
    ]  # fmt: skip


def forces(mechanism: Mechanism, outcome: Outcome, column: Column) -> list[float]:
    """How large both extremes of each of its components are, a moment as a force at the size."""
    lever = mechanism.model.size if column.unit == "N*m" else 1.0
    extremes = outcome.peaks[column.start : column.start + column.size, [0, 2]]
    return (np.abs(extremes).ravel() / lever).tolist()


def certain(mechanism: Mechanism, outcome: Outcome, regular: float) -> float:
    """The pivot below which there is a pole, or nobody looked whether there is."""
    if len(mechanism.model.redundant) or not regular > REGULAR or outcome.record.n_meetings:
        return KNOWN
    return NEAR if mechanism.model.near > 0.0 else UNSEEN  # methods of scipy


def of_masses(mechanism: Mechanism, outcome: Outcome, regular: float) -> float:
    """What unequal masses make of the least pivot at the start, 1 at most."""
    if not regular > REGULAR:
        return 1.0
    work = scene(mechanism.model)
    project_positions(work, 0.0, outcome.start.y.copy())
    if work.status[0] == SINGULAR:
        return 1.0
    return min(1.0, float(smallest_pivot.python(work)) / regular**2)
