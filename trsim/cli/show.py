"""trsim show: what is in a result file."""

from math import isnan
from typing import Any

import click

from trsim.cli.frame import Answer, framed
from trsim.cli.redundancy import redundancy
from trsim.errors import FileError, UsageError

TOLD = ("format", "format_version", "title", "status", "reason", "content_sha256")


@click.command("show")
@click.argument("run", type=click.Path())
@click.argument("words", nargs=-1)
@click.option("--unit", "units", multiple=True, metavar="UNIT", help="Of the numbers: kN, rpm.")
@click.option("--verify", is_flag=True, help="Read all of it, and compare the content hash.")
@framed
def command(
    answer: Answer, run: str, words: tuple[str, ...], units: tuple[str, ...], verify: bool
) -> None:
    """Print what is in the result file RUN, or the numbers that WORDS ask for.

    A word is KIND:OF, such as peak:B.contact_force or mean:stroke.rate@0.3..0.9 (s); the kinds are
    those of `report --table`.  Each number is a line: with its SI unit behind it, or alone in the
    unit of --unit, which may be given once for each kind of quantity.

    With --verify the content hash is computed anew and compared; exit code 7 if it differs.
    """
    from trsim.store.read import read

    found = read(run)
    if verify:
        check_same(found)
    sections = found.poincare
    answer.data |= {
        "file": str(found.path),
        **{name: found.attributes[name] for name in TOLD if name in found.attributes},
        "verified": verify or None,
        "rows": found.rows,
        "channels": {name: found.units[name] for name in found.names},
        "summary": found.summary,
        "solver": found.group("solver"),
        "warnings": list(found.warnings),
        "mobility": found.group("mechanism")["mobility"],
        "redundant": list(found.text("mechanism/redundant")),
        "not_unique": list(found.text("mechanism/not_unique")),
        "provenance": found.group("provenance"),
        "phase": list(found.phase),
        "poincare": {name: len(points.x) for name, points in sections.items()},
        "dispersion": {name: points.dispersion._asdict() for name, points in sections.items()},
        "fired": found.fired,
    }
    certified = found.certificate
    if certified is not None:
        from trsim.cli.certify import full

        answer.data["certificate"] = full(certified)
    if units and not words:
        raise UsageError("--unit goes with a number", "For example `show FILE peak:B.force`.")
    if words:
        return numbers(answer, found, words, units)
    for text in lines(found, answer.data):
        answer.put(text)
    if certified is not None:
        from trsim.cli.certify import table

        answer.put("  certificate: value (value less that of the twin)")
        for text in table(certified):
            answer.put(f"    {text}")


def numbers(answer: Answer, run: Any, words: tuple[str, ...], units: tuple[str, ...]) -> None:
    """Print the numbers of some words, in full."""
    from trsim.analyse.outputs import in_units, pressed, scalar

    in_si = [scalar(run, word) for word in words]
    found = [in_units(word, number, units) for word, number in zip(words, in_si, strict=True)]
    answer.data["values"] = [
        {"run": str(run.path), "what": word, "value": value, "half": float("nan"), "unit": unit}
        for word, (value, unit) in zip(words, found, strict=True)
    ]
    for word, (value, unit), (_, si) in zip(words, found, in_si, strict=True):
        if isnan(value):
            answer.warn(str(run.path), f"{word}: it has nothing to make it of")
        if value == 0.0 and (other := pressed(run, word)):
            answer.warn(str(run.path), other)
        text = repr(int(value)) if value.is_integer() and unit == "-" else repr(value)
        # of a conversion the last digit is its rounding: 59.99999999999999 deg
        text = text if unit == si else f"{value:.15g}"
        answer.put(text if units or unit == "-" else f"{text} {unit}")


def check_same(run: Any) -> None:
    """Check that a file holds what its content hash says; raises FileError."""
    from trsim.store.read import verify

    path = str(run.path)
    if "content_sha256" not in run.attributes:
        what = f"{path} has no content hash to compare with: its run was not completed"
        raise FileError(what, file=path)
    if not verify(path):
        what = f"{path} does not hold what was written: its content hash differs"
        raise FileError(
            what, "It was changed or damaged since.  Run the scenario again.", file=path
        )


