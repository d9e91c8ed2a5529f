"""Whether a run without projection knows its way where branches of the motion meet.

At delta from such a place the branches are apart by some delta^2, and so is the smallest pivot of S
from nothing.  Rows that are open by as much join the branches to one curve that turns from one into
the other: which way a run goes is then a matter of what the rows are off by, and a run with an open
book and small residuals may be wrong in all of its numbers.

Of rows open by much less the way is sure, but not all of its numbers: what is open by e moves the
mechanism by e / delta, and since delta changes with the motion, accelerations by e / delta^3 of the
square of the rates.  What they would be with the joints closed is looked at where delta is small,
with Baumgarte's stabilisation up to where all that is measured is closed anyway (DOUBTFUL of
land.py).  It is reported; where nothing closes the rows, numbers between the ends of steps may be
off by more, and the run ends.
"""

from collections.abc import Iterator
from math import sqrt
from typing import Any

from trsim.assemble.beside import plain_pivot, speed, unit
from trsim.assemble.equations import evaluate
from trsim.assemble.linear import TINY, refactorise, smallest_pivot
from trsim.assemble.mechanism import Mechanism
from trsim.assemble.projection import DOUBTFUL, poses_and_rows, project_velocities
from trsim.elements.contract import compiled
from trsim.elements.scene import NONE
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_to
from trsim.solve.diagnose.locked import dependent
from trsim.solve.march.calls import LOOK
from trsim.solve.march.openings import closed, look, opening
from trsim.solve.march.record import Record

AS_FAR = 0.03  # of the pivot: runs on the right branch had 0.005, on the wrong one 0.07
NEARLY = 0.3  # pivots of rows that nearly depend on each other
# times the tolerance: rows that are open by less are not felt; what accelerations feel and is told;
# what of it ends a run that closes rows nowhere, inside steps either
LITTLE, TOLD, ENOUGH = 1e-3, 10.0, 1.0


@compiled(LOOK)
def look_at_drift(s, r, b, setting, t, step):
    """`look` of openings.py, whether the run has lost its way at the end of a step, and what
    accelerations feel of open rows: without any stabilisation the same, at rows inside it too."""
    felt, without = 0, s.stabilisation == NONE
    if step == 1 or without:
        pivot, worst = max(smallest_pivot(s), TINY), 0.0
        for row in range(s.m):
            worst = max(worst, opening(s, row))
        if step == 1 and worst > AS_FAR * pivot and worst > AS_FAR * plain(s):
            r.lost = 1
        least = 0.0 if without else DOUBTFUL
        little = min(LITTLE, pivot * sqrt(pivot)) * s.tolerance
        felt = int(least < pivot <= NEARLY and worst > little)
    if felt > 0:
        keep_accelerations(s, b)
    went = look(s, r, b, setting, t, step)
    if felt > 0:
        if step == 1:
            copy_to(b.y2, b.y1)
        feel(s, r, b, t)
        if without and r.felt > (ENOUGH if step == 1 else TOLD) * s.tolerance:
            r.lost = 1
    return max(felt, went)


@internal
def plain(s):
    """The smallest pivot, whatever the masses: small ones of theirs say nothing of branches."""
    smallest = plain_pivot(s)
    refactorise(s)
    return max(smallest, TINY)


@internal
def keep_accelerations(s, b):
    """b.rough[2] <- those of the last evaluation."""
    for f in range(1, s.n_r):
        for c in range(s.d):
            b.rough[2, s.d * (f - 1) + c] = s.free[f, c]


@internal
def feel(s, r, b, t):
    """Into the record by how much the accelerations that were kept would be others with the rows of
    b.y2 closed: of the largest, or of the square of the fastest rate so far."""
    kept = b.rough[2]
    closed(s, t, b.y2)
    poses_and_rows(s, t, b.y2)
    project_velocities(s, b.y2)
    fastest = max(speed(s), r.top_speed / s.size)
    evaluate(s, t, b.y2, b.rough[1])
    most, scale = 0.0, fastest * fastest
    for f in range(1, s.n_r):
        for c in range(s.d):
            i = s.d * (f - 1) + c
            most = max(most, abs(s.free[f, c] - kept[i]) / unit(s, i))
            scale = max(scale, abs(kept[i]) / unit(s, i))
    if most > r.felt * scale:
        r.felt, r.felt_t = most / scale, t


def lost_its_way(scenario: Any, mechanism: Mechanism, r: Record) -> str:
    """Whose rows depend on each other where a run lost its way, and what to do, in words."""
    names, _ = dependent(mechanism, float(r.t), r.y)
    if scenario.solver.stabilisation == "none" and r.felt > ENOUGH * scenario.solver.tolerance:
        return f"{felt(scenario, r)} (rows of {', '.join(names)} depend on each other there)"
    return (
        f"branches of the motion meet here (rows of {', '.join(names)} depend on each other), and "
        "joints are open by as much as the branches are apart, so which one the motion takes is "
        f"chance; {REMEDY[scenario.solver.stabilisation]}"
    )


def of_drift(scenario: Any, mechanism: Mechanism, r: Record) -> Iterator[str]:
    """Rows that were open enough for accelerations to feel it where branches nearly meet."""
    if r.felt > TOLD * scenario.solver.tolerance:
        yield felt(scenario, r)


def felt(scenario: Any, r: Record) -> str:
    """What accelerations feel of open joints, in words."""
    return (
        f"branches of the motion nearly meet at t = {r.felt_t:.6g} s, where open joints change "
        f"accelerations by {r.felt:.2g} of the largest, and velocities and forces to a lesser "
        f"degree; {REMEDY[scenario.solver.stabilisation]}"
    )


REMEDY = {
    "none": "use `stabilisation: projection`",
    "baumgarte": "use `stabilisation: projection`, or larger rates and shorter steps",
}
