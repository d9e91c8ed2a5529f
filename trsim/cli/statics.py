"""trsim statics: the static equilibrium of a scenario, and whether it is stable."""

from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from trsim.api.source import loaded, stem
from trsim.cli.frame import NAMED, Answer, framed
from trsim.cli.modes import shape
from trsim.errors import TrsimError

SECTIONS = ("bodies", "joints", "drives", "forces", "sensors", "points")
MOVES = ("/s", "/s^2", "J", "W")  # units of what is zero at rest, or no part of the balance
NOISE = 1e-11  # of the largest value of the same unit


@click.command("statics")
@click.argument("scenario", type=click.Path())
@click.option("-o", "--output", type=NAMED, help="Result file.  [default: runs/NAME.statics.h5]")
@click.option("--set", "sets", multiple=True, metavar="KEY=VALUE", help="Override a number.")
@framed
def command(answer: Answer, scenario: str, output: str | None, sets: tuple[str, ...]) -> None:
    """Find where SCENARIO rests: places, reactions and loads, and whether it stays there.

    Drives stand where they are at t = 0, loads are those of t = 0, and nothing moves.  The search
    begins as drawn, or at values of joints under `initial`.  The result file has one row, which
    `show`, `export` and `report` read.
    """
    from trsim.store.target import RESULT, replaceable

    target = Path(output) if output else Path("runs") / f"{stem(scenario)}.statics.h5"
    file = replaceable(target, RESULT, [scenario])
    found = one(answer, scenario, file, loaded(scenario, sets))
    answer.data |= found
    for text in lines(found):
        answer.put(text)
    answer.put(found["result"])


def one(answer: Answer, source: str, target: Path, scenario: Any) -> dict[str, Any]:
    """The equilibrium of a scenario, also written into a result file."""
    from trsim.api.compiling import compiling
    from trsim.api.running import placed

    compiling(answer)
    from trsim.scenario.lint import lint
    from trsim.solve.rest import at_rest, blocks
    from trsim.store.hdf5 import write

    try:
        with answer.doing(source) as doing:
            doing("looking for the equilibrium")
            resting = at_rest(scenario)
        summary = write(target, resting.scenario, resting.mechanism, blocks(resting))
    except TrsimError as error:
        raise placed(error, scenario) from None
    mechanism, found = resting.mechanism, resting.found
    warnings = [*mechanism.notes, *lint(scenario), *falls(asdict(found))]
    for text in warnings:
        answer.warn(source, text)
    values = {
        c.name: {"unit": c.unit, "value": resting.channels[c.start : c.start + c.size].tolist()}
        for c in mechanism.columns
        if c.wanted
    }
    kinds = {i.name: (i.section, i.element.key) for i in mechanism.instances if i.section}
    return {
        "file": source,
        "title": scenario.title,
        "result": summary["file"],
        "mobility": mechanism.mobility,
        "redundant": list(mechanism.redundant),
        "not_unique": list(mechanism.not_unique),
        "equilibrium": asdict(found),
        "elements": {name: kind for name, (_, kind) in kinds.items()},
        "sections": {name: section for name, (section, _) in kinds.items()},
        "channels": values,
        "turns": [{"body": n, "rotation": turn} for n, turn in resting.turns.items()],
        "content_sha256": summary["content_sha256"],
        "warnings": warnings,
    }


def falls(found: dict[str, Any]) -> Iterator[str]:
    """What is said of a balance that is not stable."""
    if found["verdict"] == "unstable":
        way = shape(found["direction"])
        yield f"in balance but not stable: at the smallest push it falls: {way}"
    if found["verdict"] == "indifferent":
        yield (
            f"the balance is indifferent: nothing holds {shape(found['direction'])} where it is; a "
            "spring or a stop would"
        )


# --- for a reader ----------------------------------------------------------------------------


def lines(found: dict[str, Any]) -> Iterator[str]:
    """Stability, and a table of what is where and carries how much."""
    yield f"{found['file']}: {found['title']}" if found["title"] else found["file"]
    yield from stability(found["equilibrium"])
    if found["not_unique"]:
        yield (
            f"  not unique  {', '.join(found['not_unique'])}: of all reactions that balance the "
            "loads those of least norm are told"
        )
    for section in SECTIONS:
        names = [name for name, of in found["sections"].items() if of == section]
        told = [row for name in names for row in rows(name, found)]
        if told:
            yield f"  {section}"
            width = max(len(name) for name, _ in told)
            yield from (f"    {name:<{width}}  {value}" for name, value in told)


def stability(found: dict[str, Any]) -> Iterator[str]:
    """Whether it is stable, and how nearly."""
    left = f"{found['residual']:.1e} N or N*m left of the balance"
    if found["freedoms"] == 0:
        yield f"  stable      nothing can move: joints and drives hold all; {left}"
        return
    many = f"{found['freedoms']} freedom{'s' if found['freedoms'] > 1 else ''}"
    frequency = found["frequency"]
    slow = f", {frequency:.6g} Hz without damping" if frequency is not None else ""
    least = f"lowest eigenvalue {found['eigenvalue']:.6g} 1/s^2{slow}"
    yield f"  {found['verdict']:<11} {many}, {least}; {left}"
    yield f"              {'falls' if found['verdict'] == 'unstable' else 'softest'}: " + shape(
        found["direction"]
    )


def rows(name: str, found: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The channels of an element that tell something at rest; of a body how it has turned."""
    for channel, at in found["channels"].items():
        unit, values = at["unit"], at["value"]
        own = channel == name or channel.startswith(f"{name}.")
        if own and not unit.endswith(MOVES) and len(values) in (1, 3):
            yield channel, f"{' '.join(rounded(values, unit, found))} {unit}"
    for turn in found["turns"]:
        if turn["body"] == name:
            yield f"{name} turned by", f"{' '.join(rounded(turn['rotation'], 'rad', found))} rad"


def rounded(values: list[float], unit: str, found: dict[str, Any]) -> Iterator[str]:
    """Values for a reader: what is rounding beside others of the same unit is zero."""
    alike = [x for at in found["channels"].values() if at["unit"] == unit for x in at["value"]]
    alike += [x for turn in found["turns"] for x in turn["rotation"] if unit == "rad"]
    largest = max(map(abs, [*alike, 1e-300]))
    return (f"{x if abs(x) > NOISE * largest else 0.0:.6g}" for x in values)
