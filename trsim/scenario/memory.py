"""What scenarios that are much alike have in common, read once."""

import json
import re
from collections.abc import Iterator
from functools import cache, lru_cache
from typing import Any

from trsim.scenario.merge import merged
from trsim.scenario.unfolded import Scope

MOST = 1000  # specs that are known at once from case to case: those just before are much alike
WORD = re.compile("[A-Za-z_][A-Za-z0-9_]*")  # that may name a parameter or a point


class Memory:
    """Specs that were made already; see scenario/load.py."""

    def __init__(self) -> None:
        self.made: dict[tuple, Any] = {}
        self.pieces: dict[int, tuple[Any, str]] = {}  # the data is kept: its id is too
        self.joined: dict[tuple[int, int], tuple[Any, Any, Any]] = {}

    @classmethod
    def lasting(cls) -> "Memory":
        """One that knows what cases before this one had, of which their data are gone."""
        memory = _lasting()
        memory.pieces.clear()
        memory.joined.clear()
        if len(memory.made) > MOST:
            memory.made.clear()
        return memory

    def key(
        self,
        section: str,
        data: Any,
        parameters: dict[str, float],
        scope: Scope | None,
        points: dict[str, Any],
    ) -> tuple:
        """What a piece of data depends on: its text, the values of the parameters and the points
        that any word of it may name, and what the text means where it stands.

        Equal keys make specs that are equal to the bit: numbers count with their sign, as of zero,
        and with their unit, as 1 m/rad is none per turn.
        """
        if id(data) not in self.pieces:
            self.pieces[id(data)] = data, json.dumps(data)
        text = self.pieces[id(data)][1]
        names, found = scope.names if scope else {}, list[Any]()
        for word in words(text):
            if word in parameters:
                value = parameters[word]
                found += word, repr(value), getattr(value, "unit", None)
            if (point := points.get(names.get(word, word))) is not None:
                found += word, repr(point.frame)  # nothing else of it is asked
        means = (repr(scope.frame), *scope.names.items()) if scope else ()
        return section, text, means, *found

    def merged(self, base: Any, over: Any) -> Any:
        """One piece of data overridden by another; the same piece for the same two."""
        key = id(base), id(over)
        if key not in self.joined:
            self.joined[key] = base, over, merged(base, over)
        return self.joined[key][2]


@lru_cache(MOST)
def words(text: str) -> tuple[str, ...]:
    """All that may be a name in the strings of some JSON."""
    return tuple(sorted({word for one in strings(json.loads(text)) for word in WORD.findall(one)}))


def strings(data: Any) -> Iterator[str]:
    """Every string in a tree, keys among them."""
    if isinstance(data, str):
        yield data
    elif isinstance(data, dict | list):
        for one in data:
            yield from strings(one)
        if isinstance(data, dict):
            yield from strings(list(data.values()))


@cache
def _lasting() -> Memory:
    return Memory()
