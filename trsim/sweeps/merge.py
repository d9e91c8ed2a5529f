"""Folders of the same sweep made into one, as if one machine had run all of it.

Each has the whole plan, and what came of some of its cases: shards on machines that share no
folder.  Of a case that several have, the best is taken: a result file before a record, a record
before a case that gave neither, then the later.  Two results of a case must be the same.

The folder that is made counts as one of them.  So what was broken off is gone on with, and more
can be added later.  Nothing in the others is changed.
"""

import os
import shutil
from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

from trsim.errors import FileError, UsageError, some
from trsim.store.disk import synced
from trsim.store.lock import writing
from trsim.store.own import remove
from trsim.store.target import PART, RESULT, file_errors, fresh, make, replaceable
from trsim.sweeps.folder import (
    NUMBERED,
    check_usable,
    read_plan,
    refuse_at_work,
    remove_unfinished,
    write_index,
    write_told,
)
from trsim.sweeps.ledger import Entry, Ledger, entries, stamp
from trsim.sweeps.plan import named_file
from trsim.sweeps.records import Records, raw, words_digest
from trsim.sweeps.study import Case, study

SAME = ("keys", "units", "numbers")  # of plans, beside the cases
AT_ONCE = 1 << 20  # bytes
SHOWN = 5  # cases that are told one by one


class Lost(NamedTuple):
    """A case of which what its folder tells of is not there."""

    case: str
    folder: Path
    why: str


class Taken(NamedTuple):
    """A case, and the folder it is taken from."""

    folder: Path
    case: Case
    entry: Entry


def merge(
    folders: Sequence[Path], output: Path, link: bool = False
) -> Generator[int | Entry | Lost, None, None]:
    """Make one folder: first how many cases are to be taken, then each, and each that is lost.

    link: result files become second names of those that are there.  Raises UsageError where the
    folders are not of the same plan, FileError where two results of a case differ, where a folder
    cannot be read, or where a process is at work in one.
    """
    told = the_plan(folders, output)
    check_usable(output)
    with file_errors(output):
        make(output / "cases")
    mine = output / "ledger.jsonl"
    with writing(mine):
        refuse_at_work(output, mine)
        sweep_out(output)
        chosen, lost = choice(told, [*_there(output), *folders], output)
        write_told(output, told)
        with file_errors(output):
            ledger, records = Ledger(output), Records(output, "", told.get("numbers", ()))
        try:
            yield from _taken(chosen, output, link, (ledger, records))
            yield from lost
        finally:
            records.close()
            ledger.close()
            write_index(output, told, entries(output))


def _there(output: Path) -> list[Path]:
    return [output] if (output / "plan.json").exists() else []


# --- the same plan ---------------------------------------------------------------------------


def the_plan(folders: Sequence[Path], output: Path) -> dict[str, Any]:
    """The plan of all folders.  Raises UsageError where they have different ones."""
    first, *others = folders
    told = read_plan(first)
    for folder in folders:
        if Path(os.path.realpath(output)).is_relative_to(os.path.realpath(folder)):
            what = f"{output} is in {folder}, which is to stay as it is"
            raise UsageError(what, "Name another folder with -o.")
        refuse_at_work(folder)
    for folder in (*others, *_there(output)):
        if why := unlike(told, read_plan(folder)):
            hint = "Shards have the same scenario, the same --set and the same trsim."
            raise UsageError(f"{folder} is of another sweep than {first}: {why}", hint)
    return told


def unlike(a: dict[str, Any], b: dict[str, Any]) -> str:
    """What plan b has another way than plan a; empty where they have the same cases."""
    if a["engine"] != b["engine"]:
        return f"it was made by trsim {b['engine']}, not {a['engine']}"
    ours, theirs = ({one["name"]: one["digest"] for one in told["cases"]} for told in (a, b))
    if only := [name for name in theirs if name not in ours]:
        return f"case {some(only, SHOWN)} is of it alone"
    if only := [name for name in ours if name not in theirs]:
        return f"it has no case {some(only, SHOWN)}"
    if differ := [name for name in ours if ours[name] != theirs[name]]:
        return f"case {some(differ, SHOWN)} has other numbers"
    if [*ours] != [*theirs]:
        return "its cases come in another order"
    return next((f"its {key} differ" for key in SAME if a.get(key) != b.get(key)), "")


# --- which of several ------------------------------------------------------------------------


