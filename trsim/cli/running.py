"""A run on the command line: compiled for, watched, stopped by a signal, its errors placed."""

import shlex
import sys
from pathlib import Path
from typing import Any

from trsim.cli.frame import Answer, Stop
from trsim.cli.resume import found, interval
from trsim.errors import TrsimError, some


def ran(
    answer: Answer, source: str, target: Path, scenario: Any, resume: bool,
    checkpoint: float | None, closing: Any = None, twin: bool = False,
) -> dict[str, Any]:  # fmt: skip
    """Simulate a scenario into a file; its summary.  A twin repeats no warnings."""
    from trsim.cli.progress import compiling, compiling_sparse, watched

    every = interval(answer, source, scenario, checkpoint)
    kept = found(answer, source, target, scenario, resume)
    compiling(answer, scenario.solver.method)
    from trsim.assemble.assemble import assemble
    from trsim.scenario.lint import lint
    from trsim.solve.simulate import simulate
    from trsim.store.hdf5 import write

    try:
        mechanism = assemble(scenario)
        compiling_sparse(answer, scenario, mechanism)
        for note in () if twin else (*mechanism.notes, *lint(scenario)):
            answer.warn(source, note)
        if mechanism.spatial_because and not twin:
            told = some(mechanism.spatial_because, 1, ", and {} more (see `trsim check`)")
            answer.say(f"{source}: spatial motion: {told}")
        running = simulate(scenario, mechanism, kept.state if kept else None)
        blocks = watched(running, answer, source, scenario.solver.end)
        called = shlex.join(["trsim", *sys.argv[1:]])
        summary = write(target, scenario, mechanism, blocks, called, every, kept, closing)
        summary["resumed_from"] = kept.time if kept else None
    except TrsimError as error:
        raise placed(error, scenario) from None
    finally:
        Stop.patient = False
    if Stop.number:
        raise KeyboardInterrupt
    return summary


def placed(error: TrsimError, scenario: Any) -> TrsimError:
    """The error with its place in the scenario's files, if it is about something in them."""
    from trsim.scenario.load import locate

    return locate(error, scenario) if any(one.path for one in error.problems) else error


def look() -> None:
    """End a measurement when a signal asked for it."""
    if Stop.number:
        raise KeyboardInterrupt
