"""Functions without a value: a step that passes a pole, or leaves where a root or a logarithm is.

Every u of assemble/poles.py is followed through the step that is to be accepted.  A part of it is
clear where the ranges of u (laws/ranges.py) keep to one side, or u rises or falls and has one sign
at both ends; every other one is halved, and in a SHORT one the least u is sought.

    u passes zero, or touches it     looked at from near by: f grows as fast as 1/u, or is no number
                                     it keeps its size, as sin(u)/u does

What grows so has no integral: whatever a method made of it would be wrong.  The step is made
shorter until it begins just before, and then the run ends there.
"""

from math import isfinite

from trsim.assemble.equations import evaluate, set_poses
from trsim.assemble.poles import AT, DOMAIN, DRIVE, KIND, OF, RESTS
from trsim.elements.contract import compiled
from trsim.elements.prescribed import began
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_table
from trsim.laws.corners import in_row, ranges_of
from trsim.laws.functions import HEAD, N_IN, RESULT, SLOTS, value
from trsim.laws.waves import seen
from trsim.solve.march.calls import LAST_AT, SEARCH
from trsim.solve.march.corners import NONE, show
from trsim.solve.march.dense_output import build
from trsim.solve.march.illinois import TRIALS, between, is_narrow, narrowed

BRIEF = 1e-9  # of a run: so near to a pole it ends
SHORT = 1.0 / 256.0  # of a step: in a part so short u has one lowest point
LOOKS = 4000  # parts of a step
GOLDEN, NARROWED = 0.6180339887498949, 60  # how often a part is, by the golden section
NEAR = (1e-2, 1e-4, 1e-6)  # of a step: how far off a function is looked at
ROUNDING, APART = 2.2e-16, 60.0  # roundings of the time: what those must be apart
GROWS = 2.0 / 3.0  # from which power of 1/u on
NOTHING = 1e-9  # of what a function does in a step: as much is made of rounding where u is zero


@compiled(SEARCH)
def poles_ahead(s, r, b, setting, method):
    """Where in the step at hand, whose end was evaluated last, a function first has no value.

    As theta; NONE, the scene is then again as evaluated there.  Sets r.pole where no shorter step
    is to be tried.
    """
    first, whose, evaluations = NONE, -1, s.status[1]
    for k in range(s.pole.shape[0]):
        at = first_of(s, r, b, method, k)
        if at < first:
            first, whose = at, k
    if first < NONE:
        distance = first * b.h
        if setting.fixed_step > 0.0 or distance <= BRIEF * setting.t_end:
            r.pole, r.pole_t = 1 + whose, b.t + distance
        return first
    if s.status[1] > evaluations:
        evaluate(s, b.t1, b.y1, b.K[method[LAST_AT]])
    else:
        set_poses(s, b.y1)
    return NONE


@internal
def first_of(s, r, b, method, k):
    """The same of one u; NONE too of a motion that no drive follows, and of a load that rests."""
    if s.pole[k, KIND] == RESTS:
        return NONE
    since = began(s, s.pole[k, DRIVE], s.pole[k, OF])
    if since < 0.0:
        return NONE
    for c in range(b.pole_first.shape[0]):
        b.pole_first[c, 0], b.pole_first[c, 1] = r.branch[c], r.turning[c]
        b.pole_last[c, 0], b.pole_last[c, 1] = b.branch1[c], b.turning1[c]
    t, low, high, last = b.t - since, 0.0, (b.t1 - b.t) / b.h, (b.t1 - b.t) / b.h
    for _ in range(LOOKS):
        if not clear(s, b, (k, t), (low, high)):
            if b.built == 0:
                build(s, r, b, method)
            if high - low > SHORT:
                high = 0.5 * (low + high)
                look(s, r, b, high)
                continue
            at = met(s, r, b, (k, t), (low, high))
            if at >= 0.0 and unbounded(s, r, b, (k, t), at):
                return at
            look(s, r, b, high)
        if high >= last:
            return NONE
        low, high = high, min(last, high + 2.0 * (high - low))
        copy_table(b.pole_first, b.pole_last)
        look(s, r, b, high)
    return NONE


@internal
def look(s, r, b, theta):
    """What sensors show at theta of the step, into the far end of a part."""
    show(s, r, b, theta)
    for c in range(b.pole_last.shape[0]):
        b.pole_last[c, 0], b.pole_last[c, 1] = s.S[c, 0], s.S[c, 1]


