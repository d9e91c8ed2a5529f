"""Corners of functions: where they are, on which piece a function is, and whether it stays there.

A corner is known by its place in tab, of what is held there (functions.py).  Interval arithmetic
(ranges.py) encloses what its u does in a stretch of time, from the ranges of the sensors.
"""

import math

from trsim.kernels.lazy import internal
from trsim.laws.functions import (
    BY_SENSORS,
    EXPRESSION,
    HEAD,
    HELD,
    HELD_OF_TABLE,
    N_IN,
    OF_TABLE,
    POINTS,
    SLOTS,
    TABLE,
    VARIABLE,
    WATCHED,
    WIDTH,
    inputs,
    operands,
    operations,
    run,
    value_and_rate,
)
from trsim.laws.operations import (
    ABOVE,
    ATAN2,
    BELOW,
    EXP,
    FREE,
    MUL,
    NEG,
    POW,
    SUB,
    beside,
    branch_at,
    branch_ends,
    switching,
)
from trsim.laws.ranges import ranged
from trsim.laws.tables import interval_at, interval_ends

CLEAR, MEETS, UNSURE = 0, 1, 2


@internal
def sensed(tab, o, place):
    """Whether sensors meet a corner."""
    if tab[o] == TABLE:
        return tab[o + VARIABLE] >= 0.0
    return tab[place - HELD + WATCHED] == BY_SENSORS


@internal
def corner(tab, o, place, S):
    """u of a corner that sensors meet, its rate, and the size of what u is the difference of.

    As `located` left them in the slots.
    """
    if tab[o] == TABLE:
        k = int(tab[o + VARIABLE])
        return S[k, 0], S[k, 1], abs(S[k, 0])
    code, a, b = operands(tab, o, place - HELD)
    if code == ATAN2 or code >= NEG:
        return tab[a], tab[a + 1], abs(tab[a])
    return tab[a] - tab[b], tab[a + 1] - tab[b + 1], abs(tab[a]) + abs(tab[b])


@internal
def located(tab, o, t, S):
    """Fill the slots of an expression with values and rates at t."""
    if tab[o] == EXPRESSION:
        value_and_rate(tab, o, t, S)


@internal
def ends_of(tab, o, place):
    """Between which u the piece lies that is held."""
    held = tab[place]
    if tab[o] != TABLE:
        return branch_ends(int(tab[place - HELD]), held)
    if held == FREE:
        return -math.inf, math.inf
    return interval_ends(tab, o + OF_TABLE, int(tab[o + POINTS]), held)


@internal
def piece_at(tab, o, place, u):
    """The piece that u is on; at a corner the one above."""
    if tab[o] == TABLE:
        return interval_at(tab, o + OF_TABLE, int(tab[o + POINTS]), u)
    return branch_at(int(tab[place - HELD]), u)


@internal
def neighbour(tab, o, place, above):
    """The piece next to the one that is held."""
    held = tab[place]
    if tab[o] == TABLE:
        if above:
            return 1.0 if held < 0.0 else held + 1.0
        return held - 1.0 if held > 1.0 else -1.0
    return beside(int(tab[place - HELD]), held, above)


@internal
def brief(tab, o, place):
    """Whether the piece that is held may be a short event: exp between its outer edges."""
    held = tab[place]
    if tab[o] == TABLE or int(tab[place - HELD]) != EXP:
        return False
    return held != FREE and held != BELOW and held != ABOVE


@internal
def judged(u, ranges, low, high):
    """Whether u stays between low and high, with these ranges of it and its rate; it ends at u."""
    (l, h), rate = ranges
    if low < l and h < high:
        return CLEAR
    if not (rate[0] > 0.0 or rate[1] < 0.0):
        return UNSURE
    return MEETS if u < low or u > high else CLEAR


@internal
def in_row(row):
    """The ranges of a number and of its rate that stand in a row."""
    return (row[0], row[1]), (row[2], row[3])


@internal
def into_row(row, ranges):
    """The opposite."""
    (row[0], row[1]), (row[2], row[3]) = ranges


@internal
def enclosed(tab, o, stretch, S, seen, box):
    """Whether a function stays on its pieces in a stretch of time, at whose end its sensors show S.

    Parameters
    ----------
    tab, o, S                as in `value`
    stretch : (float, float) its begin and its end, s
    seen : (n_s, 4)          ranges of the sensors and of their rates meanwhile
    box : (n_slots, 4)       scratch: those of the slots

    Returns
    -------
    int                      CLEAR; MEETS one, whose u' has one sign meanwhile; UNSURE
    """
    if tab[o] == TABLE:
        k = int(tab[o + VARIABLE])
        low, high = ends_of(tab, o, o + HELD_OF_TABLE)
        return judged(S[k, 0], in_row(seen[k]), low, high)
    inputs(tab, o, stretch[1], S)
    run(tab, o)
    for i in range(int(tab[o + N_IN])):
        into_row(box[i + 1], in_row(seen[int(tab[o + HEAD + i])]))
    ranges_of(tab, o, stretch, box)
    worst, first = CLEAR, o + int(tab[o + SLOTS])
    n_op, p, _ = operations(tab, o)
    for _ in range(n_op):
        code, slot_a, slot_b = operands(tab, o, p)
        held = tab[p + HELD]
        if tab[p + WATCHED] == BY_SENSORS and held != FREE:
            x, y = in_row(box[(slot_a - first) // 3]), in_row(box[(slot_b - first) // 3])
            low, high = branch_ends(code, held)
            u = switching(code, tab[slot_a], tab[slot_b])
            of_u = x if code == ATAN2 or code >= NEG else ranged(SUB, x, y, FREE)
            worst = max(worst, judged(u, of_u, low, high))
        p += WIDTH
    return worst


@internal
def ranges_of(tab, o, stretch, box):
    """The ranges of all slots of an expression and of their rates in a stretch of time, of which
    box holds those of the sensors."""
    first = o + int(tab[o + SLOTS])
    n, p, out = operations(tab, o)
    into_row(box[0], (stretch, (1.0, 1.0)))
    k = (out - first) // 3
    for place in range(out + 3 * n, min(tab.size, first + 3 * box.shape[0]), 3):
        into_row(box[(place - first) // 3], ((tab[place], tab[place]), (0.0, 0.0)))
    for _ in range(n):
        code, slot_a, slot_b = operands(tab, o, p)
        x, y = in_row(box[(slot_a - first) // 3]), in_row(box[(slot_b - first) // 3])
        if code == MUL and slot_a == slot_b:  # a square is never negative
            code, y = POW, ((2.0, 2.0), (0.0, 0.0))
        into_row(box[k], ranged(code, x, y, tab[p + HELD]))
        p += WIDTH
        k += 1
