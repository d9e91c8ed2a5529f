"""Extremes of channels between two places of a path, by polynomials: what takes all channels."""

from math import nan, sqrt

from trsim.elements.contract import SCENE, compiled
from trsim.kernels.lazy import internal
from trsim.kernels.signatures import A1, A2, I1, f8, float64, void
from trsim.solve.march.record import PEAK_MAX, PEAK_MIN

LOOKS = 32  # parts of the way between two places at which a polynomial is looked at
NEAR = 1e-4  # of the way between two places: nearer to a known one there is nothing new
UNSURE = 2.0  # times the last term: what a polynomial is off by
HIGH, LOW, ENOUGH, LEAST = range(4)  # rows of `limits`
VALUE, DOUBT, SLOPE = range(3)  # rows of `room`


@compiled(void(SCENE, f8, A1, I1, A1, A2))
def take(s, t, out, untold, full, peak):
    """full <- channels of one time and, behind them, the magnitudes of vectors among them; they go
    into `peak`, but for those that are untold there (1)."""
    for c in range(s.n_out):
        full[c] = out[c]
    for k in range(s.vector.size):
        x, y, z = full[s.vector[k]], full[s.vector[k] + 1], full[s.vector[k] + 2]
        full[s.n_out + k] = sqrt(x * x + y * y + z * z)
    for c in range(full.size):
        if untold[c] > 0:
            continue
        if full[c] > peak[PEAK_MAX, c]:
            peak[PEAK_MAX, c], peak[PEAK_MAX + 1, c] = full[c], t
        if full[c] < peak[PEAK_MIN, c]:
            peak[PEAK_MIN, c], peak[PEAK_MIN + 1, c] = full[c], t


@internal
def top(before, there, after):
    """Where three values in a row are largest, in parts of the way between two of them, and how
    large: on a top in the middle that of the parabola, else the one in the middle."""
    rise, bend = after - before, 2.0 * there - before - after
    if there < before or there < after or not bend > 0.0:
        return 0.0, there
    off = 0.5 * rise / bend
    return off, there + 0.25 * rise * off


@internal
def draw(times, values, c, span, room):
    """The polynomial through the values of channel c, and what it may be off by, at places that
    divide the way between the first two evenly."""
    scale, slope, many = times[1] - times[0], room[SLOPE], times.size
    for j in range(many):
        slope[j] = values[j, c]
    for j in range(1, many):
        for i in range(many - 1, j - 1, -1):
            by = (times[i] - times[0]) / scale - (times[i - j] - times[0]) / scale
            slope[i] = (slope[i] - slope[i - 1]) / by
    for i in range(LOOKS + 1):
        x = (span[i] - times[0]) / scale
        value, term, last = slope[0], 1.0, 0.0
        for j in range(1, many):
            term *= x - (times[j - 1] - times[0]) / scale
            last = term * slope[j]
            value += last
        room[VALUE, i], room[DOUBT, i] = value, UNSURE * abs(last)


@internal
def is_new(t, times, known, width):
    """Whether no place that is known is near."""
    for k in range(known):  # noqa: SIM110 - a generator does not compile
        if abs(t - times[k]) <= NEAR * width:
            return False
    return True


@compiled(float64(A1, A2, A2, A2, f8))
def promised(times, values, limits, room, inside):
    """When a channel may go furthest beyond its extremes, between the first two of these places;
    NaN where all stay within what may be missed.

    Parameters
    ----------
    times, values     (n), (n, channels): both ends, then so many places `inside`, then others
    limits            (4, channels): extremes so far, what may be missed, the least there can be
    room              (4, LOOKS + 1 or n)
    """
    a, width, found, most = times[0], times[1] - times[0], nan, 1.0
    span = room[3]
    for i in range(LOOKS + 1):
        span[i] = a + i * (width / LOOKS)
    span[LOOKS] = times[1]
    known = 2 + int(inside)
    for c in range(values.shape[1]):
        draw(times, values, c, span, room)
        value, doubt, enough = room[VALUE], room[DOUBT], limits[ENOUGH, c]
        for i in range(1, LOOKS):
            off, x = top(value[i - 1], value[i], value[i + 1])
            beyond = (x + doubt[i] - limits[HIGH, c]) / enough
            if beyond > most:
                t = span[i] + off * (span[1] - span[0])
                if is_new(t, times, known, width):
                    most, found = beyond, t
            if not limits[LOW, c] > limits[LEAST, c]:
                continue
            off, x = top(-value[i - 1], -value[i], -value[i + 1])
            beyond = (limits[LOW, c] + x + doubt[i]) / enough
            if beyond > most:
                t = span[i] + off * (span[1] - span[0])
                if is_new(t, times, known, width):
                    most, found = beyond, t
    return found
