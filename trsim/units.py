"""Units as mechanisms use them, and quantities such as `0.3 mm`.

A unit is a product of powers: N*m/rad, m/s^2, N/m^1.5, 1/(m*s); "-" is none.  The angle is a
dimension of its own, so that rpm and Hz, or N*m and N*m/rad, cannot be mixed up.
"""

import math
import re
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any

from trsim.errors import ScenarioError, described, known
from trsim.meant import meant, nearest

Dimension = tuple[float, ...]  # exponents of m, kg, s, rad

BASE = {"m": (1, 0, 0, 0), "kg": (0, 1, 0, 0), "s": (0, 0, 1, 0), "rad": (0, 0, 0, 1)}

PREFIXES = {"µ": "1e-6", "u": "1e-6", "m": "1e-3", "c": "1e-2", "k": "1e3", "M": "1e6", "G": "1e9"}


def prefixed(prefixes: str, word: str) -> dict[str, tuple[str | float, str]]:
    """A unit with each of some prefixes, as in DERIVED."""
    return {prefix + word: (PREFIXES[prefix], word) for prefix in prefixes}


# word -> factor (exact where it is), unit.  The angle is a dimension: 1/s is no rad/s.
DERIVED: dict[str, tuple[str | float, str]] = {
    **prefixed("kcmuµ", "m"),
    "in": ("0.0254", "m"),
    "ft": ("0.3048", "m"),
    "g": ("1e-3", "kg"),
    "t": ("1e3", "kg"),
    "lb": ("0.45359237", "kg"),
    **prefixed("muµ", "s"),
    "min": ("60", "s"),
    "h": ("3600", "s"),
    "mrad": ("1e-3", "rad"),
    "deg": (math.pi / 180, "rad"),
    "°": (math.pi / 180, "rad"),
    "rev": (2 * math.pi, "rad"),
    "turn": (2 * math.pi, "rad"),
    "rpm": (2 * math.pi / 60, "rad/s"),
    "Hz": ("1", "1/s"),
    "kHz": ("1e3", "1/s"),
    "kt": (1852 / 3600, "m/s"),
    "g0": ("9.80665", "m/s^2"),
    "N": ("1", "kg*m/s^2"),
    **prefixed("mkM", "N"),
    "lbf": ("4.4482216152605", "N"),
    "Pa": ("1", "N/m^2"),
    **prefixed("kMG", "Pa"),
    "bar": ("1e5", "Pa"),
    "psi": (4.4482216152605 / 0.0254**2, "Pa"),
    "J": ("1", "N*m"),
    "kJ": ("1e3", "J"),
    "W": ("1", "J/s"),
    "kW": ("1e3", "W"),
    "%": ("1e-2", "-"),
}

KINDS = {
    "-": "a plain number",
    "m": "a length",
    "m^2": "an area",
    "m^3": "a volume",
    "m^4": "a second moment of area",
    "kg": "a mass",
    "kg*m^2": "a moment of inertia",
    "kg/m^3": "a density",
    "s": "a time",
    "1/s": "a frequency",
    "rad": "an angle",
    "rad/s": "an angular velocity",
    "rad/s^2": "an angular acceleration",
    "m/s": "a speed",
    "m/s^2": "an acceleration",
    "N": "a force",
    "N*m": "a torque or an energy",
    "N*s": "an impulse",
    "N/m": "a stiffness",
    "N*m/rad": "a torsional stiffness",
    "N*s/m": "a damping",
    "N*m*s/rad": "a torsional damping",
    "N/m^2": "a pressure",
    "W": "a power",
}

AGAIN = 4096  # numbers with units that are remembered: cases of a sweep have the same few
FORM = "Write it like N*m/rad or m/s^2."
_WORD = re.compile(r"\s*(?:([A-Za-zµ°%]+[0-9]*)|([0-9]+(?:\.[0-9]+)?)|(\*\*|[*/^()-]))")
_PLAIN = str.maketrans({"μ": "µ", "·": "*", "²": "^2", "³": "^3"})


class UnitError(ScenarioError):
    """A text that is no unit, with what was probably meant."""

    asked: tuple[str, str] = "", ""  # the text, and the part of it that nobody knows


@cache
def unit(text: str) -> tuple[Fraction | float, Dimension]:
    """The SI factor and the dimension of a unit such as N*m/rad, m/s^2, N/m^1.5, 1/(m*s)."""
    try:
        return _parsed(text)
    except UnitError as error:
        raise no_unit(error.what, *error.asked) from None


