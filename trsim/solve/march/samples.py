"""The last samples of all channels whose extremes are looked for, and polynomials through them.

Samples are values at the ends of steps and at output rows inside them, POINTS of them kept in a
ring.  Their divided differences f[t0], f[t0, t1], ... are kept too, newest first: one pass over all
channels for each sample.

What kinematic analysis finds inside steps is exact, and no error of a dense output bends what goes
through it.  There more samples are kept (EXACT_POINTS), what was found between two is a sample of
its own from then on, and of magnitudes the squares are kept, which have no kink where a vector
passes zero.

Between two neighbours polynomials are in Newton's form with the later of the two first, the earlier
one second, then what was found between them, then the sample behind them if there is one, then
older ones:

    p(x) = f[a] + f[a, b] (x - a) + f[a, b, c] (x - a) (x - b) + ...

Divided differences do not depend on the order of their places: as long as nothing was found in
between, all but the first two are those kept, wherever the interval lies.

Samples on two sides of an event have nothing to do with each other: `behind`.
"""

from math import sqrt

from trsim.assemble.linear import smallest_pivot
from trsim.assemble.outputs import measure
from trsim.kernels.lazy import internal
from trsim.kernels.vectors import copy_to
from trsim.solve.march.land import limits_to_measure
from trsim.solve.march.polynomials import ENOUGH, SLOWEST, differences, doubt, factors, invert, lay
from trsim.solve.march.record import PEAK_MAX, PEAK_MAX_T, PEAK_MIN, PEAK_MIN_T

CLOSE = 1e-3  # of the time between two samples: a third one nearer than that is none of its own
# of it: an extreme so near a known place is known; where samples are exact
NEAR, NEAREST = 1e-4, 1e-5
AWAY = 0.1  # of the way to the next known place
APART = 0.1  # of the time between two samples: what was found so near to one of them is none
YOUNG = 3  # samples since an event: with no more what lies between them is looked at in any case
NOT_LAID = -1
LEAST = 1e-300  # not to divide zero by zero
# times the error of a polynomial next to a sample where its channel turns back, or that no sample
# follows: on which side of it must be plain
TURNED = 4.0


@internal
def behind(s, r, b, t):
    """Begin anew with the channels behind an event, of the state r.y, which was evaluated last."""
    limits_to_measure(s, t, r.y, firmness(s), b.rough[0])
    measure(s, t, r.y, r.work_projection, r.energy_0)
    restart(s, r, b, t)


@internal
def restart(s, r, b, t):
    """Begin anew with the channels in s.out."""
    gather(s, b.full, s.out, r.sample[0])
    square(s, r, r.sample[0])
    b.firm[0] = firmness_of_extremes(s)
    known_extremes(s, r, b, t)
    for c in range(s.sought.size):
        r.slope[0, c] = r.sample[0, c]
    r.newest, r.n_samples, r.unseen, r.sampled[0] = 0, 1, 0, t


@internal
def push(s, r, b, at, values):
    """Keep the channels at a time; whether that is a sample of its own.

    One that is too near to the newest takes its place.
    """
    head, known = r.newest, r.n_samples
    own = known < 2 or at - r.sampled[head] > CLOSE * (r.sampled[head] - r.sampled[older(r, 1)])
    if own:
        most = r.sampled.size
        r.newest, r.n_samples = (head + 1) % most, min(known + 1, most)
    new = r.newest
    gather(s, b.full, values, r.sample[new])
    square(s, r, r.sample[new])
    r.sampled[new] = at
    if own:
        take(r, b)
    else:
        anew(r, b)
    return own


@internal
def older(r, k):
    """Where in the ring the sample is that is k older than the newest."""
    return (r.newest + r.sampled.size - k) % r.sampled.size


