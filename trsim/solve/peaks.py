"""Extremes of every channel: of the dense motion, right to the tolerance, never beyond it.

Channels are known at samples: the ends of steps and the output rows inside them.  Between two
samples a channel may pass an extreme.  The polynomial through its last POINTS samples says how far
it may go there, and its last term how uncertain that is.  Only where that is beyond the extreme so
far is the dense output evaluated, at the place where the polynomial is largest; the polynomial then
goes through that place too, until it promises nothing more.  What is kept is always a value of the
dense motion, so a run costs little once its extremes have been met.

Samples on two sides of an event have nothing to do with each other: `restart`.
"""

from math import sqrt

from trsim.elements import signatures as types
from trsim.elements.calls import caller
from trsim.elements.contract import SCENE, compiled
from trsim.elements.packed import A1, I1, f8, i8
from trsim.elements.vectors import internal
from trsim.solve.calls import DENSE_AT, INTERPOLATE_AT
from trsim.solve.dense_output import build, measure_inside
from trsim.solve.record import (
    BUFFERS,
    NEWEST,
    PEAK_MAX,
    PEAK_MAX_T,
    PEAK_MIN,
    PEAK_MIN_T,
    POINTS,
    RECORD,
    SAMPLES,
    TOLERANCE,
)

SHARE = 0.3  # of the tolerance, times the range of a channel: what may be missed
HALF, EASY, PROPORTION = 0.5, 1e-2, 7.0 / 8.0  # from the tolerance of a step to that
SURE = 0.2  # of that: a polynomial that doubts no more is believed
ROUNDING = 1e-12  # of the largest channel of its unit: less is no extreme
BEFORE = 10.0  # times that: the same of the term before the last
YOUNG = 2  # samples since an event: with fewer the middle between two is looked at in any case
CLOSE = 1e-3  # of the time between two samples: a third one nearer than that is none of its own
NEAR = 1e-4  # of it: an extreme so near a known place is known
DOUBT = 0.25  # of the last term of a polynomial: its error
SLOPES = 4  # samples whose polynomials tell the rates at both ends
PARTS, ROUNDS = 8, 3  # in which the top of a polynomial is looked for
TRIES = 6  # evaluations for one extreme of one channel

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
    apart = known < 2 or at - r.sampled[head] > CLOSE * (r.sampled[head] - r.sampled[before])
    new = (head + 1) % POINTS if apart else head
    last, older = r.sample[head], r.sample[before] if known > 1 else r.sample[head]
    now = r.sample[new]
    lengths(s, now, values)
    for c in range(now.size):
        if now[c] > r.peak[c, PEAK_MAX] or now[c] < r.peak[c, PEAK_MIN]:
            extreme(r.peak[c], at, now[c])
            grow(s, r, c, now[c])
    if apart and known > 0:
        b.found[0], share, told = 0.0, -1.0, False
        if known < YOUNG:
            built = look(s, r, b, method, t, h, 0.5 * (r.sampled[head] + at), projected, built)
        for c in range(now.size):
            if s.kin[c] < 0:
                continue
            v, v0, most, least = now[c], last[c], r.peak[c, PEAK_MAX], r.peak[c, PEAK_MIN]
            bend = abs(v - v0) + abs(v0 - older[c])
            if known < YOUNG:
                bend += abs(v - b.inside[0, c]) + abs(b.inside[0, c] - v0)
            high, low = max(v, v0) + bend > most, min(v, v0) - bend < least
            if not (high or low):
                continue
            if share < 0.0:
                share = missed(setting)
            enough = max(share * (most - least), ROUNDING * r.largest[s.kin[c]])
            if bend <= enough:
                continue
            if known >= SLOPES - 1:
                if not told:
                    rates(r, b, at)
                    told = True
                high, low = turns(r, b, now, c, most + enough, least - enough)
            if high:
                built = search(
                    s, r, b, enough, method, t, h, at, now, c, 1.0, projected, built
                )  # fmt: skip
            if low:
                built = search(
                    s, r, b, enough, method, t, h, at, now, c, -1.0, projected, built
                )  # fmt: skip
    r.count[NEWEST], r.sampled[new] = new, at
    if apart:
        r.count[SAMPLES] = min(known + 1, POINTS)
    return built


@internal
def missed(setting):
    """What may be missed of an extreme, as a part of the range of its channel: SHARE of the
    tolerance asked for, of which that of a step is made in outcome.py."""
    return SHARE * EASY * (setting[TOLERANCE] / (HALF * EASY)) ** PROPORTION


