"""Extremes of every channel: of the dense motion, right to the tolerance, never beyond it.

Channels are known at samples: the ends of steps and the output rows inside them.  Between two
samples a channel may pass an extreme.  The polynomial through its last POINTS samples says how far
it may go there, and its last term how uncertain that is.  Only where that is beyond the extreme so
far is the dense output evaluated, at the place where the polynomial is largest; the polynomial then
goes through that place too, until it promises nothing more.  What is kept is always a value of the
dense motion, so a run costs little once its extremes have been met.

A dense output that is not there yet costs several evaluations.  Before it is built the middle of
the step is guessed by the cubic through both its ends; a channel that with it plainly goes one way,
or stays plainly within its extremes, has none there.

Samples on two sides of an event have nothing to do with each other: `restart`.
"""

from math import sqrt

from trsim.assemble.outputs import measure
from trsim.elements import signatures as types
from trsim.elements.calls import caller
from trsim.elements.contract import SCENE, compiled
from trsim.elements.packed import A1, I1, f8, i8
from trsim.elements.vectors import internal
from trsim.solve.calls import INTERPOLATE_AT, LAST_AT
from trsim.solve.dense_output import build, measure_inside
from trsim.solve.land import evaluate_inside
from trsim.solve.polynomials import (
    DOUBT,
    SURE,
    apart,
    differences,
    lay,
    one_way,
    polynomial,
    reach,
    settled,
    top,
)
from trsim.solve.record import (
    BUFFERS,
    ENERGY_0,
    MISSED,
    NEWEST,
    PEAK_MAX,
    PEAK_MAX_T,
    PEAK_MIN,
    PEAK_MIN_T,
    POINTS,
    RECORD,
    SAMPLES,
    STEPS,
    WORK_PROJECTION,
)

ROUNDING = 1e-12  # of the largest channel of its unit: less is no extreme
YOUNG = 2  # samples since an event: with fewer the middle between two is looked at in any case
TINY = 0.02  # of the mean step: in a shorter one nothing turns
CLOSE = 1e-3  # of the time between two samples: a third one nearer than that is none of its own
NEAR = 1e-4  # of it: an extreme so near a known place is known
NOT_LAID = -1.0
GUESSED = 0.02  # of what a channel changes by: how wrong the guess of its middle may be
TRIES = 12  # evaluations for one extreme of one channel: a kink is approached slowly

#                     scene  record  buffers setting method t  h   at values projected built
SAMPLE = types.int64(SCENE, RECORD, BUFFERS, A1, I1, f8, f8, f8, A1, f8, i8)
call_sample = caller(SAMPLE)


@compiled(SAMPLE)
def sample(s, r, b, setting, method, t, h, at, values, projected, built):
    """Take the channels at one time of the step from t into their extremes, and what lies between
    them and those of the sample before.

    built: whether b.P holds the dense output.  Returns whether it does now.
    """
    head, known = r.count[NEWEST], r.count[SAMPLES]
    if known > 0 and at <= r.sampled[head]:
        return built
    before = (head + POINTS - 1) % POINTS
    own = known < 2 or at - r.sampled[head] > CLOSE * (r.sampled[head] - r.sampled[before])
    new = (head + 1) % POINTS if own else head
    now = r.sample[new]
    gather(s, b.full, values, now)
    known_extremes(s, r, b.full, at)
    if own and known > 0:
        b.found[0], b.laid[0] = 0.0, NOT_LAID
        if known < YOUNG and h * r.count[STEPS] >= TINY * t:
            if built == 0:
                guess(s, r, b, method, t, h, projected)
            else:
                built = look(s, r, b, method, t, h, 0.5 * (r.sampled[head] + at), projected, built)
        take(r, b, at, now, known)
        built = between(s, r, b, setting, method, t, h, at, now, projected, built)
    r.count[NEWEST], r.sampled[new] = new, at
    if own:
        r.count[SAMPLES] = min(known + 1, POINTS)
    else:
        anew(r, b)
    return built


