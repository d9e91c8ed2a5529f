"""What happens first inside a step: a touch, a separation, a corner of a law, a user event.

Called by its address, which is 0 where nothing can happen: such a run compiles nothing of it.
"""

from trsim.assemble.equations import evaluate, set_poses
from trsim.elements.contract import compiled
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import LAST_AT, SEARCH, SOUND_AT, STAGES_AT, call_sound
from trsim.solve.march.dense_output import build
from trsim.solve.march.events import NONE, SAME, any_change, first_change
from trsim.solve.march.spread import fill_net
from trsim.solve.march.watch import crossing, heard, may_cross


@compiled(SEARCH)
def search(s, r, b, setting, method):
    """The first event of the step at hand, whose end is in b.y1 and was evaluated last.

    As theta in [0, 1]; NONE if there is none, the scene is then again as evaluated there.  Fills
    b.root and b.corner_root.
    """
    if not to_search(s, r, b, setting, 0 if b.built > 0 else method[STAGES_AT]):
        return NONE
    evaluations = s.status[1]
    if b.built == 0:
        build(s, r, b, method)
    fill_net(s, r, b, method)
    first = earliest(s, r, b, setting, method)
    if first > 1.0 or first == 1.0:
        if s.status[1] > evaluations:
            evaluate(s, b.t + b.h, b.y1, b.K[method[LAST_AT]])
        else:
            set_poses(s, b.y1)
    return first


@internal
def to_search(s, r, b, setting, stages):
    """Whether something may happen inside the step."""
    for k in range(s.watch.shape[0]):
        if may_cross(s, r, b, k, stages):
            return True
    return setting.locate > 0 and any_change(s, r, b, stages)


@internal
def earliest(s, r, b, setting, method):
    """Fill b.root for contacts and user events; the first, corners of laws included."""
    b.parts = 0
    for c in range(s.contact.size):
        b.root[c], b.corner_root[c] = NONE, NONE
    first = first_change(s, r, b, setting) if setting.locate > 0 else NONE
    for k in range(s.watch.shape[0]):
        end = min(first + SAME, 1.0)
        if heard(s, k):
            root = call_sound(method[SOUND_AT], s, r, b, method, k, end)
        else:
            root = crossing(s, r, b, setting, k, end)
        b.root[s.contact.size + k] = root
        first = min(first, root)
    return first
