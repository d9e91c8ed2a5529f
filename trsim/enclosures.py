"""Interval arithmetic: between which numbers an expression of t, and its rate, surely lie.

A sensor in it may show any number.

    F = [a, b], F' = [c, d]         f(t) in F and f'(t) in F' for every t of an interval T

Each of the four is an array, one entry for each interval, so that thousands are enclosed at once.
Every operation is widened by its own rounding.  F' bounds difference quotients too: at a corner it
holds both slopes, and across a jump it is without bounds.                         [Moore1966]
"""

import math
from collections.abc import Callable
from functools import partial, reduce
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.arrays import Array
from trsim.expressions import COMPARISONS, OPERATORS, Node

ROUNDING = 4.0 * np.finfo(float).eps  # of one operation, sin and exp included
TINY = 1e-300


class Interval(NamedTuple):
    """Lower and upper ends, (n,) each."""

    low: Array
    high: Array


class Enclosure(NamedTuple):
    """Intervals that hold a quantity and its rate in t."""

    value: Interval
    rate: Interval


def widened(low: Array, high: Array, tiny: float = TINY) -> Interval:
    """An interval made larger by rounding; without bounds where it is no number.

    tiny: what underflow may have lost.
    """
    low = low - ROUNDING * np.abs(low) - tiny
    high = high + ROUNDING * np.abs(high) + tiny
    nothing = np.isnan(low) | np.isnan(high)
    return Interval(np.where(nothing, -np.inf, low), np.where(nothing, np.inf, high))


def exactly(value: float, like: Array) -> Interval:
    """A number, for each interval."""
    return Interval(np.full_like(like, value), np.full_like(like, value))


def everything(like: Array) -> Interval:
    return Interval(np.full_like(like, -np.inf), np.full_like(like, np.inf))


def hull(a: Interval, b: Interval) -> Interval:
    """What holds both."""
    return Interval(np.minimum(a.low, b.low), np.maximum(a.high, b.high))


def where(condition: NDArray[np.bool_], a: Interval, b: Interval) -> Interval:
    return Interval(np.where(condition, a.low, b.low), np.where(condition, a.high, b.high))


def holds(a: Interval, value: float) -> NDArray[np.bool_]:
    """Whether a number lies inside."""
    return (a.low <= value) & (value <= a.high)


def plus(a: Interval, b: Interval) -> Interval:
    return widened(a.low + b.low, a.high + b.high, 0.0)  # a sum of 0 is exact


def minus(a: Interval, b: Interval) -> Interval:
    return widened(a.low - b.high, a.high - b.low, 0.0)


def times(a: Interval, b: Interval) -> Interval:
    """a b; exactly zero where one factor is, whatever the other."""
    ends = (a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high)
    ends_ = [np.where(np.isnan(e), 0.0, e) for e in ends]  # 0 times infinity
    low, high = np.minimum.reduce(ends_), np.maximum.reduce(ends_)
    nothing = (low == 0.0) & (high == 0.0)
    return where(nothing, exactly(0.0, low), widened(low, high))


def over(a: Interval, b: Interval) -> Interval:
    """Without bounds where the divisor may be zero."""
    safe = (b.low > 0.0) | (b.high < 0.0)
    inverse = widened(1.0 / np.where(safe, b.high, 1.0), 1.0 / np.where(safe, b.low, 1.0))
    return where(safe, times(a, inverse), everything(a.low))


def rising(f: Callable[[Array], Array], a: Interval) -> Interval:
    """The values on an interval of a function that rises."""
    return widened(f(a.low), f(a.high))


def cosine(a: Interval) -> Interval:
    """-1 or 1 where a turning point, a whole multiple of pi, may lie inside."""
    pi = math.pi
    slack = 1.0 + 4.0 * ROUNDING * (np.abs(a.low) + np.abs(a.high))
    ends = (np.cos(a.low), np.cos(a.high))
    low, high = np.minimum(*ends), np.maximum(*ends)
    edge = (slack - 1.0) + 1e-15
    with np.errstate(invalid="ignore"):
        top = np.floor((a.high + edge) / (2.0 * pi)) >= np.ceil((a.low - edge) / (2.0 * pi))
        bottom = np.floor((a.high + edge - pi) / (2.0 * pi)) >= np.ceil(
            (a.low - edge - pi) / (2.0 * pi)
        )
    wild = ~np.isfinite(a.low) | ~np.isfinite(a.high)
    low = np.where(bottom | wild, -1.0, low - edge)
    high = np.where(top | wild, 1.0, high + edge)
    return Interval(np.maximum(low, -1.0), np.minimum(high, 1.0))