@internal
def take(r, b, at, now, known):
    """Divided differences of all channels with a new sample: f[t0], f[t0, t1], ... newest first.

    known: samples before it.  Also, into b.node[4] and [5], what the product (x - t0) ...
    (x - tk-1) and its rate do not exceed between the two newest: the first two factors a quarter of
    the square of their distance, each other one the distance of the further one.
    """
    head, n = r.count[NEWEST], min(known + 1, POINTS)
    inverse, most, steep = b.node[3], b.node[4], b.node[5]
    h = at - r.sampled[head]
    most[1], term, rate = h, 0.25 * h * h, h
    for k in range(1, n):
        apart = at - r.sampled[(head + POINTS + 1 - k) % POINTS]
        inverse[k] = 1.0 / apart
        if k > 1:
            most[k], steep[k] = term, rate
            rate = rate * apart + term
            term *= apart
    d, before = r.slope, b.bound[0]
    for c in range(now.size):
        before[c] = d[0, c]
        d[0, c] = now[c]
    for k in range(1, n):
        above, row, by = d[k - 1], d[k], inverse[k]
        for c in range(now.size):
            old = row[c]
            row[c] = (above[c] - before[c]) * by
            before[c] = old


@internal
def anew(r, b):
    """The divided differences made again, where the newest sample was replaced."""
    head, known = r.count[NEWEST], r.count[SAMPLES]
    for k in range(known):
        j = (head + POINTS + 1 - known + k) % POINTS
        r.count[NEWEST] = (j + POINTS - 1) % POINTS
        take(r, b, r.sampled[j], r.sample[j], k)
    r.count[NEWEST] = head


@internal
def between(s, r, b, setting, method, t, h, at, now, projected, built):
    """Look for the extremes of all channels between the newest sample and `at`."""
    share, last = setting[MISSED], r.sample[r.count[NEWEST]]
    n = min(r.count[SAMPLES] + 1, POINTS)
    bounds(r, b, n)
    for c in range(now.size):
        high, low = r.peak[PEAK_MAX, s.sought[c]], r.peak[PEAK_MIN, s.sought[c]]
        bend, turn = b.bound[1, c], b.bound[2, c]
        if n > 2 and turn < abs(r.slope[1, c]) and b.found[0] == 0.0:
            continue  # it goes one way all the time
        above, below = max(now[c], last[c]), min(now[c], last[c])
        for k in range(int(b.found[0])):
            above, below = max(above, b.inside[k, c]), min(below, b.inside[k, c])
        bend += above - below if b.found[0] > 0.0 else 0.0
        enough = max(share * (high - low), ROUNDING * r.largest[s.kin[c]])
        rises = above + bend > high + enough
        falls = low > s.least[c] and below - bend < low - enough
        if not (rises or falls):
            continue
        found = b.found[0]
        if found <= POINTS - 2:  # one polynomial through all that was found
            nodes_of = through(r, b, at, now, c, 1.0)
            guessed = built == 0 and found > 0.0
            if guessed and one_way(b.node, nodes_of):
                continue
            up, down = reach(b, nodes_of)
            margin = -GUESSED * apart(b.node) if guessed else enough
            rises, falls = rises and up > high + margin, falls and down < low - margin
        if rises:
            built = search(s, r, b, enough, method, t, h, at, now, c, 1.0, projected, built)
        if falls:
            built = search(s, r, b, enough, method, t, h, at, now, c, -1.0, projected, built)
    return built


@internal
def bounds(r, b, n):
    """What every channel bends by between the two newest samples, and its slope changes by, at
    most, into b.bound[1] and [2]."""
    d, bend, turn = r.slope, b.bound[1], b.bound[2]
    most, steep = b.node[4], b.node[5]
    for c in range(bend.size):
        last = DOUBT * abs(d[n - 1, c])
        bend[c], turn[c] = last * most[n - 1], last * steep[n - 1]
    for k in range(2, n):
        row, by, rate = d[k], most[k], steep[k]
        for c in range(bend.size):
            bend[c] += abs(row[c]) * by
            turn[c] += abs(row[c]) * rate