def choice(
    told: dict[str, Any], folders: Sequence[Path], output: Path
) -> tuple[list[Taken], list[Lost]]:
    """What is taken of each case, and what is lost.  Raises FileError where results differ."""
    studies = [study(folder) for folder in folders]
    words = words_digest(told.get("numbers", ()))
    chosen: list[Taken] = []
    lost: list[Lost] = []
    wrong: list[str] = []
    for k in range(len(told["cases"])):
        every = [(one.folder, one.cases[k]) for one in studies]
        good = [Taken(folder, case, case.entry) for folder, case in every
                if case.entry and (case.there or not case.entry.content)]  # fmt: skip
        wrong += contradictions(good)
        if good:
            chosen.append(max(good, key=lambda one: _rank(one, words, output)))
        if not any(one.case.there for one in good):
            lost += [Lost(case.name, folder, case.reason or "its result is gone")
                     for folder, case in every if case.entry and case.entry.content]  # fmt: skip
    if wrong:
        hint = "Leave one of the folders out, or run the case again in one of them."
        raise FileError(some(wrong, SHOWN, "; {} more", "; "), hint)
    return chosen, lost


def _rank(one: Taken, words: str, output: Path) -> tuple[Any, ...]:
    """What is taken rather has more; where nothing tells two apart, what is there already."""
    kept = one.case.kept
    asked = kept is not None and kept.words == words
    return one.case.filed, one.case.there, asked, one.entry.at, one.folder == output


def contradictions(found: Sequence[Taken]) -> Iterator[str]:
    """The results of a case that differ from another of their kind; each is told once."""
    for a, b in combinations((one for one in found if one.case.there), 2):
        if _kind(a.case) == _kind(b.case) and a.entry.content != b.entry.content:
            yield f"{a.folder} and {b.folder} have different results of case {a.case.name}"
            return


def _kind(case: Case) -> str:
    """Hashes of files are of all rows, those of records of the numbers that were asked for."""
    return case.kept.words if case.kept else ""


# --- taking ----------------------------------------------------------------------------------


def sweep_out(output: Path) -> None:
    """Remove what a process that was killed left unfinished.  Only for who is alone there."""
    remove_unfinished(output)
    for path in (output / "cases").glob("*.h5.*"):
        if NUMBERED.fullmatch(path.suffix):
            with suppress(FileError):  # something else with such a name stays
                remove(path, PART)


def _taken(
    chosen: Sequence[Taken], output: Path, link: bool, books: tuple[Ledger, Records]
) -> Generator[int | Entry | Lost, None, None]:
    (ledger, records), known = books, entries(output)
    wanted = [one for one in chosen if one.entry != known.get(one.case.name)]
    yield len(wanted)
    for one in wanted:
        entry = one.entry
        if one.folder != output:
            try:
                entry = _moved(one, output, link, records)
            except Damaged as error:
                yield Lost(one.case.name, one.folder, str(error))
                continue
        if before := known.get(entry.case):  # of the lines of a case the latest counts
            entry = entry._replace(at=max(entry.at, before.at))
        with file_errors(ledger.path):
            ledger.add(entry)
        yield entry


class Damaged(Exception):
    """A result is not what the ledger tells of."""


def _moved(one: Taken, output: Path, link: bool, records: Records) -> Entry:
    """The entry of a case whose result is in the other folder now."""
    entry, at = one.entry, one.case.kept
    if at is not None:
        try:
            data = raw(one.folder, at, entry.content)
        except FileError as error:
            raise Damaged(error.what) from None
        with file_errors(records.path):
            return entry._replace(kept=records.put(data, at.words))
    if not entry.content:
        return entry
    file = named_file(output, entry.case)
    with writing(file):
        (linked if link else copied)(one.case.file, file)
    size, changed = stamp(file)
    if size != entry.size:
        raise FileError(f"{one.case.file} was changed meanwhile", file=str(one.case.file))
    return entry._replace(size=size, changed=changed)


def copied(source: Path, target: Path) -> None:
    """Copy a result file, with the time it was written."""
    try:
        file = source.open("rb")
    except OSError as error:
        raise FileError(f"{source}: {error.strerror}", file=str(source)) from None
    with file, fresh(target, RESULT) as unfinished, file_errors(target):
        with unfinished.open("wb") as new:
            shutil.copyfileobj(file, new, AT_ONCE)
        found = os.fstat(file.fileno())
        os.utime(unfinished, ns=(found.st_atime_ns, found.st_mtime_ns))
        synced(unfinished)


def linked(source: Path, target: Path) -> None:
    """Give a result file a second name; both are one file, which trsim only ever replaces."""
    with file_errors(target):
        replaceable(target, RESULT).unlink(missing_ok=True)
    try:
        os.link(os.path.realpath(source), target)
    except OSError as error:
        what = f"{target} cannot be a second name of {source}: {error.strerror}"
        raise FileError(what, "Without --link files are copied.", file=str(target)) from None
