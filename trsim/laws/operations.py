"""The operations an expression is made of, on numbers and on numbers with time derivatives.

Derivatives go forward through every operation, (a b)'' = a'' b + 2 a' b' + a b'' and so on.  At
a corner of min, max, abs or a comparison they belong to the branch taken; a comparison is 1 or 0
and does not vary.

Operations with corners or jumps have branches, on which they are smooth.  One may be HELD on a
branch: it is then drawn on beyond its ends, as a step needs it that ends at the corner.

    u        a - b: comparisons, min, max      a: abs, sign, atan2 (a of atan2(a, b)), floor
                                               a: smooth steps
    branch   BELOW u < 0, ABOVE u > 0          of a smooth step BELOW u < 0, INSIDE, ABOVE u > 1
             of floor the whole number k, counted from 1 where k >= 0, in k <= u < k + 1
    FREE     whatever a and b say

A root or a broken power of what is never negative, as max(x, 0)**1.5 and sqrt(abs(x)), is DRAWN on
as well, to -(-a)**b: a step that ends at the corner of max or abs looks a little beyond it.

exp is smooth, but beside 1 it is nothing below u = -37 and 1 is nothing beside it above 37: in the
middle of a long run a bump exp(-((x - a)/w)^2) or a switch 1/(1 + exp(x/w)) is a short event.  It
has corners too, though it is the same function on both sides: steps end at its edges, and none is
passed over by one that begins before it and ends behind.
"""

from math import acos, asin, atan2, exp, floor, inf, log, pi, sqrt, tan

from trsim.expressions import NOTHING, SOME
from trsim.kernels.lazy import internal
from trsim.laws.sine import sine_cosine
from trsim.laws.tables import quintic, quintic_rates, smoothstep, smoothstep_rates

ADD, SUB, MUL, DIV, POW, MIN, MAX, ATAN2, LT, LE, GT, GE, EQ, NE = range(14)
NEG, ABS, SQRT, SIN, COS, TAN, EXP, LOG, SMOOTHSTEP, QUINTIC = range(14, 24)
ASIN, ACOS, FLOOR, SIGN = range(24, 28)

BINARY = {"+": ADD, "-": SUB, "*": MUL, "/": DIV, "**": POW}
BINARY |= {"<": LT, "<=": LE, ">": GT, ">=": GE, "==": EQ, "!=": NE}
UNARY = {"abs": ABS, "sqrt": SQRT, "sin": SIN, "cos": COS, "tan": TAN, "exp": EXP, "log": LOG}
UNARY |= {"smoothstep": SMOOTHSTEP, "asin": ASIN, "acos": ACOS, "floor": FLOOR, "sign": SIGN}

MONOTONE = frozenset({ADD, MUL, DIV, MIN})  # of what is never negative they make nothing negative
NEVER_NEGATIVE = frozenset({LT, LE, GT, GE, EQ, NE, ABS, SQRT, EXP, SMOOTHSTEP, QUINTIC, ACOS})
CORNERED = frozenset({MIN, MAX, ATAN2, LT, LE, GT, GE, EQ, NE, ABS, EXP, SMOOTHSTEP, QUINTIC})
CORNERED |= {FLOOR, SIGN}
FREE, BELOW, INSIDE, ABOVE = 0.0, -1.0, 2.0, 1.0  # what such an operation is held on
WHOLE_FROM = 4503599627370496.0  # 2^52: from there on numbers have no fractions
DRAWN = 1.0  # the same of a root or a power
RISING, LARGE = 3.0, 4.0  # exp between its second and third edge, and up to its fourth


@internal
def floored(x):
    """The largest whole number that x is not below; x itself where numbers have no fractions."""
    return float(floor(x)) if abs(x) < WHOLE_FROM else x


@internal
def step_number(k):
    """What floor is held on between k and k + 1: k, but never FREE."""
    return k + 1.0 if k >= 0.0 else k


@internal
def step_at(held):
    """The opposite."""
    return held - 1.0 if held > 0.0 else held


@internal
def sign(x):
    """-1, 0 or 1."""
    if x > 0.0:
        return 1.0
    if x < 0.0:
        return -1.0
    return 0.0 if x == 0.0 else x  # -0.0 is 0, and what is no number stays none


@internal
def switching(code, a, b):
    """u of an operation with branches."""
    return a if code == ATAN2 or code >= NEG else a - b


