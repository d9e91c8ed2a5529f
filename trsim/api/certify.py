"""`certify`: the twin of a run, by another method at a tighter tolerance, and its comparison."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from trsim.api.compiling import compiling
from trsim.api.given import NO_MOTION
from trsim.api.hearing import Listener
from trsim.api.running import Wanted, placed, ran
from trsim.api.source import Given, called, loaded
from trsim.api.stop import Stop, look
from trsim.errors import FileError, TrsimError, UsageError
from trsim.scenario.methods import METHODS

BRIEF = ("windows", "contacts")  # tables
Closing = Callable[[Any], dict[str, Any]]


def beside(target: Path) -> Path:
    """The file of the twin, while it is there."""
    return target.with_name(f"{target.name.removesuffix('.h5')}.twin.h5")


def twin(hears: Listener, source: Given, target: Path, scenario: Any, wanted: Wanted) -> Closing:
    """Have the twin's file; what is to be done with it at the end of the run."""
    from trsim.store.checkpoint import beside as kept
    from trsim.store.checkpoint import keys

    if METHODS[scenario.solver.method].rests:
        raise UsageError(NO_MOTION, "Compare it with a slow motion: `trsim run` without `method`.")
    path, name = beside(target), called(source)
    other = other_scenario(hears, source, scenario, wanted)
    known = json.dumps(keys(other), sort_keys=True)
    if wanted.resume and was_for(path) == known:
        hears.say(f"{name}: the twin is there already: {path}")
    else:
        if path.exists() and was_for(path) is None:
            what = f"{path} exists and is no twin of a run that can be read"
            raise UsageError(what, "Remove it, or name another file with -o.")
        solver = other.solver
        hears.say(f"{name}: first its twin, by {solver.method} at {solver.tolerance:g}")

        def mark(file: Any) -> dict[str, Any]:
            file["provenance"].attrs["keys"] = known
            return {}

        goes_on = wanted.resume and kept(path).is_file()
        ran(hears, f"twin of {name}", path, other, wanted._replace(resume=goes_on, twin=True),
            mark)  # fmt: skip
    return lambda file: compared(hears, file, path)


def other_scenario(hears: Listener, source: Given, scenario: Any, wanted: Wanted) -> Any:
    """The scenario of the twin, whose setting is given or to be found."""
    compiling(hears, scenario.solver.method)
    from trsim.analyse.twin import overrides, twin_setting
    from trsim.assemble.assemble import assemble

    Stop.patient = True
    try:
        setting = wanted.certify
        if setting is True:
            setting = twin_setting(scenario, assemble(scenario), look)
    except TrsimError as error:
        raise placed(error, scenario) from None
    finally:
        Stop.patient = False
    return loaded(source, (*wanted.sets, *overrides(scenario, setting)))


def was_for(path: Path) -> str | None:
    """What a file is the twin of, as far as it has an influence; None if it is none."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            found: str | None = file["provenance"].attrs.get("keys")
            return found
    except (OSError, KeyError):
        return None


def compared(hears: Listener, file: Any, path: Path) -> dict[str, Any]:
    """Add the certificate to the file of a run, and remove the twin.

    The run is worth keeping also where the twin cannot be read.
    """
    import h5py

    from trsim.analyse.certificate import certificate
    from trsim.store.certificate import store

    try:
        with h5py.File(path, "r") as other:
            found = certificate(file, other)
            cpu = float(other["provenance"].attrs.get("integration_cpu", 0.0))
    except OSError as error:
        hears.lost(FileError(f"{path}: the twin cannot be read: {error}"))
        return {}
    store(file, found)
    file["provenance"].attrs["twin_integration_cpu"] = cpu
    path.unlink(missing_ok=True)
    return {"certificate": brief(found)}


def brief(found: Any) -> dict[str, Any]:
    """A certificate in a few numbers."""
    verdicts = [level.verdict for level in found.levels]
    return {
        **found.about,
        **{word: verdicts.count(word) for word in ("agree", "differ", "unknown")},
        **{name: [row._asdict() for row in getattr(found, name)] for name in BRIEF},
    }
