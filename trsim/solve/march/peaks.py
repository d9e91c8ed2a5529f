"""Extremes of every channel: of the dense motion, right to the tolerance, never beyond it.

Channels are known at samples: the ends of steps and the output rows inside them (samples.py).
Between two samples a channel may pass an extreme.  The polynomial through the samples around says
how far it may go there, and its last term how uncertain that is.  Only where that is beyond the
extreme so far is the dense output evaluated, at the place where the polynomial is largest; the
polynomial then goes through that place too, until it promises nothing more.  What is kept is always
a value of the dense motion, so a run costs little once its extremes have been met.

What lies between two samples is looked at when the next one is known: a polynomial through places
on both sides misses nothing that one through those before it hardly sees, such as an extreme just
before the end of a step.  So the step before is kept (earlier.py).  Where no sample follows, at an
event and at the end of a run, what lies before it is looked at by those there are (`finish`).

A dense output that is not there yet costs several evaluations.  Before it is built the middle of
the step is guessed by the cubic through both its ends; a channel that with it plainly goes one way,
or stays plainly within its extremes, has none there.
"""

from trsim.assemble.outputs import measure
from trsim.elements.contract import SCENE, compiled
from trsim.kernels import signatures as types
from trsim.kernels.calls import caller
from trsim.kernels.lazy import internal
from trsim.kernels.packed import A1, I1, i8
from trsim.solve.march.calls import BETWEEN_AT, INSIDE_AT
from trsim.solve.march.dense_output import astray, build, call_measure_in
from trsim.solve.march.earlier import build_earlier, either_step, ends
from trsim.solve.march.land import evaluate_inside
from trsim.solve.march.polynomials import (
    SURE,
    apart,
    one_way,
    polynomial,
    reach,
    settled,
    sharper,
    top,
)
from trsim.solve.march.record import BUFFERS, PEAK_MAX, PEAK_MIN, POINTS, RECORD, SETTINGS
from trsim.solve.march.samples import (
    NOT_LAID,
    YOUNG,
    aside,
    bounds,
    constant,
    extreme,
    gather,
    keep_found,
    kept_as,
    known_extremes,
    known_place,
    nearest,
    older,
    push,
    square,
    squared,
    through,
    value_of,
)

SMALL = 0.01  # of what may be missed of the largest channel of its kind: less is no extreme
ENDS = 4  # of what is known between and around two samples that are looked at, at least
ROUGH = 16.0  # times what rounding makes of a channel: one that changes by less is constant
TINY = 0.02  # of the mean step: in a shorter one nothing turns
GUESSED = 0.02  # of what a channel changes by: how wrong the guess of its middle may be
TRIES = 12  # evaluations for one extreme of one channel: a kink is approached slowly

#                   scene  record  buffers  settings method values
SAMPLE = types.void(SCENE, RECORD, BUFFERS, SETTINGS, I1, A1)
call_sample = caller(SAMPLE)
#                   scene  record  buffers  settings method
FINISH = types.void(SCENE, RECORD, BUFFERS, SETTINGS, I1)
call_finish = caller(FINISH)
#                    scene  record  buffers  settings method ahead
BETWEEN = types.void(SCENE, RECORD, BUFFERS, SETTINGS, I1, i8)
call_between = caller(BETWEEN)


@compiled(SAMPLE)
def sample(s, r, b, setting, method, values):
    """Take the channels at one time of the step at hand, b.sampled_t, into their extremes, and what
    lies between the two samples before it."""
    at = b.sampled_t
    if s.sought.size == 0:  # no channel is told
        gather(s, b.full, values, b.inside[0])
        known_extremes(s, r, b, at)
        return
    if r.n_samples > 0 and at <= r.sampled[r.newest]:
        return
    own = push(s, r, b, at, values)
    known_extremes(s, r, b, at)
    if own:
        if r.unseen > 0 and r.n_samples > 2:
            call_between(method[BETWEEN_AT], s, r, b, setting, method, 1)
            if r.driven > 0 and b.n_found > 0:
                keep_found(r, b)
        r.unseen = 1


@compiled(FINISH)
def finish(s, r, b, setting, method):
    """Take what lies between the two newest samples into the extremes: no sample follows that they
    have to do with."""
    if r.unseen > 0 and r.n_samples > 1:
        call_between(method[BETWEEN_AT], s, r, b, setting, method, 0)
    r.unseen = 0


