"""Interval arithmetic of compiled expressions: what an operation can be while its inputs vary.

    (l, h, l', h')       l <= f <= h and l' <= f' <= h' throughout a stretch of time

An operation with branches is taken on the one it is held on (operations.py); FREE, where it may
change, its rate is without bounds.  Every result is widened by rounding.            [Moore1966]
"""

from math import ceil, cos, exp, floor, inf, isfinite, log, pi, sqrt

from trsim.kernels.lazy import law
from trsim.laws.operations import (
    ABOVE,
    ABS,
    ADD,
    ATAN2,
    BELOW,
    COS,
    DIV,
    EXP,
    FREE,
    INSIDE,
    LOG,
    MAX,
    MIN,
    MUL,
    NEG,
    POW,
    QUINTIC,
    SIN,
    SMOOTHSTEP,
    SQRT,
    SUB,
    TAN,
    compared,
    held_angle,
    held_single,
)

ROUNDING = 1e-15  # of each operation
WHOLE = 64.0  # the largest whole power taken as a product


@law
def widened(l, h):
    """An interval made larger by rounding; without bounds where it is no number."""
    if not (l <= h):
        return -inf, inf
    return l - ROUNDING * abs(l), h + ROUNDING * abs(h)


@law
def plus(a, b, c, d):
    return widened(a + c, b + d)


@law
def minus(a, b, c, d):
    return widened(a - d, b - c)


@law
def product(x, y):
    """0 times anything is 0: a bound may be infinite."""
    return 0.0 if x == 0.0 or y == 0.0 else x * y


@law
def times(a, b, c, d):
    p, q, r, s = product(a, c), product(a, d), product(b, c), product(b, d)
    return widened(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)))


@law
def over(a, b, c, d):
    """Without bounds where the divisor may be zero."""
    if c <= 0.0 <= d:
        return -inf, inf
    return times(a, b, 1.0 / d, 1.0 / c)


@law
def whole_power(a, b, n):
    """Between which numbers x^n lies for a <= x <= b, n >= 0 a whole number."""
    l, h = a**n, b**n
    if n == 0.0:
        return 1.0, 1.0
    if n % 2.0 == 0.0:
        low, high = min(l, h), max(l, h)
        l, h = widened(low, high)
        return (0.0 if a <= 0.0 <= b else max(l, 0.0)), h
    return widened(l, h)


@law
def powered(a, b, n):
    """Between which numbers x^n lies for a <= x <= b, n any whole number."""
    if n >= 0.0:
        return whole_power(a, b, n)
    l, h = whole_power(a, b, -n)
    return over(1.0, 1.0, l, h)


@law
def cosine(a, b):
    """-1 or 1 where a whole multiple of pi may lie inside."""
    if not (isfinite(a) and isfinite(b)):
        return -1.0, 1.0
    edge = 1e-15 * (1.0 + abs(a) + abs(b))
    l, h = min(cos(a), cos(b)) - edge, max(cos(a), cos(b)) + edge
    if floor((b + edge) / (2.0 * pi)) >= ceil((a - edge) / (2.0 * pi)):
        h = 1.0
    if floor((b + edge - pi) / (2.0 * pi)) >= ceil((a - edge - pi) / (2.0 * pi)):
        l = -1.0
    return max(l, -1.0), min(h, 1.0)


@law
def sine(a, b):
    return cosine(a - 0.5 * pi, b - 0.5 * pi)


@law
def quotient(a0, a1, r0, r1, b0, b1, q0, q1):
    """(a/b)' = (a' - (a/b) b') / b."""
    l, h = over(a0, a1, b0, b1)
    c, d = times(l, h, q0, q1)
    m, n = minus(r0, r1, c, d)
    rl, rh = over(m, n, b0, b1)
    return l, h, rl, rh


@law
def smooth_step(code, a, b, r0, r1, held):
    """A smooth step on a branch: the cubic or quintic is drawn on where it is held inside."""
    if held == BELOW or (held == FREE and b <= 0.0):
        return 0.0, 0.0, 0.0, 0.0
    if held == ABOVE or (held == FREE and a >= 1.0):
        return 1.0, 1.0, 0.0, 0.0
    if held == FREE:
        a, b = min(max(a, 0.0), 1.0), min(max(b, 0.0), 1.0)
    f0, _, _ = held_single(code, a, INSIDE)
    f1, _, _ = held_single(code, b, INSIDE)
    l, h = min(f0, f1), max(f0, f1)
    if a < 0.0 or b > 1.0:  # it turns at 0 and at 1 where it is cubic
        l, h = min(l, 0.0 if a < 0.0 < b else l), max(h, 1.0 if a < 1.0 < b else h)
    # slope 6 x (1 - x), or 30 (x (1 - x))^2; x (1 - x) has its top at 1/2
    s0, s1 = a * (1.0 - a), b * (1.0 - b)
    low, high = min(s0, s1), max(s0, s1)
    if a <= 0.5 <= b:
        high = 0.25
    if code == SMOOTHSTEP:
        low, high = 6.0 * low, 6.0 * high
    else:
        low, high = whole_power(low, high, 2.0)
        low, high = 30.0 * low, 30.0 * high
    rl, rh = times(low, high, r0, r1)
    l, h = widened(l, h)
    return l, h, rl, rh


