"""Cases of a sweep run again with all they give, where the sweep kept only their numbers."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py

from trsim.api.hearing import Listener
from trsim.api.run import Work, made, wanted
from trsim.api.running import Wanted
from trsim.api.sweep import planned_of
from trsim.errors import UsageError, known
from trsim.sweeps.folder import read_plan
from trsim.sweeps.go import engine
from trsim.sweeps.ledger import DIGEST, Entry, entries
from trsim.sweeps.plan import Case, Plan, named_file


def again(
    hears: Listener, folder: Path, names: tuple[str, ...], how: Wanted | None = None
) -> Iterator[dict[str, Any]]:
    """Run cases of the sweep in a folder into their result files; the summary of each.

    Raises UsageError for what is no case of it, FileError where there is no sweep to be read.
    """
    told = read_plan(folder)
    there = {one["name"]: one["digest"] for one in told["cases"]}
    for name in names:
        if name not in there:
            raise UsageError(f"{folder}: no case named '{name}'", known(name, there))
    planned = planned_of(hears, told["source"], tuple(told.get("sets", ())), engine())
    cases = {case.name: case for case in planned.cases}
    for name in names:
        if name not in cases:
            hint = f"Run the sweep again: trsim sweep {told['source']} -o {folder}"
            raise UsageError(f"{told['source']} has no case '{name}' any more", hint)
        if cases[name].digest != there[name]:
            hears.warn(str(folder), f"{name}: the scenario, or trsim itself, changed since then")
        yield _one(hears, planned, cases[name], (folder, how or wanted(())))


def _one(hears: Listener, planned: Plan, case: Case, into: tuple[Path, Wanted]) -> dict[str, Any]:
    folder, how = into
    target = named_file(folder, case.name)
    summary = made(hears, Work(planned.scenario(case), target, how))
    with h5py.File(summary["file"], "r+") as file:
        file["provenance"].attrs[DIGEST] = case.digest  # the sweep knows it by this
    entry = entries(folder).get(case.name)
    if entry is not None and entry.kept and entry.digest == case.digest:
        same = agrees(target, planned, entry)
        summary["as_kept"] = same
        if not same:
            hears.warn(str(target), "its numbers are not those that the sweep kept of the case")
    return summary


def agrees(target: Path, planned: Plan, entry: Entry) -> bool:
    """Whether a result file has the numbers that a sweep kept."""
    from trsim.store.read import read
    from trsim.sweeps.summary import packed, record

    return packed(record(read(target), planned.numbers))[1] == entry.content