@internal
def gather(s, full, values, sought):
    """Fill `full` with the channels and, behind them, the magnitudes of vectors among them, and
    `sought` with those whose extremes are looked for between samples."""
    for c in range(s.n_out):
        full[c] = values[c]
    for k in range(s.vector.size):
        x, y, z = values[s.vector[k]], values[s.vector[k] + 1], values[s.vector[k] + 2]
        full[s.n_out + k] = sqrt(x * x + y * y + z * z)
    for k in range(sought.size):
        sought[k] = full[s.sought[k]]


@internal
def known_extremes(s, r, full, t):
    """Take all channels of one time into their extremes; the sizes of those of one unit follow."""
    high, low, beyond = r.peak[PEAK_MAX], r.peak[PEAK_MIN], 0
    for c in range(full.size):
        beyond += int(full[c] > high[c]) + int(full[c] < low[c])
    if beyond == 0:
        return
    for c in range(full.size):
        extreme(r.peak, c, t, full[c])
    for k in range(s.kin.size):
        r.largest[s.kin[k]] = max(r.largest[s.kin[k]], abs(full[s.sought[k]]))


@internal
def extreme(p, c, t, value):
    """Take a value into the extremes p of channel c."""
    if value > p[PEAK_MAX, c]:
        p[PEAK_MAX, c], p[PEAK_MAX_T, c] = value, t
    if value < p[PEAK_MIN, c]:
        p[PEAK_MIN, c], p[PEAK_MIN_T, c] = value, t


@internal
def restart(s, r, b, t):
    """Begin anew with the channels in s.out, those behind an event."""
    gather(s, b.full, s.out, r.sample[0])
    known_extremes(s, r, b.full, t)
    for c in range(s.sought.size):
        r.slope[0, c] = r.sample[0, c]
    r.count[NEWEST], r.count[SAMPLES], r.sampled[0] = 0, 1, t


@internal
def search(s, r, b, enough, method, t, h, at, now, c, sign, projected, built):
    """Look for an extreme of channel c between the newest sample and `at`, by its polynomial.

    sign: 1 for a maximum, -1 for a minimum; enough: what may be missed.  A polynomial that is much
    surer than that is taken at its word.
    """
    o = s.sought[c]
    for _ in range(TRIES):
        best = r.peak[PEAK_MAX, o] if sign > 0.0 else -r.peak[PEAK_MIN, o]
        guessed = built == 0 and b.found[0] > 0.0
        n = through(r, b, at, now, c, sign)
        if guessed and one_way(b.node, n):
            break
        low, high = b.node[0, 1], b.node[0, 0]
        wanted = best - GUESSED * apart(b.node) if guessed else best + enough
        place, promised = top(b, n, low, high, wanted)
        if not promised > wanted:
            break
        if not guessed:
            if known_place(b, low, high, place):
                break
            said = polynomial(b.node, n, place, 0.0)
            if n == POINTS and promised - said < SURE * enough and settled(b.node, place, enough):
                extreme(r.peak, o, place, sign * said)
                break
        if built == 0 and not guessed:
            guess(s, r, b, method, t, h, projected)
            continue
        if guessed:
            b.found[0], b.laid[0] = 0.0, NOT_LAID
            built = look(s, r, b, method, t, h, 0.5 * (low + high), projected, built)
            continue
        if int(b.found[0]) + 1 >= b.found.size:
            break
        built = look(s, r, b, method, t, h, place, projected, built)
    return built


@internal
def look(s, r, b, method, t, h, place, projected, built):
    """Evaluate all channels at a place inside the step, and keep them in b.inside and b.found."""
    if built == 0:
        build(s, r, b, method, t, h)
    k = int(b.found[0])
    measure_inside(s, r, b, method[INTERPOLATE_AT], place, (place - t) / h, projected)
    gather(s, b.full, s.out, b.inside[k])
    known_extremes(s, r, b.full, place)
    b.found[0], b.found[1 + k] = k + 1.0, place
    return 1


