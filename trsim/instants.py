"""The instants at which a function of t changes its course: none is missed, whatever stands inside.

    corner                          u(t)                 met where u is
    a < b  a <= b  a == b ...       a - b                0
    min(a, b)  max(a, b)            a - b                0
    abs(a), sign(a), atan2(a, b)    a                    0
    floor(a)                        a                    a whole number
    asin(a), acos(a)                a                    -1 and 1
    smoothstep(x), step, step5      x, (x-x0)/(x1-x0)    0 and 1
    exp(a)                          a                    EDGES of expressions.py

Roots of u are excluded or isolated, not sampled: an interval of t on which the enclosure of u
(enclosures.py) does not hold the value has no root, one on which that of u' does not hold zero has
one at most, which the signs at its ends tell; every other one is halved.  What touches the value
without crossing it is an instant too: a step more, and nothing missed.
"""

from collections.abc import Iterator
from math import pi

import numpy as np

from trsim.arrays import Array
from trsim.enclosures import Interval, enclosure, values
from trsim.errors import ScenarioError
from trsim.expressions import COMPARISONS, EDGES, LOW, Node, names, parts

MOST = 500_000  # instants of one function in one run
RESOLUTION = 1e-12  # of the run: instants nearer to each other are one
# of the run: nearer to each other, places that rounding cannot tell apart are one
NEIGHBOURS = 1e-7
AT_ONCE = 1 << 15  # intervals enclosed in one go
TRIED = 8_000_000  # intervals: more of them are not looked at


def instants(node: Node, end: float) -> list[float]:
    """The times in (0, end) at which an expression changes its course, as far as t alone decides.

    Raises ScenarioError where there are more than MOST.
    """
    found: list[float] = []
    with np.errstate(all="ignore"):
        for u, met_at in corners(node):
            if names(u) - {"pi"} == {"t"}:
                for value in met_at:
                    found += crossings(u, value, end, found)
    return distinct(found, end)


def corners(node: Node) -> Iterator[tuple[Node, tuple[float, ...]]]:
    """u of every corner, the inner ones first, with the values at which they are met."""
    for part in parts(node):
        yield from corners(part)
    match node:
        case ("binary", sign, left, right) if sign in COMPARISONS:
            yield ("binary", "-", left, right), (0.0,)
        case ("call", word, arguments):
            yield from of_call(word, arguments)


def of_call(word: str, a: tuple[Node, ...]) -> Iterator[tuple[Node, tuple[float, ...]]]:
    """The corners of a function of these arguments."""
    if word in ("min", "max"):
        for k in range(1, len(a)):
            before = a[0] if k == 1 else ("call", word, a[:k])
            yield ("binary", "-", before, a[k]), (0.0,)
    elif word in ("abs", "atan2", "sign"):
        yield a[0], (0.0,)
    elif word in ("asin", "acos"):
        yield a[0], (-1.0, 1.0)
    elif word == "floor":  # whole numbers are the zeros of a sine
        yield ("call", "sin", (("binary", "*", ("number", pi), a[0]),)), (0.0,)
    elif word == "smoothstep":
        yield a[0], (0.0, 1.0)
    elif word == "exp":
        yield a[0], EDGES
    elif word in ("step", "step5"):
        x, x0, _, x1, _ = a
        yield ("binary", "-", x, x0), (0.0,)
        yield ("binary", "-", x, x1), (0.0,)


def peaked(node: Node) -> bool:
    """Whether an expression has quotients or powers that may be short events without a corner.

    Those by exp alone are met by its edges.
    """
    short = False
    match node:
        case ("binary", "/", _, right):
            short = varies(right)
        case ("binary", "**", left, right):
            low = right[0] == "number" and right[1] in range(LOW + 1)
            short = varies(right) or (varies(left) and not low)
    return short or any(map(peaked, parts(node)))


def varies(node: Node) -> bool:
    """Whether something beside the exponents of exp varies."""
    if node[0] == "name":
        return bool(node[1] != "pi")
    return node[:2] != ("call", "exp") and any(map(varies, parts(node)))


def distinct(times: list[float], end: float) -> list[float]:
    """Inside the run, in order, one of those that only rounding parts."""
    out: list[float] = []
    for t in sorted(times):
        inside = RESOLUTION * end < t < end * (1.0 - RESOLUTION)
        if inside and (not out or t - out[-1] > RESOLUTION * end):
            out.append(t)
    return out


