"""What a text that is no unit probably means: kgm2 is kg*m^2, Nm is N*m, sec is s.

Words that stand together are taken apart into units that are known, and a digit behind one is its
power.  Of several readings the one of the dimension that is wanted counts, then that of fewest
parts.  A unit is never guessed by its nearest letters where these are few: mg is no kg.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from itertools import islice, product
from typing import Any, NamedTuple

from trsim.errors import edits

# what others write -> ours, singular and in small letters
NAMES = {
    "second": "s",
    "sec": "s",
    "minute": "min",
    "hour": "h",
    "hr": "h",
    "metre": "m",
    "meter": "m",
    "inch": "in",
    "inche": "in",
    "foot": "ft",
    "feet": "ft",
    "gram": "g",
    "gramme": "g",
    "kilo": "kg",
    "tonne": "t",
    "ton": "t",
    "lbm": "lb",
    "newton": "N",
    "pascal": "Pa",
    "joule": "J",
    "watt": "W",
    "hertz": "Hz",
    "knot": "kt",
    "degree": "deg",
    "radian": "rad",
    "revolution": "rev",
    "cycle": "rev",
    "percent": "%",
    "kph": "km/h",
    "kmh": "km/h",
    "micron": "um",
}
FORCES = {"lb": "lbf", "pound": "lbf"}  # where these are no masses
MASSES = {"pound": "lb"}
PREFIXES = {"kilo": "k", "milli": "m", "centi": "c", "micro": "u", "mega": "M", "giga": "G"}
LONGEST, PARTS, MOST = 40, 4, 400  # letters of a text, units in a word, readings
SURE = 0.5  # of what speaks against a reading: capitals for small letters
FEWEST = 3  # letters of a word that is guessed by its nearest

_PIECE = re.compile(
    r"\s*(?:(?P<over>/|\bper\b)|(?P<one>1)\s*(?=/)|(?P<bracket>[()])|(?P<times>[*.\u00d7_-])"
    r"|(?P<word>[A-Za-zµ°%]+)(?P<power>\s*(?:\^|\*\*)\s*\(?-?NUMBER\)?|-?NUMBER)?)".replace(
        "NUMBER", r"[0-9]+(?:\.[0-9]+)?"
    )
)
Words = tuple[str, ...]


class Factor(NamedTuple):
    """A word in a text, above or below the line."""

    word: str
    power: str
    sign: int


def meant(
    text: str, known: Iterable[str], unit: Callable[[str], Any], wanted: tuple[Any, ...] = ()
) -> tuple[str, bool] | None:
    """The unit that was probably meant, as we write it, and whether its letters were all there.

    known: the words of units; unit: gives (factor, dimension); wanted: dimensions, one of which it
    should have.
    """
    factors = _factors(text)
    if not factors:
        return None
    words, best = list(known), None
    readings = product(*(list(_readings(factor.word, words)) for factor in factors))
    for reading in islice(readings, MOST):
        ours = _written(factors, [parts for parts, _ in reading])
        cost = sum(cost for _, cost in reading)
        try:
            dimension = unit(ours)[1]
        except ValueError:  # a power that is none
            return None
        rank = (bool(wanted) and dimension not in wanted, cost)
        if best is None or rank < best[0]:
            best = rank, ours
    return (best[1], best[0][1] % 1.0 < SURE) if best else None


def _factors(text: str) -> list[Factor]:
    """The words of a text with their powers; none where something else stands in it."""
    found, end, sign, held = [], 0, 1, False
    text = text.strip()
    while end < len(text):
        piece = _PIECE.match(text, end)
        if piece is None or len(text) > LONGEST:
            return []
        end = piece.end()
        if piece["over"]:
            sign = -1
        elif piece["bracket"]:
            held, sign = piece["bracket"] == "(", sign if piece["bracket"] == "(" else 1
        elif piece["word"]:
            power = re.sub(r"[\s^*()]", "", piece["power"] or "1")
            found.append(Factor(piece["word"], power, sign))
            sign = sign if held else 1
    return found


def _written(factors: list[Factor], reading: list[Words]) -> str:
    """Products and powers as we write them."""
    above: list[str] = []
    below: list[str] = []
    for factor, parts in zip(factors, reading, strict=True):
        power = factor.power.removeprefix("-")
        side = above if (factor.sign > 0) != factor.power.startswith("-") else below
        raised = "" if power == "1" else f"^{power}"
        *first, last = parts
        # the power is that of the last unit of a word; what stands before it is not below the line
        (above if factor.sign > 0 else below).extend(first)
        side.append(f"({last}){raised}" if raised and "/" in last else f"{last}{raised}")
    return "/".join(["*".join(above) or "1", *below])


def _readings(word: str, known: list[str]) -> Iterator[tuple[Words, float]]:
    """Units that a word may be made of, and what speaks against each reading."""
    if word in known:
        yield (word,), 0.0
    yield from _split(word, known, PARTS)


def _split(word: str, known: list[str], most: int) -> Iterator[tuple[Words, float]]:
    for k in range(len(word), 0, -1):
        for ours, cost in _named(word[:k], known):
            if k == len(word):
                yield (ours,), 1.0 + cost
            elif most > 1:
                for parts, more in _split(word[k:], known, most - 1):
                    yield (ours, *parts), 1.0 + cost + more


def _named(word: str, known: list[str]) -> Iterator[tuple[str, float]]:
    """The units that a whole word may stand for."""
    if word in known:
        yield word, 0.0
    small = word.casefold()
    yield from ((one, 0.6) for one in known if one.casefold() == small and one != word)
    name = small if small in NAMES else small.removesuffix("s") if len(small) > 2 else small
    if name != word and name in known:
        yield name, 0.1
    for table, cost in ((NAMES, 0.1), (MASSES, 0.1), (FORCES, 0.2)):
        if table.get(name):
            yield table[name], cost
    for prefix, ours in (*PREFIXES.items(), ("m", "m"), ("u", "u")):  # milliseconds, msec
        unit = NAMES.get(name.removeprefix(prefix), "") if name.startswith(prefix) else ""
        if unit and f"{ours}{unit}" in known:
            yield f"{ours}{unit}", 0.1


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The unit of a slip of a finger, in words of some length: dge is deg."""
    if len(word) < FEWEST:
        return None
    near = [one for one in known if len(one) >= FEWEST and edits(word, one) == 1]
    return near[0] if near else None