@law
def one(code, a, b, r0, r1, held):
    """An operation on one number."""
    if code == NEG:
        return -b, -a, -r1, -r0
    if code in (SMOOTHSTEP, QUINTIC):
        return smooth_step(code, a, b, r0, r1, held)
    if code == ABS:
        if held == ABOVE or (held == FREE and a >= 0.0):
            return a, b, r0, r1
        if held == BELOW or (held == FREE and b <= 0.0):
            return -b, -a, -r1, -r0
        return 0.0, max(-a, b), min(r0, -r1), max(r1, -r0)
    if code in (SIN, COS, TAN):
        s0, s1 = sine(a, b)
        c0, c1 = cosine(a, b)
        if code == SIN:
            l, h = times(c0, c1, r0, r1)
            return s0, s1, l, h
        m, n = times(-s1, -s0, r0, r1)
        if code == COS:
            return c0, c1, m, n
        l, h = times(c0, c1, r0, r1)
        return quotient(s0, s1, l, h, c0, c1, m, n)
    if code == SQRT and a < 0.0 and held != FREE:
        l, h = widened(-sqrt(-a), sqrt(b) if b > 0.0 else -sqrt(-b))
        return l, h, -inf, inf
    if code == SQRT:
        l, h = widened(sqrt(max(a, 0.0)), sqrt(max(b, 0.0)))
        m, n = over(r0, r1, 2.0 * l, 2.0 * h)
        return max(l, 0.0), h, m, n
    if code == EXP:
        l, h = widened(exp(a), exp(b))
        m, n = times(l, h, r0, r1)
        return l, h, m, n
    if a <= 0.0:
        return -inf, inf, -inf, inf
    l, h = widened(log(a), log(b))
    m, n = over(r0, r1, a, b)
    return l, h, m, n


@law
def raised(a, b, r0, r1, c, d, q0, q1):
    """a**b: whole powers as products, others as exp(b log a) where a is surely positive."""
    if c == d and c == floor(c) and abs(c) <= WHOLE:
        l, h = powered(a, b, c)
        m, n = powered(a, b, c - 1.0)
        m, n = times(m, n, c, c)
        m, n = times(m, n, r0, r1)
        return l, h, m, n
    l, h, m, n = one(LOG, a, b, r0, r1, FREE)
    u, v = times(l, h, c, d)
    x, y = times(m, n, c, d)
    z, w = times(l, h, q0, q1)
    x, y = plus(x, y, z, w)
    return one(EXP, u, v, x, y, FREE)


@law
def angle(a, b, r0, r1, c, d, q0, q1, held):
    """atan2(a, b): of a box that does not hold the origin, from its corners."""
    if (a <= 0.0 <= b and c <= 0.0 <= d) or (held == FREE and a <= 0.0 <= b and c < 0.0):
        return -2.0 * pi, 2.0 * pi, -inf, inf
    e, f = held_angle(a, c, held), held_angle(a, d, held)
    g, i = held_angle(b, c, held), held_angle(b, d, held)
    l, h = widened(min(min(e, f), min(g, i)), max(max(e, f), max(g, i)))
    u, v = whole_power(a, b, 2.0)
    w, x = whole_power(c, d, 2.0)
    u, v = plus(u, v, w, x)
    m, n = times(c, d, r0, r1)
    w, x = times(a, b, q0, q1)
    m, n = minus(m, n, w, x)
    m, n = over(m, n, u, v)
    return l, h, m, n


@law
def ranged(code, a, b, r0, r1, c, d, q0, q1, held):
    """An operation on (a, b, r0, r1) and (c, d, q0, q1), on the branch it is held on."""
    if code == ADD:
        l, h = plus(a, b, c, d)
        m, n = plus(r0, r1, q0, q1)
        return l, h, m, n
    if code == SUB:
        l, h = minus(a, b, c, d)
        m, n = minus(r0, r1, q0, q1)
        return l, h, m, n
    if code == MUL:
        l, h = times(a, b, c, d)
        m, n = times(r0, r1, c, d)
        u, v = times(a, b, q0, q1)
        m, n = plus(m, n, u, v)
        return l, h, m, n
    if code == DIV:
        return quotient(a, b, r0, r1, c, d, q0, q1)
    if code == POW:
        return raised(a, b, r0, r1, c, d, q0, q1)
    if code in (MIN, MAX):
        first = (held == BELOW) == (code == MIN)
        if held == FREE:
            if code == MIN:
                return min(a, c), min(b, d), min(r0, q0), max(r1, q1)
            return max(a, c), max(b, d), min(r0, q0), max(r1, q1)
        return (a, b, r0, r1) if first else (c, d, q0, q1)
    if code == ATAN2:
        return angle(a, b, r0, r1, c, d, q0, q1, held)
    if code >= NEG:
        return one(code, a, b, r0, r1, held)
    if held != FREE:
        f = compared(code, held)
        return f, f, 0.0, 0.0
    if b < c or a > d:
        f = compared(code, a - d if a > d else b - c)
        return f, f, 0.0, 0.0
    return 0.0, 1.0, -inf, inf
