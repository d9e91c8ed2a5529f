"""Interval arithmetic of compiled expressions: what an operation can be while its inputs vary.

    (l, h), (l', h')     l <= f <= h and l' <= f' <= h' throughout a stretch of time

An operation with branches is taken on the one it is held on (operations.py); FREE, where it may
change, its rate is without bounds.  Every result is widened by rounding.            [Moore1966]
"""

from math import acos, asin, ceil, cos, exp, floor, inf, isfinite, log, pi, sqrt

from trsim.kernels.lazy import internal
from trsim.laws.operations import (
    ABOVE,
    ABS,
    ACOS,
    ADD,
    ASIN,
    ATAN2,
    BELOW,
    COS,
    DIV,
    EXP,
    FLOOR,
    FREE,
    INSIDE,
    LOG,
    MAX,
    MIN,
    MUL,
    NEG,
    POW,
    QUINTIC,
    SIGN,
    SIN,
    SMOOTHSTEP,
    SQRT,
    SUB,
    TAN,
    compared,
    floored,
    held_angle,
    held_single,
    sign,
)

ROUNDING = 1e-15  # of each operation
WHOLE = 64.0  # the largest whole power taken as a product
ALL = (-inf, inf)  # without bounds
FURTHEST = 1e15  # what is infinite is more, and that is all that is said of it


@internal
def widened(l, h):
    """An interval made larger by rounding; without bounds where it is no number."""
    if not (l <= h):
        return ALL
    low = l - ROUNDING * abs(l) if l < inf else FURTHEST
    return low, h + ROUNDING * abs(h) if h > -inf else -FURTHEST


@internal
def spanned(p, q, r, s):
    """The interval with four numbers."""
    return widened(min(min(p, q), min(r, s)), max(max(p, q), max(r, s)))


@internal
def negative(x):
    return -x[1], -x[0]


@internal
def plus(x, y):
    return widened(x[0] + y[0], x[1] + y[1])


@internal
def minus(x, y):
    return widened(x[0] - y[1], x[1] - y[0])


@internal
def product(x, y):
    """0 times anything is 0: a bound may be infinite."""
    return 0.0 if x == 0.0 or y == 0.0 else x * y


@internal
def times(x, y):
    (a, b), (c, d) = x, y
    return spanned(product(a, c), product(a, d), product(b, c), product(b, d))


@internal
def over(x, y):
    """Without bounds where the divisor may be zero."""
    if y[0] <= 0.0 <= y[1]:
        return ALL
    return times(x, (1.0 / y[1], 1.0 / y[0]))


@internal
def whole_power(x, n):
    """Between which numbers the n-th power of an interval lies, n >= 0 a whole number."""
    a, b = x
    l, h = a**n, b**n
    if n == 0.0:
        return 1.0, 1.0
    if n % 2.0 == 0.0:
        low, high = min(l, h), max(l, h)
        l, h = widened(low, high)
        return (0.0 if a <= 0.0 <= b else max(l, 0.0)), h
    return widened(l, h)


@internal
def powered(x, n):
    """Between which numbers the n-th power of an interval lies, n any whole number."""
    return whole_power(x, n) if n >= 0.0 else over((1.0, 1.0), whole_power(x, -n))


@internal
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


@internal
def quotient(x, y):
    """(a/b)' = (a' - (a/b) b') / b."""
    f = over(x[0], y[0])
    return f, over(minus(x[1], times(f, y[1])), y[0])


@internal
def smooth_step(code, x, held):
    """A smooth step on a branch: the cubic or quintic is drawn on where it is held inside."""
    (a, b), rate = x
    if held == BELOW or (held == FREE and b <= 0.0):
        return (0.0, 0.0), (0.0, 0.0)
    if held == ABOVE or (held == FREE and a >= 1.0):
        return (1.0, 1.0), (0.0, 0.0)
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
        low, high = whole_power((low, high), 2.0)
        low, high = 30.0 * low, 30.0 * high
    return widened(l, h), times((low, high), rate)