@compiled(BETWEEN)
def between(s, r, b, setting, method, ahead):
    """Look for the extremes of all channels between two neighbours among the samples.

    ahead: samples that are newer than the later of them.
    """
    share, now, last = setting.missed, r.sample[older(r, ahead)], r.sample[older(r, ahead + 1)]
    b.n_found, b.laid, b.astray = 0, NOT_LAID, 0
    inner = max(ENDS - r.n_samples, 1)
    last_one = r.sampled[r.newest] >= setting.t_end
    # an event cuts steps of any length
    turns = ahead == 0 or length(r, b, ahead) * r.steps >= TINY * b.t
    if (r.n_samples <= YOUNG and turns) or (ahead == 0 and last_one):
        if not ready(r, b, ahead) and not last_one:
            guess(s, r, b, method, ahead, inner)
        else:
            look_within(s, r, b, setting, method, (ahead, inner))
    if b.astray > 0:
        return
    bounds(r, b, ahead)
    for c in range(now.size):
        high, low = r.peak[PEAK_MAX, s.sought[c]], r.peak[PEAK_MIN, s.sought[c]]
        of_high, of_low = kept_as(s, r, c, high), kept_as(s, r, c, low)
        beyond = b.bound[1, c]
        above, below = max(now[c], last[c]), min(now[c], last[c])
        for k in range(b.n_found):
            above, below = max(above, b.inside[k, c]), min(below, b.inside[k, c])
        beyond += above - below if b.n_found > 0 else 0.0
        if above + beyond <= of_high and below - beyond >= of_low:
            continue
        kind, lever = s.kin[c], s.lever[c]
        enough = share * max(high - low, SMALL * r.largest[kind] / lever)
        enough = max(enough, r.faint[kind] / lever)
        rises = above + beyond > kept_as(s, r, c, high + enough)
        falls = low > s.least[c] and below - beyond < kept_as(s, r, c, low - enough)
        if not (rises or falls) or constant(r, c, ROUGH * r.faint[kind] / lever):
            continue
        if b.n_found == 0 or (ready(r, b, ahead) and b.n_found <= r.sampled.size - 2):
            up, down = reached(s, r, b, ahead, c, enough)
            rises, falls = rises and up, falls and down
            if not (rises or falls):
                continue
        if not ready(r, b, ahead):
            if b.n_found == 0:
                guess(s, r, b, method, ahead, inner)
            up, down = guessed(s, r, b, ahead, c)
            rises, falls = rises and up, falls and down
            if not (rises or falls):
                continue
            b.n_found, b.laid = 0, NOT_LAID
            look_within(s, r, b, setting, method, (ahead, inner))
        if b.astray > 0:
            return
        if rises:
            search(s, r, b, setting, method, (ahead, c, 1.0, enough))
        if falls:
            search(s, r, b, setting, method, (ahead, c, -1.0, enough))
        if b.astray > 0:
            return


@internal
def before(r, ahead):
    """Whether two neighbours lie in the step that was kept, not in the one at hand."""
    return r.sampled[older(r, ahead + 1)] < r.t


@internal
def length(r, b, ahead):
    """Of the step they lie in, s."""
    return r.earlier_h if before(r, ahead) else b.h


@internal
def ready(r, b, ahead):
    """Whether its dense output is there."""
    return (r.earlier_built if before(r, ahead) else b.built) > 0


@internal
def reached(s, r, b, ahead, c, enough):
    """Whether the polynomial of channel c may rise above its extremes, and fall below them."""
    up, down = reach(b, through(r, b, ahead, c, 1.0))
    o = s.sought[c]
    high, low = r.peak[PEAK_MAX, o] + enough, r.peak[PEAK_MIN, o] - enough
    return up > kept_as(s, r, c, high), down < kept_as(s, r, c, low)


@internal
def guessed(s, r, b, ahead, c):
    """`reached` with a guess of the middle: plainly not, or it is to be looked at."""
    n = through(r, b, ahead, c, 1.0)
    if one_way(b, n):
        return False, False
    up, down = reach(b, n)
    o, doubtful = s.sought[c], GUESSED * apart(b.node)
    return up > r.peak[PEAK_MAX, o] - doubtful, down < r.peak[PEAK_MIN, o] + doubtful


