"""trsim check: read and assemble scenarios, and say what they are, without running them."""

from typing import Any

import click

from trsim.cli.frame import Answer, framed
from trsim.cli.source import loaded
from trsim.errors import TrsimError


@click.command("check")
@click.argument("scenarios", nargs=-1, required=True, type=click.Path())
@click.option("--set", "sets", multiple=True, metavar="KEY=VALUE", help="Override a number.")
@framed
def command(answer: Answer, scenarios: tuple[str, ...], sets: tuple[str, ...]) -> None:
    """Check SCENARIO files: bodies, joints, mobility, redundancy, start."""
    answer.data["scenarios"] = []
    for k, source in enumerate(scenarios):
        try:
            found = one(answer, source, sets)
        except TrsimError as error:
            answer.fail(error)
            continue
        answer.data["scenarios"].append(found)
        if k:
            answer.put("")
        for text in lines(found):
            answer.put(text)


def one(answer: Answer, source: str, sets: tuple[str, ...]) -> dict[str, Any]:
    """What a scenario is once assembled, and where it would start."""
    from trsim.cli.progress import compiling
    from trsim.cli.run import placed

    scenario = loaded(source, sets)
    compiling(answer, "equations.derivative")
    from trsim.assemble.assemble import assemble

    try:
        mechanism = assemble(scenario)
        return {
            "file": source,
            "title": scenario.title,
            **described(scenario, mechanism),
            "start": started(scenario, mechanism),
        }
    except TrsimError as error:
        raise placed(error, scenario) from None


def described(scenario: Any, mechanism: Any) -> dict[str, Any]:
    """Bodies, joints and what the assembly found out about them."""
    from trsim.spec.lint import lint

    model = mechanism.model
    return {
        "bodies": list(scenario.bodies),
        "joints": {name: spec.type for name, spec in scenario.joints.items()},
        "drives": list(scenario.drives),
        "forces": {name: spec.type for name, spec in scenario.forces.items()},
        "contacts": [mechanism.instances[e].name for e in model.contact],
        "planar": mechanism.planar,
        "planar_assumed": mechanism.planar_assumed,
        "unknowns": int(model.n_v),
        "constraints": int(model.m),
        "mobility": int(mechanism.mobility),
        "redundant": list(mechanism.redundant),
        "singular": list(mechanism.singular),
        "not_unique": list(mechanism.not_unique),
        "notes": [*mechanism.notes, *lint(scenario)],
    }


def started(scenario: Any, mechanism: Any) -> dict[str, Any]:
    """The start of a run; its own errors are those of the scenario."""
    from trsim.solve.start import start

    if scenario.solver.end is None:  # a scale of time is needed, not how long it would run
        solver = scenario.solver.model_copy(update={"end": 1.0})
        scenario = scenario.model_copy(update={"solver": solver})
    begun = start(scenario, mechanism, located=True)
    return {
        "position_residual": begun.moved,
        "force_residual": begun.residual,
        "length": begun.length,
        "speed": begun.speed,
        "closed_contacts": [
            mechanism.instances[e].name for e in mechanism.model.contact if begun.mem[e, 0] > 0.0
        ],
    }


def lines(found: dict[str, Any]) -> list[str]:
    """The same for a reader."""

    def words(names: Any) -> str:
        return ", ".join(names) or "-"

    def typed(key: str) -> str:
        return words(f"{name} ({kind})" for name, kind in found[key].items())

    plane = "planar" + (" (assumed)" if found["planar_assumed"] else "")
    start = found["start"]
    return [
        f"{found['file']}: {found['title']}" if found["title"] else found["file"],
        f"  bodies      {len(found['bodies'])}: {words(found['bodies'])}",
        f"  joints      {len(found['joints'])}: {typed('joints')}",
        f"  drives      {words(found['drives'])}",
        f"  forces      {typed('forces')}",
        f"  contacts    {words(found['contacts'])}",
        f"  motion      {plane if found['planar'] else 'spatial'}",
        f"  mobility    {found['mobility']}: {found['unknowns']} unknowns, "
        f"{found['constraints']} constraint rows, drives included",
        f"  redundant   {words(found['redundant'])}",
        f"  singular    {words(found['singular'])}",
        f"  reactions   {'all unique' if not found['not_unique'] else 'not unique: '}"
        f"{', '.join(found['not_unique'])}",
        f"  start       joints closed from {start['position_residual']:.1e} m, "
        f"{start['force_residual']:.1e} N out of balance, "
        f"in touch: {words(start['closed_contacts'])}",
        *(f"  note        {note}" for note in found["notes"]),
    ]
