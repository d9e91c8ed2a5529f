"""When Newton's iteration on the stages of a step ends.                          [HairerWanner1996]

With d the size of the last change in units of the error allowed, and theta = d / d_before the rate
at which changes become smaller, what is left after it is d theta / (1 - theta).
"""

from trsim.kernels.vectors import internal

GOES_ON, FAILS, CONVERGED, NEXT_TO_NOTHING = range(4)
LITTLE = 0.1  # of what may be left: so small a change is taken for the last without a rate


@internal
def resolution(r, weight, h):
    """How many entries have weight, and the size of the smallest change that is not rounding."""
    counted, floor = 0, 0.0
    for c in range(r.y.size):
        if weight[c] > 0.0:
            counted += 1
            floor = max(floor, (2.0e-15 * abs(r.y[c]) + h * r.noise[c]) * weight[c])
    return counted, floor


@internal
def judged(moved, before, iteration, most, kappa):
    """What becomes of an iteration, the k-th of at most `most`, and its rate; 1 of the first.

    moved, before: the sizes of the last change and of the one before; kappa: what may be left.
    """
    rate = 1.0
    if iteration > 0:
        rate = moved / before if before > 0.0 else 0.0
        if rate >= 2.0 and moved > kappa:
            return FAILS, rate
        if rate < 1.0 and moved * rate ** (most - 1 - iteration) / (1.0 - rate) > kappa:
            return FAILS, rate
        if rate < 1.0 and moved * rate / (1.0 - rate) < kappa:
            return CONVERGED, rate
    if moved == 0.0:
        return CONVERGED, rate
    return NEXT_TO_NOTHING if moved < LITTLE * kappa else GOES_ON, rate
