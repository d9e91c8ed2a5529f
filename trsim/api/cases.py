"""Cases of a sweep run again with all they give, where the sweep kept only their numbers."""

from collections.abc import Iterator, Sequence
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
from trsim.sweeps.plan import named_file


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
    cases, kept = {case.name: case for case in planned.cases}, entries(folder)
    for name in names:
        if name not in cases:
            hint = f"Run the sweep again: trsim sweep {told['source']} -o {folder}"
            raise UsageError(f"{told['source']} has no case '{name}' any more", hint)
        if cases[name].digest != there[name]:
            hears.warn(str(folder), f"{name}: the scenario, or trsim itself, changed since then")
        case, target = cases[name], named_file(folder, name)
        summary = made(hears, Work(planned.scenario(case), target, how or wanted(())))
        with h5py.File(target, "r+") as file:
            file["provenance"].attrs[DIGEST] = case.digest  # the sweep knows it by this
        entry = kept.get(name)
        if entry is not None and entry.kept and entry.digest == case.digest:
            summary["as_kept"] = agrees(target, entry, told.get("numbers", ()))
            if not summary["as_kept"]:
                text = "its numbers are not those that the sweep kept of the case"
                hears.warn(str(target), text)
        yield summary


def agrees(target: Path, entry: Entry, words: Sequence[str]) -> bool:
    """Whether a result file has the numbers that a sweep kept, which asked for some words."""
    from trsim.store.read import read
    from trsim.sweeps.summary import packed, record

    return packed(record(read(target), words))[1] == entry.content