@internal
def take(r, b):
    """Divided differences of all channels with a new sample: f[t0], f[t0, t1], ... newest first."""
    n, now, inverse = r.n_samples, r.sample[r.newest], b.node[3]
    at = r.sampled[r.newest]
    for k in range(1, n):
        inverse[k] = 1.0 / (at - r.sampled[older(r, k)])
    d, before, kept = r.slope, b.bound[0], b.bound[1]
    copy_to(before, d[0])
    copy_to(d[0], now)
    for k in range(1, n):
        above, row, by = d[k - 1], d[k], inverse[k]
        copy_to(kept, row)  # one loop for both would not take several channels at a time
        for c in range(now.size):
            row[c] = (above[c] - before[c]) * by
        before, kept = kept, before


@internal
def anew(r, b):
    """The divided differences made again, where the newest sample was replaced."""
    head, known, most = r.newest, r.n_samples, r.sampled.size
    for k in range(known):
        r.newest, r.n_samples = (head + most + 1 - known + k) % most, k + 1
        take(r, b)


@internal
def keep_found(r, b):
    """What was found between the two samples before the newest becomes samples of its own, where it
    is not next to one."""
    near, kept = APART * (r.sampled[older(r, 1)] - r.sampled[older(r, 2)]), 0
    for k in range(b.n_found):
        if kept == r.sampled.size // 2:  # both samples stay
            break
        place, behind = b.found[k], 1
        while r.sampled[older(r, behind)] > place:
            behind += 1
        next_ones = r.sampled[older(r, behind)], r.sampled[older(r, behind - 1)]
        if min(place - next_ones[0], next_ones[1] - place) > near:
            put_in(r, behind, place, b.inside[k])
            kept += 1
    if kept > 0:
        anew(r, b)


@internal
def put_in(r, behind, place, values):
    """A sample between those that are `behind` - 1 and `behind` older than the newest."""
    most = r.sampled.size
    r.newest, r.n_samples = (r.newest + 1) % most, min(r.n_samples + 1, most)
    for k in range(behind):
        to, off = older(r, k), older(r, k + 1)
        r.sampled[to] = r.sampled[off]
        copy_to(r.sample[to], r.sample[off])
    own = older(r, behind)
    r.sampled[own] = place
    copy_to(r.sample[own], values)


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
def square(s, r, sought):
    """Of magnitudes their squares, which have no kink where a vector passes zero; where samples
    are exact only: nothing else resolves the square."""
    for c in range(sought.size):
        if squared(s, r, c):
            sought[c] *= sought[c]


@internal
def squared(s, r, c):
    """Whether the square of the c-th channel that is sought is kept."""
    return r.driven > 0 and s.sought[c] >= s.n_out


@internal
def kept_as(s, r, c, value):
    """What is kept of a value of the c-th channel that is sought; less than any of one below zero
    of a magnitude."""
    if not squared(s, r, c):
        return value
    return value * value if value > 0.0 else -1e300


@internal
def nearest(s, r, c, sign):
    """How near to a known place an extreme is known too: as near as its channel is flat there, and
    next to where a vector passes zero its magnitude is not."""
    if r.driven == 0:
        return NEAR
    return NEAREST * NEAREST if sign < 0.0 and squared(s, r, c) else NEAREST


@internal
def value_of(s, r, c, kept):
    """The value that is kept so."""
    return sqrt(max(kept, 0.0)) if squared(s, r, c) else kept


@internal
def constant(r, c, rough):
    """Whether all samples of channel c are the same to rounding, which polynomials enlarge."""
    if r.driven == 0:
        return False
    high = low = r.sample[r.newest, c]
    for k in range(1, r.n_samples):
        value = r.sample[older(r, k), c]
        high, low = max(high, value), min(low, value)
    return r.n_samples > YOUNG and high - low <= rough


@internal
def known_extremes(s, r, b, t):
    """Take all channels of one time, in b.full, into their extremes; the sizes of those of one kind
    follow.  b.firm[0] is the least pivot there."""
    full, high, low, beyond = b.full, r.peak[PEAK_MAX], r.peak[PEAK_MIN], 0
    for c in range(full.size):
        beyond += int(full[c] > high[c]) + int(full[c] < low[c])
    if beyond == 0:
        return
    for c in range(full.size):
        extreme(r, c, t, full[c], b.firm[0])
    largest, kin, lever, sought = r.largest, s.kin, s.lever, s.sought
    for k in range(kin.size):
        size = lever[k] * abs(full[sought[k]])
        if size > largest[kin[k]]:  # rarely: to write it in any case makes the next one wait
            largest[kin[k]] = size