@internal
def guess(s, r, b, method, t, h, projected):
    """The channels in the middle of the step, of the cubic through both ends and their rates,
    into b.inside: what tells whether the dense output is worth building."""
    last = method[LAST_AT]
    for k in range(b.y2.size):
        b.y2[k] = 0.5 * (r.y[k] + b.y1[k]) + 0.125 * h * (r.yd[k] - b.K[last, k])
    middle = t + 0.5 * h
    evaluate_inside(s, r, middle, b.y2, b.rough[0])
    measure(s, middle, b.y2, r.clock[WORK_PROJECTION] + 0.5 * projected, r.clock[ENERGY_0])
    gather(s, b.full, s.out, b.inside[0])
    b.found[0], b.found[1] = 1.0, middle


@internal
def known_place(b, start, end, place):
    """Whether the channels are known at this place between two samples."""
    near = NEAR * (end - start)
    if place - start < near or end - place < near:
        return True
    for k in range(int(b.found[0])):  # noqa: SIM110 - a generator does not compile
        if abs(b.found[1 + k] - place) < near:
            return True
    return False


@internal
def through(r, b, at, now, c, sign):
    """The polynomial through sign times channel c, into b.node and b.lattice; how many nodes.

    Both samples around come first, then what was found between them, then older samples: the last
    one is what the polynomial may do without.  Where more was found than it can go through, it
    goes through the places around the best one, the two next to it first.
    """
    found, values, slope = int(b.found[0]), b.node[1], b.node[2]
    if found > POINTS - 2:
        values[0], values[1] = sign * now[c], sign * r.sample[r.count[NEWEST], c]
        b.node[0, 0], b.node[0, 1] = at, r.sampled[r.count[NEWEST]]
        n = around_best(b, found, c, sign)
        lay(b, n)
        b.laid[0] = NOT_LAID
        differences(b, n)
        return n
    if b.laid[0] != found:
        lay(b, nodes(r, b, at, found))
        b.laid[0] = found
    n, head = min(r.count[SAMPLES] + 1 + found, POINTS), r.count[NEWEST]
    values[0], values[1] = sign * now[c], sign * r.sample[head, c]
    if found == 0:  # as `take` has them
        for k in range(n):
            slope[k] = sign * r.slope[k, c]
        return n
    for k in range(found):
        values[2 + k] = sign * b.inside[k, c]
    for k in range(2 + found, n):
        values[k] = sign * r.sample[(head + POINTS + 1 + found - k) % POINTS, c]
    differences(b, n)
    return n


@internal
def nodes(r, b, at, found):
    """Fill the times of b.node where less was found than a polynomial goes through; how many."""
    times, head, n = b.node[0], r.count[NEWEST], min(r.count[SAMPLES] + 1 + found, POINTS)
    times[0], times[1] = at, r.sampled[head]
    for k in range(found):
        times[2 + k] = b.found[1 + k]
    for k in range(2 + found, n):
        times[k] = r.sampled[(head + POINTS + 1 + found - k) % POINTS]
    return n


@internal
def around_best(b, found, c, sign):
    """Replace the nodes, both ends of an interval, by those around the best place known in it."""
    times, values = b.node[0], b.node[1]
    end, start, last, first = times[0], times[1], values[0], values[1]
    place, best = (end, last) if last > first else (start, first)
    for k in range(found):
        if sign * b.inside[k, c] > best:
            place, best = b.found[1 + k], sign * b.inside[k, c]
    low, high = start, end
    for k in range(found):
        x = b.found[1 + k]
        low = x if low < x < place else low
        high = x if place < x < high else high
    n = 0
    for k in range(-2, found):
        x = end if k == -2 else start if k == -1 else b.found[1 + k]
        value = last if k == -2 else first if k == -1 else sign * b.inside[k, c]
        # those of the interval first, then the others by their distance to its middle
        at = min(n, POINTS)
        while at > 0 and further(times[at - 1], x, low, high):
            if at < POINTS:
                times[at], values[at] = times[at - 1], values[at - 1]
            at -= 1
        if at < POINTS:
            times[at], values[at] = x, value
            n += 1 if n < POINTS else 0
    return n


@internal
def further(one, other, low, high):
    """Whether a node is to stand behind another: the end of the interval first, then its start."""
    if high in (one, other):
        return other == high
    if low in (one, other):
        return other == low
    middle = 0.5 * (low + high)
    return abs(one - middle) > abs(other - middle)
