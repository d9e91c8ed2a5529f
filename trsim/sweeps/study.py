"""A sweep as it stands in its folder, for whatever reads its runs."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path

from trsim.errors import FileError
from trsim.statuses import NOT_NEEDED
from trsim.store.read import Run, read
from trsim.sweeps.folder import SPARED, read_plan
from trsim.sweeps.ledger import FAILED, Entry, entries, stamp
from trsim.sweeps.needed import CHANGED, adopted, stands
from trsim.sweeps.plan import named_file
from trsim.sweeps.records import Place, Sizes, place, stored
from trsim.sweeps.summary import kept

MISSING = "missing"
READ = 1000  # cases whose names and units are kept, 10 kB each


@dataclass(frozen=True)
class Case:
    """One run of a sweep."""

    name: str
    file: Path
    status: str  # of the run, MISSING, NOT_NEEDED, or why there is none (ledger.py)
    reason: str
    values: dict[str, float | str]  # key -> SI number, or word
    entry: Entry | None

    @property
    def kept(self) -> Place | None:
        """Where its record is, of a case without a result file."""
        return place(self.entry.kept) if self.entry else None

    @property
    def there(self) -> bool:
        """Whether it has a result file or a record, whatever its status."""
        return self.entry is not None and bool(self.entry.content) and self.status != MISSING

    @property
    def filed(self) -> bool:
        """Whether it has a result file."""
        return self.there and self.kept is None

    @property
    def changed(self) -> bool:
        """Whether what has the name of its file is something else."""
        return self.status == MISSING and self.reason == CHANGED

    @property
    def failed(self) -> bool:
        return self.status in FAILED

    def run(self) -> Run:
        """Its results.  Raises FileError where there are none."""
        if not self.there:
            told = f": {self.reason}" if self.reason else ""
            what = f"{self.file}: the case has no result, {self.status}{told}"
            hint = "`trsim sweep` again runs what is missing."
            raise FileError(what, hint, file=str(self.file))
        if (at := self.kept) is not None:
            folder, sha = self.file.parent.parent, self.entry.content if self.entry else ""
            return kept(self.file, self.name, stored(folder, at, sha))
        try:
            found = self.file.stat()
        except OSError:
            return read(self.file)  # which says why
        return _read(self.file, found.st_ino, found.st_size, found.st_mtime_ns, found.st_ctime_ns)


@lru_cache(READ)
def _read(file: Path, *_: int) -> Run:
    """The file of a case, by what changes with it: a report asks several times for each, and to
    look whether all of a file is sound takes longer than most of what it is asked."""
    return read(file)


@dataclass(frozen=True)
class Study:
    """All cases of a sweep, in the order of its plan."""

    folder: Path
    source: str  # the scenario
    keys: tuple[str, ...]  # that vary by themselves; "case" first where there are named cases
    units: dict[str, str]  # key -> SI unit, or "-"
    written: dict[str, str]  # key -> unit as written in the scenario, where there is one
    method: str
    samples: int
    seed: int
    cases: tuple[Case, ...]
    adaptive: bool = False  # whether it chooses which cases are run
    chosen: tuple[str, ...] = ()  # what it found, and from how many cases; once it has ended

    @cached_property
    def named(self) -> dict[str, Case]:
        return {case.name: case for case in self.cases}


def study(folder: str | Path) -> Study:
    """The sweep in a folder.  Raises FileError where there is none that can be read."""
    folder = Path(folder)
    told, known = read_plan(folder), entries(folder)
    cases, sizes = [], Sizes(folder)
    for one in told["cases"]:
        entry, file = known.get(one["name"]), named_file(folder, one["name"])
        if entry is not None and entry.digest != one["digest"]:
            entry = None
        if entry is None and file.is_file():  # its line was lost; the file says what it is
            entry = adopted(one["name"], one["digest"], file, told["engine"])
        without = NOT_NEEDED if one.get(SPARED) else MISSING
        status, reason = (entry.status, entry.reason) if entry else (without, "")
        if entry and entry.content:
            if found := stands(entry, file, told["engine"], sizes):
                entry, status, reason = found, found.status, found.reason
            else:
                status, reason = MISSING, CHANGED if stamp(file)[0] else ""
        cases.append(Case(one["name"], file, status, reason, one["values"], entry))
    same = {name: told[name] for name in ("source", "units", "method", "samples", "seed")}
    keys, written = tuple(told["keys"]), told.get("written", {})
    adaptive, chosen = "chosen" in told, tuple(told.get("chosen", ()))
    return Study(folder=folder, keys=keys, written=written, cases=tuple(cases), adaptive=adaptive,
                 chosen=chosen, **same)  # fmt: skip
