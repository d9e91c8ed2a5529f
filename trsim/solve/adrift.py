"""Whether a run without projection knows its way where branches of the motion meet.

At delta from such a place the branches are apart by some delta^2, and so is the smallest pivot of S
from nothing.  Rows that are open by as much join the branches to one curve that turns from one into
the other: which way a run goes is then a matter of what the rows are off by, and a run with an open
book and small residuals may be wrong in all of its numbers.
"""

from typing import Any

from trsim.assemble.beside import factors_again, plain_pivot
from trsim.assemble.linear import TINY, smallest_pivot
from trsim.assemble.mechanism import Mechanism
from trsim.elements.contract import compiled
from trsim.elements.vectors import internal
from trsim.solve.calls import LOOK
from trsim.solve.locked import dependent
from trsim.solve.openings import look, opening
from trsim.solve.record import LOST, Record, T

AS_FAR = 0.03  # of the pivot: runs on the right branch had 0.005, on the wrong one 0.07


@compiled(LOOK)
def look_at_drift(s, r, b, setting, t, y, step):
    """`look` of openings.py, and whether the run has lost its way at the end of a step."""
    if step == 1 and adrift(s):
        r.count[LOST] = 1
    return look(s, r, b, setting, t, y, step)


@internal
def adrift(s):
    """Whether rows are open by as much as branches are apart, at the state of the last evaluation.

    Pivots that only unequal masses make small say nothing of branches.
    """
    worst = 0.0
    for row in range(s.m):
        worst = max(worst, opening(s, row))
    if worst <= AS_FAR * max(smallest_pivot(s), TINY):
        return False
    plain = plain_pivot(s)
    factors_again(s)
    return worst > AS_FAR * max(plain, TINY)


def lost_its_way(scenario: Any, mechanism: Mechanism, r: Record) -> str:
    """Whose rows depend on each other where a run lost its way, and what to do, in words."""
    names, _ = dependent(mechanism, float(r.clock[T]), r.y)
    return (
        f"branches of the motion meet here (rows of {', '.join(names)} depend on each other), and "
        "joints are open by as much as the branches are apart, so which one the motion takes is "
        f"chance; {REMEDY[scenario.solver.stabilisation]}"
    )


REMEDY = {
    "none": "use `stabilisation: projection`",
    "baumgarte": "use `stabilisation: projection`, or larger rates and shorter steps",
}
