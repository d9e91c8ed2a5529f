"""Contact events inside a step: which contact changes its phase first, and where.

The phase (flight or contact) is a discrete state changed here and nowhere else; it is never read
back from the sign of the gap.  That no change of sign inside a step is passed over is proved, not
sampled: with f the distance from the change, of one sign at both ends of a part of the step, and

    |f'| <= L,  f'' >= -M                      bounds on that part             spread.py

there is no zero where (f_0 + f_1 - L l) / 2 > 0, or where the two parabolas that bound f from
below, from either end with its value, its rate and -M, meet above zero.  Where f' cannot change its
sign a change of sign of f is the only one.  A part that proves neither is halved, from the
beginning of the step on, until it would hide no more than what the tolerance allows.
"""

from math import inf

from trsim.assemble.equations import call_one
from trsim.assemble.switches import LIMITS
from trsim.assemble.travel import ANGLES, RATE_OF
from trsim.elements.contract import FLIGHT, UNLOCATED, Memory
from trsim.kernels.lazy import internal
from trsim.solve.march.corners import NONE, any_left, corner_root, show
from trsim.solve.march.illinois import TRIALS, between, is_narrow, narrowed
from trsim.solve.march.spread import spread, spread_at_stages

SAME = 1e-12  # roots closer than this part of a step are one event
HIDDEN = 1e-3  # of the error allowed: how deep a crossing may be that is not looked for
ROUNDING = 1e-15  # of the mechanism's size: what no place is known better than
FINEST = 1e-8  # of a step: no part is shorter
PART = 0.125  # of a step: a part is no longer where no bounds are known
HALVINGS = 60  # in the search for a place away from zero
LOOKS = 4000  # parts of one step that are looked at for one gap
# of the time of a contact: the first step after a touch, at a tolerance of 1 and at most
FIRST, FIRST_WHOLE, MOST_OF = 12.0, 8.0, 0.25
GUESS = 4.0  # of the bends seen at its ends: what is taken for a bound where there is none


@internal
def stays(start, end, bounds, length, kink):
    """Whether f cannot reach zero between two ends where it is positive: f and its rate at each.

    bounds: L, M.  L < 0: none are known; what is seen of f'' is taken for one, enlarged.
    """
    (f0, r0), (f1, r1), (L, M) = start, end, bounds
    if L >= 0.0 and f0 + f1 > L * length:
        return True
    # the least f'' with which these ends go together
    bend = abs(r1 - r0) / length
    bend = max(bend, 2.0 * abs(f1 - f0 - r0 * length) / length**2)
    bend = max(bend, 2.0 * abs(f1 - f0 - r1 * length) / length**2)
    if L < 0.0:
        M = GUESS * bend
    elif f0 + f1 + L * length > 2.0 * kink or through(f0, f1, L, length, kink):
        return False  # it may be on its other branch in between
    M = max(M, bend)
    if not inf > M:
        return False
    both = M * length + r1 - r0
    if both <= 0.0:
        return min(f0, f1) > 0.0
    meet = min(max((f0 - f1 + r1 * length + 0.5 * M * length**2) / both, 0.0), length)
    return f0 + meet * (r0 - 0.5 * M * meet) > 0.0


@internal
def through(f0, f1, L, length, kink):
    """Whether f, positive at both ends, may have been below -kink between them, where its other
    branch begins: a stop that swings through between its limits from one to the other.

    There and back is f0 + f1 + 2 kink; half of what is below zero is left to rounding.
    """
    return L * length - f0 - f1 > kink


@internal
def falls(r0, r1, M, length):
    """Whether f falls all the way between two ends with the rates r, where f'' >= -M."""
    return M >= 0.0 and r1 + max(M, (r0 - r1) / length) * length < 0.0


@internal
def inside(s, r, b, c, theta):
    """Penetration and rate of contact c at theta of the step; counted on, what is watched
    (watch.py)."""
    show(s, r, b, theta)
    t = b.t + theta * b.h
    if c >= s.contact.size:
        return watched(s, t, c - s.contact.size)
    call_one(s, s.gaps, t, s.contact[c])
    return s.gap[s.contact[c], 0], s.gap[s.contact[c], 1]


@internal
def watched(s, t, k):
    """The k-th user event: what it looks at less its value, and the rate, at the scene's poses."""
    entry, value = s.watch[k, 0], s.watch_at[k, 0]
    if s.hear != 0 and s.heard[k] >= 0:  # sampled: of its rate nothing is known
        return s.out[s.heard[k]] - value, 0.0
    if entry <= LIMITS:
        call_one(s, s.gaps, t, LIMITS - entry)
        return s.gap[LIMITS - entry, 0], s.gap[LIMITS - entry, 1]
    if entry < 0:
        return t - value, 1.0
    return s.S[entry, 0] - value, s.S[entry, 1]


