"""Roots of functions that are dear: steps of the Illinois method, safeguarded by bisection.

A bracket is (low, f_low, high, f_high, side): two places with values of different sign, one of the
values halved where the same end moved twice, and which end moved last (-1 low, 1 high, 0 none).
"""

from trsim.kernels.lazy import internal

TRIALS = 200  # in one search
RESOLUTION = 4e-16  # of a step


@internal
def between(bracket, k):
    """Where to look next, in the k-th step."""
    low, f_low, high, f_high, _ = bracket
    middle = 0.5 * (low + high)
    if k % 4 != 3 and f_high != f_low:
        secant = high - f_high * (high - low) / (f_high - f_low)
        if low < secant < high:
            middle = secant
    return middle


@internal
def is_narrow(bracket):
    """Whether its ends are as near to each other as places of a step can be."""
    return bracket[2] - bracket[0] <= RESOLUTION * max(1.0, bracket[2])


@internal
def narrowed(bracket, middle, f, rising):
    """The bracket with `middle`, where the value is f, for one of its ends.

    rising: the value at `high` is the positive one.
    """
    low, f_low, high, f_high, side = bracket
    if (f > 0.0) == rising:
        return low, f_low * (0.5 if side > 0.0 else 1.0), middle, f, 1.0
    return middle, f, high, f_high * (0.5 if side < 0.0 else 1.0), -1.0
