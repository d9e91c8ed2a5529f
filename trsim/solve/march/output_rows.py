"""Output rows inside a step: its channels at the times that are due."""

from trsim.elements.scene import PROJECTION
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import all_finite, copy_to
from trsim.solve.march.calls import INSIDE_AT, LOOK_AT, STEP_AT, call_look
from trsim.solve.march.dense_output import astray, measure_inside
from trsim.solve.march.turns import BRIEF

SOON = 0.05  # of a step: a row so near to its start is as right as that
SOONEST = 1e-3  # the same, of what is stiff
# a pivot at which the dense output's error is felt a hundredfold; long steps of loose tolerances,
# from the one there on, may reach past such a place and are further off
FELT, LOOSE, MORE = 2e-5, 1e-6, 0.2


@internal
def due(r, setting, t1):
    """Whether an output time lies at or before t1."""
    return setting.every * r.next_row <= t1 * (1.0 + 1e-15)


@internal
def at_end(t_o, t1):
    """Whether an output time is the end of the step, as far as rounding can tell."""
    return t_o >= t1 * (1.0 - 2e-15)


@internal
def felt(s, b, setting, method):
    """Whether the row just measured inside the step feels the error of the dense output so much
    that the step is to end there, and may."""
    chosen = setting.fixed_step == 0.0 and method[STEP_AT] > 0  # and by whom: not scipy
    if b.restless > 0 and chosen:
        return True
    if s.near_rows == 0.0 or b.firm[0] >= FELT * max(1.0, s.tolerance / LOOSE) ** MORE:
        return False
    return chosen and s.stabilisation == PROJECTION  # else rows are closed inside steps only


@internal
def of_none(s, r, b, setting, method, theta):
    """Whether the row just measured is none of the motion, and the step may end there."""
    may = setting.fixed_step == 0.0 and method[INSIDE_AT] > 0
    return may and astray(s, r, b, setting, 0, theta)


@internal
def torn(b, setting, method):
    """Whether the row just measured is off the rows of joints by more than interpolation is, and
    the step may be shorter.

    Stages that only the dense output has may lie where branches nearly meet.
    """
    chosen = setting.fixed_step == 0.0 and method[STEP_AT] > 0
    return b.torn > 0 and chosen and b.h > BRIEF * setting.t_end


@internal
def rows_until(s, r, b, setting, method):
    """Write the output rows of the step at hand; the one at its end is in b.out.

    Returns False, and writes none of them, where a value is not finite, or where rows of joints
    nearly depend on each other: what the dense output is off by is felt 1 / pivot times there, so
    the step is to end at that row, b.until after its start.
    """
    rows, next_row, b.until = r.rows, r.next_row, 0.0
    while r.rows < b.rows.shape[0]:
        t_o = setting.every * r.next_row
        if t_o > b.t1 * (1.0 + 1e-15):
            break
        row = b.rows[r.rows]
        row[0] = t_o
        if at_end(t_o, b.t1):
            copy_to(row[1:], b.out)
            b.row_firm[r.rows] = b.firm[1]
        else:
            measure_inside(s, r, b, t_o, (t_o - b.t) / b.h)
            copy_to(row[1:], s.out)
            b.row_firm[r.rows] = b.firm[0]
            if method[LOOK_AT] > 0:
                call_look(method[LOOK_AT], s, r, b, setting, t_o, 0)
            soon = SOON if b.restless == 0 else SOONEST
            late = t_o - b.t
            if torn(b, setting, method) or (
                late > soon * b.h
                and (felt(s, b, setting, method) or of_none(s, r, b, setting, method, late / b.h))
            ):
                b.until = max(late, soon * b.h)
        if not all_finite(row) or b.until > 0.0:
            r.rows, r.next_row, r.opened = rows, next_row, 0
            return False
        r.rows += 1
        r.next_row += 1
    return True