@internal
def grow(s, r, c, value):
    """Let the size of the channels of one unit follow."""
    g = s.kin[c]
    if g >= 0 and abs(value) > r.largest[g]:
        r.largest[g] = abs(value)


@internal
def lengths(s, now, values):
    """The channels and, behind them, the magnitudes of vectors among them."""
    for c in range(s.n_out):
        now[c] = values[c]
    for k in range(s.vector.size):
        x, y, z = values[s.vector[k]], values[s.vector[k] + 1], values[s.vector[k] + 2]
        now[s.n_out + k] = sqrt(x * x + y * y + z * z)


@internal
def rates(r, b, at):
    """Weights of the newest SLOPES values, `at` included, into b.node: of their polynomial's rate
    at the last sample and at `at`, and of the divided difference of order SLOPES - 1, times what
    it adds to either rate."""
    if r.count[SAMPLES] < SLOPES - 1:
        return
    head, times = r.count[NEWEST], b.node[0]
    times[0] = at
    for k in range(1, SLOPES):
        times[k] = r.sampled[(head + POINTS + 1 - k) % POINTS]
    h, old = at - times[1], times[1] - times[2]
    for j in range(SLOPES):
        product = 1.0
        for i in range(SLOPES):
            if i != j:
                product *= times[j] - times[i]
        b.node[3, j] = 1.0 / product
    # what the cubic term (x - t0)(x - t1)(x - t2) adds to the rate at t0 = at and at t1
    b.node[4, 0], b.node[4, 1] = h * (h + old), -h * old
    b.node[4, 2], b.node[4, 3] = h, old


@internal
def turns(r, b, now, c, most, least):
    """Whether channel c may rise beyond `most` and turn, and whether it may fall below `least`,
    between the newest sample and the present: a parabola, with the cubic term for its doubt."""
    head = r.count[NEWEST]
    v0, v1 = now[c], r.sample[head, c]
    v2 = r.sample[(head + POINTS - 1) % POINTS, c]
    v3 = r.sample[(head + POINTS - 2) % POINTS, c]
    h, old = b.node[4, 2], b.node[4, 3]
    third = b.node[3, 0] * v0 + b.node[3, 1] * v1 + b.node[3, 2] * v2 + b.node[3, 3] * v3
    rise = (v0 - v1) / h
    second = (rise - (v1 - v2) / old) / (h + old)
    end, start = rise + second * h, rise - second * h
    off_end, off_start = abs(third * b.node[4, 0]), abs(third * b.node[4, 1])
    up, down = start + off_start, off_end - end
    above = up > 0.0 and down > 0.0 and max(v0, v1) + arch(up, down, h) > most
    up, down = off_start - start, end + off_end
    below = up > 0.0 and down > 0.0 and min(v0, v1) - arch(up, down, h) < least
    return above, below


@internal
def arch(up, down, h):
    """How far a curve that starts with one slope and ends with the other rises above the higher of
    its ends: at most what the tangents allow."""
    return h * up * down / (up + down)


@internal
def extreme(p, t, value):
    """Take a value into a channel's extremes."""
    if value > p[PEAK_MAX]:
        p[PEAK_MAX], p[PEAK_MAX_T] = value, t
    if value < p[PEAK_MIN]:
        p[PEAK_MIN], p[PEAK_MIN_T] = value, t


@internal
def restart(s, r, t):
    """Begin anew with the channels in s.out, those behind an event."""
    lengths(s, r.sample[0], s.out)
    for c in range(r.sample.shape[1]):
        extreme(r.peak[c], t, r.sample[0, c])
        grow(s, r, c, r.sample[0, c])
    r.count[NEWEST], r.count[SAMPLES], r.sampled[0] = 0, 1, t


@internal
def search(s, r, b, enough, method, t, h, at, now, c, sign, projected, built):
    """Look for an extreme of channel c between the newest sample and `at`, by its polynomial.

    sign: 1 for a maximum, -1 for a minimum; enough: what may be missed.  A polynomial that is much
    surer than that is taken at its word.
    """
    p, start = r.peak[c], r.sampled[r.count[NEWEST]]
    for _ in range(TRIES):
        best = p[PEAK_MAX] if sign > 0.0 else -p[PEAK_MIN]
        n = nodes(r, b, at, now, c, sign)
        differences(b.node, n)
        if not highest(b.node, n) > best + enough:
            break
        place, promised = top(b.node, n, start, at)
        if not promised > best + enough or known_place(b, start, at, place):
            break
        said = polynomial(b.node[0], b.node[2], n, place, 0.0)
        if n == POINTS and promised - said < SURE * enough and settled(b, place, enough):
            extreme(p, place, sign * said)
            break
        if int(b.found[0]) + 1 >= b.found.size:
            break
        built = look(s, r, b, method, t, h, place, projected, built)
    return built


