"""How far the rows dropped as redundant are open: looked at wherever a run keeps a state.

A row that depends on the rows of the solve is held by them.  If it depends on them only as drawn,
it opens as the mechanism moves.  Openings are relative: lengths over the mechanism's size, angles
in rad.

Interpolation, or a run without projection, opens all rows a little.  Where a redundant row is open
by more than is told, the position is brought to the rows of the solve first.  What is then open by
much more than these is not held by them: beyond max(100 tolerance, 1e-8) the run ends, as the
accuracy that was asked for is lost; beyond a hundredth of that it is told.

Where rows of the solve nearly depend on each other, others of those that hold the same may not;
solve/march/anew.py then sees which to take.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from trsim.assemble.equations import constraints, poses, set_poses
from trsim.assemble.instances import Instance
from trsim.assemble.linear import smallest_pivot
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import close_positions
from trsim.assemble.schur import velocity_residual
from trsim.assemble.tables import turns_by
from trsim.elements.contract import compiled
from trsim.elements.scene import workspace
from trsim.errors import ModelError
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_to
from trsim.solve.march.calls import LOOK
from trsim.solve.march.record import Record

Array = NDArray[np.float64]

ROW, INDEX = range(2)  # columns of s.redundant
OF_TOLERANCE, LEAST = 100.0, 1e-8
TOLD, LEAST_TOLD = 0.01, 1e-9
NEWTON, CLOSED = 12, 1e-14  # steps; of the mechanism's size
FEEBLE, FALLEN = 1e-2, 0.1  # pivots; against the last one that was asked about
AS_THE_OTHERS = 100.0  # where rows are singular, Newton's steps leave them open
WHY = (
    "It was left out of the solve, since the other rows seemed to hold what it holds; but these "
    "rows depend on each other only as drawn"
)
REMEDY = (
    "what was drawn cannot move like this: draw it to more digits, give the joint a clearance, or "
    "loosen `tolerance`, to 100 times of which joints may be open"
)


@compiled(LOOK)
def look(s, r, b, setting, t, step):
    """Note the openings of the redundant rows at t, which the last evaluation was at.

    step: 1 at the end of a step, b.y1; 0 inside, at b.y2, where interpolation may open them to what
    is told.

    Leaves other poses in the workspace, and b.y2 changed, where it returns 1; else 0.
    """
    if step == 1:
        look_at_pivots(s, r)
    told, worst = max(TOLD * setting.held_to, LEAST_TOLD), 0.0
    for k in range(s.redundant.shape[0]):
        worst = max(worst, opening(s, s.m + k))
        r.worst_open_rate = max(r.worst_open_rate, rate(s, s.m + k))
    r.worst_open = max(r.worst_open, worst)
    if worst <= (told if step == 1 else setting.held_to):
        return 0
    if step == 1:
        copy_to(b.y2, b.y1)
    bound = AS_THE_OTHERS * closed(s, t, b.y2)
    for k in range(s.redundant.shape[0]):
        left = opening(s, s.m + k)
        if left <= max(told, bound):
            continue
        if left > r.apart:
            r.apart, r.apart_t = left, t
            r.open_row, r.open_index = s.redundant[k, ROW], s.redundant[k, INDEX]
        if left > setting.held_to:
            r.opened = 1
    return 1


@internal
def look_at_pivots(s, r):
    """Ask for other rows where those of the solve come to depend on each other."""
    smallest = smallest_pivot(s)
    if smallest < FEEBLE and smallest <= FALLEN * r.weakest:
        r.weakest = smallest
        r.weak = 1
    r.weakest = max(r.weakest, smallest)
    if r.weak > 0:
        r.fired += 1


@internal
def closed(s, t, y):
    """Bring y to the rows of the solve, as close as rounding lets it; what they stay open by."""
    counted = (s.status[0], s.status[1], s.status[2], s.status[3])
    close_positions(s, t, y, CLOSED * s.size, NEWTON)
    set_poses(s, y)
    constraints(s, t)
    s.status[0], s.status[1], s.status[2], s.status[3] = counted
    worst = 0.0
    for row in range(s.m):
        worst = max(worst, opening(s, row))
    return worst


@internal
def opening(s, row):
    """|Phi| of a row, relative."""
    return abs(s.phi[row]) / s.row_unit[row]


@internal
def rate(s, row):
    """|Phi'| of a row, relative, 1/s."""
    return abs(velocity_residual(s, row)) / s.row_unit[row]


def held_to(tolerance: float) -> float:
    """What redundant rows may be open by, relative."""
    return max(OF_TOLERANCE * tolerance, LEAST)


def opened(scenario: Any, mechanism: Mechanism, r: Record) -> str:
    """Which redundant row is open, by how much, when and why, in words."""
    instance, axis, by = worst(mechanism, r)
    entry = scenario.entry(instance.section, instance.name)
    return f"{entry} opens: its row {axis} is off by {by}.  {WHY}; {REMEDY}"


def apart(mechanism: Mechanism, r: Record) -> str:
    """`opened` of a row that is open by more than is told; empty where none is."""
    if r.apart == 0.0:
        return ""
    instance, axis, by = worst(mechanism, r)
    return (
        f"{instance.section}.{instance.name}: its row {axis}, left out of the solve as redundant, "
        f"was off by {by}: the rows that should hold it do so only as drawn; draw the mechanism "
        "to more digits"
    )


def worst(mechanism: Mechanism, r: Record) -> tuple[Instance, str, str]:
    """The redundant row that was most open: of which element, its name, how far and when."""
    e, index = int(r.open_row), int(r.open_index)
    instance = mechanism.instances[e]
    by = f"{size(mechanism, e, index, float(r.apart))} at t = {r.apart_t:.6g} s"
    return instance, instance.element.rows[index], by


def size(mechanism: Mechanism, e: int, index: int, opening: float) -> str:
    """A relative opening of row `index` of instance e with its unit."""
    if turns_by(mechanism.instances[e], index):
        return f"{opening:.2g} rad"
    return f"{opening * mechanism.model.size:.2g} m"


def check_closed(mechanism: Mechanism, y: Array, tolerance: float) -> None:
    """Redundant rows are closed at the start.  Raises ModelError."""
    model = mechanism.model
    if not len(model.redundant):
        return
    w = workspace(model)
    poses(w, y)
    constraints(w, 0.0)
    opening = np.abs(w.phi[model.m :]) / model.row_unit[model.m :]
    k = int(np.argmax(opening))
    if opening[k] <= held_to(tolerance):
        return
    e, index = model.redundant[k].tolist()
    instance = mechanism.instances[e]
    raise ModelError(
        f"its row {instance.element.rows[index]} is off by "
        f"{size(mechanism, e, index, float(opening[k]))} where the run begins.  {WHY}",
        REMEDY,
        (instance.section, instance.name),
    )
