"""What scenarios that are much alike have in common, read once."""

import json
import re
from functools import lru_cache
from typing import Any

from trsim.scenario.merge import mapping, merged
from trsim.scenario.unfolded import Scope

MOST = 1000  # specs that are known at once from case to case: those just before are much alike


class Memory:
    """Specs that were made already; see scenario/load.py.

    names: of all parameters and points of the scenarios, see `named`.
    """

    def __init__(self, names: frozenset[str]) -> None:
        self.made: dict[tuple, Any] = {}
        self.pieces: dict[int, tuple[Any, str, list[str]]] = {}  # the data is kept: its id is too
        self.joined: dict[tuple[int, int], tuple[Any, Any, Any]] = {}
        self.word = re.compile("|".join(rf"\b{name}\b" for name in sorted(names)) or r"(?!)")

    @classmethod
    def of(cls, data: dict[str, Any]) -> "Memory":
        """One for scenarios with the names of this data."""
        return cls(named(data))

    @classmethod
    def lasting(cls, data: dict[str, Any]) -> "Memory":
        """One that knows what cases before this one had, of which their data are gone."""
        memory = _lasting(named(data))
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
        that the text names, and what the text means where it stands."""
        if id(data) not in self.pieces:
            text = json.dumps(data)
            self.pieces[id(data)] = data, text, sorted(set(self.word.findall(text)))
        _, text, names = self.pieces[id(data)]
        means = (scope.frame, *scope.names.items()) if scope else ()
        meant = scope.names if scope else {}
        named = [points.get(meant.get(name, name)) for name in names]
        values = [parameters.get(name) for name in names]
        units = [getattr(one, "unit", None) for one in values]  # 1 m/rad is none per turn
        return section, text, means, *values, *units, *named

    def merged(self, base: Any, over: Any) -> Any:
        """One piece of data overridden by another; the same piece for the same two."""
        key = id(base), id(over)
        if key not in self.joined:
            self.joined[key] = base, over, merged(base, over)
        return self.joined[key][2]


def named(data: dict[str, Any]) -> frozenset[str]:
    """The names of the parameters and points of a scenario, and of its templates."""
    of = [data, *mapping(data, "templates").values()]
    return frozenset(
        name for one in of for key in ("parameters", "points") for name in mapping(one, key)
    )


_lasting = lru_cache(8)(Memory)
