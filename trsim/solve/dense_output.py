"""The dense output of a step, built when something asks for it."""

from trsim.assemble.outputs import measure
from trsim.elements.vectors import internal
from trsim.solve.calls import call_dense, call_interpolate
from trsim.solve.land import evaluate_inside
from trsim.solve.record import DENSE_BUILT, ENERGY_0, WORK_PROJECTION


@internal
def build(s, r, b, dense, t, h):
    """The dense output of the step, into b.P."""
    call_dense(dense, s, b.K, t, r.y, h, b.y1, b.P)
    r.count[DENSE_BUILT] += 1


@internal
def measure_inside(s, r, b, interpolate, at, theta, projected):
    """All channels at the time `at`, theta of the step, into s.out; the state is in b.y2.

    projected: the work of the projection at the step's end.
    """
    call_interpolate(interpolate, b.P, r.y, theta, b.y2)
    evaluate_inside(s, r, at, b.y2, b.K[1])
    measure(s, at, b.y2, r.clock[WORK_PROJECTION] + theta * projected, r.clock[ENERGY_0])
