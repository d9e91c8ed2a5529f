"""Polynomials through few values of a channel: where they may be largest.

The rows of `node` are times, values and slopes: nodes, those at both ends of the part of time that
is looked at first, and Newton's form p(x) = f[t0] + f[t0, t1] (x - t0) + ...  Its error is that of
the terms that it lacks, T_n + T_n+1 + ...: where the last ones it has fall by the factor rho from
one to the next, T / (1 - rho) of the last (`lacking`).  What all channels with the same nodes share
is made once: the products (x - t0) ... (x - ti) at PARTS + 1 places between the first two nodes
(`lattice`), and 1 / (ti - tj) (`inverse`).
"""

from math import sqrt

from trsim.kernels.lazy import internal
from trsim.solve.march.record import PARTS

ENOUGH = 5  # nodes of a polynomial whose last terms tell how fast they fall
SLOWEST = 0.9  # rho: terms that fall no faster tell nothing
ROUNDS = 3  # in which the top of a polynomial is looked for
SHARPER, CLOSER = 2, 50.0  # more of them where it is looked for closer by, each by so much
SURE = 0.2  # of what may be missed: a polynomial that doubts no more is believed
BEFORE = 10.0  # times that: the same of the term before the last
PLAIN = 0.9  # of the mean slope: what changes in it less leaves its sign


@internal
def lay(b, n):
    """Fill b.lattice for the times of the first n nodes."""
    times, lattice = b.node[0], b.lattice
    low, width = times[1], (times[0] - times[1]) / PARTS
    for k in range(PARTS + 1):
        lattice[0, k] = 1.0
    for i in range(1, n):
        for k in range(PARTS + 1):
            lattice[i, k] = lattice[i - 1, k] * (low + k * width - times[i - 1])


@internal
def invert(b, n):
    """Fill b.inverse for them."""
    times, inverse = b.node[0], b.inverse
    for i in range(1, n):
        for j in range(i):
            inverse[i, j] = 1.0 / (times[i] - times[j])


@internal
def differences(b, n):
    """Newton's form of the polynomial through n nodes, into b.node[2]."""
    slope, inverse = b.node[2], b.inverse
    for i in range(n):
        slope[i] = b.node[1, i]
    for j in range(1, n):
        for i in range(n - 1, j - 1, -1):
            slope[i] = (slope[i] - slope[i - 1]) * inverse[i, i - j]


@internal
def lacking(last, second, third):
    """The size of the terms a series lacks, from those of the last three that it has.

    The last may be small by chance: it counts as what the two before it let expect.
    """
    if third > 0.0:
        last = max(last, second * min(1.0, second / third))
    if not last > 0.0:
        return 0.0
    rho = SLOWEST
    if second > 0.0:
        rho = min(rho, last / second)
    if third > 0.0:
        rho = min(rho, sqrt(last / third))
    return last / (1.0 - rho)


@internal
def doubt(b, n, surer):
    """What stands for the last divided difference in the error of a polynomial, into b.doubt.

    surer: how many times it counts.  Places that were looked at lie anyhow: how fast terms fall
    says nothing there.  Where none was, b.node[4] holds the `factors` of these nodes.
    """
    slope, size = b.node[2], b.node[4]
    b.doubt = surer * abs(slope[n - 1])
    if n < ENOUGH or b.n_found > 0:
        return
    third, second = abs(slope[n - 3]) * size[n - 3], abs(slope[n - 2]) * size[n - 2]
    last = abs(slope[n - 1]) * size[n - 1]
    b.doubt = surer * lacking(last, second, third) / size[n - 1]


@internal
def factors(times, size, n):
    """What the products (x - t0) ... (x - tk-1), k >= 2, do not exceed between the first two nodes.

    The first two factors do not exceed a quarter of the square of their distance, each other one
    the distance of the further one.
    """
    product = 0.25 * (times[0] - times[1]) ** 2
    for k in range(2, n):
        size[k] = product
        product *= max(abs(times[0] - times[k]), abs(times[1] - times[k]))


@internal
def along(b, n):
    """b.along <- the polynomial at the places of the lattice."""
    slope, lattice, value = b.node[2], b.lattice, b.along
    for k in range(PARTS + 1):
        value[k] = slope[0]
    for i in range(1, n):
        for k in range(PARTS + 1):
            value[k] += slope[i] * lattice[i, k]


@internal
def reach(b, n):
    """What a polynomial plainly is not above, and not below, between its first two nodes.

    Between places it is beyond them by an eighth of its second difference, the largest of which is
    taken twice.
    """
    along(b, n)
    lattice, value = b.lattice, b.along
    most, least, bend = -1e300, 1e300, 0.0
    last = b.doubt
    for k in range(PARTS + 1):
        doubt = last * abs(lattice[n - 1, k])
        most, least = max(most, value[k] + doubt), min(least, value[k] - doubt)
        if k > 1:
            row = lattice[n - 1]
            more = last * abs(row[k] - 2.0 * row[k - 1] + row[k - 2])
            bend = max(bend, abs(value[k] - 2.0 * value[k - 1] + value[k - 2]) + more)
    return most + 0.25 * bend, least - 0.25 * bend


