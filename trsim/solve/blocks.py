"""The blocks of a run as they come."""

from collections.abc import Generator, Iterator
from typing import Any


class Blocks:
    """The blocks of a run, and behind the last one its outcome."""

    outcome: Any = None

    def __init__(self, run: Generator[Any, None, Any]) -> None:
        self.run = run

    def __iter__(self) -> Iterator[Any]:
        self.outcome = yield from self.run
