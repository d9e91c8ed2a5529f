"""Dense output of methods that have none of their own: the cubic through both ends, order 3."""

from trsim.elements.contract import compiled
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import INTERPOLATE

ROWS = 3


@internal
def build(start, end, h, ends, P):
    """Fill P from the states at both ends of a step and their rates there."""
    y, y1 = ends[0], ends[1]
    for c in range(y.size):
        delta = y1[c] - y[c]
        P[0, c] = delta
        P[1, c] = h * start[c] - delta
        P[2, c] = delta - h * end[c] - P[1, c]


@compiled(INTERPOLATE)
def value(P, y, theta, out):
    """out <- solution at t + theta h."""
    rest = 1.0 - theta
    for c in range(y.size):
        out[c] = y[c] + theta * (P[0, c] + rest * (P[1, c] + theta * P[2, c]))
