"""When Newton's iteration on the stages of a step ends.                          [HairerWanner1996]

With d the size of the last change in units of the error allowed, and theta = d / d_before the rate
at which changes become smaller, what is left after it is d theta / (1 - theta).
"""

from math import sqrt

from trsim.kernels.lazy import internal

GOES_ON, FAILS, CONVERGED, NEXT_TO_NOTHING = range(4)
LITTLE = 0.1  # of what may be left: so small a change is taken for the last without a rate


@internal
def resolution(r, weight, h):
    """The size of the smallest change that is not rounding."""
    floor = 0.0
    for c in range(r.y.size):
        floor = max(floor, (2.0e-15 * abs(r.y[c]) + h * r.noise[c]) * weight[c])
    return floor


@internal
def size_of_change(s, K, first, weight):
    """The size of the change of three stages in the rows of K from `first`: with S_b the sum of
    weighed squares of the n_b entries of body b,

        sqrt(sum S_b^2 / sum 3 n_b S_b)

    the root of their mean square where all bodies take part alike, and the same whatever bodies are
    at rest beside.  Nodes and states count as one body.
    """
    of_q, of_v = 3 if s.d == 3 else 7, s.d
    squares, counted, rest, others = 0.0, 0.0, 0.0, 0
    for body in range(s.n_r - 1):
        total = 0.0
        for i in range(first, first + 3):
            for c in range(of_q * body, of_q * (body + 1)):
                total += (K[i, c] * weight[c]) ** 2
            for c in range(s.n_q + of_v * body, s.n_q + of_v * (body + 1)):
                total += (K[i, c] * weight[c]) ** 2
        squares, counted = squares + total * total, counted + 3 * (of_q + of_v) * total
    for c in range(of_q * (s.n_r - 1), weight.size):
        if weight[c] > 0.0 and not s.n_q <= c < s.n_q + s.v_node:
            others += 1
            for i in range(first, first + 3):
                rest += (K[i, c] * weight[c]) ** 2
    squares, counted = squares + rest * rest, counted + 3 * others * rest
    return sqrt(squares / counted) if counted > 0.0 else 0.0


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