def _parsed(text: str) -> tuple[Fraction | float, Dimension]:
    """The same, told without what was meant."""
    if text in ("-", "1", ""):
        return Fraction(1), (0, 0, 0, 0)
    words, end = [], 0
    plain = text.translate(_PLAIN).strip()
    while end < len(plain):
        match = _WORD.match(plain, end)
        if not match or len(plain) > 60:
            raise _none(text)
        words.append(match[0].strip())
        end = match.end()
    result = _product(words, text)
    if words:
        raise _none(text)
    return result


def _none(text: str, word: str = "") -> UnitError:
    what = f"unknown unit {described(word)}" if word else f"not a unit: {described(text)}"
    error = UnitError(what, FORM)
    error.asked = text, word
    return error


def _product(words: list[str], text: str) -> tuple[Fraction | float, Dimension]:
    """Factors joined by * and /, from left to right; takes its words off the list."""
    factor, dimension = _power(words, text)
    while words and words[0] in ("*", "/"):
        sign = 1 if words.pop(0) == "*" else -1
        f, d = _power(words, text)
        factor = factor * f if sign > 0 else factor / f
        dimension = tuple(a + sign * b for a, b in zip(dimension, d, strict=True))
    return factor, dimension


def _power(words: list[str], text: str) -> tuple[Fraction | float, Dimension]:
    word = words.pop(0) if words else ""
    if word == "(":
        factor, dimension = _product(words, text)
        if not words or words.pop(0) != ")":
            raise ScenarioError(f"not a unit: {described(text)}", "A bracket is not closed.")
    elif word == "1":
        factor, dimension = Fraction(1), (0, 0, 0, 0)
    elif word in BASE:
        factor, dimension = Fraction(1), BASE[word]
    elif word in DERIVED:
        number, of = DERIVED[word]
        factor, dimension = _parsed(of)
        factor = factor * (Fraction(number) if isinstance(number, str) else number)
    elif not word or not word[0].isalpha():
        raise ScenarioError(f"not a unit: {described(text)}", FORM)
    else:
        raise _none(text, word)
    if words and words[0] in ("^", "**"):
        words.pop(0)
        sign = -1 if words and words[0] == "-" and words.pop(0) else 1
        if not words or not words[0][0].isdigit() or float(words[0]) > 9:
            raise ScenarioError(f"not a unit: {described(text)}", "A power is a number up to 9.")
        n = sign * Fraction(words.pop(0))
        factor = factor ** (int(n) if n.denominator == 1 else float(n))
        dimension = tuple(float(n * Fraction(d)) for d in dimension)
    return factor, dimension


def no_unit(what: str, text: str, word: str = "", wanted: tuple[str, ...] = ()) -> UnitError:
    """The error of a text that is no unit; word: the part that nobody knows."""
    words = [*BASE, *DERIVED]
    should = dimensions(wanted)
    found, close = meant(text, words, _parsed, should), None
    if found and (not should or unit(found[0])[1] in should):
        close = found[0]
    elif found is None and word:
        close = nearest(word, words)
    hints = [f"Did you mean '{close}'?"] if close else []
    if found and not close and found[1] and (name := kind(unit(found[0])[1])):
        hints.append(f"'{found[0]}' is {name}.")
    if wanted:
        hints.append(units_hint(wanted))
        simple = [unit(text)[1] for text in wanted if text in words]
        alike = [one for one in words if unit(one)[1] in simple]
        hints += [f"Known: {', '.join(alike)}."] if alike else []
    elif word:
        hints.append(known(word, words, close).removeprefix(f"Did you mean '{close}'?  "))
    error = UnitError(what, "  ".join(hint for hint in hints if hint) or FORM)
    error.asked = text, word
    return error


def dimensions(units: tuple[str, ...]) -> tuple[Dimension, ...]:
    """The dimensions of units; an angle may also have none."""
    found = tuple(unit(text)[1] for text in units if text not in ("-", "1"))
    return (*found, unit("rad/rad")[1]) if found and unit("rad")[1] in found else found


_TITLE = re.compile(r"(.*?)\s*(?:\[([^][]*)\]|\(([^()]*)\))\s*", re.DOTALL)


def titled(text: str) -> tuple[str, str]:
    """Name and unit of the title of a column: `force [kN]`, `force (kN)`; no unit: empty.

    Raises ScenarioError for what is in brackets and no unit, or for brackets elsewhere.
    """
    found = _TITLE.fullmatch(text.strip())
    name, inner = (found[1], (found[2] or found[3] or "").strip()) if found else (text.strip(), "")
    if re.search(r"[][()]", name) or (found and not inner):
        what = f"no title of a column: {described(text.strip())}"
        raise ScenarioError(what, "A unit stands last, in brackets: `force [kN]`.")
    if inner:
        unit(inner)
    return name, inner


