"""Corners of laws inside a step: where friction passes from one of its branches to the next.

A law with corners is followed on one branch, drawn on beyond its ends, so that every step sees
smooth functions; where the element leaves its branch is an event like a touch.  It is looked for
where the branch is left at the end of a step or at any stage of it.
"""

from trsim.assemble.equations import call_one, set_poses
from trsim.elements.contract import CONTACT, WHOLE, Memory
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import call_interpolate
from trsim.solve.march.illinois import between, narrowed

NONE = 2.0  # a root beyond the step
EXACT = 1e-12  # of a step: how well a corner is located
LOOKS = 16  # places of a step that are looked at before the root is bracketed


@internal
def any_left(s, r, b):
    """Whether some element left its branch during the step, as far as its evaluations tell."""
    for c in range(s.contact.size):
        e = s.contact[c]
        if Memory(s, e).phase == CONTACT and (b.corner1[c] > 0.0 or s.left[e] > 0.0):
            return True
    return False


@internal
def show(s, r, b, theta):
    """The poses at theta of the step, whose state is left in b.y2."""
    call_interpolate(b.interpolate, b.P, r.y, theta, b.y2)
    set_poses(s, b.y2)


@internal
def beyond_inside(s, r, b, c, theta):
    """How far contact c has left its branch at theta of the step."""
    show(s, r, b, theta)
    call_one(s, s.corners, b.t + theta * b.h, s.contact[c])
    return s.corner[s.contact[c], 0]


@internal
def corner_root(s, r, b, c):
    """Where contact c first leaves its branch, as theta in [0, 1]; NONE if it does not."""
    e = s.contact[c]
    if Memory(s, e).phase != CONTACT or not (b.corner1[c] > 0.0 or s.left[e] > 0.0):
        return NONE
    low, f_low = 0.0, r.corner[c]
    inside = f_low < 0.0
    for k in range(1, LOOKS + 1):
        theta = k / LOOKS
        f = b.corner1[c] if k == LOOKS else beyond_inside(s, r, b, c, theta)
        if inside and f > 0.0:
            return bracketed(s, r, b, c, (low, f_low), (theta, f))
        if f < 0.0:
            inside, low, f_low = True, theta, f
    # it starts on a corner: away from it at once, or the branch was left only by a trial
    return 0.0 if not inside and b.corner1[c] > 0.0 else NONE


@internal
def bracketed(s, r, b, c, low, high):
    """The root between two places, (theta, how far) each: inside and beyond."""
    # inside it may be zero: just inside
    bracket = (low[0], min(low[1], -1e-3 * high[1]), high[0], high[1], 0.0)
    for k in range(100):
        if bracket[2] - bracket[0] <= EXACT:
            break
        middle = between(bracket, k)
        f = beyond_inside(s, r, b, c, middle)
        bracket = narrowed(bracket, middle, f, True)
    return bracket[2]


@internal
def look(s, c):
    """Put contact c, newly closed, on the branch of its law that it is on."""
    e = s.contact[c]
    own = Memory(s, e)
    own.branch = WHOLE
    s.corner[e, 1] = WHOLE  # stays where the element has no corners
    call_one(s, s.corners, 0.0, e)
    own.branch = s.corner[e, 1]