def sine(a: Interval) -> Interval:
    return cosine(minus(a, exactly(0.5 * math.pi, a.low)))


def power(a: Interval, n: int) -> Interval:
    """A whole power; an even one is never negative."""
    if n < 0:
        return over(exactly(1.0, a.low), power(a, -n))
    if n == 0:
        return exactly(1.0, a.low)
    low, high = a.low**n, a.high**n
    if n % 2 == 0:
        low, high = np.minimum(low, high), np.maximum(low, high)
        inside = holds(a, 0.0)
        wide = widened(low, high)
        return Interval(np.where(inside, 0.0, np.maximum(wide.low, 0.0)), wide.high)
    return widened(low, high)


def enclosure(node: Node, T: Interval) -> Enclosure:
    """The enclosure of an expression over intervals of t, whatever the sensors in it show."""
    zero, one = exactly(0.0, T.low), exactly(1.0, T.low)
    match node:
        case ("number", value):
            return Enclosure(exactly(value, T.low), zero)
        case ("name", "t"):
            return Enclosure(T, one)
        case ("name", "pi"):
            return Enclosure(exactly(math.pi, T.low), zero)
        case ("name", _):
            return Enclosure(everything(T.low), everything(T.low))
        case ("unary", _, operand):
            a = enclosure(operand, T)
            return Enclosure(minus(zero, a.value), minus(zero, a.rate))
        case ("binary", sign, left, right):
            return BINARY[sign](enclosure(left, T), enclosure(right, T))
    _, word, arguments = node
    return of_call(word, [enclosure(argument, T) for argument in arguments])


def of_call(word: str, a: list[Enclosure]) -> Enclosure:
    """The enclosure of a function of what is enclosed already."""
    if word in ("min", "max"):
        return reduce(partial(extreme, word), a)
    if word in ("step", "step5"):
        x, x0, h0, x1, h1 = a
        s = divided(subtracted(x, x0), subtracted(x1, x0))
        f = smooth(s) if word == "step" else smoothest(s)
        return added(h0, multiplied(subtracted(h1, h0), f))
    return FUNCTIONS[word](*a)


def added(a: Enclosure, b: Enclosure) -> Enclosure:
    return Enclosure(plus(a.value, b.value), plus(a.rate, b.rate))


def subtracted(a: Enclosure, b: Enclosure) -> Enclosure:
    return Enclosure(minus(a.value, b.value), minus(a.rate, b.rate))


def multiplied(a: Enclosure, b: Enclosure) -> Enclosure:
    rate = plus(times(a.rate, b.value), times(a.value, b.rate))
    return Enclosure(times(a.value, b.value), rate)


def divided(a: Enclosure, b: Enclosure) -> Enclosure:
    f = over(a.value, b.value)
    return Enclosure(f, over(minus(a.rate, times(f, b.rate)), b.value))


def raised(a: Enclosure, b: Enclosure) -> Enclosure:
    """A whole power, or exp(b log a) where a is surely positive."""
    n = b.value.low[:1]
    if np.all(b.value.low == b.value.high) and np.all(n == np.round(n)) and abs(n[0]) < 1e6:
        k = int(n[0])
        slope = times(exactly(float(k), n[0] + a.value.low * 0.0), power(a.value, k - 1))
        return Enclosure(power(a.value, k), times(slope, a.rate))
    f = exponential(multiplied(b, logarithm(a)))
    return Enclosure(
        where(a.value.low > 0.0, f.value, everything(a.value.low)),
        where(a.value.low > 0.0, f.rate, everything(a.value.low)),
    )


