"""The step before the one at hand, kept for what is only seen from behind it (peaks.py).

Kept are both ends with their derivatives, and what the dense output is made of: it is made when it
is asked for, or kept if it was.  Whichever step it is, what channels inside it are measured from is

    y0, dense output, start, work of projections up to its start, and in it
"""

from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_table, copy_to
from trsim.solve.march.calls import DENSE_AT, LAST_AT, STAGES_AT, call_dense
from trsim.solve.march.samples import older


@internal
def this_step(r, b):
    """The step at hand."""
    return r.y, b.P, r.t, r.work_projection, b.projected


@internal
def either_step(r, b, earlier):
    """The step that was kept, or the one at hand."""
    if earlier:
        t, work, done = r.earlier_t, r.earlier_work, r.earlier_projected
        return r.earlier[0], r.stages, t, work, done
    return this_step(r, b)


@internal
def ends(r, b, method, earlier):
    """Both ends of either step, their derivatives: y0, y1, y0', y1'."""
    if earlier:
        return r.earlier[0], r.earlier[1], r.earlier[2], r.earlier[3]
    return r.y, b.y1, r.yd, b.K[method[LAST_AT]]


@internal
def keep_step(r, b, method):
    """Keep the step at hand, which is about to be accepted, if extremes in it are still looked for.

    It is the one that the newest two samples lie in: not a step so short that its end took the
    place of the sample before.
    """
    t = r.t
    if r.earlier.shape[0] == 0 or r.unseen == 0 or r.n_samples < 2 or r.sampled[older(r, 1)] < t:
        return
    copy_to(r.earlier[0], r.y)
    copy_to(r.earlier[1], b.y1)
    copy_to(r.earlier[2], r.yd)
    copy_to(r.earlier[3], b.K[method[LAST_AT]])
    r.earlier_t, r.earlier_h = t, b.h
    r.earlier_work, r.earlier_projected = r.work_projection, b.projected
    r.earlier_built = b.built
    source = b.P if b.built > 0 else b.K
    rows = method[STAGES_AT] if b.built == 0 and method[STAGES_AT] > 0 else source.shape[0]
    for k in range(min(rows, r.stages.shape[0])):
        copy_to(r.stages[k], source[k])


@internal
def build_earlier(s, r, b, method):
    """The dense output of the step that was kept, in the place of its stages."""
    t, h = r.earlier_t, r.earlier_h
    call_dense(method[DENSE_AT], s, r.stages, t, h, r.earlier, b.P_earlier)
    copy_table(r.stages, b.P_earlier)
    r.earlier_built = 1
    r.dense_built += 1
