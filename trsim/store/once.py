"""A run that is asked many things one after the other: nothing is read twice in a row.

Every quantity of an envelope asks for times, peaks and the steps of its contact, and its components
for the same rows.  Reading them again took most of the time of an envelope.
"""

from dataclasses import fields
from functools import cached_property, lru_cache
from typing import Any

from trsim.arrays import Array
from trsim.store.peaks import Peak
from trsim.store.read import Run

LAST = 4  # channels, and contacts, that are kept: those of a large run fill the memory


class Once(Run):
    """What it tells is read only: others are told the same arrays."""

    @classmethod
    def of(cls, run: Run) -> Run:
        """A run that is complete; others, whose rows may change or are not there, as they are."""
        if type(run) is not Run:
            return run
        return cls(**{one.name: getattr(run, one.name) for one in fields(Run)})

    @cached_property
    def peaks(self) -> tuple[Peak, ...]:  # type: ignore[override]
        return super().peaks

    def steps(self, joint: str) -> dict[str, Array]:
        return dict(self._tables(joint))

    def _rows(self, stored: str) -> Array:
        found: Array = self._columns(stored)
        return found

    @cached_property
    def _tables(self) -> Any:
        return lru_cache(LAST)(super().steps)

    @cached_property
    def _columns(self) -> Any:
        return lru_cache(LAST)(super()._rows)
