"""What happens first inside a step: a touch, a separation, a corner of a law, a user event.

Called by its address, which is 0 where nothing can happen: such a run compiles nothing of it.
"""

from trsim.assemble.equations import evaluate, poses
from trsim.elements.contract import compiled
from trsim.kernels.vectors import internal
from trsim.solve.march.calls import INTERPOLATE_AT, LAST_AT, SEARCH, STAGES_AT
from trsim.solve.march.dense_output import build
from trsim.solve.march.events import NONE, SAME, any_change, first_change
from trsim.solve.march.spread import fill_net
from trsim.solve.march.watch import crossing, may_cross


@compiled(SEARCH)
def search(s, r, b, setting, method, t, h, built):
    """The first event of the step of length h, whose end is in b.y1 and was evaluated last.

    As theta in [0, 1]; NONE if there is none, the scene is then again as evaluated there.  Fills
    b.root and b.corner_root.  built: not 0 where b.P already holds the dense output.
    """
    stages, interpolate = method[STAGES_AT], method[INTERPOLATE_AT]
    if not to_search(s, r, b, setting, h, 0 if built > 0 else stages):
        return NONE
    evaluations = s.status[1]
    if built == 0:
        build(s, r, b, method, t, h)
    fill_net(s, r, b, method)
    first = earliest(s, r, b, setting, t, h, interpolate)
    if first > 1.0 or first == 1.0:
        if s.status[1] > evaluations:
            evaluate(s, t + h, b.y1, b.K[method[LAST_AT]])
        else:
            poses(s, b.y1)
    return first


@internal
def to_search(s, r, b, setting, h, stages):
    """Whether something may happen inside the step."""
    for k in range(s.watch.shape[0]):
        if may_cross(s, r, b, k, h, stages):
            return True
    return setting.locate > 0 and any_change(s, r, b, h, stages)


@internal
def earliest(s, r, b, setting, t, h, interpolate):
    """Fill b.root for contacts and user events; the first, corners of laws included."""
    first = NONE
    if setting.locate > 0:
        first = first_change(s, r, b, setting, t, h, interpolate)
    else:
        for c in range(s.contact.size):
            b.root[c], b.corner_root[c] = NONE, NONE
    for k in range(s.watch.shape[0]):
        root = crossing(s, r, b, setting, t, h, k, min(first + SAME, 1.0), interpolate)
        b.root[s.contact.size + k] = root
        first = min(first, root)
    return first