def compared(sign: str, a: Enclosure, b: Enclosure) -> Enclosure:
    """1 or 0; both, and a rate without bounds, where it may jump inside."""
    u = minus(a.value, b.value)
    exact = (a.value.low == a.value.high) & (b.value.low == b.value.high)
    equal = exact & (a.value.low == b.value.low)
    above, below = u.low > 0.0, u.high < 0.0
    truths = [OPERATORS[sign](*pair) for pair in ((1, 0), (0, 1), (0, 0))]
    known = above | below | equal
    value = np.where(above, truths[0], np.where(below, truths[1], truths[2])).astype(float)
    low, high = np.where(known, value, 0.0), np.where(known, value, 1.0)
    return Enclosure(Interval(low, high), where(known, exactly(0.0, low), everything(low)))


def extreme(word: str, a: Enclosure, b: Enclosure) -> Enclosure:
    """The smaller, or the larger, of two."""
    of = np.minimum if word == "min" else np.maximum
    value = Interval(of(a.value.low, b.value.low), of(a.value.high, b.value.high))
    a_below, b_below = a.value.high < b.value.low, b.value.high < a.value.low
    first, second = (a_below, b_below) if word == "min" else (b_below, a_below)
    rate = where(first, a.rate, where(second, b.rate, hull(a.rate, b.rate)))
    return Enclosure(value, rate)


def absolute(a: Enclosure) -> Enclosure:
    value, rate = a
    opposite = minus(exactly(0.0, value.low), rate)
    inside = (value.low < 0.0) & (value.high > 0.0)
    ends = np.abs(value.low), np.abs(value.high)
    low = np.where(inside, 0.0, np.minimum(*ends))
    bounds = where(value.low >= 0.0, rate, opposite)
    return Enclosure(Interval(low, np.maximum(*ends)), where(inside, hull(rate, opposite), bounds))


def root(a: Enclosure) -> Enclosure:
    with np.errstate(invalid="ignore"):
        value = rising(np.sqrt, Interval(np.maximum(a.value.low, 0.0), a.value.high))
    return Enclosure(value, over(a.rate, plus(value, value)))


def sine_of(a: Enclosure) -> Enclosure:
    return Enclosure(sine(a.value), times(cosine(a.value), a.rate))


def cosine_of(a: Enclosure) -> Enclosure:
    zero = exactly(0.0, a.value.low)
    return Enclosure(cosine(a.value), times(minus(zero, sine(a.value)), a.rate))


def tangent(a: Enclosure) -> Enclosure:
    return divided(sine_of(a), cosine_of(a))


def arctangent(a: Enclosure, b: Enclosure) -> Enclosure:
    """atan2(a, b): bounds where b > 0; elsewhere all angles, and a jump where a may be zero."""
    positive = b.value.low > 0.0
    quotient = over(a.value, b.value)
    near = rising(np.arctan, quotient)
    low = np.where(a.value.low > 0.0, 0.0, -math.pi)
    high = np.where(a.value.high < 0.0, 0.0, math.pi)
    length = plus(power(a.value, 2), power(b.value, 2))
    turn = minus(times(b.value, a.rate), times(a.value, b.rate))
    cut = ~positive & holds(a.value, 0.0)
    rate = where(cut, everything(length.low), over(turn, length))
    return Enclosure(where(positive, near, Interval(low, high)), rate)


def exponential(a: Enclosure) -> Enclosure:
    value = rising(np.exp, a.value)
    value = Interval(np.maximum(value.low, 0.0), value.high)
    return Enclosure(value, times(value, a.rate))


def logarithm(a: Enclosure) -> Enclosure:
    value = rising(np.log, Interval(np.maximum(a.value.low, 0.0), a.value.high))
    return Enclosure(value, over(a.rate, a.value))


def arcsine(a: Enclosure) -> Enclosure:
    """Bounds of the rate too where the argument is surely between -1 and 1."""
    inside = Interval(np.clip(a.value.low, -1.0, 1.0), np.clip(a.value.high, -1.0, 1.0))
    square = minus(exactly(1.0, inside.low), power(inside, 2))
    cosine = rising(np.sqrt, Interval(np.maximum(square.low, 0.0), np.maximum(square.high, 0.0)))
    return Enclosure(rising(np.arcsin, inside), over(a.rate, cosine))


