"""Where a run begins: at its start, or at the checkpoint an earlier one left."""

import math
from pathlib import Path
from typing import Any

import click

from trsim.cli.frame import Answer
from trsim.errors import FileError, UsageError
from trsim.scenario.methods import METHODS

EVERY = 60.0  # s of wall time between two checkpoints


class Seconds(click.FloatRange):
    """A span of time: NaN compares with nothing, so a range lets it pass."""

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        found = super().convert(value, param, ctx)
        if not math.isfinite(found):
            self.fail(f"{value} is not a number of seconds; 0 is for never.", param, ctx)
        return found


def interval(answer: Answer, source: str, scenario: Any, asked: float | None) -> float:
    """Seconds between two checkpoints, 0 for none; `asked` is what the command line says."""
    method = scenario.solver.method
    if METHODS[method].marches:
        return EVERY if asked is None else asked
    if asked:
        answer.say(f"{source}: no checkpoints: {method} keeps a state of its own")
    return 0.0


def found(answer: Answer, source: str, target: Path, scenario: Any, wanted: bool) -> Any:
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