@internal
def branch_at(code, u):
    """The branch of an operation at u; at an end of it the one above."""
    if code in (SMOOTHSTEP, QUINTIC):
        return BELOW if u < 0.0 else INSIDE if u < 1.0 else ABOVE
    if code == FLOOR:
        return step_number(floored(u))
    if code == EXP:
        if u < SOME:
            return BELOW if u < -NOTHING else INSIDE if u < -SOME else RISING
        return LARGE if u < NOTHING else ABOVE
    return BELOW if u < 0.0 else ABOVE


@internal
def branch_ends(code, held):
    """Between which u a branch lies."""
    if held == FREE:
        return -inf, inf
    if code == EXP:
        return edges_of(held)
    if code == FLOOR:
        return step_at(held), step_at(held) + 1.0
    if held == INSIDE:
        return 0.0, 1.0
    if held == BELOW:
        return -inf, 0.0
    return 1.0 if code in (SMOOTHSTEP, QUINTIC) else 0.0, inf


@internal
def edges_of(held):
    """Between which u a branch of exp lies."""
    if held == BELOW:
        return -inf, -NOTHING
    if held == INSIDE:
        return -NOTHING, -SOME
    if held == RISING:
        return -SOME, SOME
    return (SOME, NOTHING) if held == LARGE else (NOTHING, inf)


@internal
def beside(code, held, above):
    """The branch next to one."""
    if code == FLOOR:
        return step_number(step_at(held) + (1.0 if above else -1.0))
    if code == EXP:
        if held == INSIDE:
            return RISING if above else BELOW
        if held == RISING:
            return LARGE if above else INSIDE
        if held == LARGE:
            return ABOVE if above else RISING
        return INSIDE if held == BELOW else LARGE
    if code in (SMOOTHSTEP, QUINTIC) and held != INSIDE:
        return INSIDE
    return ABOVE if above else BELOW


@internal
def compared(code, u):
    """1 or 0: a comparison by its u = a - b."""
    if code == LT:
        return 1.0 if u < 0.0 else 0.0
    if code == LE:
        return 1.0 if u <= 0.0 else 0.0
    if code == GT:
        return 1.0 if u > 0.0 else 0.0
    if code == GE:
        return 1.0 if u >= 0.0 else 0.0
    if code == EQ:
        return 1.0 if u == 0.0 else 0.0
    return 1.0 if u != 0.0 else 0.0


@internal
def held_angle(a, b, held):
    """atan2 drawn on across its cut, a = 0 where b < 0."""
    f = atan2(a, b)
    if b < 0.0 and held == ABOVE and a < 0.0:
        return f + 2.0 * pi
    if b < 0.0 and held == BELOW and a >= 0.0:
        return f - 2.0 * pi
    return f


@internal
def held_single(code, a, held):
    """abs, exp, floor, sign, a smooth step or a root on a branch: value, first and second
    derivative in a."""
    if code == FLOOR:
        return step_at(held), 0.0, 0.0
    if code == SIGN:
        return held, 0.0, 0.0
    if code == ABS:
        return held * a, held, 0.0
    if code == EXP:
        f = exp(a)
        return f, f, f
    if code == SQRT:
        f = sqrt(abs(a))
        f_a = 0.5 / f
        return f if a >= 0.0 else -f, f_a, -0.5 * f_a / a
    if held != INSIDE:
        return 0.0 if held == BELOW else 1.0, 0.0, 0.0
    if code == SMOOTHSTEP:
        return a * a * (3.0 - 2.0 * a), 6.0 * a * (1.0 - a), 6.0 - 12.0 * a
    y = a * (1.0 - a)
    f = a * a * a * (10.0 + a * (6.0 * a - 15.0))
    return f, 30.0 * y * y, 60.0 * y * (1.0 - 2.0 * a)


@internal
def single(code, a):
    """Value of an operation on one number."""
    if code == NEG:
        return -a
    if code == SMOOTHSTEP:
        return smoothstep(a)
    if code == ABS:
        return abs(a)
    if code == SQRT:
        return sqrt(a)
    if code == SIN:
        return sine_cosine(a)[0]
    if code == COS:
        return sine_cosine(a)[1]
    if code == TAN:
        return tan(a)
    if code == EXP:
        return exp(a)
    if code == LOG:
        return log(a)
    if code == ASIN:
        return asin(a)
    if code == ACOS:
        return acos(a)
    if code == FLOOR:
        return floored(a)
    if code == SIGN:
        return sign(a)
    return quintic(a)


