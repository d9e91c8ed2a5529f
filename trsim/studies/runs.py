"""The runs of a study: of every case its ensemble, the member as stated first.

The runs of a grid are no ensemble: each is a case of its own, under the name of its file.
"""

import os
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from trsim.arrays import Array
from trsim.errors import UsageError
from trsim.statuses import WELL
from trsim.store.read import Run

BOOK = 1e-3  # J an energy book may miss; the chain has 6 J, and misses 1e-8 or, with bars, 1e-4


class Member:
    """One run of an ensemble; what was read of it is kept."""

    def __init__(self, case: str, index: int, file: Path, run: Run) -> None:
        self.case, self.index, self.file, self.run = case, index, file, run
        self._channels: dict[str, Array] = {}

    def channel(self, name: str) -> Array:
        """The rows of a channel."""
        if name not in self._channels:
            self._channels[name] = self.run.channel(name)
        return self._channels[name]

    @property
    def time(self) -> Array:
        return self.channel("time")

    @cached_property
    def missed(self) -> float:
        """What the energy book misses at most, J."""
        if "energy.residual" not in self.run.units:
            return 0.0
        return float(np.max(np.abs(self.run.channel("energy.residual")), initial=0.0))

    def forget(self) -> None:
        """Let go of what was read."""
        self._channels.clear()


class Runs:
    """All members of a study, and how many of each case are planned and missing.

    grids: cases whose runs are no ensemble, but each a case of its own.
    book: J, what an energy book may miss.
    Raises FileError where there is no sweep in the folder, UsageError for one without cases.
    """

    def __init__(self, folder: str | Path, grids: Sequence[str] = (), book: float = BOOK) -> None:
        from trsim.sweeps.study import study

        self.members: dict[str, list[Member]] = {}
        self.missing: dict[str, int] = {}
        self.planned: dict[str, int] = {}
        self.folder, self.book = Path(folder), book
        found = study(folder)
        if "case" not in found.keys:
            hint = "Name the folder of a sweep over the cases of a study, see docs/studies.md."
            raise UsageError(f"{folder} is the sweep of one scenario, not of a study", hint)
        for case in found.cases:
            name = str(case.values["case"])
            name = case.name if name in grids else name
            index = self.planned.get(name, 0)
            self.planned[name] = index + 1
            if case.status in WELL:
                member = Member(name, index, Path(case.file), case.run())
                self.members.setdefault(name, []).append(member)
            else:
                self.missing[name] = self.missing.get(name, 0) + 1

    def has(self, *cases: str) -> bool:
        """Whether the first member of every one of these cases is there."""
        return all(self.of(case, 0) for case in cases)

    def stated(self, case: str) -> Member:
        """The member with the values as stated."""
        return self.members[case][0]

    def sound(self, case: str) -> list[Member]:
        """The members of an ensemble that count."""
        return [member for member in self.members.get(case, ()) if member.missed <= self.book]

    @property
    def aside(self) -> list[Member]:
        """The members that do not: their energy book does not close."""
        return [m for members in self.members.values() for m in members if m.missed > self.book]

    def of(self, case: str, index: int) -> Member | None:
        return next((m for m in self.members.get(case, ()) if m.index == index), None)

    def named(self, member: Member) -> str:
        """The file of a member as seen from the folder of the study."""
        return os.path.relpath(member.file, self.folder).replace(os.sep, "/")