@internal
def search(s, r, b, setting, method, what):
    """Look for an extreme of a channel between two neighbours, by its polynomial; the dense output
    is there.

    what: samples that are newer, the channel, 1 for a maximum or -1 for a minimum, and what may be
    missed.  A polynomial that is much surer than that is taken at its word.
    """
    ahead, c, sign, enough = what
    o, aside_before, near = s.sought[c], False, nearest(s, r, c, sign)
    for _ in range(TRIES):
        known = r.peak[PEAK_MAX, o] if sign > 0.0 else r.peak[PEAK_MIN, o]
        wanted = sign * kept_as(s, r, c, known + sign * enough)
        n = through(r, b, ahead, c, sign)
        low, high = b.node[0, 1], b.node[0, 0]
        place, promised = top(b, n, low, high, wanted)
        if sign < 0.0 and squared(s, r, c):
            place, promised = sharper(b, n, low, high, (place, promised))
        if not promised > wanted:
            break
        # its places lie so that it says little of this one
        if known_place(b, low, high, place, near):
            place = aside(b, low, high, place)
            if aside_before or known_place(b, low, high, place, near):
                break
            aside_before = True
        said = polynomial(b.node, n, place, 0.0)
        allowed = enough
        if squared(s, r, c):  # the root of the least square is of what a polynomial leaves over
            allowed = wanted - kept_as(s, r, c, known) if sign > 0.0 else 0.0
        sure = n >= POINTS and promised - said < SURE * allowed
        if sure and settled(b.node, n, place, allowed):
            extreme(r, o, place, value_of(s, r, c, sign * said), b.firm[0])
            break
        if b.n_found >= b.found.size:
            break
        look(s, r, b, setting, method, (ahead, place))
        if b.astray > 0:
            break


@internal
def look(s, r, b, setting, method, where):
    """Evaluate all channels at a place inside the step, and keep them in b.inside and b.found,
    unless they are none of the motion: then nothing more is looked for."""
    ahead, place = where
    earlier, h = before(r, ahead), length(r, b, ahead)
    if not ready(r, b, ahead):
        if earlier:
            build_earlier(s, r, b, method)
        else:
            build(s, r, b, method)
    k, t = b.n_found, r.earlier_t if earlier else r.t
    place = min(place, t + h)
    theta = (place - t) / h
    call_measure_in(b.measure_in, s, r, b, int(earlier), place, theta)
    if method[INSIDE_AT] > 0 and (b.torn > 0 or astray(s, r, b, setting, int(earlier), theta)):
        b.astray = 1
        return
    gather(s, b.full, s.out, b.inside[k])
    square(s, r, b.inside[k])
    known_extremes(s, r, b, place)
    b.n_found, b.found[k] = k + 1, place


@internal
def look_within(s, r, b, setting, method, where):
    """`look` at `inner` places that part the time between two neighbours into equal parts."""
    ahead, inner = where
    start, end = r.sampled[older(r, ahead + 1)], r.sampled[older(r, ahead)]
    for k in range(inner):
        place = start + (k + 1.0) / (inner + 1.0) * (end - start)
        look(s, r, b, setting, method, (ahead, place))
        if b.astray > 0:
            return


@internal
def guess(s, r, b, method, ahead, inner):
    """The channels at `inner` places that part the time between two neighbours into equal parts, of
    the cubic through both ends of their step and its rates, into b.inside: what tells whether the
    dense output is worth building."""
    start, end = r.sampled[older(r, ahead + 1)], r.sampled[older(r, ahead)]
    h = length(r, b, ahead)
    y0, y1, yd0, yd1 = ends(r, b, method, before(r, ahead))
    _, _, t, work, done = either_step(r, b, before(r, ahead))
    for i in range(inner):
        u = (start + (i + 1.0) / (inner + 1.0) * (end - start) - t) / h
        v, way = 1.0 - u, u * u * (3.0 - 2.0 * u)
        for k in range(b.y2.size):
            b.y2[k] = y0[k] + way * (y1[k] - y0[k]) + h * u * v * (v * yd0[k] - u * yd1[k])
        evaluate_inside(s, r, t + u * h, b.y2, b.rough)
        measure(s, t + u * h, b.y2, work + u * done, r.energy_0)
        gather(s, b.full, s.out, b.inside[i])
        square(s, r, b.inside[i])
        b.n_found, b.found[i] = i + 1, t + u * h