@internal
def operation(code, a, b, held):
    """Value of an operation, on the branch it is held on; operations on one number ignore b."""
    if code == ADD:
        return a + b
    if code == SUB:
        return a - b
    if code == MUL:
        return a * b
    if code == DIV:
        return a / b
    if code == POW:
        return a**b if held == FREE or a >= 0.0 else -((-a) ** b)
    if code == MIN:
        return b if (b < a if held == FREE else held > 0.0) else a
    if code == MAX:
        return b if (b > a if held == FREE else held < 0.0) else a
    if code == ATAN2:
        return held_angle(a, b, held)
    if code >= NEG:
        return single(code, a) if held == FREE else held_single(code, a, held)[0]
    return compared(code, a - b if held == FREE else held)


@internal
def single_rates(code, a):
    """Value of an operation on one number, with first and second derivative in a."""
    if code == NEG:
        return -a, -1.0, 0.0
    if code == SMOOTHSTEP:
        return smoothstep_rates(a)
    if code == ABS:
        return abs(a), 1.0 if a >= 0.0 else -1.0, 0.0
    if code == SQRT:
        f = sqrt(a)
        return f, 0.5 / f, -0.25 / (f * a)
    if code == SIN:
        s, c = sine_cosine(a)
        return s, c, -s
    if code == COS:
        s, c = sine_cosine(a)
        return c, -s, -c
    if code == TAN:
        f = tan(a)
        return f, 1.0 + f * f, 2.0 * f * (1.0 + f * f)
    if code == EXP:
        f = exp(a)
        return f, f, f
    if code == LOG:
        return log(a), 1.0 / a, -1.0 / (a * a)
    if code in (ASIN, ACOS):
        way, inside = (1.0 if code == ASIN else -1.0), 1.0 - a * a
        f_a = way / sqrt(inside)
        return asin(a) if code == ASIN else acos(a), f_a, f_a * a / inside
    if code in (FLOOR, SIGN):
        return floored(a) if code == FLOOR else sign(a), 0.0, 0.0
    return quintic_rates(a)


@internal
def chain(f, f_a, f_aa, x):
    """f(a) and its derivatives in time, x = (a, a', a''); f_a may be infinite where a rests."""
    _, a1, a2 = x
    if a1 == 0.0 and a2 == 0.0:
        return f, 0.0, 0.0
    return f, f_a * a1, f_aa * a1 * a1 + f_a * a2


@internal
def power_rates(x, y):
    """a**b and its derivatives."""
    (a, a1, a2), (b, b1, b2) = x, y
    f = a**b
    if a == 0.0 < b or (b1 == 0.0 and b2 == 0.0):  # a fixed exponent allows a <= 0
        f_a = b * a ** (b - 1.0) if b != 0.0 else 0.0
        f_aa = b * (b - 1.0) * a ** (b - 2.0) if b != 0.0 and b != 1.0 else 0.0
        return chain(f, f_a, f_aa, x)
    # ln f = b ln a
    u = b1 * log(a) + b * a1 / a
    u1 = b2 * log(a) + (2.0 * b1 * a1 + b * a2) / a - b * a1 * a1 / (a * a)
    return f, f * u, f * (u * u + u1)


@internal
def operation_rates(code, x, y, held):
    """An operation on (a, a', a'') and (b, b', b''), on the branch it is held on."""
    (a, a1, a2), (b, b1, b2) = x, y
    if code == ADD:
        return a + b, a1 + b1, a2 + b2
    if code == SUB:
        return a - b, a1 - b1, a2 - b2
    if code == MUL:
        return a * b, a1 * b + a * b1, a2 * b + 2.0 * a1 * b1 + a * b2
    if code == DIV:
        f = a / b
        f1 = (a1 - f * b1) / b
        return f, f1, (a2 - 2.0 * f1 * b1 - f * b2) / b
    if code == POW:
        if held == FREE or a >= 0.0:
            return power_rates(x, y)
        f, f1, f2 = power_rates((-a, -a1, -a2), y)
        return -f, -f1, -f2
    if code == MIN:
        return y if (b < a if held == FREE else held > 0.0) else x
    if code == MAX:
        return y if (b > a if held == FREE else held < 0.0) else x
    if code == ATAN2:
        r, r1 = a * a + b * b, 2.0 * (a * a1 + b * b1)
        f1 = (b * a1 - a * b1) / r
        return held_angle(a, b, held), f1, (b * a2 - a * b2 - f1 * r1) / r
    if code >= NEG:
        f, f_a, f_aa = single_rates(code, a) if held == FREE else held_single(code, a, held)
        return chain(f, f_a, f_aa, x)
    return operation(code, a, b, held), 0.0, 0.0