@internal
def top(b, n, start, end, wanted):
    """Where a polynomial may be largest between its first two nodes, and how large.

    Where it plainly is not as large as `wanted` it is not looked for further: between places it is
    above them by an eighth of its second difference, the largest of which is taken twice.
    """
    place, best, bend, before, last = start, -1e300, 0.0, 0.0, 0.0
    along(b, n)
    lattice, width, value = b.lattice, (end - start) / PARTS, b.along
    for k in range(PARTS + 1):
        value[k] += b.doubt * abs(lattice[n - 1, k])
    for k in range(PARTS + 1):
        if value[k] > best:
            best, place = value[k], start + k * width
        if k > 1:
            bend = max(bend, abs(value[k] - 2.0 * last + before))
        before, last = last, value[k]
    if best + 0.25 * bend < wanted:
        return place, best
    return higher(b, n, start, end, (place, best))


@internal
def higher(b, n, start, end, known):
    """`top`, from the best of PARTS + 1 places on: known, the place and its value."""
    node, doubt, (place, best) = b.node, b.doubt, known
    low, high, width = start, end, (end - start) / PARTS
    for _ in range(1, ROUNDS):
        low, high = max(start, place - width), min(end, place + width)
        width = (high - low) / PARTS
        for k in range(PARTS + 1):
            x = low + k * width
            value = polynomial(node, n, x, doubt)
            if value > best:
                best, place = value, x
    if place in (start, end):
        return beside_end(b, n, place, width if place == start else -width, best)
    return vertex(b, n, max(start, place - width), min(end, place + width), (place, best))


@internal
def sharper(b, n, start, end, known):
    """`top` once more, closer by: of a square whose root is asked for, where it is next to zero."""
    for k in range(1, SHARPER + 1):
        width = (end - start) * CLOSER**-k / PARTS
        near = max(start, known[0] - width), min(end, known[0] + width)
        known = vertex(b, n, near[0], near[1], known)
    return known


@internal
def vertex(b, n, low, high, known):
    """The vertex of the parabola through a known place and two around it, if it is higher."""
    node, doubt, (place, best) = b.node, b.doubt, known
    if low < place < high:
        f0, f2 = polynomial(node, n, low, doubt), polynomial(node, n, high, doubt)
        left, right = (best - f0) / (place - low), (best - f2) / (high - place)
        if left + right > 0.0:
            x = place + 0.5 * (left * (high - place) - right * (place - low)) / (left + right)
            value = polynomial(node, n, x, doubt)
            if value > best:
                best, place = value, x
    return place, best


@internal
def beside_end(b, n, end, width, best):
    """`top` where the first or last place is the best one of all: the vertex may lie between it and
    the next.  width: from there to the next place, or a negative one."""
    node, doubt = b.node, b.doubt
    half = polynomial(node, n, end + 0.5 * width, doubt)
    whole = polynomial(node, n, end + width, doubt)
    first, second = half - best, whole - half
    rise, bend = 1.5 * first - 0.5 * second, second - first  # f = best + 2 rise u + 2 bend u^2
    if rise > 0.0 and bend < 0.0:
        place = end - 0.5 * rise / bend * width
        value = polynomial(node, n, place, doubt)
        if value > best:
            return place, value
    return end, best


@internal
def polynomial(node, n, x, doubt):
    """Its value at x, and on top that much times the last product of distances from nodes."""
    times, slope = node[0], node[2]
    value, term = slope[0], 1.0
    for i in range(1, n):
        term *= x - times[i - 1]
        value += slope[i] * term
    return value + doubt * abs(term)


@internal
def one_way(b, n):
    """Whether it rises or falls all the time between its first two nodes, the third one being about
    in their middle: with slopes that plainly have one sign."""
    times, slope = b.node[0], b.node[2]
    h = abs(times[0] - times[1])
    bend, product, rate = 0.0, 0.25 * h * h, h  # of (x - t0) (x - t1)
    for k in range(2, n):
        bend += rate * (abs(slope[k]) + (b.doubt if k == n - 1 else 0.0))
        far = max(abs(times[0] - times[k]), abs(times[1] - times[k]))
        product, rate = product * far, rate * far + product
    return bend < PLAIN * abs(slope[1])


@internal
def apart(node):
    """How far apart the values at the first three nodes are."""
    a, b, c = node[1, 0], node[1, 1], node[1, 2]
    return max(a, b, c) - min(a, b, c)


@internal
def settled(node, n, place, enough):
    """Whether the last but one term of the polynomial is small too: of a channel that swings faster
    than it is sampled the last one passes zero by chance."""
    with_it = polynomial(node, n - 1, place, 0.0)
    without = polynomial(node, n - 2, place, 0.0)
    return abs(with_it - without) < BEFORE * SURE * enough