_NUMBER = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)(.*)", re.DOTALL)


def quantity(
    text: str, names: Any = (), wanted: tuple[str, ...] = ()
) -> tuple[float, str] | None:  # fmt: skip
    """The SI value of `0.3 mm` and the unit as written; None if it is no number with a unit.

    "5/s" is a quantity unless `s` is one of the names an expression may use here.  wanted: units of
    the number that is asked for, for the hint where there is an error.
    """
    match = _NUMBER.fullmatch(text)
    if not match or len(text) > 200:
        return None
    number, rest = match[1], match[2].strip()
    if re.match(r"[+-]?0[0-9]", number):
        what = f"a number does not begin with 0: {described(text)}"
        raise ScenarioError(what, "YAML once read 010 as 8, others read 10: drop the zero.")
    if rest.startswith("/"):
        words = re.findall(r"[A-Za-z_]\w*", rest)
        if any(word in names or word not in {**BASE, **DERIVED} for word in words) or not words:
            return None
        if re.match(r"/\s*[0-9]", rest):  # 2/12 kg
            what = f"a unit stands behind one number: {described(text)}"
            raise ScenarioError(what, "Write 0.5 kg for 1/2 kg, or 1/2 alone, in SI.")
        rest = f"1{rest}"
    elif rest and not re.match(r"[A-Za-zµμ°%]|1\s*/", rest):
        return None
    value = float(number)
    try:
        factor, _ = unit(rest)
    except UnitError as error:
        if error.asked[1] in names or re.search(r"[A-Za-z_]\w*\s*\(", rest):  # 0.9 m*cos(a)
            what = f"a unit stands behind one number alone: {described(text)}"
            alone = re.split(r"[*/]", rest)[0].strip()
            alone = alone if alone in {**BASE, **DERIVED} else ""
            named = f"parameters: {{x: {f'{number} {alone}'.strip()}}}"
            raise ScenarioError(
                what, f"In an expression numbers are in SI, or named: `{named}`, then x*..."
            ) from None
        raise no_unit(error.what, *error.asked, wanted) from None
    # decimal fractions are exact: 0.7 mm is the same number as 0.0007
    if isinstance(factor, Fraction) and 1e-99 < abs(value) < 1e99:
        return _exactly(number, factor), rest
    return value * float(factor), rest


@lru_cache(AGAIN)
def _exactly(number: str, factor: Fraction) -> float:
    """A decimal fraction times a factor, rounded once."""
    return float(Fraction(number) * factor)


@cache
def kind(dimension: Dimension) -> str:
    """What a number of this dimension is called; empty if nothing common."""
    return next((name for text, name in KINDS.items() if unit(text)[1] == dimension), "")


def inside(units: tuple[str, ...]) -> str:
    """`this number is a length, in m`"""
    parts = []
    for text in units:
        in_unit = f"in {text}" if text not in ("-", "1") else ""
        parts.append(", ".join(part for part in (kind(unit(text)[1]), in_unit) if part))
    return f"this number is {', or '.join(parts)}"


def units_hint(units: tuple[str, ...]) -> str:
    """These units as a hint."""
    return f"T{inside(units)[1:]}." if units != ("-",) else ""


@cache
def si(text: str) -> str:
    """The SI unit of the same kind: m for mm, rad/s for rpm."""
    dimension = unit(text)[1]
    if kind(dimension):
        return next(text for text in KINDS if unit(text)[1] == dimension)
    powers = [(base, p) for base, p in zip(BASE, dimension, strict=True) if p]
    return "*".join(base if p == 1 else f"{base}^{p:g}" for base, p in powers)


def check_dimension(written: str, units: tuple[str, ...]) -> None:
    """Refuse a written unit that is none of the allowed ones in kind; rad may be left out."""
    _, dimension = unit(written)
    allowed = [unit(text)[1] for text in units]
    if dimension in allowed or (not any(dimension) and unit("rad")[1] in allowed):
        return
    name = kind(dimension)
    what = f"wrong unit: {described(written)}{f' is {name}' if name else ''}"
    raise ScenarioError(f"{what}; {inside(units)}")


def fits(written: str, wanted: str) -> bool:
    """Whether a unit is one of the kind wanted; none is SI, and rad may be left out."""
    if not written or unit(written)[1] == unit(wanted)[1]:
        return True
    return wanted == "rad" and not any(unit(written)[1])
