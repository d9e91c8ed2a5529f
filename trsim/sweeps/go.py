"""A sweep made, or gone on with: what is needed is run, and what becomes of it is kept."""

import time
from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from trsim.errors import FileError
from trsim.store.checkpoint import sources
from trsim.store.lock import refuse_if_written, writing
from trsim.store.own import remove
from trsim.store.target import LOCK, file_errors, make
from trsim.sweeps.adaptive import Batches, check_whole
from trsim.sweeps.choosing import Results
from trsim.sweeps.folder import (
    check_usable,
    read_plan,
    refuse_at_work,
    remove_unfinished,
    write_index,
    write_plan,
)
from trsim.sweeps.job import task
from trsim.sweeps.ledger import Entry, Ledger, entries, stamp
from trsim.sweeps.needed import Need, Where, need
from trsim.sweeps.plan import Case, Plan, named_file
from trsim.sweeps.records import Records, Sizes
from trsim.version import __version__

WRITTEN, RARELY = 1.0, 100.0  # s between two writings of the index; of the time one takes
Runner = Callable[[Iterable[dict[str, Any]]], Iterable[tuple[dict[str, Any], dict[str, Any]]]]


class Shard(NamedTuple):
    """The part of the cases that one of several processes runs: i of n, from 1."""

    i: int = 1
    n: int = 1

    @property
    def name(self) -> str:
        return "" if self.n == 1 else f"{self.i}of{self.n}"


WHOLE = Shard()


def engine() -> str:
    """What makes results: the version, and a hash of the sources that have a part in them."""
    return f"{__version__} {sources(Path(__file__).parents[1])[:16]}"


def needs(plan: Plan, folder: Path, engine: str, shard: Shard = WHOLE) -> list[tuple[Case, Need]]:
    """What is to be done about every case of a shard."""
    known = entries(folder)
    mine = plan.cases[shard.i - 1 :: shard.n]
    where = Where(folder, engine, Sizes(folder))
    return [(case, need(case, known.get(case.name), plan, where)) for case in mine]


def go(
    plan: Plan, folder: Path, engine: str, run: Runner, shard: Shard = WHOLE
) -> Generator[Entry | int, None, None]:
    """Run what is needed, batch by batch: first how many cases that are, then each as it ends.

    Raises FileError where the folder cannot be written, or is being written by another process;
    UsageError where it is not the folder of a sweep, or where shards cannot choose their cases.
    """
    check_whole(plan, shard.n)
    check_usable(folder)
    with file_errors(folder):
        make(folder / "cases")
    mine = folder / f"ledger{shard.name and '-'}{shard.name}.jsonl"
    with writing(mine):
        check_alone(plan, folder, shard, mine)
        sweep_out(folder, mine)
        write_plan(folder, plan, engine)
        with file_errors(folder):
            ledger = Ledger(folder, shard.name)
            records = Records(folder, shard.name, plan.numbers)
        try:
            yield from _gone_on(plan, folder, engine, run, shard, (ledger, records))
        finally:
            records.close()
            ledger.close()
            write_index(folder, read_plan(folder), entries(folder))


def check_alone(plan: Plan, folder: Path, shard: Shard, mine: Path) -> None:
    """Check that nobody works in the folder but shards of the same plan.

    Raises FileError where a process does.
    """
    same = shard.n > 1 and differing(plan, folder) == 0
    for lock in folder.glob("ledger*.jsonl.lock"):
        other = lock.with_name(lock.name.removesuffix(".lock"))
        if other != mine and (not same or other.name == "ledger.jsonl"):
            refuse_if_written(other)


def sweep_out(folder: Path, mine: Path | None = None) -> None:
    """Remove what processes that were killed left: locks beside results that are complete, and
    unfinished plans and indices, unless another shard may be writing one."""
    with suppress(FileError):
        refuse_at_work(folder, mine)
        remove_unfinished(folder)
    for lock in (folder / "cases").glob("*.h5.lock"):
        with suppress(FileError):  # of a case that is being run, or no lock
            refuse_if_written(lock.with_name(lock.name.removesuffix(".lock")))
            remove(lock, LOCK)


def differing(plan: Plan, folder: Path) -> int:
    """How many cases of the plan in a folder are not in this one; 0 without a plan."""
    try:
        there = read_plan(folder)["cases"]
    except FileError:
        return 0
    known = {(case.name, case.digest) for case in plan.cases}
    return sum((one["name"], one["digest"]) not in known for one in there)


def _gone_on(
    plan: Plan,
    folder: Path,
    engine: str,
    run: Runner,
    shard: Shard,
    books: tuple[Ledger, Records],
) -> Generator[Entry | int, None, None]:
    ledger, standing, why, known = books[0], dict[str, Entry](), set[str](), entries(folder)
    for case, found in needs(plan, folder, engine, shard):
        if found.why:
            why.add(case.name)
        elif found.entry:
            standing[case.name] = found.entry
            if found.entry != known.get(case.name):  # its line was lost, or is old
                ledger.add(found.entry)
    batches = Batches(plan, Results(folder, standing))
    for k, batch in enumerate(batches):
        wanted = [case for case in batch if case.name in why]
        if wanted or k == 0:
            yield len(wanted)
        for entry in _ran(plan, folder, engine, run, (wanted, books)) if wanted else ():
            standing[entry.case] = entry
            why.discard(entry.case)
            yield entry
        if not all(case.name in standing for case in batch):
            return  # other shards have them
    if plan.adaptive:
        write_plan(folder, plan, engine, batches.chosen)


def _ran(
    plan: Plan,
    folder: Path,
    engine: str,
    run: Runner,
    of: tuple[list[Case], tuple[Ledger, Records]],
) -> Generator[Entry, None, None]:
    """Cases run, and what became of each written down as it ends."""
    wanted, (ledger, records) = of
    cases = {case.name: case for case in wanted}
    tasks = (task(case, plan, named_file(folder, case.name)) for case in wanted)
    table, known = read_plan(folder), entries(folder)  # with what other shards did
    took, written = 0.0, time.monotonic()
    for one, ended in run(tasks):
        case = cases[one["name"]]
        with file_errors(records.path):
            kept = records.add(ended["record"]) if "record" in ended else ""
        filed = ended.get("content") and not kept
        size, changed = stamp(named_file(folder, case.name)) if filed else (0, 0)
        entry = Entry(case.name, case.digest, engine, ended["status"], ended["reason"],
                      ended.get("attempts", 1), ended.get("content", ""), size, changed,
                      time.time(), ended.get("wall", 0.0), ended.get("summary", {}),
                      kept)  # fmt: skip
        with file_errors(ledger.path):
            ledger.add(entry)
        known[case.name] = entry
        if time.monotonic() - written > max(WRITTEN, RARELY * took):
            began = time.monotonic()
            write_index(folder, table, known)
            written = time.monotonic()
            took = written - began
        yield entry