def arccosine(a: Enclosure) -> Enclosure:
    right = exactly(0.5 * math.pi, a.value.low)
    return subtracted(Enclosure(right, exactly(0.0, a.value.low)), arcsine(a))


def jumping(f: Callable[[Array], Array], a: Enclosure) -> Enclosure:
    """What is constant between its jumps, and rises there."""
    value = Interval(f(a.value.low), f(a.value.high))
    still = value.low == value.high
    return Enclosure(value, where(still, exactly(0.0, value.low), everything(value.low)))


def clipped(a: Interval) -> Interval:
    return Interval(np.clip(a.low, 0.0, 1.0), np.clip(a.high, 0.0, 1.0))


def smooth(a: Enclosure) -> Enclosure:
    return eased(a, lambda x: x * x * (3.0 - 2.0 * x), 1.5, 1)


def smoothest(a: Enclosure) -> Enclosure:
    return eased(a, lambda x: x**3 * (10.0 - 15.0 * x + 6.0 * x * x), 1.875, 2)


def eased(a: Enclosure, step: Callable[[Array], Array], largest: float, n: int) -> Enclosure:
    """A smooth step, of a clipped to 0..1, whose slope is largest (4 s (1 - s))^n."""
    s = clipped(a.value)
    bump = times(exactly(4.0, s.low), times(s, minus(exactly(1.0, s.low), s)))
    slope = times(exactly(largest, s.low), power(clipped(bump), n))
    outside = (a.value.high <= 0.0) | (a.value.low >= 1.0)
    rate = where(outside, exactly(0.0, s.low), times(slope, a.rate))
    return Enclosure(clipped(rising(step, s)), rate)


BINARY: dict[str, Callable[[Enclosure, Enclosure], Enclosure]] = {
    "+": added,
    "-": subtracted,
    "*": multiplied,
    "/": divided,
    "**": raised,
    **{sign: partial(compared, sign) for sign in COMPARISONS},
}
FUNCTIONS: dict[str, Callable[..., Enclosure]] = {
    "abs": absolute,
    "sqrt": root,
    "sin": sine_of,
    "cos": cosine_of,
    "tan": tangent,
    "atan2": arctangent,
    "exp": exponential,
    "log": logarithm,
    "smoothstep": smooth,
    "asin": arcsine,
    "acos": arccosine,
    "floor": partial(jumping, np.floor),
    "sign": partial(jumping, np.sign),
}


# numpy calls the other functions as we do
POINTS: dict[str, Callable[..., Any]] = {
    **{word: getattr(np, word) for word in ("abs", "sqrt", "sin", "cos", "tan", "exp", "log")},
    **OPERATORS,
    "floor": np.floor,
    "sign": np.sign,
    "asin": np.arcsin,
    "acos": np.arccos,
    "**": np.power,
    "atan2": np.arctan2,
}


def values(node: Node, t: Array) -> Array:
    """An expression of t alone at many times, as doubles tell it."""
    match node:
        case ("number", value):
            return np.full_like(t, value)
        case ("name", "t"):
            return t
        case ("name", _):
            return np.full_like(t, math.pi)
        case ("unary", _, operand):
            return -values(operand, t)
        case ("binary", sign, left, right):
            return np.asarray(POINTS[sign](values(left, t), values(right, t)), float)
    _, word, arguments = node
    a = [values(argument, t) for argument in arguments]
    if word in ("min", "max"):
        return np.asarray((np.minimum if word == "min" else np.maximum).reduce(a))
    if word in ("step", "step5", "smoothstep"):
        x, x0, h0, x1, h1 = a if len(a) == 5 else (a[0], 0.0, 0.0, 1.0, 1.0)
        s = np.clip((x - x0) / (x1 - x0), 0.0, 1.0)
        rise = s * s * (3.0 - 2.0 * s)
        if word == "step5":
            rise = s**3 * (10.0 - 15.0 * s + 6.0 * s * s)
        return np.asarray(h0 + (h1 - h0) * rise)
    return np.asarray(POINTS[word](*a))
