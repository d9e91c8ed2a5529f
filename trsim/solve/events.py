"""Contact events inside a step: which contact changes its phase first, and where.

The phase (flight or contact) is a discrete state changed here and nowhere else; it is never read
back from the sign of the gap.  A step is searched where the gap has the wrong sign at its end, or
where its rate turns inside the step and the cubic through both ends may reach zero (a touch between
two points in flight, a separation between two points in contact).
"""

from trsim.assemble.equations import call_one, poses
from trsim.assemble.switches import LIMITS
from trsim.elements.contract import CONTACT, FLIGHT, PHASE, UNLOCATED
from trsim.elements.vectors import internal
from trsim.solve.calls import call_interpolate
from trsim.solve.corners import any_left, corner_root
from trsim.solve.illinois import between, narrowed

NONE = 2.0  # a root beyond the step
SAME = 1e-12  # roots closer than this part of a step are one event
MARGIN = 0.2  # of the gap's change over the step: how near to zero a cubic must come


@internal
def suspicious(phase, d0, r0, d1, r1, h):
    """Whether a contact may change its phase in a step from (d0, r0) to (d1, r1)."""
    if phase == FLIGHT:
        return d1 > 0.0 or (r0 > 0.0 > r1 and turning_value(d0, r0, d1, r1, h) > 0.0)
    return d1 <= 0.0 or (r0 < 0.0 < r1 and -turning_value(-d0, -r0, -d1, -r1, h) < 0.0)


@internal
def turning_value(d0, r0, d1, r1, h):
    """An upper bound of the cubic Hermite's maximum between a rising and a falling end."""
    theta = r0 / (r0 - r1)  # where the rate, taken linear, is zero
    a, b = h * r0 - (d1 - d0), -h * r1 + (d1 - d0)
    top = d0 + theta * (d1 - d0) + theta * (1.0 - theta) * ((1.0 - theta) * a + theta * b)
    return top + MARGIN * (abs(top - d0) + abs(top - d1))


@internal
def inside(s, P, y, t, h, theta, c, scratch, interpolate):
    """Penetration and rate of contact c at t + theta h; counted on, what is watched (watch.py)."""
    call_interpolate(interpolate, P, y, theta, scratch)
    poses(s, scratch)
    if c >= s.contact.size:
        entry, value = s.watch[c - s.contact.size, 0], s.watch_at[c - s.contact.size, 0]
        if entry <= LIMITS:
            call_one(s, s.gaps, t + theta * h, LIMITS - entry)
            return s.gap[LIMITS - entry, 0], s.gap[LIMITS - entry, 1]
        if entry < 0:
            return t + theta * h - value, 1.0
        return s.S[entry, 0] - value, s.S[entry, 1]
    e = s.contact[c]
    call_one(s, s.gaps, t + theta * h, e)
    return s.gap[e, 0], s.gap[e, 1]


@internal
def bracketed_root(s, P, y, t, h, c, scratch, interpolate, low, high, column, rising):
    """Where the value (column 0) or rate (1) of `inside` changes sign between low and high.

    rising: the sign at `high` is positive.
    """
    f_low = inside(s, P, y, t, h, low, c, scratch, interpolate)[column]
    f_high = inside(s, P, y, t, h, high, c, scratch, interpolate)[column]
    bracket = (low, f_low, high, f_high, 0.0)
    for k in range(200):
        if bracket[2] - bracket[0] <= 4e-16 * max(1.0, bracket[2]):
            break
        middle = between(bracket, k)
        f = inside(s, P, y, t, h, middle, c, scratch, interpolate)[column]
        if f == 0.0:
            return middle
        bracket = narrowed(bracket, middle, f, rising)
    return bracket[2]


