"""User events that watch a channel: a force, a reaction, an energy, a rate.

Of a channel no bounds are known inside a step, so it is sampled, not bounded: at the parts of
sampled.py, and at the bottom of what dips towards the value between three of them.  The event is
the root on the dense output; its step is made again to end there.

As in watch.py the side a channel is on is a discrete state, AT the value where an event left it.
What jumps over the value, where a load begins or another event changes the equations, crosses it
there: a pin that is torn by a blow is torn.
"""

from trsim.elements.contract import compiled
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import LAST_AT, SOUND
from trsim.solve.march.events import NONE, SAME
from trsim.solve.march.record import SIDE, SLOPE, TIMES
from trsim.solve.march.sampled import dip, parts_of, root, value, waves_of
from trsim.solve.march.watch import ABOVE, AT, BELOW, DIRECTION, MOST, VALUE, band_of

SOON = 5  # looks at the first part of a step that begins on the value, each four times as far
BESIDE = 1e-4  # of a step: where the rate at a root is taken


@internal
def parts_in(s, r, b, last):
    """In how many parts the step is looked at, the same for all events."""
    if b.parts == 0:
        b.parts = max(parts_of(s, r, b, last), waves_of(s, r, b))
    return b.parts


@compiled(SOUND)
def sound(s, r, b, method, k, end):
    """Where event k first happens in the step, as theta in (0, end]; NONE if it does not."""
    if r.watch[k, TIMES] >= s.watch[k, MOST]:
        return NONE
    parts = parts_in(s, r, b, method[LAST_AT])
    c, want, what = s.contact.size + k, s.watch[k, DIRECTION], what_of(s, k)
    side, band = r.watch[k, SIDE], band_of(s, r, k)
    before, low = (-1.0, 0.0), (0.0, r.gap[c, 0])
    if side == AT:  # it may leave the value and soon come back
        for n in range(SOON, 0, -1):
            theta = end / parts * 0.25**n
            g = value(s, r, b, what, theta)
            if abs(g) > band:
                low, side = (theta, g), ABOVE if g > 0.0 else BELOW
                break
    for j in range(1, parts + 1):
        theta = end * j / parts
        g = b.gap1[c, 0] if theta == 1.0 else value(s, r, b, what, theta)
        high, new = (theta, g), side
        if abs(g) > (band if side == AT else 0.0):
            new = ABOVE if g > 0.0 else BELOW
        if side != AT and new != side:
            if want * new >= 0.0:
                return found(s, r, b, k, low, high)
            before = (-1.0, 0.0)
        elif side != AT:
            if before[0] >= 0.0 and side * low[1] < min(side * before[1], side * g):
                x = dip(s, r, b, what, side, (before, low, high))
                if x >= 0.0:
                    bottom = (x, value(s, r, b, what, x))
                    if want == side:
                        return found(s, r, b, k, bottom, high)
                    return found(s, r, b, k, before, bottom)
            before = low
        low, side = high, new
    return NONE


@internal
def what_of(s, k):
    """What event k looks at: the column, the value taken off it, and -1: see sampled.py."""
    return s.heard[k], s.watch_at[k, VALUE], -1


@internal
def found(s, r, b, k, low, high):
    """The root between two places, just behind the beginning at least, and the rate there.

    Where the value is passed at the first place already it was jumped over before.
    """
    what, theta = what_of(s, k), low[0]
    if low[1] * high[1] < 0.0:
        theta, _ = root(s, r, b, what, low, high)
    theta = max(theta, SAME)
    one, other = max(theta - BESIDE, 0.0), min(theta + BESIDE, 1.0)
    ahead = value(s, r, b, what, other)
    r.watch[k, SLOPE] = (ahead - value(s, r, b, what, one)) / ((other - one) * b.h)
    return theta
