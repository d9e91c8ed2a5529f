"""What a `sweep:` varies: axes, their values, and how they are combined.

    joints.A.clearance: [0.1 mm, 0.3 mm]        a list
    joints.A.clearance: lin(0.1 mm, 0.5 mm, 9)  evenly spaced;  log(a, b, n): in the logarithm
    joints.B.clearance: same as joints.A.clearance
    joints.A.clearance: uniform(0.1 mm, 0.5 mm)  of samples;  log_uniform(a, b), normal(mean, sd)
    method: grid       all combinations;  zip: the values side by side;  or, of `samples` cases with
                       a `seed`: latin_hypercube, monte_carlo, sobol

    keep: all          the result file of every case; summary: its numbers only (sweeps/summary.py).
                       Without it: all of up to FEW cases, summary of more
    numbers: [...]     which a summary has besides: peak:B.contact_force@0.3..0.5
    until, refine      which cases are run at all (adaptive.py)

A key with a dot is a dotted path as for --set.  A normal distribution is cut at three standard
deviations.  sobol is Saltelli's design of samples (d + 2) cases for indices of variance.
"""

import math
import re
from typing import Any, NamedTuple

from trsim.errors import ScenarioError, closest, described, known
from trsim.scenario import adaptive
from trsim.scenario.adaptive import Refine, Widths
from trsim.units import quantity
from trsim.units import unit as dimension

METHODS = ("grid", "zip", "latin_hypercube", "monte_carlo", "sobol")
SAMPLED = METHODS[2:]
KEPT = ("keep", "numbers")  # what of cases is kept
CHOSEN = ("until", "refine")  # which cases are run
SETTINGS = ("method", "samples", "seed", *KEPT, *CHOSEN)
SUMMARY, ALL = "summary", "all"
KEEP = (ALL, SUMMARY)
FEW = 200  # cases whose result files are kept where nothing is said; one may have megabytes
SPACED = ("lin", "log")
DRAWN = ("uniform", "log_uniform", "normal")
MOST = 100_000  # values of an axis, samples
DIGITS = 12  # of a value that was computed: it is written, compared and hashed as text

_CALL = re.compile(r"\s*([a-z_]+)\s*\((.*)\)\s*", re.DOTALL)
_SAME = re.compile(r"\s*same\s+as\s+(\S+)\s*")


class Drawn(NamedTuple):
    """A distribution; a and b are numbers in its unit."""

    word: str
    a: float
    b: float
    unit: str  # as written


class Axis(NamedTuple):
    """A key that varies: through values, by a distribution, or with another key."""

    key: str
    values: tuple[Any, ...] = ()
    drawn: Drawn | None = None
    same_as: str = ""


class Sweep(NamedTuple):
    """Axes in the order of the file."""

    axes: tuple[Axis, ...] = ()
    method: str = "grid"
    samples: int = 0
    seed: int = 0
    keep: str = ""  # as the number of cases says
    numbers: tuple[str, ...] = ()  # besides those that a summary has anyway
    until: Widths = ()
    refine: Refine | None = None