def lines(run: Any, data: dict[str, Any]) -> list[str]:
    """What a file holds, line by line for a reader."""
    a = run.attributes
    out = [f"{run.path}: {a['title']}" if a["title"] else str(run.path)]
    out.append(f"  status    {a['status']}" + (f": {a['reason']}" if a["reason"] else ""))
    out.append(f"  rows      {run.rows} of {len(run.names)} channels")
    if run.rows:
        time = run.time
        out[-1] += f", t = {time[0]:g} .. {time[-1]:g} s"
    checked = " (verified)" if data["verified"] else ""
    out.append(f"  content   {a.get('content_sha256', '- (not complete)')}{checked}")
    solver = data["solver"]
    if "steps" in solver:
        out.append(
            f"  solver    {solver['method']}, tolerance {solver['tolerance']:g}, "
            f"{solver['steps']} steps, energy book closed to "
            f"{solver['energy_residual_relative']:.1e}"
        )
    for name, contact in data["summary"]["contacts"].items():
        unit = run.contact_unit(name, "contact_force", "normal_force")
        out.append(
            f"  contact   {name}: {contact['impacts']} touches, peak {contact['peak_force']:.5g} "
            f"{unit} at {contact['peak_time']:.5g} s"
        )
    out += user_events(run, data["fired"])
    if "certificate" in data:
        from trsim.cli.certify import lines as of_certificate

        first, *rest = of_certificate(data["certificate"])
        out += [f"  accuracy  {first}", *(f"            {text}" for text in rest)]
    if data["redundant"]:
        out.append(f"  redundant {redundancy(data)}{opening(data)}")
    out += [f"  warning   {text}" for text in data["warnings"]]
    out.append(f"  phase     {', '.join(data['phase']) or '-'}")
    sections = [section(name, points) for name, points in run.poincare.items()]
    out += [f"  poincare  {text}" for text in sections or ["-"]]
    out.append("  channels")
    width = max((len(name) for name in run.names), default=0)
    out += [f"    {name:<{width}}  {run.units[name]}{mark(name, data)}" for name in run.names]
    return out


def opening(data: dict[str, Any]) -> str:
    """How far the rows left out as redundant were open; nothing for files that do not know."""
    worst = data["solver"].get("redundant_open_relative")
    return "" if worst is None else f"; open by at most {worst:.1e} of the mechanism's size or rad"


def section(name: str, points: Any) -> str:
    """A Poincare section in one line."""
    from trsim.store.points import surface

    told = points.dispersion
    text = f"{name}: {surface(points.definition)}, {told.points} points"
    if not isnan(told.radius):
        return f"{text}, dispersion {told.radius:.3g} {points.x_unit}"
    if isnan(told.x):
        return text
    return f"{text}, dispersion {told.x:.3g} {points.x_unit}, {told.y:.3g} {points.y_unit}"


SHOWN = 20  # lines of user events


def user_events(run: Any, fired: dict[str, int]) -> list[str]:
    """What the scenario's events did, one line for each time, and those that did not happen."""
    events = run.events
    told = [
        f"  event     {name}: {did} at {time:.9g} s" + (f", work {work:.5g} J" if work else "")
        for name, kind, did, time, work in zip(
            events.element, events.kind, events.did, events.time, events.work, strict=False
        )
        if kind == "user"
    ]
    more = [f"            and {len(told) - SHOWN} more"] if len(told) > SHOWN else []
    never = [f"  event     {name}: never" for name, times in fired.items() if not times]
    return [*told[:SHOWN], *more, *never]


def mark(channel: str, data: dict[str, Any]) -> str:
    """What is not to be taken at its word in a reaction."""
    joint, _, what = channel.partition(".")
    rows = [row for row in data["not_unique"] if row.split(".")[0] == joint]
    return f"  not unique: {', '.join(rows)}" if rows and what.startswith("reaction") else ""
