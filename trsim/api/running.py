"""A run: compiled for, watched, stopped by a signal, its errors placed."""

from collections.abc import Generator
from pathlib import Path
from typing import Any, NamedTuple

from trsim.api.compiling import compiling, compiling_sparse
from trsim.api.hearing import Listener
from trsim.api.resume import found, interval
from trsim.api.stop import Stop
from trsim.errors import TrsimError, some
from trsim.solve.blocks import Blocks


class Wanted(NamedTuple):
    """How scenarios are to be run, as is asked."""

    sets: tuple[str, ...]
    resume: bool
    checkpoint: float | None  # s of wall time between two
    certify: Any = False  # whether to compare with a twin, or the `Setting` of that
    twin: bool = False  # which repeats no warnings


def ran(
    hears: Listener, source: str, target: Path, scenario: Any, wanted: Wanted, closing: Any = None
) -> dict[str, Any]:
    """Simulate a scenario into a file; its summary."""
    every = interval(hears, source, scenario, wanted.checkpoint)
    kept = found(hears, source, target, scenario, wanted.resume)
    compiling(hears, scenario.solver.method)
    from trsim.assemble.assemble import assemble
    from trsim.scenario.lint import lint
    from trsim.solve.simulate import simulate
    from trsim.store.hdf5 import Around, write

    try:
        mechanism = assemble(scenario)
        compiling_sparse(hears, scenario, mechanism)
        for note in () if wanted.twin else (*mechanism.notes, *lint(scenario)):
            hears.warn(source, note)
        if mechanism.spatial_because and not wanted.twin:
            told = some(mechanism.spatial_because, 1, ", and {} more (see `trsim check`)")
            hears.say(f"{source}: spatial motion: {told}")
        running = simulate(scenario, mechanism, kept.state if kept else None)
        blocks = watched(running, hears, source, scenario.solver.end)
        around = Around(hears.command, every, kept, closing, hears.again)
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


def watched(
    blocks: Generator[Any, None, Any], hears: Listener, name: str, end: float
) -> Generator[Any, None, Any]:
    """The blocks and the outcome of a run, with progress shown in passing.

    Also the place where a run stops when a signal asked for it.
    """
    show = hears.meter(name, end)
    try:
        run = Blocks(blocks)
        for block in run:
            Stop.patient = True
            percent = f"{100 * block.time / end:.0f} %, "
            show.update(block.time, summary(block), percent + summary(block))
            yield block
            if Stop.number:
                raise KeyboardInterrupt
        return run.outcome
    finally:
        show.close()


def summary(block: Any) -> str:
    """How far a run is."""
    return f"t = {block.time:.4g} s, step {block.step:.1e} s, {block.n_events} contact events"
