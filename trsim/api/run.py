"""`run`: one scenario simulated into a result file."""

import os
import weakref
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, TypedDict, Unpack

from trsim.api.hearing import Listener
from trsim.api.result import Result
from trsim.api.running import Wanted, ran
from trsim.api.source import Given, Sets, called, loaded, must_end, settings, stem
from trsim.api.stop import listening
from trsim.api.threads import one_thread
from trsim.errors import SolverError, UsageError
from trsim.statuses import ILL


class Options(TypedDict, total=False):
    """How a scenario is to be run.

    resume      go on where an interrupted or killed run was
    checkpoint  s of wall time between two checkpoints, 0 for none
    certify     whether to compare with a twin by another method; "radau:1e-10" says by which
    """

    resume: bool
    checkpoint: float | None
    certify: bool | str


class Work(NamedTuple):
    """A run to be made: of what, into which file, how."""

    given: Given
    target: Path
    wanted: Wanted


def run(
    scenario: Given, output: Any = None, set: Sets | None = None, *, raises: bool = True,
    **options: Unpack[Options],
) -> Result:  # fmt: skip
    """Simulate a scenario; its result.

    scenario  the name of a scenario file or of a result file, a dict, or what `load` gave
    output    the result file.  None: runs/NAME.h5 of a file; otherwise a file that is there as long
              as the result is
    set       what is changed: {"joints.pin.clearance": "0.3 mm"}
    raises    whether a run that fails is an error; the error has what was computed as `.result`
    options   see Options

    Raises ScenarioError, ModelError, SolverError, FileError, UsageError.
    """
    with ExitStack() as own:  # of a folder that is there as long as the result is
        if output is None and not isinstance(scenario, str | os.PathLike):
            output = Path(own.enter_context(TemporaryDirectory(prefix="trsim-"))) / "run.h5"
        target = Path(output) if output else Path("runs") / f"{stem(called(scenario))}.h5"
        hears = Listener()
        hears.command = told(scenario, output, set, options)
        hears.again = told(scenario, output, set, {**options, "resume": True})
        with listening(), one_thread():
            summary = made(hears, Work(scenario, target, wanted(settings(set), **options)))
        found = Result(summary["file"], summary)
        weakref.finalize(found, own.pop_all().close)
    for text in summary["warnings"]:
        hears.warn(called(scenario), text)
    if raises and summary["status"] in ILL:
        raise failed(called(scenario), summary, found)
    return found


def wanted(
    sets: tuple[str, ...], resume: bool = False, checkpoint: float | None = None,
    certify: bool | str = False, option: str = "certify",
) -> Wanted:  # fmt: skip
    """How a run is to be made, checked; option: what names the twin."""
    if checkpoint is not None and not 0.0 <= checkpoint < float("inf"):
        hint = "0 is for never, None for every 60 s."
        raise UsageError(f"`checkpoint` is no number of seconds: {checkpoint}", hint)
    if isinstance(certify, str):
        from trsim.api.given import chosen

        return Wanted(sets, resume, checkpoint, chosen(certify, "twin", option))
    return Wanted(sets, resume, checkpoint, bool(certify))


def made(hears: Listener, work: Work) -> dict[str, Any]:
    """Run a scenario into its file; the summary of the result."""
    from trsim.store.target import RESULT, replaceable

    given, target, wanted = work
    name = called(given)
    read = [given] if isinstance(given, str | os.PathLike) else []
    target = replaceable(target, RESULT, read)
    scenario = loaded(given, wanted.sets)
    must_end(scenario)
    closing, passes = None, None
    if scenario.sizing is not None:
        from trsim.api.sizing import found

        scenario, passes, closing = found(hears, name, target, scenario, wanted)
    if wanted.certify:
        from trsim.api.certify import twin

        closing = twin(hears, given, target, scenario, wanted)
    summary = ran(hears, name, target, scenario, wanted, closing)
    if passes is not None:
        summary["sizing"] = passes
    return summary


def failed(name: str, summary: dict[str, Any], result: Result | None = None) -> SolverError:
    """What is told of a run that came to no good end."""
    at = f"{name}: the solver failed at t = {summary['time']:.6g} s"
    kept = f"What was computed is in {summary['file']}."
    error = SolverError(f"{at}: {summary['reason']}", kept)
    error.result = result
    return error


def told(scenario: Given, output: Any, set: Sets | None, options: Any) -> str:
    """The call, as one would write it."""
    parts = [repr(scenario) if isinstance(scenario, str) else called(scenario)]
    parts += [repr(str(output))] if output else []
    parts += [f"set={set!r}"] if set else []
    parts += [f"{name}={value!r}" for name, value in options.items()]
    return f"trsim.run({', '.join(parts)})"
