"""What the rules of an adaptive sweep choose from: cases, and what they gave so far."""

import math
from collections.abc import Generator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from trsim.errors import TrsimError, UsageError
from trsim.scenario import vary
from trsim.scenario.adaptive import SHARE, Width
from trsim.statuses import WELL
from trsim.store.read import Run
from trsim.sweeps.ledger import Entry
from trsim.sweeps.plan import Case, named_file
from trsim.sweeps.study import Case as Ended
from trsim.units import unit

# indices of cases, batch by batch; what is asked next is chosen once these have ended.  At last
# what came of it, in words
Choosing = Generator[list[int], None, str]


class Part(NamedTuple):
    """The cases of one name in `cases:`, "" without any."""

    name: str
    cases: tuple[Case, ...]
    sweep: vary.Sweep


class Results:
    """What cases gave, as far as choices need it.

    known: entries of those that ended; they become more
    """

    def __init__(self, folder: Path, known: Mapping[str, Entry]) -> None:
        self.folder, self.known = folder, known
        self.units, self.asked = dict[str, str](), dict[tuple[str, str], float]()

    def status(self, case: Case) -> str:
        return self.known[case.name].status

    def number(self, case: Case, word: str) -> float:
        """A number by its word; nan where the case has none, or its run did not end well."""
        entry = self.known[case.name]
        if entry.status not in WELL:
            return math.nan
        if word in entry.summary:
            value = entry.summary[word]
            return float(value) if isinstance(value, int | float) else math.nan
        # its file is older than the wish for the number
        if (place := (case.name, word)) not in self.asked:
            from trsim.analyse.outputs import scalar

            self.asked[place] = math.nan
            with suppress(TrsimError):
                self.asked[place] = scalar(self._run(entry), word)[0]
        return self.asked[place]

    def check(self, cases: tuple[Case, ...], word: str, width: Width) -> None:
        """Check that cases have a number, and that its width is of its kind.

        Raises UsageError where they do not; nothing is said where none ended well.
        """
        well = [case for case in cases if self.status(case) in WELL]
        if word in self.units or not well:
            return
        from trsim.analyse.outputs import scalar

        having = (case for case in well if not math.isnan(self.number(case, word)))
        run = self._run(self.known[next(having, well[0]).name])
        try:
            si = scalar(run, word)[1]
        except UsageError as error:
            what = error.what.removeprefix(f"{run.path}:").strip()
            raise UsageError(f"no case has {word}: {what}", error.hint) from None
        if width.unit != SHARE and unit(width.unit)[1] != unit(si)[1]:
            told = "a plain number" if si == "-" else f"in {si}"
            what = f"{word} is {told}, its width cannot be {width.text}"
            raise UsageError(what, "Write a width of its kind, or a share: 2 %.")
        self.units[word] = si

    def unit(self, word: str) -> str:
        """The unit of a number with a space before it; nothing where it has none."""
        si = self.units.get(word, "-")
        return "" if si == "-" else f" {si}"

    def _run(self, entry: Entry) -> Run:
        file = named_file(self.folder, entry.case)
        return Ended(entry.case, file, entry.status, entry.reason, {}, entry).run()


def how_many(asked: int, cases: int) -> str:
    """How many of a part's cases were asked for, in words."""
    return f"{asked:,} of {cases:,} cases" if asked < cases else f"all {cases:,} cases"
