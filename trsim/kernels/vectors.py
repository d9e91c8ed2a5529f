"""Plain loops over arrays for compiled code.

Slice assignments of numba carry shape checks and their error texts: a second of compiling each.
"""

from math import isfinite

from trsim.kernels.lazy import internal


@internal
def copy_to(target, source):
    """target <- source, as far as the shorter one reaches."""
    for k in range(min(target.size, source.size)):
        target[k] = source[k]


@internal
def copy_table(target, source):
    """target <- source, two tables of one shape."""
    for i in range(source.shape[0]):
        for j in range(source.shape[1]):
            target[i, j] = source[i, j]


@internal
def clear(target):
    """target <- 0."""
    for k in range(target.size):
        target[k] = 0.0


@internal
def clear_table(target):
    """target <- 0."""
    for i in range(target.shape[0]):
        for j in range(target.shape[1]):
            target[i, j] = 0.0


@internal
def all_finite(x):
    """No NaN, no infinity."""
    for k in range(x.size):  # noqa: SIM110 - a generator does not compile
        if not isfinite(x[k]):
            return False
    return True
