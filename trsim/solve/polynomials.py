"""Polynomials through few values of a channel: where they may be largest.

The rows of `node` are times, values and slopes: nodes, those at both ends of the part of time that
is looked at first, and Newton's form p(x) = f[t0] + f[t0, t1] (x - t0) + ...  The last term, which
another node changed, counts as its error, DOUBT times.  What all channels with the same nodes share
is made once: the products (x - t0) ... (x - ti) at PARTS + 1 places between the first two nodes
(`lattice`), and 1 / (ti - tj) (`inverse`).
"""

from trsim.elements.vectors import internal
from trsim.solve.record import PARTS, POINTS

DOUBT = 1.0  # of the last term of a polynomial: its error
ROUNDS = 3  # in which the top of a polynomial is looked for
SURE = 0.2  # of what may be missed: a polynomial that doubts no more is believed
BEFORE = 10.0  # times that: the same of the term before the last
PLAIN = 0.9  # of the mean slope: what changes in it less leaves its sign


@internal
def lay(b, n):
    """Fill b.lattice and b.inverse for the times of the first n nodes."""
    times, lattice, inverse = b.node[0], b.lattice, b.inverse
    low, width = times[1], (times[0] - times[1]) / PARTS
    for k in range(PARTS + 1):
        lattice[0, k] = 1.0
    for i in range(1, n):
        for k in range(PARTS + 1):
            lattice[i, k] = lattice[i - 1, k] * (low + k * width - times[i - 1])
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
def reach(b, n):
    """What a polynomial plainly is not above, and not below, between its first two nodes.

    Between places it is beyond them by an eighth of its second difference, the largest of which is
    taken twice.
    """
    slope, lattice, value = b.node[2], b.lattice, b.along
    for k in range(PARTS + 1):
        value[k] = slope[0]
    for i in range(1, n):
        for k in range(PARTS + 1):
            value[k] += slope[i] * lattice[i, k]
    most, least, bend = -1e300, 1e300, 0.0
    last = DOUBT * abs(slope[n - 1])
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
    slope, lattice, width = b.node[2], b.lattice, (end - start) / PARTS
    value = b.along
    for k in range(PARTS + 1):
        value[k] = slope[0]
    for i in range(1, n):
        for k in range(PARTS + 1):
            value[k] += slope[i] * lattice[i, k]
    for k in range(PARTS + 1):
        value[k] += DOUBT * abs(slope[n - 1] * lattice[n - 1, k])
    for k in range(PARTS + 1):
        if value[k] > best:
            best, place = value[k], start + k * width
        if k > 1:
            bend = max(bend, abs(value[k] - 2.0 * last + before))
        before, last = last, value[k]
    if best + 0.25 * bend < wanted:
        return place, best
    return higher(b.node, n, start, end, place, best)


@internal
def higher(node, n, start, end, place, best):
    """`top`, from the best of PARTS + 1 places on."""
    low, high, width = start, end, (end - start) / PARTS
    for _ in range(1, ROUNDS):
        low, high = max(start, place - width), min(end, place + width)
        width = (high - low) / PARTS
        for k in range(PARTS + 1):
            x = low + k * width
            value = polynomial(node, n, x, DOUBT)
            if value > best:
                best, place = value, x
    low, high = max(start, place - width), min(end, place + width)
    if low < place < high:
        # the vertex of the parabola through the last three
        f0, f2 = polynomial(node, n, low, DOUBT), polynomial(node, n, high, DOUBT)
        left, right = (best - f0) / (place - low), (best - f2) / (high - place)
        if left + right > 0.0:
            x = place + 0.5 * (left * (high - place) - right * (place - low)) / (left + right)
            value = polynomial(node, n, x, DOUBT)
            if value > best:
                best, place = value, x
    return place, best


@internal
def polynomial(node, n, x, doubt):
    """Its value at x, and on top that much of the size of its last term."""
    times, slope = node[0], node[2]
    value, term = slope[0], 1.0
    for i in range(1, n):
        term *= x - times[i - 1]
        value += slope[i] * term
    return value + doubt * abs(slope[n - 1] * term)


@internal
def one_way(node, n):
    """Whether it rises or falls all the time between its first two nodes, the third one being about
    in their middle: with slopes that plainly have one sign."""
    times, slope = node[0], node[2]
    h = abs(times[0] - times[1])
    bend, product, rate = 0.0, 0.25 * h * h, h  # of (x - t0) (x - t1)
    for k in range(2, n):
        bend += (1.0 + (DOUBT if k == n - 1 else 0.0)) * rate * abs(slope[k])
        far = max(abs(times[0] - times[k]), abs(times[1] - times[k]))
        product, rate = product * far, rate * far + product
    return bend < PLAIN * abs(slope[1])


@internal
def apart(node):
    """How far apart the values at the first three nodes are."""
    a, b, c = node[1, 0], node[1, 1], node[1, 2]
    return max(a, b, c) - min(a, b, c)


@internal
def settled(node, place, enough):
    """Whether the last but one term of the polynomial is small too: of a channel that swings faster
    than it is sampled the last one passes zero by chance."""
    with_it = polynomial(node, POINTS - 1, place, 0.0)
    without = polynomial(node, POINTS - 2, place, 0.0)
    return DOUBT * abs(with_it - without) < BEFORE * SURE * enough
