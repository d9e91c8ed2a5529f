"""Which cases of a plan are to be run, and why."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import h5py

from trsim.errors import some
from trsim.scenario.vary import SUMMARY
from trsim.store.checkpoint import differing, leaves
from trsim.sweeps.job import CONTACT, STATISTICS
from trsim.sweeps.ledger import AGAIN, DIGEST, REFUSED, Entry, stamp
from trsim.sweeps.plan import Case, Plan, named_file
from trsim.sweeps.records import Sizes, place, words_digest

DAMAGED = (OSError, LookupError, RuntimeError, ValueError, TypeError, AttributeError)
CHANGED = "its file was changed"
SHOWN = 4  # differences that are told


class Where(NamedTuple):
    """A folder, and what makes results for it."""

    folder: Path
    engine: str
    sizes: Sizes


class Need(NamedTuple):
    """What is to be done about a case."""

    why: str  # it is run; "" where it is not
    entry: Entry | None  # that stands


def need(case: Case, entry: Entry | None, plan: Plan, where: Where) -> Need:
    """Whether a case is run, given its last entry."""
    folder, engine = where.folder, where.engine
    file = named_file(folder, case.name)
    if entry is None:
        if not file.exists():
            return Need("not run yet", None)
        entry = adopted(case.name, case.digest, file, engine)
        return Need("", entry) if entry else Need("its file is of another case", None)
    if entry.digest != case.digest:
        if entry.engine != engine:
            return Need("trsim itself changed", entry)
        return Need("the scenario changed", entry)
    if entry.status in AGAIN:
        return Need(f"tried again: {entry.status}", entry)
    if entry.status == REFUSED:
        return Need("", entry)
    if found := stands(entry, file, engine, where.sizes):
        return Need(unkept(found, plan), found)
    lost = "its summary is gone" if entry.kept else "its file is gone"
    return Need(CHANGED if stamp(file)[0] else lost, entry)


def unkept(entry: Entry, plan: Plan) -> str:
    """Why the record of a case is not all that is asked for; empty where it is, and of a file."""
    if (at := place(entry.kept)) is None:
        return ""
    if plan.keep != SUMMARY:
        return "its result file is asked for" if plan.wished else ""
    return "" if at.words == words_digest(plan.numbers) else "other numbers are asked for"


def stands(entry: Entry, file: Path, engine: str, sizes: Sizes) -> Entry | None:
    """The entry with the stamp of its file; None where the file, or the record, is gone or not what
    it tells of.  Where a case was run again since, with all that it gives, that of its file."""
    size, changed = stamp(file)
    if at := place(entry.kept):
        full = adopted(entry.case, entry.digest, file, engine) if size else None
        if full:  # which does not say what the sweep asked for
            return full._replace(summary={**entry.summary, **full.summary})
        return entry if sizes.has(at) else None
    if not size or (size, changed) == (entry.size, entry.changed):
        return entry if size else None
    # copied, perhaps: what it says of itself decides
    found = adopted(entry.case, entry.digest, file, engine)
    if found and found.content == entry.content:
        return entry._replace(size=size, changed=changed)
    return None


def adopted(name: str, digest: str, file: Path, engine: str) -> Entry | None:
    """The entry of a complete file that is of this case, whose line was lost; None of any other."""
    try:
        with h5py.File(file, "r") as inner:
            provenance = inner["provenance"].attrs
            if provenance.get(DIGEST) != digest or "content_sha256" not in inner.attrs:
                return None
            told = [str(inner.attrs[name]) for name in ("status", "reason", "content_sha256")]
            summary = _summary(inner)
            wall = float(provenance.get("wall_time", 0.0))
    except DAMAGED:
        return None
    size, changed = stamp(file)
    status, reason, content = told
    return Entry(name, digest, engine, status, reason, 1, content, size, changed,
                 at=changed * 1e-9, wall=wall, summary=summary)  # fmt: skip


def _summary(file: Any) -> dict[str, Any]:
    """What `job.brief` tells of a run, from its file."""
    told, solver = file["summary"], file["solver"]
    found: dict[str, Any] = {name: told.attrs[name].item() for name in ("time", "rows", "events")}
    found["warnings"] = len(solver["warnings"]) if "warnings" in solver else 0
    place = {"integration_cpu": file["provenance"].attrs}
    for name in STATISTICS:
        attributes = place.get(name, solver.attrs)
        if name in attributes:
            found[name] = attributes[name].item()
    for joint, contact in told.items():
        found |= {f"{joint}.{name}": contact.attrs[name].item() for name in CONTACT}
    return found


def explained(plan: Plan, case: Case, told: Need, folder: Path) -> str:
    """Why a case is run, with what is different where its file is there."""
    if told.why != "the scenario changed":
        return told.why
    try:
        with h5py.File(named_file(folder, case.name), "r") as file:
            was = leaves(json.loads(file["scenario/resolved"].asstr()[()]))
    except DAMAGED:
        return told.why
    now = leaves(case.data)
    parts = [
        f"{name} is {now.get(name, 'absent')}, was {was.get(name, 'absent')}"
        for name in differing(was, now)
    ]
    return f"{told.why}: {some(parts, SHOWN, '; {} more', '; ')}"
