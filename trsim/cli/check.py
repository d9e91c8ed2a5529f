"""trsim check: read and assemble scenarios, and say what they are, without running them."""

from math import pi
from typing import Any

import click

from trsim.cli.bars import bar_lines
from trsim.cli.frame import Answer, framed
from trsim.cli.modes import mode_lines
from trsim.errors import TrsimError


@click.command("check")
@click.argument("scenarios", nargs=-1, required=True, type=click.Path())
@click.option("--set", "sets", multiple=True, metavar="KEY=VALUE", help="Override a number.")
@click.option("--modes", is_flag=True, help="Eigenfrequencies, damping and shapes at the start.")
@framed
def command(
    answer: Answer, scenarios: tuple[str, ...], sets: tuple[str, ...], modes: bool = False
) -> None:
    """Check SCENARIO files: what they describe, and what a run of them will meet.

    Bodies, joints, mobility, redundancy and what to do about it, the start, stiffness and time
    scales, and what a run leaves out.
    """
    answer.data["scenarios"] = []
    for k, source in enumerate(scenarios):
        try:
            found = one(answer, source, sets, modes)
        except TrsimError as error:
            answer.fail(error, about=source)
            continue
        answer.data["scenarios"].append(found)
        if k:
            answer.put("")
        for text in lines(found):
            answer.put(text)


def one(answer: Answer, source: str, sets: tuple[str, ...], modes: bool = False) -> dict[str, Any]:
    """What a scenario is."""
    from trsim.api.check import checked

    return checked(answer, source, sets, modes)


# --- for a reader ----------------------------------------------------------------------------


def lines(found: dict[str, Any]) -> list[str]:
    """What was found, line by line for a reader."""

    def typed(key: str) -> str:
        return words(f"{name} ({kind})" for name, kind in found[key].items())

    plane = "planar" + (" (assumed)" if found["planar_assumed"] else "")
    space = ": ".join(["spatial", *filter(None, ["; ".join(found["spatial_because"])])])
    return [
        f"{found['file']}: {found['title']}" if found["title"] else found["file"],
        *frame_lines(found["frame"]),
        f"  bodies      {len(found['bodies'])}: {words(found['bodies'])}",
        *weight_lines(found["weights"]),
        f"  joints      {len(found['joints'])}: {typed('joints')}",
        f"  drives      {words(found['drives'])}",
        f"  forces      {typed('forces')}",
        *(f"  load set    {name} {told}" for name, told in found["load_sets"].items()),
        f"  contacts    {words(found['contacts'])}",
        *(f"  event       {name}: {told}" for name, told in found["events"].items()),
        *(f"  section     {name}: {told}" for name, told in found["sections"].items()),
        *(f"  pair        {name}: {told}" for name, told in found["pairs"].items()),
        *(f"  table       {name}: {told}" for name, told in found["tables"].items()),
        f"  motion      {plane if found['planar'] else space}",
        *mobility_lines(found),
        *start_lines(found["start"]),
        *scale_lines(found["scales"], found["mobility"]),
        *bar_lines(found),
        *(mode_lines(found["modes"]) if "modes" in found else ()),
        *(f"  skipped     {text}" for text in found["skipped"]),
        *(f"  note        {note}" for note in found["notes"]),
    ]


def words(names: Any) -> str:
    return ", ".join(names) or "-"


def frame_lines(frame: dict[str, Any] | None) -> list[str]:
    """In which frame the scenario is drawn, where that is not the world's."""
    if frame is None:
        return []
    x, y, z = (numbers([c + 0.0 for c in frame[key]]) for key in "xyz")  # no -0
    return [
        f"  frame       drawn in a frame at {numbers(frame['at'])} m, x {x}, y {y}, z {z}",
        "              gravity, channels and the places below are in world axes",
    ]


def weight_lines(found: list[dict[str, Any]]) -> list[str]:
    """What all bodies weigh together, and what of each was not given."""
    total = sum(one["mass"] for one in found)
    if not total:
        return []
    centre = [sum(one["mass"] * one["centre"][c] for one in found) / total for c in range(3)]
    return [
        f"  mass        {total:.6g} kg, centre at {numbers(centre)} m as drawn",
        *(
            f"              {one['body']}: {one['mass']:.6g} kg at {numbers(one['centre'])} m, "
            f"inertia {numbers(one['inertia'])} kg*m^2: {one['origin']}"
            for one in found
            if one["origin"] != "given"
        ),
    ]


def numbers(of: Any) -> str:
    """A list of numbers in brackets."""
    return f"[{', '.join(f'{x:.6g}' for x in of)}]"


