"""Tables: the peak load of every pin, drive and stop, with time and stroke."""

import textwrap
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from trsim import elements
from trsim.report import style
from trsim.report.asked import table
from trsim.report.display import Shown, short
from trsim.report.style import WIDTH, panels, titled
from trsim.store.target import headed

NOISE = 1e-9  # of the largest load of the same unit: rounding
EVENTS = ("run", "event", "did", "time", "work")  # columns
SECTIONS = ("joints", "drives", "forces")


class Load(NamedTuple):
    """The largest load of one element, in display units."""

    run: str
    element: str
    load: str
    value: float
    unit: str
    time: float  # s
    stroke: float
    stroke_unit: str


def draw(runs: list[Shown], folder: Path) -> list[Path]:
    """peaks.csv and peaks.png; events.csv where the scenario has events."""
    loads = [load for shown in runs for load in peak_loads(shown)]
    happened = user_events(runs, folder / "events.csv")
    if not loads:
        return happened
    written = table(folder / "peaks.csv", Load._fields, loads, headed(*Load._fields))
    return [written, style.draw(folder / "peaks.png", picture, runs, loads), *happened]


def user_events(runs: list[Shown], path: Path) -> list[Path]:
    """When the events of the scenario happened, and what they did (s, J); those that did not."""
    lines: list[list[Any]] = []
    for shown in runs:
        events = shown.run.events
        columns = (events.element, events.did, events.time, events.work)
        rows = zip(*(column.tolist() for column in columns), strict=False)
        user = [line for line, kind in zip(rows, events.kind, strict=False) if kind == "user"]
        lines += [[shown.label, *line] for line in user]
        lines += [
            [shown.label, name, "never", "", ""] for name, n in shown.run.fired.items() if not n
        ]
    if not lines:
        return []
    return [table(path, EVENTS, lines, headed(*EVENTS))]


def peak_loads(shown: Shown) -> list[Load]:
    """One line per joint, drive, stop and load: its largest magnitude."""
    best: dict[tuple[str, str], Any] = {}
    for peak in shown.run.peaks:
        element, _, channel = peak.channel.partition(".")
        kind = load_name(shown, element, channel, peak.extreme)
        if not kind or not np.isfinite(peak.value):
            continue
        key = (element, kind)
        if key not in best or abs(peak.value) > abs(best[key].value):
            best[key] = peak
    scenario = shown.run.scenario
    order = [name for s in SECTIONS for name in scenario.get(s) or {}] + list(shown.run.parts)
    largest: dict[str, float] = {}
    for peak in best.values():
        largest[peak.unit] = max(largest.get(peak.unit, 0.0), abs(peak.value))
    lines = []
    for (element, kind), peak in sorted(best.items(), key=lambda item: order.index(item[0][0])):
        factor, unit = shown.display(peak.unit)
        length, length_unit = stroke_unit(shown)
        if abs(peak.value) > NOISE * largest[peak.unit]:
            lines.append(Load(shown.label, element, kind, peak.value * factor, unit, peak.time,
                              peak.stroke * length, length_unit))  # fmt: skip
    return lines


def load_name(shown: Shown, element: str, channel: str, extreme: str) -> str:
    """What a channel is called in the table; nothing if it is no load."""
    part = shown.run.parts.get(element)
    if part is None or part.section not in SECTIONS:
        return ""
    if extreme == "magnitude":  # the rows a joint with clearance keeps carry no load in the plane
        loose = any(row.startswith(f"{element}.") for row in shown.run.text("mechanism/not_unique"))
        name = {"reaction": "reaction", "reaction_moment": "moment"}.get(channel, "")
        return f"{name} (not unique)" if name and loose else name
    if channel == "lock.force":
        return "lock"
    return elements.load(part.type).loads.get(channel, "")


def stroke_unit(shown: Shown) -> tuple[float, str]:
    if "stroke" not in shown.run.units:
        return 1.0, ""
    return shown.display(shown.run.unit("stroke"))


def picture(runs: list[Shown], loads: list[Load]) -> Any:
    """The table as a figure; of several runs, one column each."""
    second = runs[0].display("s")
    head, cells = columns(runs, loads, second) if len(runs) > 1 else lines(loads, second)
    width = max(WIDTH, 2.6 + 1.6 * len(runs))
    figure, axes = panels(1, height=0.22 * (len(cells) + 1) + 0.4, width=width, table=True)
    a = axes[0, 0]
    a.axis("off")
    a.set_title("of the motion, between steps and rows too", fontsize=8)
    widths = [max(longest(row[k]) for row in [head, *cells]) + 3 for k in range(len(head))]
    drawn = a.table(cells, colLabels=head, loc="center", cellLoc="left", edges="horizontal",
                    colWidths=[w / sum(widths) for w in widths])  # fmt: skip
    drawn.auto_set_font_size(False)
    drawn.set_fontsize(8)
    high = 1 + max(name.count("\n") for name in head)
    for (row, _), cell in drawn.get_celld().items():
        cell.set_linewidth(0.9 if row == 0 else 0.3)
        cell.set_height((high if row == 0 else 1.0) / (len(cells) + high))
        if row == 0:
            cell.set_text_props(ha="left", weight="bold")
    titled(figure, runs, "Peak loads")
    return figure


def lines(loads: list[Load], second: tuple[float, str]) -> tuple[list[str], list[list[str]]]:
    """Head and cells of one run."""
    stroke = next((load.stroke_unit for load in loads if np.isfinite(load.stroke)), "")
    head, cells = ["pin", "load", "peak", f"time ({second[1]})"], []
    for load in loads:
        cells.append([load.element, load.load, number(load), f"{load.time * second[0]:.4f}"])
        if stroke:
            cells[-1].append(short(load.stroke))
    return head + ([f"stroke ({stroke})"] if stroke else []), cells


def columns(
    runs: list[Shown], loads: list[Load], second: tuple[float, str]
) -> tuple[list[str], list[list[str]]]:
    """Head and cells of several runs: value and time of each."""
    of = {(load.run, load.element, load.load): load for load in loads}
    head = ["pin", "load", *(textwrap.fill(shown.label, 26) for shown in runs)]
    cells = []
    elements = list(dict.fromkeys(load.element for load in loads))
    pairs = dict.fromkeys((load.element, load.load) for load in loads)
    for element, kind in sorted(pairs, key=lambda pair: elements.index(pair[0])):
        found = [of.get((shown.label, element, kind)) for shown in runs]
        told = [
            f"{number(load)} at {load.time * second[0]:.4f} {second[1]}" if load else "\u2013"
            for load in found
        ]
        cells.append([element, kind, *told])
    return head, cells


def number(load: Load) -> str:
    return f"{short(load.value, 5)} {load.unit}"


def longest(text: str) -> int:
    return max(map(len, text.split("\n")))
