"""Output rows inside a step: its channels at the times that are due."""

from trsim.kernels.vectors import all_finite, copy_to, internal
from trsim.solve.march.calls import LOOK_AT, call_look
from trsim.solve.march.dense_output import measure_inside


@internal
def due(r, setting, t1):
    """Whether an output time lies at or before t1."""
    return setting.every * r.next_row <= t1 * (1.0 + 1e-15)


@internal
def at_end(t_o, t1):
    """Whether an output time is the end of the step, as far as rounding can tell."""
    return t_o >= t1 * (1.0 - 2e-15)


@internal
def rows_until(s, r, b, setting, method):
    """Write the output rows of the step at hand; the one at its end is in b.out.

    Returns False, and writes none of them, where a value is not finite.
    """
    rows, next_row = r.rows, r.next_row
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
        if not all_finite(row):
            r.rows, r.next_row, r.opened = rows, next_row, 0
            return False
        r.rows += 1
        r.next_row += 1
    return True
