"""Channels of any kind, looked at inside a step: in parts, since nothing bounds them.

The step is looked at in PARTS, and as many again for every TURN that the fastest body turns by, or
every WAVE of the fastest sine in a function (turns.py) where the channel may swing with it: a
force, an acceleration, what a drive prescribes.  What is looked at is `what`: a column of the
output rows, the value taken off it, and the row of the element that tells it by places and rates
alone, or -1.  Of such a column no forces are evaluated where places are taken as interpolated.
"""

from math import sqrt

from trsim.assemble.equations import call_one, set_poses
from trsim.assemble.linear import smallest_pivot
from trsim.assemble.projection import DOUBTFUL
from trsim.elements.scene import NONE
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import call_interpolate
from trsim.solve.march.dense_output import measure_inside
from trsim.solve.march.illinois import between, narrowed
from trsim.solve.march.record import LOOKS
from trsim.solve.march.turns import fastest, waves_in

PARTS = LOOKS  # of a step that is looked at, for each TURN
TURN, WAVE = 0.5, 2.0  # rad
MOST_PARTS = 4096  # of a step; turns.py keeps steps to fewer, unless their length is fixed
DIPS = 12  # looks at the bottom of a dip
NEAR = 0.5  # of the way a channel goes in a step: so near to zero a cubic is looked at
TRIALS = 100
RESOLUTION = 2.3e-16
SHORT = 64.0  # resolutions of the time: inside so short a step there is rounding alone


@internal
def value(s, r, b, what, theta):
    """What is looked at, inside the step."""
    column, at, alone = what
    if alone >= 0 and b.alone > 0:
        call_interpolate(b.interpolate, b.P, r.y, theta, b.y2)
        set_poses(s, b.y2)
        call_one(s, s.measure, b.t + theta * b.h, alone)
    else:
        measure_inside(s, r, b, b.t + theta * b.h, theta)
    return s.out[column] - at


@internal
def as_interpolated(s, r, b, turn):
    """Whether states inside the step are taken as interpolated, see measure_at and evaluate_inside.

    Its end was evaluated last; the least pivot there is the square of a sine that changes by no
    more than the bodies of both its rows turn, `turn` rad in the step at most.
    """
    if r.driven > 0 or b.rate > 0 or s.redundant.shape[0] > 0:
        return False
    if s.m == 0 or s.stabilisation == NONE:
        return True
    return sqrt(max(smallest_pivot(s), 0.0)) - 2.0 * turn > sqrt(DOUBTFUL)


@internal
def turn_of(s, r, b, last):
    """By how much the fastest body turns in the step, rad."""
    return max(fastest(s, r.y, r.yd), fastest(s, b.y1, b.K[last])) * (b.t1 - b.t)


@internal
def parts_of(s, r, b, last):
    """In how many parts a step is looked at."""
    return parts_for(r, turn_of(s, r, b, last) / TURN)


@internal
def parts_for(r, times):
    """PARTS of the step, and as many again for each of `times`; counts what is too many."""
    if times < MOST_PARTS / PARTS - 1:
        return PARTS * (1 + int(times))
    r.unfollowed += 1
    return MOST_PARTS


@internal
def waves_of(s, r, b):
    """In how many parts it is looked at where a channel swings with a function."""
    if s.wave.size == 0:
        return PARTS
    length = b.t1 - b.t
    return parts_for(r, waves_in(s, r, b, length) * length / WAVE)


@internal
def dip(s, r, b, what, side, places):
    """A place beyond zero at the bottom of three values of one side; -1 where it stays on it.

    By parabolas through the three lowest, as far as these may reach zero.
    """
    (x0, f0), (x1, f1), (x2, f2) = places
    for _ in range(DIPS):
        a, c = (f1 - f0) / (x1 - x0), (f2 - f1) / (x2 - x1)
        bend = (c - a) / (x2 - x0)
        if side * bend <= 0.0:
            return -1.0
        x = 0.5 * (x0 + x1) - 0.5 * a / bend
        bottom = side * (f0 + (x - x0) * (a + bend * (x - x1)))
        if bottom > NEAR * (max(side * f0, side * f2) - side * f1):
            return -1.0
        if abs(x - x1) < 1e-3 * (x2 - x0):  # the middle is the bottom: look beside it
            x = x1 + 0.1 * (x2 - x1 if x2 - x1 > x1 - x0 else x0 - x1)
        f = value(s, r, b, what, x)
        if side * f < 0.0:
            return x
        if side * f < side * f1:
            if x > x1:
                x0, f0 = x1, f1
            else:
                x2, f2 = x1, f1
            x1, f1 = x, f
        elif x > x1:
            x2, f2 = x, f
        else:
            x0, f0 = x, f
    return -1.0


@internal
def resolution(b):
    """Of the time, as theta."""
    return RESOLUTION * max(1.0, abs(b.t) / b.h)


@internal
def root(s, r, b, what, low, high):
    """Where what is looked at is zero between two places, as theta, and what it jumps by there: its
    change between neighbouring doubles of the time."""
    if low[1] == 0.0 or (low[1] > 0.0) == (high[1] > 0.0):  # beyond zero at once
        return low[0], 0.0
    rising, finest = high[1] > 0.0, resolution(b)
    if high[0] - low[0] <= SHORT * finest:
        return high[0], abs(high[1] - low[1])
    bracket, f0, f1 = (low[0], low[1], high[0], high[1], 0.0), low[1], high[1]
    for n in range(TRIALS):
        if bracket[2] - bracket[0] <= finest:
            break
        middle = between(bracket, n)
        f = value(s, r, b, what, middle)
        if f == 0.0:
            return middle, 0.0
        bracket = narrowed(bracket, middle, f, rising)
        if (f > 0.0) == rising:
            f1 = f
        else:
            f0 = f
    return bracket[2], abs(f1 - f0)
