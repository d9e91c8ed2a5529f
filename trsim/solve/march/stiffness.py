"""How stiff a mechanism is, whether that is seen of its motion or not.

A stiff spring or a strong damper between parts that move slowly together carries little, and no
stage of a step tells of it; yet of what places and velocities are off by across it, it makes
accelerations,

    w^2 = |a(q + d, v) - a(q, v)| / |d|        w of the fastest vibration there could be
    c   = |a(q, v + u) - a(q, v)| / |u|        of the fastest decay

times as much.  d and u are those of two vector iterations, d <- a(q + d, v) - a(q, v), which go on
along the run: FIRST evaluations for each before the first step, then one for one or the other after
OFTEN steps, twice as many, and so on up to SELDOM; after OFTEN again where it has risen.

Where projection holds the rows, d and u are kept to what they allow (of rigid bodies): near places
where rows depend on each other, velocities off the rows change accelerations by any amount, and
that is no damping.
"""

from math import sqrt

from trsim.assemble.equations import evaluate
from trsim.assemble.features import HELD_FROM, HELD_TO, OFFSET, SENSED
from trsim.assemble.projection import onto_rows
from trsim.elements.contract import SCENE, compiled
from trsim.elements.scene import PROJECTION
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_to
from trsim.laws.corners import sensed
from trsim.laws.functions import FREE
from trsim.solve.march.accelerations import furthest, touches
from trsim.solve.march.record import BUFFERS, RECORD
from trsim.solve.methods.displacements import active, displace, w_index

FIRST, OFTEN, SELDOM = 3, 4, 32
RISEN = 2.0  # times what it was: looked at OFTEN again
FADING = 0.5  # of what was found before: at least that stays with a look
NUDGE = 1e-7  # of the units of lengths and speeds: the size of d and u
FINEST = 1e-12  # of a place: smaller changes of it are lost in its last bits
DEEP = 1e-3  # of the unit of lengths
GOLDEN = 0.6180339887498949
NOTHING = 1e-300  # nothing holds anything
STILL = 1e-9  # of the largest speed: no motion
# the longest steps of an explicit method in which what is stiff dies out, w h and c h.  DOP853 is
# stable to 6.0 and 6.1; it leaves 0.7 of a vibration there, and of a decay its estimate sees all
SWINGING, DYING = 5.5, 3.5

LOOK_STIFF = types.void(SCENE, RECORD, BUFFERS)
call_look_stiff = caller(LOOK_STIFF)


@internal
def still(s, r):
    """Whether rows hold all there is, and nothing moves but roundings.

    Rows may hold all at a place that the motion goes through, as those of cranks in line do.
    """
    fastest = 0.0
    for c in range(s.n_q, s.n_q + s.n_v):
        fastest = max(fastest, abs(r.y[c]))
    return s.n_v == s.m and fastest <= STILL * r.top_speed


@internal
def smooth(s, r):
    """Whether accelerations are smooth in places and rates here: nothing touches, or touches only
    begin or end far from here; no rows depend on others; no function is left free on a corner."""
    if s.n_v == 0 or (s.status[6] != 0 and s.near_rows > 0.0):
        return False
    for n in range(s.feature.shape[0]):  # what rests on a corner may rest on a jump
        for k in range(s.feature[n, HELD_FROM], s.feature[n, HELD_TO]):
            place = s.held[k]
            free = s.feature[n, SENSED] > 0 and s.tab[place] == FREE
            if free and sensed(s.tab, s.feature[n, OFFSET], place):
                return False
    for c in range(s.contact.size):
        # what was found in flight holds in touch; before anything was found, touches that a nudge
        # does not end are looked at as they are
        if touches(s, r, c) and (r.vibration > 0.0 or r.gap[c, 0] <= DEEP * r.length):
            return False
    return True


@internal
def stiffness_due(r):
    """Whether it is time for a look, before a step."""
    if r.vibration == 0.0:
        return True
    return r.steps >= r.next_look and r.after_rejection == 0


@internal
def longest_calm(r):
    """The longest step in which what is stiff dies out, s."""
    return min(SWINGING / sqrt(r.vibration), DYING / max(r.decay, NOTHING))


@internal
def decays(r):
    """Whether that is set by a decay, not by a vibration."""
    return SWINGING * r.decay >= DYING * sqrt(r.vibration)


@internal
def stiffest(r):
    """The rate of what sets that, 1/s: of a vibration or of a decay."""
    return r.decay if decays(r) else sqrt(r.vibration)


@internal
def stiff_load(r, h):
    """h over that."""
    return h / longest_calm(r) if r.vibration > 0.0 else 0.0


@compiled(LOOK_STIFF)
def look_stiff(s, r, b):
    """Take one iteration on, at the state of the record; what it says is in the record."""
    counted = (s.status[1], s.status[2], s.status[3])
    apart = r.apart_looks
    if r.vibration == 0.0:
        for k in range(r.swing.shape[1]):  # no two bodies move alike
            r.swing[0, k] = r.swing[1, k] = (GOLDEN * (k + 1)) % 1.0 - 0.5
        for _ in range(FIRST):
            r.vibration, r.decay = turned(s, r, b, 0), turned(s, r, b, 1)
        apart = OFTEN
    else:
        of_rates = r.of_rates = 1 - r.of_rates
        before, now = r.decay if of_rates > 0 else r.vibration, turned(s, r, b, of_rates)
        if of_rates > 0:
            r.decay = max(now, FADING * before)
        else:
            r.vibration = max(now, FADING * before)
        apart = OFTEN if now > RISEN * before else min(2 * apart, SELDOM)
    r.apart_looks, r.next_look = apart, r.steps + apart
    r.vibration = max(r.vibration, NOTHING)
    if s.near_rows > 0.0:  # what is seen of the rows goes on from there
        evaluate(s, r.t, r.y, b.rough[1])
    s.status[1], s.status[2], s.status[3] = counted


@internal
def turned(s, r, b, of_rates):
    """One turn of an iteration; w^2 or c, or 0 where nothing changes.

    Rates are velocities and states of elements, those counted by what makes one of the error norm.
    """
    place, rates, swing = b.rough[0], b.rough[1], r.swing[of_rates]
    many = active(s) if of_rates > 0 else s.n_v
    speed = max(r.speed, r.speed_cap)
    nudge = (
        NUDGE * speed if of_rates > 0 else max(NUDGE * r.length, FINEST * furthest(s, r.y, s.size))
    )
    by = nudge / size_of(s, swing, speed, many)
    copy_to(place, r.y)
    for k in range(many):
        if of_rates > 0:
            place[w_index(s, k)] += by * swing[k]
        else:
            displace(s, place, k, by * swing[k])
    evaluate(s, r.t, place, rates)
    for k in range(many):
        rates[k] = rates[w_index(s, k)] - r.yd[w_index(s, k)]
    if s.stabilisation == PROJECTION:  # nothing leaves the rows
        onto_rows(s, rates)
    felt = size_of(s, rates, speed, many)
    if not felt > 0.0 or felt > 1e150:
        return 0.0
    for k in range(many):
        swing[k] = rates[k]
    return felt / nudge


@internal
def size_of(s, w, speed, many):
    """Of so many velocities and states of elements, or their rates, m/s."""
    total = 0.0
    for k in range(many):
        c = w_index(s, k)
        scale = s.scale[c] if k < s.n_v else speed / s.scale[c] if s.scale[c] > 0.0 else 0.0
        total += (scale * w[k]) ** 2
    return sqrt(total)
