"""The dense output of a step, built when something asks for it."""

from trsim.elements.vectors import internal
from trsim.solve.calls import call_dense
from trsim.solve.record import DENSE_BUILT


@internal
def build(s, r, b, dense, t, h):
    """The dense output of the step, into b.P."""
    call_dense(dense, s, b.K, t, r.y, h, b.y1, b.P)
    r.count[DENSE_BUILT] += 1