@internal
def bracketed_root(s, r, b, c, low, high):
    """Where the gap changes its sign between two places, (theta, gap) each; just behind it."""
    if high[1] == 0.0:
        return high[0]
    rising = high[1] > 0.0
    bracket = (low[0], low[1], high[0], high[1], 0.0)
    for k in range(TRIALS):
        if is_narrow(bracket):
            break
        middle = between(bracket, k)
        f, _ = inside(s, r, b, c, middle)
        if f == 0.0:
            return middle
        bracket = narrowed(bracket, middle, f, rising)
    return bracket[2]


@internal
def hidden_depth(s, r, setting, kind):
    """How far beyond its end something may go that is not looked for, in m or rad by its kind, in
    m/s or rad/s where it is a rate."""
    depth = max(HIDDEN * setting.step_error * r.length, ROUNDING * s.size)
    if kind > RATE_OF:
        depth, kind = max(HIDDEN * setting.step_error, ROUNDING) * r.speed, kind - RATE_OF
    return depth / s.reach if kind in ANGLES else depth


@internal
def hides(M, length, depth):
    """Whether a part of a step is so short that what it may hide is no deeper than what counts."""
    return M >= 0.0 and 0.125 * M * length**2 < depth


@internal
def way_of(s, r, setting, c, sign, beyond):
    """What is looked for of gap c: f = sign * gap, how far it is to go beyond zero, and how deep it
    may go unseen."""
    return c, sign, beyond, hidden_depth(s, r, setting, s.travel[c, 0])


@internal
def fall(s, r, b, way, start, end):
    """Where f, positive at the start, first falls through zero to below -beyond.

    way: see `way_of`; start: theta, f and its rate there.  A theta in (low, end]; NONE where it
    does not.
    """
    (c, sign, beyond, depth), (low, f0, r0) = way, start
    at_low, f_at_low = low, f0  # the last place where it was seen to be positive
    high = end
    over, g_over = NONE, 0.0  # the first place where it was seen to be over
    for _ in range(LOOKS):
        g1, rate = inside(s, r, b, c, high)
        if high == 1.0:
            g1, rate = b.gap1[c, 0], b.gap1[c, 1]
        f1, r1, length = sign * g1, sign * rate, (high - low) * b.h
        L, M = spread(s, r, b, s.travel[c], sign, (low, high))
        short = high - low < FINEST or (
            hides(M, length, depth) and not through(f0, f1, L, length, s.kink[c])
        )
        least = 0.0 if high >= end else beyond  # at an end what comes after is not known
        if f1 < -least or (f1 == 0.0 and least == 0.0 and r1 < 0.0):
            over, g_over = high, g1
            if short or falls(r0, r1, M, length) or (M < 0.0 and high - low <= PART):
                return bracketed_root(s, r, b, c, (at_low, sign * f_at_low), (high, g1))
        elif short or (
            (M >= 0.0 or high - low <= PART)
            and stays((f0 + beyond, r0), (f1 + beyond, r1), (L, M), length, s.kink[c])
        ):
            if high >= end:
                return NONE
            step = 2.0 * (high - low)
            low, f0, r0 = high, f1, r1
            if f1 > 0.0:
                at_low, f_at_low = low, f1
            high = min(end, low + step)
            continue
        high = 0.5 * (low + high)
    r.unproved += 1
    if over < NONE and f_at_low > 0.0:  # not proved to be the first one, but one there is
        return bracketed_root(s, r, b, c, (at_low, sign * f_at_low), (over, g_over))
    return NONE


@internal
def noise(s, f0):
    """How far below zero a gap is that has just been brought to it and left at f0."""
    return max(8.0 * abs(f0), ROUNDING * s.size)