@internal
def root(s, P, y, t, h, end, c, phase, d0, r0, d1, r1, scratch, interpolate):
    """The first event of contact c up to `end`, as theta in (0, end]; NONE if there is none.

    d1, r1: penetration and rate at `end`.
    """
    toward = phase == FLIGHT  # the gap rises through zero at a touch
    sign = 1.0 if toward else -1.0
    low, high = 0.0, end
    if sign * d1 <= 0.0 and not (d1 == 0.0 and not toward):
        # no wrong sign at the end: look at the extremum inside
        if not (sign * r0 > 0.0 > sign * r1):
            return NONE
        high = bracketed_root(s, P, y, t, h, c, scratch, interpolate, 0.0, end, 1, r1 > 0.0)
        top = inside(s, P, y, t, h, high, c, scratch, interpolate)[0]
        if sign * top <= 0.0:
            return NONE
    if sign * d0 >= 0.0:
        # the step starts on the event just handled: the gap first moves away and comes back
        if sign * r0 >= 0.0:
            return 0.0
        f = 1.0
        for _ in range(60):  # from the end backwards to a point on the right side
            f *= 0.5
            if sign * inside(s, P, y, t, h, f * high, c, scratch, interpolate)[0] < 0.0:
                low = f * high
                break
        if low == 0.0:
            return 0.0
    return bracketed_root(s, P, y, t, h, c, scratch, interpolate, low, high, 0, toward)


@internal
def first_event(s, r, b, t, h, interpolate):
    """Fill b.root for all contacts and return the earliest; needs b.P."""
    first = NONE
    for c in range(s.contact.size):
        b.root[c] = NONE
        if r.mem[s.contact[c], PHASE] == UNLOCATED:
            b.corner_root[c] = NONE
            continue
        b.corner_root[c] = corner_root(s, r, b, t, h, c, interpolate)
        phase = r.mem[s.contact[c], PHASE]
        d0, r0, d1, r1 = r.gap[c, 0], r.gap[c, 1], b.gap1[c, 0], b.gap1[c, 1]
        if suspicious(phase, d0, r0, d1, r1, h):
            b.root[c] = root(
                s, b.P, r.y, t, h, 1.0, c, phase, d0, r0, d1, r1, b.y2, interpolate
            )  # fmt: skip
        first = min(first, b.root[c], b.corner_root[c])
    return first


@internal
def settled(s, r, b, t, h, first, interpolate):
    """The earliest event, at which no contact is on the wrong side of zero.

    A trial step goes on as if nothing happened at `first`; what it makes of the motion behind may
    bring a contact to touch before and leave again after, which its ends do not show.  So all are
    looked at where the step will be cut, and searched up to there.
    """
    for _ in range(s.contact.size):
        if first > 1.0:
            break
        before = first
        for c in range(s.contact.size):
            phase = r.mem[s.contact[c], PHASE]
            if phase == UNLOCATED or b.root[c] <= before:
                continue
            d, rate = inside(s, b.P, r.y, t, h, before, c, b.y2, interpolate)
            if (d > 0.0) == (phase == FLIGHT) and d != 0.0:
                b.root[c] = root(
                    s, b.P, r.y, t, h, before, c, phase, r.gap[c, 0], r.gap[c, 1], d, rate,
                    b.y2, interpolate,
                )  # fmt: skip
                first = min(first, b.root[c])
        if first == before:
            break
    return first


@internal
def any_suspicious(s, r, b, h):
    """Whether the step must be searched at all."""
    for c in range(s.contact.size):
        phase = r.mem[s.contact[c], PHASE]
        if phase != UNLOCATED and suspicious(
            phase, r.gap[c, 0], r.gap[c, 1], b.gap1[c, 0], b.gap1[c, 1], h
        ):
            return True
    return any_left(s, r, b)


@internal
def hertz_step(stiffness, exponent, mass, speed, tolerance):
    """First step after a touch: 0.02 of the contact time times tolerance^(1/3)."""
    # depth of a lossless impact: K d^(n+1) / (n+1) = m v^2 / 2
    depth = ((exponent + 1.0) * mass * speed * speed / (2.0 * stiffness)) ** (1 / (exponent + 1.0))
    return 0.02 * 2.94 * depth / speed * tolerance ** (1.0 / 3.0)


@internal
def flip(phase):
    """The other phase."""
    return CONTACT if phase == FLIGHT else FLIGHT