def linear(node: Node) -> tuple[float, float] | None:
    """(a, b) of an expression that is a + b t as it is written; None of any other."""
    match node:
        case ("number", value):
            return value, 0.0
        case ("name", "t"):
            return 0.0, 1.0
        case ("unary", _, operand):
            one = linear(operand)
            return one and (-one[0], -one[1])
        case ("binary", sign, left, right) if sign in "+-*/":
            one, other = linear(left), linear(right)
            return one and other and combined(sign, one, other)
    return None


def combined(
    sign: str, one: tuple[float, float], other: tuple[float, float]
) -> tuple[float, float] | None:
    """The sum, difference, product or quotient of two, where that is linear."""
    (a, b), (c, d) = one, other
    if sign == "+":
        return a + c, b + d
    if sign == "-":
        return a - c, b - d
    if sign == "*" and (b == 0.0 or d == 0.0):
        return a * c, a * d + b * c
    if sign == "/" and d == 0.0 and c != 0.0:
        return a / c, b / c
    return None


def crossings(u: Node, value: float, end: float, known: list[float]) -> list[float]:
    """The times in [0, end] at which u reaches a value."""
    straight = linear(u)
    if straight is not None:
        a, b = straight
        t = (value - a) / b if b != 0.0 else -1.0
        return [t] if 0.0 <= t <= end else []
    return _Search(u, value, end).roots(known)


class _Search:
    """All roots of u - value over a run, by enclosures."""

    def __init__(self, u: Node, value: float, end: float) -> None:
        self.u, self.value, self.end = u, value, end
        self.single: list[tuple[Array, Array]] = []  # intervals with one root at most
        self.touched: list[Array] = []  # too short to be halved
        self.n = self.tried = 0

    def roots(self, known: list[float]) -> list[float]:
        """known: instants of what u is made of; intervals begin and end there."""
        edges = np.array([0.0, *distinct(known, self.end), self.end])
        waiting = [(edges[:-1], edges[1:])]
        while waiting:
            low, high = waiting.pop()
            if low.size > AT_ONCE:
                waiting.append((low[AT_ONCE:], high[AT_ONCE:]))
                low, high = low[:AT_ONCE], high[:AT_ONCE]
            low, high = self.undecided(low, high)
            if low.size:
                middle = 0.5 * (low + high)
                ends = np.stack((low, middle), 1).ravel(), np.stack((middle, high), 1).ravel()
                waiting.append(ends)
        found = [*(self.isolated(*ends) for ends in self.single), self.places()]
        return np.concatenate(found).tolist()

    def places(self) -> Array:
        """Where u is the value to rounding: of those that are neighbours the middle."""
        times = np.sort(np.concatenate([np.zeros(0), *self.touched]))
        apart = np.diff(times, prepend=-np.inf, append=np.inf) > NEIGHBOURS * self.end
        first, last = times[apart[:-1]], times[apart[1:]]
        return np.asarray(first + 0.5 * (last - first))

    def undecided(self, low: Array, high: Array) -> tuple[Array, Array]:
        """What must be halved; what has one root, or cannot be halved, is kept."""
        F, D = enclosure(self.u, Interval(low, high))
        may = (F.low <= self.value) & (self.value <= F.high)
        may &= (F.low != self.value) | (F.high != self.value)  # else it never leaves the value
        single = may & ((D.low > 0.0) | (D.high < 0.0))
        short = may & ~single & (high - low <= RESOLUTION * self.end)
        rest = may & ~single & ~short
        if single.any():
            self.single.append((low[single], high[single]))
        if short.any():
            self.touched.append(0.5 * (low[short] + high[short]))
        self.n += int(single.sum() + short.sum())
        self.tried += low.size
        if self.n > MOST or self.tried > TRIED:
            raise too_many()
        return low[rest], high[rest]

    def isolated(self, low: Array, high: Array) -> Array:
        """Roots of u, which rises or falls on each interval, by bisection."""
        at_low, at_high = self.sign(low), self.sign(high)
        self.touched += [low[at_low == 0.0], high[at_high == 0.0]]
        inside = at_low * at_high < 0.0
        low, high, at_low = low[inside], high[inside], at_low[inside]
        while low.size and np.max(high - low) > 1e-16 * self.end:
            middle = 0.5 * (low + high)
            if np.all((middle <= low) | (middle >= high)):
                break
            left = self.sign(middle) == at_low
            low, high = np.where(left, middle, low), np.where(left, high, middle)
        return high

    def sign(self, t: Array) -> Array:
        """The sign of u - value."""
        return np.sign(values(self.u, t) - self.value)


def too_many() -> ScenarioError:
    return ScenarioError(
        f"changes its course more than {MOST} times within the run, or at times nobody can find",
        "a step would end at each of these instants: make the run shorter, or write the mean of "
        "what is so fast",
    )