@internal
def extreme(r, c, t, value, pivot):
    """Take a value into the extremes of channel c; pivot: the least of the rows there."""
    p = r.peak
    if value > p[PEAK_MAX, c]:
        p[PEAK_MAX, c], p[PEAK_MAX_T, c], r.firm[0, c] = value, t, pivot
    if value < p[PEAK_MIN, c]:
        p[PEAK_MIN, c], p[PEAK_MIN_T, c], r.firm[1, c] = value, t, pivot


@internal
def firmness(s):
    """How far rows are from depending on each other at the last evaluation: where they nearly do,
    what they carry is chance (chance.py).  1 of open chains, which have no such places."""
    return smallest_pivot(s) if s.near_rows > 0.0 else 1.0


@internal
def firmness_of_extremes(s):
    """The same for what is told of extremes, with bodies without mass or inertia too.

    What these are solved with makes every pivot small, so nothing that steps do depends on them.
    """
    return smallest_pivot(s) if s.looped.size > 0 else firmness(s)


# --- polynomials between two neighbours: `ahead` samples are newer than the later of them --------


@internal
def nodes(r, b, ahead):
    """Fill the times of b.node for polynomials between two neighbours; how many there are."""
    times, found = b.node[0], b.n_found
    n = min(r.n_samples + found, r.sampled.size)
    times[0], times[1] = r.sampled[older(r, ahead)], r.sampled[older(r, ahead + 1)]
    for k in range(2, min(2 + found, n)):
        times[k] = b.found[k - 2]
    for k in range(2 + found, n):
        times[k] = r.sampled[other(r, ahead, k - found)]
    return n


@internal
def other(r, ahead, k):
    """Where in the ring the k-th node is, k >= 2: first the sample ahead, then those before."""
    return r.newest if k == 1 + ahead else older(r, k)


@internal
def bounds(r, b, ahead):
    """How far every channel goes beyond both its values between two neighbours, at most, into
    b.bound[1]; the slopes of their chords into b.bound[0].

    All terms but the chord have the factor (x - a) (x - b), so together they are at most
    4 B u (1 - u) at the part u between the two, B the sum of their bounds.  With the chord, D from
    end to end, that is beyond the higher end by (4 B - D)^2 / (16 B), and nowhere if 4 B < D.
    """
    n, times, size = nodes(r, b, ahead), b.node[0], b.node[4]
    chord, beyond, d = b.bound[0], b.bound[1], r.slope
    end, start = r.sample[older(r, ahead)], r.sample[older(r, ahead + 1)]
    h = times[0] - times[1]
    for c in range(beyond.size):
        chord[c] = (end[c] - start[c]) / h
        beyond[c] = 0.0
    if n == 2:
        for c in range(beyond.size):
            beyond[c] = abs(end[c] - start[c])
        return
    factors(times, size, n)
    for k in range(2, n):
        row, by = d[k], size[k]
        for c in range(beyond.size):
            beyond[c] += abs(row[c]) * by
    last, size_of_last, size_of_second = d[n - 1], size[n - 1], 0.0
    second = d[n - 2]
    if n >= ENOUGH:  # no more than `lacking` may say
        size_of_last /= 1.0 - SLOWEST
        size_of_second = size[n - 2] / (1.0 - SLOWEST)
    if ahead == 0:
        size_of_last, size_of_second = TURNED * size_of_last, TURNED * size_of_second
    for c in range(beyond.size):
        more = max(abs(last[c]) * size_of_last, abs(second[c]) * size_of_second)
        bend = 4.0 * (beyond[c] + more)
        rest = max(bend - abs(end[c] - start[c]), 0.0)
        beyond[c] = rest * rest / max(4.0 * bend, LEAST)