@internal
def look(s, r, b, method, t, h, place, projected, built):
    """Evaluate all channels at a place inside the step, and keep them in b.inside and b.found."""
    if built == 0:
        build(s, r, b, method[DENSE_AT], t, h)
    k = int(b.found[0])
    measure_inside(s, r, b, method[INTERPOLATE_AT], place, (place - t) / h, projected)
    lengths(s, b.inside[k], s.out)
    b.found[0], b.found[1 + k] = k + 1.0, place
    for o in range(r.sample.shape[1]):
        extreme(r.peak[o], place, b.inside[k, o])
    return 1


@internal
def settled(b, place, enough):
    """Whether the last but one term of the polynomial is small too: of a channel that swings faster
    than it is sampled the last one passes zero by chance."""
    with_it = polynomial(b.node[0], b.node[2], POINTS - 1, place, 0.0)
    without = polynomial(b.node[0], b.node[2], POINTS - 2, place, 0.0)
    return DOUBT * abs(with_it - without) < BEFORE * SURE * enough


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
def nodes(r, b, at, now, c, sign):
    """Fill b.node with times and values of sign times channel c; how many there are.

    Both samples around come first, then what was found between them, then older samples: the last
    one is what the polynomial may do without.
    """
    times, values = b.node[0], b.node[1]
    head, found = r.count[NEWEST], int(b.found[0])
    times[0], values[0] = at, sign * now[c]
    times[1], values[1] = r.sampled[head], sign * r.sample[head, c]
    n = 2
    for k in range(max(0, found - POINTS + 3), found):
        times[n], values[n] = b.found[1 + k], sign * b.inside[k, c]
        n += 1
    for k in range(1, r.count[SAMPLES]):
        if n == POINTS:
            break
        old = (head + POINTS - k) % POINTS
        times[n], values[n] = r.sampled[old], sign * r.sample[old, c]
        n += 1
    return n


@internal
def differences(node, n):
    """Newton's form of the polynomial through n nodes, into node[2]."""
    times, slope = node[0], node[2]
    for i in range(n):
        slope[i] = node[1, i]
    for j in range(1, n):
        for i in range(n - 1, j - 1, -1):
            slope[i] = (slope[i] - slope[i - 1]) / (times[i] - times[i - j])


@internal
def highest(node, n):
    """What the polynomial does not exceed between its first two nodes, with what `top` adds.

    Between them |(x - t0) (x - t1)| is a quarter of the square of their distance at most, and x is
    no further from another node than the further one of them is.
    """
    times, slope = node[0], node[2]
    most, h = max(node[1, 0], node[1, 1]), times[0] - times[1]
    if n == 2:
        return most + DOUBT * abs(slope[1]) * h
    term = 0.25 * h * h
    for i in range(2, n):
        most += (1.0 + (DOUBT if i == n - 1 else 0.0)) * abs(slope[i]) * term
        term *= max(abs(times[0] - times[i]), abs(times[1] - times[i]))
    return most


@internal
def top(node, n, start, end):
    """Where the polynomial of `differences` may be largest between two times, and how large.

    The last term, which another node changed, counts as its error.
    """
    times, slope = node[0], node[2]
    place, best, low, high = start, -1e300, start, end
    for _ in range(ROUNDS):
        width = (high - low) / PARTS
        for k in range(PARTS + 1):
            x = low + k * width
            value = polynomial(times, slope, n, x, DOUBT)
            if value > best:
                best, place = value, x
        low, high = max(start, place - width), min(end, place + width)
    if low < place < high:
        # the vertex of the parabola through the last three
        f0, f2 = (polynomial(times, slope, n, low, DOUBT), polynomial(times, slope, n, high, DOUBT))
        left, right = (best - f0) / (place - low), (best - f2) / (high - place)
        if left + right > 0.0:
            x = place + 0.5 * (left * (high - place) - right * (place - low)) / (left + right)
            value = polynomial(times, slope, n, x, DOUBT)
            if value > best:
                best, place = value, x
    return place, best


@internal
def polynomial(times, slope, n, x, doubt):
    """Its value at x in Newton's form, and on top that much of the size of its last term."""
    value, term = slope[0], 1.0
    for i in range(1, n):
        term *= x - times[i - 1]
        value += slope[i] * term
    return value + doubt * abs(slope[n - 1] * term)