def mobility_lines(found: dict[str, Any]) -> list[str]:
    """Mobility, dependent rows, reactions, what to let go."""
    rank, count = found["mobility"], found["mobility_by_count"]
    redundant, singular = found["redundant"], found["singular"]
    told = [
        f"  mobility    {rank} by rank, {count} by count: {found['unknowns']} unknowns, "
        f"{found['unknowns'] - count} constraint rows, drives included"
    ]
    if rank != count:
        told.append(
            f"              they differ because {len(redundant)} rows repeat what others say: "
            "counting takes every row for a freedom"
        )
    if found["drives"] and found["kinematic"]:
        told.append(
            "              driven in all freedoms: `method: kinematic` finds places, forces and "
            "torques row by row, without integrating"
        )
    if singular:
        told.append(
            f"              as drawn {rank + len(singular)}: a singular position, where "
            f"{words(singular)} depends on other rows"
        )
    told += [f"  redundant   {words(redundant)}", f"  singular    {words(singular)}"]
    told.append(f"  reactions   unique: {words(found['unique'])}")
    if found["not_unique"]:
        told.append(f"              not unique: {words(found['not_unique'])}")
    if found["release"]:
        told += release_lines(found["release"], rank)
    return told


def release_lines(release: dict[str, Any], rank: int) -> list[str]:
    """The proposal, and how far it is proven."""
    told = []
    for joint, becomes in release["joints"].items():
        rows = words(row for row in release["rows"] if row.split(".")[0] == joint)
        kind = release["types"].get(joint)
        how = f"`type: {kind}`" if kind else becomes
        told.append(f"release {rows}" + (f" ({joint}: {how})" if how else ""))
    result = f"leaves no redundant row, all reactions unique and mobility {rank}"
    other = release["alternatives"]
    choice = f"; {other} other choices are as good, the first in the file is shown" if other else ""
    return [
        f"  release     {'; '.join(told)}",
        f"              {result if release['proven'] else 'not proven: try it'}{choice}",
    ]


def start_lines(start: dict[str, Any]) -> list[str]:
    """Residuals, and what was projected."""
    p = start["projected"]
    of = {k: f" ({p[k]})" if p[k] else "" for k in ("position_row", "velocity_row")}
    moved = [f"{p['shift_body']} by {p['shift']:.2g} m"] if p["shift"] else []
    moved += [f"{p['turn_body']} by {p['turn']:.2g} rad"] if p["turn"] else []
    slipped = [f"{p['slip_body']} by {p['slip']:.2g} m/s"] if p["slip"] else []
    slipped += [f"{p['spin_body']} by {p['spin']:.2g} rad/s"] if p["spin"] else []
    if slipped or not p["velocity_before"]:
        velocities = (
            f"velocities off by {p['velocity_before']:.1e} as given{of['velocity_row']}, "
            f"{p['velocity_after']:.1e} at the start; given ones changed most: {words(slipped)}"
        )
    else:  # nobody gave any, and drives move
        velocities = f"velocities follow from the drives, off by {p['velocity_after']:.1e}"
    return [
        f"  start       positions open by {p['position_before']:.1e} as drawn{of['position_row']}, "
        f"{p['position_after']:.1e} at the start; moved most: {words(moved)}",
        f"              {velocities}",
        f"              equations of motion off by {start['force_residual']:.1e} N, "
        f"in touch: {words(start['closed_contacts'])}",
    ]


def scale_lines(scales: dict[str, Any], mobility: int) -> list[str]:
    """What is fast, and what that means for explicit steps."""
    told = []
    if not scales["eigenvalues"]:
        why = "mobility 0" if mobility == 0 else "no stiffness at the start"
        why = "too many nodes for them" if scales["fastest_is"].startswith("the mesh") else why
        told.append(f"no eigenvalues: {why}")
    else:
        fastest = [f"{scales['frequency'] / (2 * pi):.3g} Hz"] if scales["frequency"] else []
        fastest += [f"decays in {1 / scales['decay']:.1e} s"] if scales["decay"] else []
        fastest += [f"grows in {1 / scales['growth']:.1e} s"] if scales["growth"] else []
        told.append(f"fastest motion at the start: {words(fastest)}")
    told += map(contact_line, scales["contacts"])
    told.append(f"natural time {scales['natural_time']:.2g} s")
    told.append(step_line(scales))
    first, *rest = told
    return [f"  scales      {first}", *(f"              {text}" for text in rest)]


def contact_line(contact: dict[str, Any]) -> str:
    """One contact: how it vibrates, how it rebounds, how its friction grows."""
    if contact["half_period"] == float("inf"):
        return f"{contact['name']}: joints and drives fix it, it cannot vibrate"
    moves = "kg" if contact["unit"] == "N" else "kg*m^2"
    text = (
        f"{contact['name']}: half a period {contact['half_period']:.1e} s pressed by "
        f"{contact['force']:.2g} {contact['unit']} ({contact['mass']:.2g} {moves} move), "
        f"{contact['impact_time']:.1e} s at the slowest impact"
    )
    rate = contact["friction_rate"]
    return text + (f", friction settles in {1 / rate:.1e} s" if rate else "")


def step_line(scales: dict[str, Any]) -> str:
    """The bound of explicit steps."""
    step = scales["explicit_step"]
    if step == float("inf"):
        return "explicit steps: nothing here limits them but accuracy"
    number = f", {scales['end'] / step:.1e} steps to the end" if scales["end"] else ""
    return (
        f"explicit steps: rk4 is stable below {step:.1e} s{number}; the limit is "
        f"{scales['fastest_is']}, {scales['fastest']:.1e} 1/s; higher loads make it shorter"
    )
