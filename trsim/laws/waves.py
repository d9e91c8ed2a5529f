"""Waves and pulses in functions: how fast they may swing, so that none is passed over.

    w = sup |u'| + w_u               of a sine, a cosine or a tangent of u
    w = w_a + w_b                    of a product
    w = w_a + max(w_b, sup |b'| / inf |b|)     of a/b: 1/(1 + u^2) is a pulse 1/|u'| long
    w = max(w_a, sup |a'| / inf |a|)           of log a
    w = max(w_a, w_b, sup |f'|)      of an angle f = atan2(a, b): two of them may cancel out
    w = n max(w_a, sup |a'| / sup |a|)         of a^n from the 9th power on; inf |a| of n < 0
    w = n w_a                        of lower powers, which have few turns of their own
    w = max(w_a, w_b)                of all else; what else may be short has corners (operations.py)

in rad/s; of quotients, logarithms and high powers only where these may turn back.  Ranges are those
of interval arithmetic (ranges.py), so that what is fast anywhere in a stretch of time counts, not
only what is so at its ends.  What is nothing there does not swing.
"""

from math import inf

from trsim.kernels.lazy import internal
from trsim.laws.corners import in_row, into_row, ranges_of
from trsim.laws.functions import (
    EXPRESSION,
    HEAD,
    N_IN,
    N_OP,
    RESULT,
    SLOTS,
    WIDTH,
    operands,
    operations,
)
from trsim.laws.operations import ATAN2, COS, DIV, LOG, MUL, POW, SIN, TAN

LOW = 8.0  # power: those that have few turns
NOTHING = 1e-100  # what is smaller throughout does not swing
BETWEEN = 1.6  # of its mean rate: the largest of half a wave is pi/2 of it


def waves(code):
    """Whether a function, as numbers for `tab`, has something of its own that may swing."""
    return pulses(code) or has(code, (SIN, COS, TAN))


def has(code, operations):
    """Whether a function has one of some operations."""
    if code[0] != EXPRESSION:
        return False
    first = HEAD + int(code[N_IN])
    return any(code[p] in operations for p in range(first, int(code[SLOTS]), WIDTH))


def pulses(code):
    """Whether it has something that may be short and is no wave: what divides, high powers, log,
    angles."""
    if code[0] != EXPRESSION:
        return False
    slots, first = int(code[SLOTS]), HEAD + int(code[N_IN])
    constants = slots + 3 * (1 + int(code[N_IN]) + int(code[N_OP]))
    for p in range(first, slots, WIDTH):
        op, b = code[p], int(code[p + 2])
        if op in (LOG, ATAN2) or (op == DIV and b < constants):
            return True
        if op == POW and b >= constants and not 0.0 <= code[b] <= LOW:
            return True
    return False


@internal
def swing(tab, o, stretch, before, behind, own):
    """How fast an expression may swing in a stretch of time, in rad/s of the fastest wave in it.

    Where nothing bounds it between, as beside a pole, that of both ends.

    Parameters
    ----------
    tab, o                   as in `value`
    stretch : (float, float) when it begins, and how long it is, s
    before, behind           (n_s,), (n_s,): what sensors show at its ends, and its rates
    own                      waves: 1, or 0 where pulses alone are asked for; and
                             (n_slots, 4) scratch: ranges of the slots
    """
    w = swing_within(tab, o, stretch, before, behind, own)
    if w < inf:
        return w
    first = swing_within(tab, o, (stretch[0], 0.0), before, before, own)
    last = swing_within(tab, o, (stretch[0] + stretch[1], 0.0), behind, behind, own)
    return max(first if first < inf else 0.0, last if last < inf else 0.0)


@internal
def swing_within(tab, o, stretch, before, behind, own):
    """The same; infinite where nothing bounds it."""
    (t, length), (sines, box), first = stretch, own, o + int(tab[o + SLOTS])
    tab[first + 2] = 0.0
    for i in range(int(tab[o + N_IN])):
        k = int(tab[o + HEAD + i])
        seen(box[i + 1], length, (before[0][k], before[1][k]), (behind[0][k], behind[1][k]))
        tab[first + 3 * (i + 1) + 2] = 0.0
    ranges_of(tab, o, (t, t + length), box)
    n, p, out = operations(tab, o)
    for _ in range(n):
        code, a, b = operands(tab, o, p)
        x, y = box[(a - first) // 3], box[(b - first) // 3]
        if sines > 0 or code not in (SIN, COS, TAN):
            f_rate = in_row(box[(out - first) // 3])[1]
            w = swinging(code, (tab[a + 2], in_row(x)), (tab[b + 2], in_row(y)), f_rate)
        else:
            w = tab[a + 2]
        f, _ = in_row(box[(out - first) // 3])
        tab[out + 2] = w if largest(f) > NOTHING else 0.0
        p += WIDTH
        out += 3
    return tab[o + int(tab[o + RESULT]) + 2]


@internal
def swinging(code, x, y, f_rate):
    """w of an operation, from w and the ranges of a and b, and that of its rate."""
    (w_a, (a, a_rate)), (w_b, (b, b_rate)) = x, y
    turns = f_rate[0] < 0.0 < f_rate[1]  # what rises or falls throughout is no pulse
    if code in (SIN, COS, TAN):
        return largest(a_rate) + w_a
    if code == MUL:
        return w_a + w_b
    if code == DIV:
        return w_a + max(w_b, ratio(largest(b_rate), least(b)) if turns else 0.0)
    if code == LOG:
        return max(w_a, ratio(largest(a_rate), least(a)) if turns else 0.0)
    if code == ATAN2:
        return max(max(w_a, w_b), largest(f_rate))
    if code == POW and largest(b_rate) == 0.0:
        if 0.0 <= b[0] <= LOW:
            return w_a * max(b[0], 1.0)
        size = largest(a) if b[0] > 0.0 else least(a)
        return abs(b[0]) * max(w_a, ratio(largest(a_rate), size) if turns else 0.0)
    return max(w_a, w_b)


@internal
def largest(ranges):
    """The largest size in a range."""
    return max(-ranges[0], ranges[1])


@internal
def least(ranges):
    """The least one."""
    return max(max(ranges[0], -ranges[1]), 0.0)


@internal
def ratio(rate, size):
    """0 of what rests."""
    return rate / size if rate > 0.0 else 0.0


@internal
def seen(row, length, before, behind):
    """About the ranges of a sensor and of its rate between two instants."""
    (s0, rate0), (s1, rate1) = before, behind
    low, high = min(rate0, rate1), max(rate0, rate1)
    if length > 0.0:  # what begins and ends at rest goes faster between
        mean = BETWEEN * (s1 - s0) / length
        low, high = min(low, mean), max(high, mean)
    most = length * max(-low, high)
    spread = max(0.5 * (most - abs(s1 - s0)), 0.0)
    into_row(row, ((min(s0, s1) - spread, max(s0, s1) + spread), (low, high)))
