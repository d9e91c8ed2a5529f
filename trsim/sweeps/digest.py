"""What a case is known by.

    digest = sha256(sources of trsim that make results; the data of the case, keys in order)

Comments, spaces and the order of keys do not count.
"""

import hashlib
from json import JSONEncoder
from typing import Any

TEXT = JSONEncoder(sort_keys=True).encode  # one encoder: making one takes as long as a piece


class Digests:
    """Digests of the data of cases; a piece that cases share is hashed once."""

    def __init__(self, engine: str) -> None:
        self.engine = engine
        self.known: dict[int, tuple[Any, str]] = {}

    def of(self, data: dict[str, Any]) -> str:
        parts = [f"{key}:{self.section(data[key])}" for key in sorted(data)]
        return hashlib.sha256("\n".join([self.engine, *parts]).encode()).hexdigest()

    def section(self, piece: Any) -> str:
        if not isinstance(piece, dict):
            return TEXT(piece)
        if id(piece) not in self.known:
            inner = {key: self.section(value) for key, value in piece.items()}
            text = TEXT(inner)
            self.known[id(piece)] = piece, hashlib.sha256(text.encode()).hexdigest()
        return self.known[id(piece)][1]
