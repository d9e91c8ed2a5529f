"""Whether a result file is to blame for an error nobody expected while it was read.

A file that is as a run leaves it is not: then the fault is ours.  Looked at are its content hash,
its scenario, its numbers, and whether it holds what a run of its scenario writes.
"""

from pathlib import Path
from typing import Any

import numpy as np

from trsim.errors import FileError, TrsimError
from trsim.store.read import Run, read, verify

HINT = "It was changed, damaged, or not written by this trsim.  Run the scenario again."


def blamed(path: Path) -> FileError | None:
    """What is wrong with a result file; None of one that is as it should be."""
    try:
        what = _faults(read(path))
    except TrsimError as error:
        return FileError(error.what, error.hint or HINT, file=str(path))
    return FileError(f"{path} {what}", HINT, file=str(path)) if what else None


def _faults(run: Run) -> str:
    from trsim.assemble.assemble import assemble
    from trsim.scenario.load import loads
    from trsim.store.points import plan

    if "content_sha256" not in run.attributes:
        return "was not completed, and cannot be read as it is"
    if not verify(run.path):
        return "does not hold what was written: its content hash differs"
    try:
        scenario = loads(run.text("scenario/resolved"))
        mechanism = assemble(scenario)
        planned = plan(scenario, mechanism)
    except TrsimError as error:
        return f"holds a scenario that is none: {error.what}"
    return _layout(run, mechanism, planned) or _rows(run)


def _layout(run: Run, mechanism: Any, planned: Any) -> str:
    """What is not there as a run of its scenario writes it."""
    columns = [c for c in mechanism.columns if c.wanted or c.name in planned.columns]
    there = {name: (run.units[name], run.sizes[name]) for name in run.units}
    if there != {c.name: (c.unit, c.size) for c in columns}:
        return "has not the channels of its scenario"
    contacts = {i.name for i in mechanism.instances if i.row.contact is not None}
    if {*run.contacts} != contacts:
        return "has not the contacts of its scenario"
    parts = {i.name: (i.section, i.element.key) for i in mechanism.instances if i.section}
    if {name: (part.section, part.type) for name, part in run.parts.items()} != parts:
        return "has not the elements of its scenario"
    wanted = {section.name for section in planned.sections}, {p.name for p in planned.portraits}
    if ({*run.poincare}, {*run.phase}) != wanted:
        return "has not the sections and portraits of its scenario"
    return ""


def _rows(run: Run) -> str:
    """What no run writes: times that do not rise, numbers that are none."""
    if np.any(np.diff(run.time) <= 0.0):
        return "has times that do not rise"
    for name in ("time", *run.names):
        if not np.all(np.isfinite(run.channel(name))):
            return f"has values of {name} that are no numbers"
    return ""
