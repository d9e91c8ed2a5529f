"""Where a run begins: at its start, or at the checkpoint an earlier one left."""

from pathlib import Path
from typing import Any

from trsim.cli.frame import Answer
from trsim.errors import FileError, UsageError

EVERY = 60.0  # s of wall time between two checkpoints


def interval(answer: Answer, source: str, scenario: Any, asked: float | None) -> float:
    """Seconds between two checkpoints, 0 for none; `asked` is what the command line says."""
    method = scenario.solver.method
    if not method.startswith("scipy:"):
        return EVERY if asked is None else asked
    if asked:
        answer.say(f"{source}: no checkpoints: {method} keeps a state of its own")
    return 0.0


def found(answer: Answer, source: str, target: Path, scenario: Any, wanted: bool) -> Any:
    """The checkpoint to go on from, None to start at the beginning; says which.

    Raises UsageError where it is that of another run, FileError where it cannot be read.
    """
    from trsim.store.checkpoint import ANEW, beside, differences, load

    path = beside(target)
    if not path.is_file():
        if wanted:
            answer.say(f"{source}: nothing to resume at {path}: starts from the beginning")
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
        answer.say(f"{source}: goes on at t = {kept.time:.6g} s, {kept.rows['/']} rows are kept")
        return kept
    else:
        answer.say(
            f"{source}: starts anew; --resume would go on at t = {kept.time:.6g} s of {path}"
        )
    return None
