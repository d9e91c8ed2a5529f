"""Decimal commas in lists: [0, -0,5] holds three numbers where two were meant."""

import re
from collections.abc import Iterator
from typing import Any

LIST = re.compile(r"\[[^][{}#'\"]*\]")
CLOSE = re.compile(r"(?<![\w.])([-+]?[0-9]+),([0-9]+)(?![\w.])")  # a comma alone between two
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
        for found in CLOSE.finditer(written[0]):
            if APART.search(written[0]) or found[1] == "-0":
                count = written[0].count(",") + 1
                yield (
                    f"{'.'.join(map(str, path))}: {written[0]} is a list of {count} numbers; if "
                    f"{found[0]} is one of them, write {found[1]}.{found[2]}"
                )
                break


def _whole(data: Any, path: tuple[str | int, ...]) -> Iterator[tuple[str | int, ...]]:
    """The places of lists in which two whole numbers stand side by side."""
    if isinstance(data, dict):
        for key, value in data.items():
            if isinstance(value, dict | list):
                yield from _whole(value, (*path, key))
    elif isinstance(data, list):
        whole = [isinstance(value, int) for value in data]
        if any(map(min, whole, whole[1:])):
            yield path
        for k, value in enumerate(data):
            if isinstance(value, dict | list):
                yield from _whole(value, (*path, k))