@internal
def leaves(s, r, b, way, start, end):
    """A place behind the start, where f is about zero, at which it is above `beyond`; -1 for none.

    way, start: see `fall`.
    """
    (c, sign, beyond, depth), (low, f0, r0) = way, start
    at, rate = low, r0
    for trial in range(2):
        if rate > 0.0 or trial == 0:
            reach, M = end, inf
            for _ in range(HALVINGS):
                L, M = spread(s, r, b, s.travel[c], sign, (at, reach))
                # not as far as to its other branch: bounds hold on one
                if inf > M and not f0 + L * (reach - at) * b.h > s.kink[c]:
                    break
                reach = at + 0.5 * (reach - at)
            # f >= f_0 + r_0 tau - M tau^2 / 2 is largest there; what is not known is looked at soon
            place = min(reach, at + rate / (M * b.h)) if M > 0.0 else reach
            if M < 0.0:
                place = at + PART**2 * (end - at)
            place = max(place, at + FINEST * (end - at))
            for _ in range(HALVINGS):
                g, _ = inside(s, r, b, c, place)
                if sign * g > beyond:
                    return place
                # no deeper than rounding has it, it is still on its way
                if place >= end or sign * g < -noise(s, f0):
                    break
                place = min(end, at + 2.0 * (place - at))
        if at > low or f0 >= 0.0:
            break
        # below zero: where it rises through zero, if it does
        at = fall(s, r, b, (c, -sign, 0.0, depth), (low, -f0, -r0), end)
        if at >= end:
            break
        _, rate = inside(s, r, b, c, at)
        rate *= sign
    return -1.0


@internal
def change(s, r, b, setting, c, end):
    """Where contact c first changes its phase up to `end`, as theta; NONE if it does not."""
    sign = -1.0 if Memory(r, s.contact[c]).phase == FLIGHT else 1.0
    way = way_of(s, r, setting, c, sign, 0.0)
    low, f0, r0 = 0.0, sign * r.gap[c, 0], sign * r.gap[c, 1]
    if f0 <= 0.0:
        # it begins on the event just handled, and first moves away
        low = leaves(s, r, b, way, (0.0, f0, r0), end)
        if low < 0.0:
            # a step that other events make short may end while it is still on its way; so may the
            # first one of what begins at rest just where it touches
            g, rate = inside(s, r, b, c, end)
            slow = ROUNDING * r.speed
            away = r0 > 0.0 or (r0 >= -slow and sign * rate > 0.0)
            still = abs(r0) <= slow and abs(rate) <= slow  # two that touch and rest
            return NONE if (away or still) and sign * g >= -noise(s, f0) else 0.0
        g, rate = inside(s, r, b, c, low)
        f0, r0 = sign * g, sign * rate
    if low >= end:
        return NONE
    return fall(s, r, b, way, (low, f0, r0), end)


@internal
def may_change(s, r, b, c, stages):
    """Whether contact c may change its phase in the step, as far as is known without looking."""
    phase = Memory(r, s.contact[c]).phase
    if phase == UNLOCATED:
        return False
    sign = -1.0 if phase == FLIGHT else 1.0
    f0, r0 = sign * r.gap[c, 0], sign * r.gap[c, 1]
    f1, r1 = sign * b.gap1[c, 0], sign * b.gap1[c, 1]
    if f1 <= 0.0 or stages == 0:
        return True
    bounds = spread_at_stages(s, r, b, s.travel[c], sign)
    return not stays((max(f0, 0.0), r0), (f1, r1), bounds, b.h, s.kink[c])


@internal
def first_change(s, r, b, setting):
    """Fill b.root and b.corner_root of contacts that change and return the earliest; needs b.P,
    b.net."""
    first = NONE
    for c in range(s.contact.size):
        if Memory(r, s.contact[c]).phase != UNLOCATED:
            b.corner_root[c] = corner_root(s, r, b, c)
            first = min(first, b.corner_root[c])
    for c in range(s.contact.size):
        if Memory(r, s.contact[c]).phase != UNLOCATED:
            b.root[c] = change(s, r, b, setting, c, min(first + SAME, 1.0))
            first = min(first, b.root[c])
    return first


@internal
def any_change(s, r, b, stages):
    """Whether the step must be searched at all."""
    for c in range(s.contact.size):
        if may_change(s, r, b, c, stages):
            return True
    return any_left(s, r, b)


@internal
def hertz_step(stiffness, exponent, mass, speed, tolerance):
    """First step after a touch, a part of the time of contact.

    Unless n is whole, a force d^n has only so many derivatives at the touch: over a first step h
    the velocity is off by h^(n+1) whatever the order of the method, and its estimate of the error
    may not see it.  So h goes with the tolerance to the power 1 / (n + 1).
    """
    # depth of a lossless impact: K d^(n+1) / (n+1) = m v^2 / 2
    depth = ((exponent + 1.0) * mass * speed * speed / (2.0 * stiffness)) ** (1 / (exponent + 1.0))
    if exponent == int(exponent):
        part = FIRST_WHOLE * tolerance ** (1.0 / 3.0)
    else:
        part = FIRST * tolerance ** (1.0 / (exponent + 1.0))
    return min(part, MOST_OF) * 2.94 * depth / speed