def sweep(data: Any) -> Sweep:
    """The sweep that a `sweep:` block says.  Raises ScenarioError with the path in the block."""
    if not isinstance(data, dict):
        raise ScenarioError(f"must be a mapping of keys, got {described(data)}")
    method = data.get("method", "grid")
    if method not in METHODS:
        what = f"unknown method {described(method)}"
        raise ScenarioError(what, known(method, METHODS), ("method",))
    for key in data:
        if key not in SETTINGS and "." not in key and closest(key, SETTINGS):
            raise ScenarioError(f"unknown key {described(key)}", known(key, SETTINGS), (key,))
    axes = tuple(axis(key, value) for key, value in data.items() if key not in SETTINGS)
    drawn = [one.key for one in axes if one.drawn]
    if method not in SAMPLED:
        if drawn:
            hint = f"Write `method: {SAMPLED[0]}` and `samples:` beside it, or a list of values."
            raise ScenarioError(f"a distribution cannot be part of a {method}", hint, (drawn[0],))
        for key in ("samples", "seed"):
            if key in data:
                what = f"{key} belongs to a method that draws samples"
                raise ScenarioError(what, f"Those are {', '.join(SAMPLED)}.", (key,))
    else:
        for one in axes:
            if one.values:
                hint = "Write for example `uniform(0.1 mm, 0.5 mm)`."
                raise ScenarioError(f"{method} needs a distribution, not values", hint, (one.key,))
        if not drawn:
            raise ScenarioError(f"{method} needs a key with a distribution", path=("method",))
    _related(axes)
    if method == "zip" and len({len(one.values) for one in axes if one.values}) > 1:
        lengths = ", ".join(f"{len(one.values)} of {one.key}" for one in axes if one.values)
        raise ScenarioError("zip needs as many values of each key", f"There are {lengths}.")
    samples = _whole(data, "samples", 1) if method in SAMPLED else 0
    seed = _whole(data, "seed", 0) if "seed" in data else 0
    until, refine = _chosen(data, method, axes)
    keep, numbers = _kept(data)
    asked = dict.fromkeys(word for word, _ in (*until, *(refine.by if refine else ())))
    numbers = tuple(dict.fromkeys((*numbers, *asked)))
    return Sweep(axes, method, samples, seed, keep, numbers, until, refine)


def _chosen(
    data: dict[str, Any], method: str, axes: tuple[Axis, ...]
) -> tuple[Widths, Refine | None]:
    """What decides which cases are run."""
    own = {one.key: one.values for one in axes if not one.same_as}
    until: Widths = ()
    refine: Refine | None = None
    for key in (key for key in CHOSEN if key in data):
        try:
            if key == "until":
                until = adaptive.until(data[key], method)
            else:
                refine = adaptive.refine(data[key], method, own)
        except ScenarioError as error:
            raise error.at(key) from None
    return until, refine


def _kept(data: dict[str, Any]) -> tuple[str, tuple[str, ...]]:
    """What is kept of the cases."""
    keep, numbers = data.get("keep", ""), data.get("numbers", [])
    if "keep" in data and keep not in KEEP:
        hint = known(keep, KEEP)
        raise ScenarioError(f"must be one of {', '.join(KEEP)}, got {described(keep)}", hint,
                            ("keep",))  # fmt: skip
    if not isinstance(numbers, list) or not all(isinstance(word, str) for word in numbers):
        hint = "Write for example `numbers: [peak:B.contact_force@0.3..0.5]`."
        raise ScenarioError(f"must be a list of numbers of a run, got {described(numbers)}", hint,
                            ("numbers",))  # fmt: skip
    return keep, tuple(dict.fromkeys(numbers))


def axis(key: str, value: Any) -> Axis:
    """One entry of a sweep."""
    try:
        if isinstance(value, list):
            if not value:
                raise ScenarioError("an empty list has nothing to vary")
            return Axis(key, tuple(value))
        if isinstance(value, str) and (match := _SAME.fullmatch(value)):
            return Axis(key, same_as=match[1])
        if isinstance(value, str) and (match := _CALL.fullmatch(value)):
            return _of_call(key, match[1], match[2])
    except ScenarioError as error:
        raise error.at(key) from None
    hint = "Write a list, lin(a, b, n), log(a, b, n), `same as KEY`, or a distribution of samples."
    if isinstance(value, dict):
        hint = "What varies stands in `sweep` itself: `joints.A.clearance: [...]`."
    raise ScenarioError(f"no values to vary: {described(value)}", hint, (key,))


def varies(value: Any) -> bool:
    """Whether the value of a --set is an axis, not a number."""
    if isinstance(value, list):
        return True
    if not isinstance(value, str):
        return False
    call = _CALL.fullmatch(value)
    return bool(_SAME.fullmatch(value) or (call and call[1] in (*SPACED, *DRAWN)))


