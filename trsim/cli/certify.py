"""What is told of a run and its twin."""

from math import isnan
from pathlib import Path
from typing import Any

from trsim.api.certify import brief
from trsim.cli.frame import Answer
from trsim.errors import some

REST = ("curves", "quantities", "levels", "onsets")  # tables
SHOWN = 3  # windows in a message
COLUMNS, CELL = ("largest", "smallest", "final", "mean", "rms"), 23  # of the table; width


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
        text = f"{contact['contact']}: {contact['impacts']} touches, twin {contact['twin']}"
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
