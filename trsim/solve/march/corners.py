"""Corners of laws inside a step: where friction passes from one of its branches to the next.

A law with corners is followed on one branch, drawn on beyond its ends, so that every step sees
smooth functions; where the element leaves its branch is an event like a touch.  It is looked for
where the branch is left at the end of a step or at any stage of it.

What rubs fully and slides the other way round later in the step has been at rest in between, though
no stage may have come near to that: there it is looked for as well.
"""

from math import inf

from trsim.assemble.equations import call_one, set_poses
from trsim.elements.contract import CONTACT, WHOLE, ContactNumbers, Memory
from trsim.kernels.lazy import internal
from trsim.solve.march.calls import call_interpolate
from trsim.solve.march.illinois import between, narrowed

NONE = 2.0  # a root beyond the step
EXACT = 1e-12  # of a step: how well a corner is located
LOOKS = 16  # places of a step that are looked at before the root is bracketed
HALVINGS = 50  # of a part of a step in which sliding turns round


@internal
def begin_sliding(s, r):
    """Keep how elements slide that rub fully, at the start of a step."""
    posed = False
    for c in range(s.contact.size):
        e, numbers = s.contact[c], ContactNumbers(s, c)
        if not (numbers.ramp > 0.0 and numbers.clearance == inf):  # a journal knows which way
            continue
        own = Memory(s, e)
        for k in range(6):
            s.slid[e, k] = 0.0
        if own.phase == CONTACT and own.branch != WHOLE:
            if not posed:
                set_poses(s, r.y)
                posed = True
            call_one(s, s.corners, r.t, e)
            for k in range(3):
                s.slid[e, 3 + k] = s.slid[e, k]


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
def onward(s, e):
    """How far an element slides as at the start of the step, at the place looked at last."""
    return s.slid[e, 0] * s.slid[e, 3] + s.slid[e, 1] * s.slid[e, 4] + s.slid[e, 2] * s.slid[e, 5]


@internal
def left_between(s, r, b, c, low, high):
    """A place between two, where contact c slides on and back, at which it has left its branch, and
    how far: where it comes to rest.  Where it turns round at some speed there may be none: -1."""
    for _ in range(HALVINGS):
        theta = 0.5 * (low + high)
        f = beyond_inside(s, r, b, c, theta)
        if f > 0.0:
            return theta, f
        if onward(s, s.contact[c]) > 0.0:
            low = theta
        else:
            high = theta
    return high, -1.0


@internal
def corner_root(s, r, b, c):
    """Where contact c first leaves its branch, as theta in [0, 1]; NONE if it does not."""
    e = s.contact[c]
    if Memory(s, e).phase != CONTACT or not (b.corner1[c] > 0.0 or s.left[e] > 0.0):
        return NONE
    low, f_low = 0.0, r.corner[c]
    inside, on = f_low < 0.0, True
    for k in range(1, LOOKS + 1):
        theta = k / LOOKS
        f = beyond_inside(s, r, b, c, theta)
        back = onward(s, e) < 0.0
        f = b.corner1[c] if k == LOOKS else f
        if inside and f > 0.0:
            return bracketed(s, r, b, c, (low, f_low), (theta, f))
        if inside and on and back:
            other, f_other = left_between(s, r, b, c, low, theta)
            if f_other > 0.0:
                return bracketed(s, r, b, c, (low, f_low), (other, f_other))
        if f < 0.0:
            inside, low, f_low, on = True, theta, f, not back
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
