"""A run on the command line: compiled for, watched, stopped by a signal, its errors placed."""

import shlex
import sys
from pathlib import Path
from typing import Any, NamedTuple

from trsim.cli.frame import Answer, Stop
from trsim.cli.resume import found, interval
from trsim.errors import TrsimError, some


class Wanted(NamedTuple):
    """How scenarios are to be run, as the command line says."""

    sets: tuple[str, ...]
    resume: bool
    checkpoint: float | None  # s of wall time between two
    certify: Any = False  # whether to compare with a twin, or the `Setting` of that
    twin: bool = False  # which repeats no warnings


def ran(
    answer: Answer, source: str, target: Path, scenario: Any, wanted: Wanted, closing: Any = None
) -> dict[str, Any]:
    """Simulate a scenario into a file; its summary."""
    from trsim.cli.progress import compiling, compiling_sparse, watched

    every = interval(answer, source, scenario, wanted.checkpoint)
    kept = found(answer, source, target, scenario, wanted.resume)
    compiling(answer, scenario.solver.method)
    from trsim.assemble.assemble import assemble
    from trsim.scenario.lint import lint
    from trsim.solve.simulate import simulate
    from trsim.store.hdf5 import Around, write

    try:
        mechanism = assemble(scenario)
        compiling_sparse(answer, scenario, mechanism)
        for note in () if wanted.twin else (*mechanism.notes, *lint(scenario)):
            answer.warn(source, note)
        if mechanism.spatial_because and not wanted.twin:
            told = some(mechanism.spatial_because, 1, ", and {} more (see `trsim check`)")
            answer.say(f"{source}: spatial motion: {told}")
        running = simulate(scenario, mechanism, kept.state if kept else None)
        blocks = watched(running, answer, source, scenario.solver.end)
        around = Around(shlex.join(["trsim", *sys.argv[1:]]), every, kept, closing)
        summary = write(target, scenario, mechanism, blocks, around)
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
