"""Where a run begins: at its start, or at the checkpoint an earlier one left."""

from pathlib import Path
from typing import Any

from trsim.api.hearing import Listener
from trsim.errors import FileError, UsageError
from trsim.scenario.methods import METHODS

EVERY = 60.0  # s of wall time between two checkpoints


def interval(hears: Listener, source: str, scenario: Any, asked: float | None) -> float:
    """Seconds between two checkpoints, 0 for none; `asked` is what was asked for."""
    method = scenario.solver.method
    if METHODS[method].marches:
        return EVERY if asked is None else asked
    if asked:
        hears.say(f"{source}: no checkpoints: {method} keeps a state of its own")
    return 0.0


def found(hears: Listener, source: str, target: Path, scenario: Any, wanted: bool) -> Any:
    """The checkpoint to go on from, None to start at the beginning; says which.

    Raises UsageError where it is that of another run, FileError where it cannot be read, or where
    another process writes this result.
    """
    from trsim.store.checkpoint import ANEW, beside, differences, load, waiting
    from trsim.store.lock import refuse_if_written

    refuse_if_written(target)
    path = beside(target)
    if not waiting(target):
        if wanted:
            hears.say(f"{source}: nothing to resume at {path}: starts from the beginning")
        return None
    try:
        kept = load(path)
    except FileError:
        if wanted:
            raise
        return None
    if differing := differences(kept, scenario):
        if wanted:
            raise UsageError(f"{path} is of another run: {differing}", ANEW)
    elif wanted:
        hears.say(f"{source}: goes on at t = {kept.time:.6g} s, {kept.rows['/']} rows are kept")
        return kept
    else:
        hears.say(f"{source}: starts anew; --resume would go on at t = {kept.time:.6g} s of {path}")
    return None