@internal
def known_place(b, start, end, place, near):
    """Whether the channels are known next to this place between two samples: within `near` of their
    distance."""
    near = near * (end - start)
    if place - start < near or end - place < near:
        return True
    for k in range(b.n_found):  # noqa: SIM110 - a generator does not compile
        if abs(b.found[k] - place) < near:
            return True
    return False


@internal
def aside(b, start, end, place):
    """A place away from one that is known, towards the further of the two known ones next to it."""
    near, low, high = NEAR * (end - start), start, end
    for k in range(b.n_found):
        x = b.found[k]
        low = x if low < x < place - near else low
        high = x if place + near < x < high else high
    return place + AWAY * ((high if high - place > place - low else low) - place)


@internal
def through(r, b, ahead, c, sign):
    """The polynomial through sign times channel c, into b.node and b.lattice; how many nodes.

    The last node is what the polynomial may do without.  Where more was found than it can go
    through, it goes through the places around the best one, the two next to it first.
    """
    found, values, slope = b.n_found, b.node[1], b.node[2]
    end, start = older(r, ahead), older(r, ahead + 1)
    if found > r.sampled.size - 2:
        values[0], values[1] = sign * r.sample[end, c], sign * r.sample[start, c]
        b.node[0, 0], b.node[0, 1] = r.sampled[end], r.sampled[start]
        n = around_best(b, found, c, sign)
        lay(b, n)
        invert(b, n)
        b.laid = NOT_LAID
        differences(b, n)
        doubt(b, n, 1.0)
        return n
    n, surer = min(r.n_samples + found, r.sampled.size), 1.0
    if ahead == 0 or turns(r, ahead, c) or turns(r, ahead + 1, c):
        surer = TURNED
    if b.laid != found:
        lay(b, nodes(r, b, ahead))
        if found > 0:
            invert(b, n)
        b.laid = found
    values[0], values[1] = sign * r.sample[end, c], sign * r.sample[start, c]
    if found == 0:  # as `take` and `bounds` have them
        slope[0], slope[1] = values[0], sign * b.bound[0, c]
        for k in range(2, n):
            slope[k] = sign * r.slope[k, c]
        doubt(b, n, surer)
        return n
    for k in range(found):
        values[2 + k] = sign * b.inside[k, c]
    for k in range(2 + found, n):
        values[k] = sign * r.sample[other(r, ahead, k - found), c]
    differences(b, n)
    doubt(b, n, surer)
    return n


@internal
def turns(r, k, c):
    """Whether channel c turns back at the sample that is k older than the newest."""
    if k < 1 or k + 1 >= r.n_samples:
        return False
    here = r.sample[older(r, k), c]
    return (here - r.sample[older(r, k - 1), c]) * (here - r.sample[older(r, k + 1), c]) > 0.0


@internal
def around_best(b, found, c, sign):
    """Replace the nodes, both ends of an interval, by those around the best place known in it."""
    times, values = b.node[0], b.node[1]
    end, start, last, first = times[0], times[1], values[0], values[1]
    place, best = (end, last) if last > first else (start, first)
    for k in range(found):
        if sign * b.inside[k, c] > best:
            place, best = b.found[k], sign * b.inside[k, c]
    low, high = start, end
    for k in range(found):
        x = b.found[k]
        low = x if low < x < place else low
        high = x if place < x < high else high
    n, most = 0, b.node.shape[1]
    for k in range(-2, found):
        x = end if k == -2 else start if k == -1 else b.found[k]
        value = last if k == -2 else first if k == -1 else sign * b.inside[k, c]
        # those of the interval first, then the others by their distance to its middle
        at = min(n, most)
        while at > 0 and further(times[at - 1], x, low, high):
            if at < most:
                times[at], values[at] = times[at - 1], values[at - 1]
            at -= 1
        if at < most:
            times[at], values[at] = x, value
            n += 1 if n < most else 0
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