@internal
def clear(s, b, what, part):
    """Whether u stays where it may be in a part of a step, at whose ends the sensors are known.

    what: which u, and when the step begins by its own clock, s.
    """
    k, t = what
    tab, o, box = s.tab, s.pole[k, AT], b.pole_box
    t0, t1 = t + part[0] * b.h, t + part[1] * b.h
    u0, u1 = value(tab, o, t0, b.pole_first), value(tab, o, t1, b.pole_last)
    for i in range(int(tab[o + N_IN])):
        c = int(tab[o + HEAD + i])
        before = (b.pole_first[c, 0], b.pole_first[c, 1])
        seen(box[i + 1], t1 - t0, before, (b.pole_last[c, 0], b.pole_last[c, 1]))
    ranges_of(tab, o, (t0, t1), box)
    (least, most), rate = in_row(box[(int(tab[o + RESULT]) - int(tab[o + SLOTS])) // 3])
    one_way = rate[0] >= 0.0 or rate[1] <= 0.0
    if s.pole[k, KIND] == DOMAIN:
        return least >= 0.0 or (one_way and u0 >= 0.0 and u1 >= 0.0)
    if least > 0.0 or most < 0.0:
        return True
    return one_way and ((u0 > 0.0 and u1 > 0.0) or (u0 < 0.0 and u1 < 0.0))


@internal
def u_at(s, r, b, what, theta):
    """u at theta of the step."""
    k, t = what
    show(s, r, b, theta)
    return value(s.tab, s.pole[k, AT], t + theta * b.h, s.S)


@internal
def met(s, r, b, what, part):
    """Where u passes zero in a short part of the step, or comes nearest to it; -1: it has no lowest
    place inside and passes none."""
    low, high = part
    before = u_at(s, r, b, what, low)
    side = 1.0 if before >= 0.0 or s.pole[what[0], KIND] == DOMAIN else -1.0
    after = u_at(s, r, b, what, high)
    if side * after < 0.0:
        return root(s, r, b, what, (low, before), (high, after))
    if side * before < 0.0:
        return -1.0  # of a domain: it is outside, where the function has had a value
    a, c = low, high
    x, y = c - GOLDEN * (c - a), a + GOLDEN * (c - a)
    f_x, f_y = side * u_at(s, r, b, what, x), side * u_at(s, r, b, what, y)
    for _ in range(NARROWED):
        if f_x < 0.0 or f_y < 0.0:
            beyond = (x, side * f_x) if f_x < 0.0 else (y, side * f_y)
            return root(s, r, b, what, (low, before), beyond)
        if f_x < f_y:
            c, y, f_y = y, x, f_x
            x = c - GOLDEN * (c - a)
            f_x = side * u_at(s, r, b, what, x)
        else:
            a, x, f_x = x, y, f_y
            y = a + GOLDEN * (c - a)
            f_y = side * u_at(s, r, b, what, y)
    lowest = 0.5 * (x + y)
    return lowest if low < a and c < high else -1.0


@internal
def root(s, r, b, what, low, high):
    """Where u, on one side of zero or at it at the first of two places and beyond it at the other,
    (theta, u) each, has just passed it."""
    sign = 1.0 if high[1] > 0.0 else -1.0
    bracket = (low[0], sign * low[1], high[0], sign * high[1], 0.0)
    for n in range(TRIALS):
        if is_narrow(bracket):
            break
        middle = between(bracket, n)
        bracket = narrowed(bracket, middle, sign * u_at(s, r, b, what, middle), True)
    return bracket[2]


@internal
def unbounded(s, r, b, what, at):
    """Whether the function grows as fast as 1/u towards a place, or has no number beside it."""
    if s.pole[what[0], KIND] == DOMAIN and not isfinite(function_at(s, r, b, what, at)):
        return True
    last, nearest = (b.t1 - b.t) / b.h, APART * ROUNDING * abs(b.t1) / b.h
    far, near = max(NEAR[1], nearest), max(NEAR[2], nearest)
    size = before = behind = 0.0
    for side in (-1.0, 1.0):
        if not 0.0 <= at + side * NEAR[0] <= last:
            continue
        f0 = function_at(s, r, b, what, at + side * NEAR[0])
        f1 = function_at(s, r, b, what, at + side * far)
        f2 = function_at(s, r, b, what, at + side * near)
        if not isfinite(f0 + f1 + f2):
            return True
        size = max(size, abs(f0))
        before, behind = max(before, abs(f1 - f0)), max(behind, abs(f2 - f1))
    return behind > before * (far / near) ** GROWS and behind * near > NOTHING * size


@internal
def function_at(s, r, b, what, theta):
    """What becomes of u: the function at theta of the step."""
    k, t = what
    show(s, r, b, theta)
    return value(s.tab, s.pole[k, OF], t + theta * b.h, s.S)
