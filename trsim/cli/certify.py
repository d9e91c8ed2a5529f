"""`trsim run --certify`: the twin of a run, and what is told of the two."""

import json
from collections.abc import Callable
from math import isnan
from pathlib import Path
from typing import Any

from trsim.cli.frame import Answer, Stop
from trsim.cli.given import NO_MOTION
from trsim.cli.running import Wanted, look, placed, ran
from trsim.cli.source import loaded
from trsim.errors import FileError, TrsimError, UsageError, some
from trsim.scenario.methods import METHODS

BRIEF, REST = ("windows", "contacts"), ("curves", "quantities", "levels", "onsets")  # tables
SHOWN = 3  # windows in a message
COLUMNS, CELL = ("largest", "smallest", "final", "mean", "rms"), 23  # of the table; width
Closing = Callable[[Any], dict[str, Any]]


def beside(target: Path) -> Path:
    """The file of the twin, while it is there."""
    return target.with_name(f"{target.name.removesuffix('.h5')}.twin.h5")


def twin(answer: Answer, source: str, target: Path, scenario: Any, wanted: Wanted) -> Closing:
    """Have the twin's file; what is to be done with it at the end of the run."""
    from trsim.store.checkpoint import beside as kept
    from trsim.store.checkpoint import keys

    if METHODS[scenario.solver.method].rests:
        raise UsageError(NO_MOTION, "Compare it with a slow motion: `trsim run` without `method`.")
    path = beside(target)
    other = other_scenario(answer, source, scenario, wanted)
    known = json.dumps(keys(other), sort_keys=True)
    if wanted.resume and was_for(path) == known:
        answer.say(f"{source}: the twin is there already: {path}")
    else:
        if path.exists() and was_for(path) is None:
            what = f"{path} exists and is no twin of a run that can be read"
            raise UsageError(what, "Remove it, or name another file with -o.")
        solver = other.solver
        answer.say(f"{source}: first its twin, by {solver.method} at {solver.tolerance:g}")

        def mark(file: Any) -> dict[str, Any]:
            file["provenance"].attrs["keys"] = known
            return {}

        goes_on = wanted.resume and kept(path).is_file()
        ran(answer, f"twin of {source}", path, other, wanted._replace(resume=goes_on, twin=True),
            mark)  # fmt: skip
    return lambda file: compared(answer, file, path)


def other_scenario(answer: Answer, source: str, scenario: Any, wanted: Wanted) -> Any:
    """The scenario of the twin, whose setting is given or to be found."""
    from trsim.cli.progress import compiling

    compiling(answer, scenario.solver.method)
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


def compared(answer: Answer, file: Any, path: Path) -> dict[str, Any]:
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
        answer.fail(FileError(f"{path}: the twin cannot be read: {error}"))
        return {}
    store(file, found)
    file["provenance"].attrs["twin_integration_cpu"] = cpu
    path.unlink(missing_ok=True)
    return {"certificate": brief(found)}


# --- what is told ----------------------------------------------------------------------------


def brief(found: Any) -> dict[str, Any]:
    """A certificate in a few numbers."""
    verdicts = [level.verdict for level in found.levels]
    return {
        **found.about,
        **{word: verdicts.count(word) for word in ("agree", "differ", "unknown")},
        **{name: [row._asdict() for row in getattr(found, name)] for name in BRIEF},
    }


def full(found: Any) -> dict[str, Any]:
    """All of it."""
    return {**brief(found), **{n: [row._asdict() for row in getattr(found, n)] for n in REST}}


def print_certificate(answer: Answer, target: Path, data: dict[str, Any]) -> None:
    """Say it in a few lines."""
    first, *rest = lines(data)
    answer.say(f"{target}: {first}")
    for text in rest:
        answer.say(f"  {text}")


def lines(data: dict[str, Any]) -> list[str]:
    """A certificate for a reader."""
    out = [f"compared with {data['method']} at {data['tolerance']:g}, {data['steps']} steps"]
    if data["status"] != "done":
        out.append(f"the twin {data['status']} at t = {data['time']:.6g} s: {data['reason']}")
    if not data["motion"]:
        out.append("no channel of positions or velocities is recorded: nothing tells if they part")
        return out
    within = f"within {data['difference']:.1e} of its range ({data['difference_channel']})"
    if not data["windows"]:
        out.append(f"together until t = {data['compared_until']:.6g} s: motion agrees {within}")
    else:
        out += parted(data, within)
    if data["quantity"]:
        what = "largest difference of a summary quantity"
        out.append(f"{what} {data['quantity_difference']:.1e} of the range ({data['quantity']})")
    for contact in data["contacts"]:
        text = f"{contact['contact']}: {contact['impacts']} impacts, twin {contact['twin']}"
        early = f"; {contact['before']} and {contact['twin_before']} before they part"
        out.append(text + (early if data["windows"] else ""))
    return out


def parted(data: dict[str, Any], within: str) -> list[str]:
    """The lines of two runs that became two motions."""
    times = [
        f"{one['begin']:.6g} .. {data['compared_until'] if isnan(one['end']) else one['end']:.6g} s"
        for one in data["windows"]
    ]
    judged = data["agree"] + data["differ"]
    return [
        f"predictable until t = {data['apart']:.6g} s: there {data['apart_channel']} differs by "
        "more than 1 % of its range",
        f"apart at {some(times, SHOWN)}; otherwise motion agrees {within}",
        f"while apart {data['agree']} of {judged} means, RMS and shares of contact agree within "
        f"95 % intervals; {data['unknown']} have no interval",
    ]


def table(found: Any) -> list[str]:
    """The summary quantities of all components that are not zero."""
    by: dict[str, dict[str, Any]] = {}
    for row in found.quantities:
        by.setdefault(row.channel, {})[row.quantity] = row
    by = {n: rows for n, rows in by.items() if any(r.value or r.twin for r in rows.values())}
    width = max(map(len, by), default=0)
    out = [f"{'':<{width}}  {'unit':<9}" + "".join(f"{name:>{CELL}}" for name in COLUMNS)]
    for name, rows in by.items():
        cells = "".join(f"{cell(rows[quantity]):>{CELL}}" for quantity in COLUMNS)
        out.append(f"{name:<{width}}  {rows['largest'].unit:<9}{cells}")
    if not all(row.certain for row in found.quantities):
        out.append("~ of a time in which the two are apart: one value of many")
    return out


def cell(row: Any) -> str:
    """A value, and what its twin has less."""
    return f"{'' if row.certain else '~'}{row.value + 0.0:.6g} ({row.difference + 0.0:+.0e})"
