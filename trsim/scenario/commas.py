"""Decimal commas in lists: [0, -0,5] holds three numbers where two were meant."""

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from trsim.errors import Place

LIST = re.compile(r"\[[^][{}#'\"]*\]")
# a comma alone between two numbers, the second with a unit or without
CLOSE = re.compile(r"(?<![\w.])([-+]?[0-9]+),([0-9]+)(?=\s*[\],]|\s*[^\W\d_])")
APART = re.compile(r",\s")


def commas(scenario: Any) -> Iterator[str]:
    """Lists in which a comma stands close between two whole numbers, and others do not.

    `[1,2]` is a list that is written close.  Another comma with a space behind it gives the decimal
    comma away, and so does a first number of -0.
    """
    for path in _whole(scenario.resolved, ()):
        place = scenario.place(path)
        written = place and LIST.match(place.excerpt, place.column - 1)
        if not written:
            continue
        if found := comma(written[0]):
            count = written[0].count(",") + 1
            yield (
                f"{'.'.join(map(str, path))}: {written[0]} is a list of {count} numbers; if "
                f"{found[0]} is one of them, write {found[1]}.{found[2]}"
            )


def comma(text: str) -> re.Match[str] | None:
    """What may be a decimal comma in a list as it is written."""
    return next(
        (found for found in CLOSE.finditer(text) if APART.search(text) or found[1] == "-0"), None
    )


def in_a_list(place: Place | None) -> str:
    """The hint for a list that is too long, where a decimal comma may be why."""
    written = place and LIST.match(place.excerpt, place.column - 1)
    found = written and comma(written[0])
    return f"If {found[0]} is one number, write {found[1]}.{found[2]}." if found else ""


def _begins(value: Any) -> bool:
    """Whether a value is written with a whole number first: 5, 5 mm."""
    return isinstance(value, int) or (isinstance(value, str) and value[:1].isdigit())


def _whole(data: Any, path: tuple[str | int, ...]) -> Iterator[tuple[str | int, ...]]:
    """The places of lists in which two whole numbers stand side by side."""
    if isinstance(data, dict):
        for key, value in data.items():
            if isinstance(value, dict | list):
                yield from _whole(value, (*path, key))
    elif isinstance(data, list):
        if any(isinstance(a, int) and _begins(b) for a, b in pairwise(data)):
            yield path
        for k, value in enumerate(data):
            if isinstance(value, dict | list):
                yield from _whole(value, (*path, k))