@internal
def one(code, x, held):
    """An operation on one number."""
    (a, b), rate = x
    if code == NEG:
        return negative(x[0]), negative(rate)
    if code in (SMOOTHSTEP, QUINTIC):
        return smooth_step(code, x, held)
    if code == ABS:
        if held == ABOVE or (held == FREE and a >= 0.0):
            return x
        if held == BELOW or (held == FREE and b <= 0.0):
            return negative(x[0]), negative(rate)
        return (0.0, max(-a, b)), (min(rate[0], -rate[1]), max(rate[1], -rate[0]))
    if code in (SIN, COS, TAN):
        s, c = cosine(a - 0.5 * pi, b - 0.5 * pi), cosine(a, b)
        s_rate, c_rate = times(c, rate), times(negative(s), rate)
        if code == SIN:
            return s, s_rate
        return (c, c_rate) if code == COS else quotient((s, s_rate), (c, c_rate))
    if code == SQRT and a < 0.0 and held != FREE:
        return widened(-sqrt(-a), sqrt(b) if b > 0.0 else -sqrt(-b)), ALL
    if code == SQRT:
        l, h = widened(sqrt(max(a, 0.0)), sqrt(max(b, 0.0)))
        return (max(l, 0.0), h), over(rate, (2.0 * l, 2.0 * h))
    if code in (FLOOR, SIGN):
        return stepped(code, a, b, held)
    if code in (ASIN, ACOS):
        return arc(code, x)
    if code == EXP:
        f = widened(exp(a), exp(b))
        return f, times(f, rate)
    if a <= 0.0:
        return ALL, ALL
    return widened(log(a), log(b)), over(rate, x[0])


@internal
def stepped(code, a, b, held):
    """floor or sign of what lies between a and b."""
    if held != FREE:
        f, _, _ = held_single(code, a, held)
        return (f, f), (0.0, 0.0)
    l, h = (floored(a), floored(b)) if code == FLOOR else (sign(a), sign(b))
    return (l, h), ((0.0, 0.0) if l == h else ALL)


@internal
def arc(code, x):
    """asin or acos: without bounds where its argument may be beyond -1 or 1."""
    (a, b), rate = x
    if not (a >= -1.0 and b <= 1.0):
        return ALL, ALL
    # the root of 1 - a^2 is least where a is farthest from zero
    far = max(abs(a), abs(b))
    near = 0.0 if a <= 0.0 <= b else min(abs(a), abs(b))
    slope = over(rate, widened(sqrt(1.0 - far * far), sqrt(1.0 - near * near)))
    if code == ASIN:
        return widened(asin(a), asin(b)), slope
    return widened(acos(b), acos(a)), negative(slope)


@internal
def raised(x, y):
    """a**b: whole powers as products, others as exp(b log a) where a is surely positive."""
    c = y[0]
    if c[0] == c[1] and c[0] == floor(c[0]) and abs(c[0]) <= WHOLE:
        return powered(x[0], c[0]), times(times(powered(x[0], c[0] - 1.0), c), x[1])
    f, rate = one(LOG, x, FREE)
    return one(EXP, (times(f, c), plus(times(rate, c), times(f, y[1]))), FREE)


@internal
def angle(x, y, held):
    """atan2(a, b): of a box that does not hold the origin, from its corners."""
    (a, b), (c, d) = x[0], y[0]
    if (a <= 0.0 <= b and c <= 0.0 <= d) or (held == FREE and a <= 0.0 <= b and c < 0.0):
        return (-2.0 * pi, 2.0 * pi), ALL
    f = spanned(
        held_angle(a, c, held), held_angle(a, d, held),
        held_angle(b, c, held), held_angle(b, d, held),
    )  # fmt: skip
    square = plus(whole_power(x[0], 2.0), whole_power(y[0], 2.0))
    return f, over(minus(times(y[0], x[1]), times(x[0], y[1])), square)


@internal
def ranged(code, x, y, held):
    """An operation on two of (l, h), (l', h'), on the branch it is held on."""
    (a, b), (c, d) = x[0], y[0]
    if code == ADD:
        return plus(x[0], y[0]), plus(x[1], y[1])
    if code == SUB:
        return minus(x[0], y[0]), minus(x[1], y[1])
    if code == MUL:
        return times(x[0], y[0]), plus(times(x[1], y[0]), times(x[0], y[1]))
    if code == DIV:
        return quotient(x, y)
    if code == POW:
        return raised(x, y)
    if code in (MIN, MAX):
        if held != FREE or b < c or a > d:
            return x if (held == BELOW or (held == FREE and b < c)) == (code == MIN) else y
        rate = (min(x[1][0], y[1][0]), max(x[1][1], y[1][1]))
        if code == MIN:
            return (min(a, c), min(b, d)), rate
        return (max(a, c), max(b, d)), rate
    if code == ATAN2:
        return angle(x, y, held)
    if code >= NEG:
        return one(code, x, held)
    if held != FREE or b < c or a > d:
        f = compared(code, held if held != FREE else a - d if a > d else b - c)
        return (f, f), (0.0, 0.0)
    return (0.0, 1.0), ALL