def _of_call(key: str, word: str, inside: str) -> Axis:
    if word not in (*SPACED, *DRAWN):
        raise ScenarioError(f"unknown word {described(word)}", known(word, (*SPACED, *DRAWN)))
    parts = [part.strip() for part in inside.split(",")]
    wanted = 3 if word in SPACED else 2
    if len(parts) != wanted:
        form = "a, b, n" if word in SPACED else "mean, sd" if word == "normal" else "a, b"
        raise ScenarioError(f"{word}({form}) has {wanted} entries, got {len(parts)}")
    a, b, unit = _ends(parts[:2])
    if word in ("log", "log_uniform") and not (a > 0.0 and b > 0.0):
        raise ScenarioError(f"{word} needs positive numbers")
    if word == "normal" and not b > 0.0:
        raise ScenarioError("a standard deviation is positive")
    if word in DRAWN:
        if word != "normal" and not a < b:
            raise ScenarioError(f"{word}(a, b) needs a < b")
        return Axis(key, drawn=Drawn(word, a, b, unit))
    if not re.fullmatch(r"[0-9]{1,6}", parts[2]) or not 1 <= int(parts[2]) <= MOST:
        raise ScenarioError(f"the number of values is 1 to {MOST}, got {described(parts[2])}")
    n = int(parts[2])
    shares = [k / (n - 1) if n > 1 else 0.0 for k in range(n)]
    if word == "log":
        return Axis(key, tuple(written(a * (b / a) ** share, unit) for share in shares))
    return Axis(key, tuple(written(a + (b - a) * share, unit) for share in shares))


def _ends(parts: list[str]) -> tuple[float, float, str]:
    """Two numbers in one unit: that of the second, or of the first where only it has one."""
    found = []
    for part in parts:
        one = quantity(part)
        if one is None:
            what = f"must be a number, got {described(part)}"
            raise ScenarioError(what, "Parameters cannot stand here.")
        plain = re.match(r"[-+0-9.]+(?:[eE][-+]?[0-9]+)?", part)
        found.append((one[0], one[1], float(plain[0]) if plain else one[0]))
    (a, unit_a, plain_a), (_, unit_b, plain_b) = found
    if unit_a == unit_b or (not unit_b and plain_b == 0.0):
        return plain_a, plain_b, unit_a
    if not unit_a and plain_a == 0.0:
        return plain_a, plain_b, unit_b
    if not (unit_a and unit_b):
        raise ScenarioError("both numbers need the same unit", "Write it at both, or at none.")
    if dimension(unit_a)[1] != dimension(unit_b)[1]:
        raise ScenarioError(f"{unit_a} and {unit_b} are not of one kind")
    return float(a / dimension(unit_b)[0]), plain_b, unit_b


def written(value: float, unit: str) -> Any:
    """A number that was computed, as one would write it."""
    rounded = float(f"{value:.{DIGITS}g}")
    return f"{rounded:.{DIGITS}g} {unit}" if unit else rounded


def drawn(one: Drawn, share: float) -> Any:
    """The value that a share (0..1) of a distribution lies below."""
    if one.word == "uniform":
        return written(one.a + (one.b - one.a) * share, one.unit)
    if one.word == "log_uniform":
        return written(one.a * math.exp(math.log(one.b / one.a) * share), one.unit)
    from scipy.special import ndtr, ndtri

    tail = ndtr(-3.0)
    deviations = min(max(float(ndtri(tail + share * (1.0 - 2.0 * tail))), -3.0), 3.0)
    return written(one.a + one.b * deviations, one.unit)


def _related(axes: tuple[Axis, ...]) -> None:
    """Check that every `same as` names a key that varies by itself."""
    own = [one.key for one in axes if not one.same_as]
    for one in axes:
        if one.same_as and one.same_as not in own:
            what = f"{described(one.same_as)} does not vary by itself"
            raise ScenarioError(what, known(one.same_as, own), (one.key,))


def _whole(data: dict, key: str, least: int) -> int:
    value = data.get(key)
    if value is None:
        raise ScenarioError(f"field required: {key}", f"Write for example `{key}: 64`.")
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= MOST:
        raise ScenarioError(f"must be a whole number from {least} to {MOST}", path=(key,))
    return value
