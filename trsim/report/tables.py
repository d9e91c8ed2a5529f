"""Tables: the peak load of every pin, drive and stop, with time and stroke."""

import csv
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from trsim.report.display import Shown
from trsim.report.style import WIDTH, panels, save, titled

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
    """peaks.csv and peaks.png."""
    loads = [load for shown in runs for load in peak_loads(shown)]
    if not loads:
        return []
    return [write(loads, folder / "peaks.csv"), save(picture(runs, loads), folder / "peaks.png")]


def peak_loads(shown: Shown) -> list[Load]:
    """One line per joint, drive, stop and load: its largest magnitude."""
    best: dict[tuple[str, str], Any] = {}
    for peak in shown.run.peaks:
        element, _, channel = peak.channel.partition(".")
        kind = load_name(shown, element, channel, peak.extreme)
        if not kind:
            continue
        key = (element, kind)
        if key not in best or abs(peak.value) > abs(best[key].value):
            best[key] = peak
    order = list(shown.run.parts)
    lines = []
    for (element, kind), peak in sorted(best.items(), key=lambda item: order.index(item[0][0])):
        factor, unit = shown.display(peak.unit)
        length, length_unit = stroke_unit(shown)
        if abs(peak.value) > 0.0:
            lines.append(Load(shown.label, element, kind, peak.value * factor, unit, peak.time,
                              peak.stroke * length, length_unit))  # fmt: skip
    return lines


def load_name(shown: Shown, element: str, channel: str, extreme: str) -> str:
    """What a channel is called in the table; nothing if it is no load."""
    part = shown.run.parts.get(element)
    if part is None or part.section not in SECTIONS:
        return ""
    if extreme == "magnitude":  # the rows a joint with clearance keeps carry no load in the plane
        return {"reaction": "reaction", "reaction_moment": "moment"}.get(channel, "")
    names = {"contact_force": "contact force", "torque": "torque", "magnitude": "load"}
    if part.section == "drives" or part.type == "spring_damper":
        names["force"] = "force"
    if part.type == "limit_stop":
        names["normal_force"] = "contact force"
    return names.get(channel, "")


def stroke_unit(shown: Shown) -> tuple[float, str]:
    if "stroke" not in shown.run.units:
        return 1.0, ""
    return shown.display(shown.run.unit("stroke"))


def write(loads: list[Load], path: Path) -> Path:
    """The table as CSV, numbers in full."""
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(Load._fields)
        for load in loads:
            table.writerow([repr(v) if isinstance(v, float) else v for v in load])
    return path


def picture(runs: list[Shown], loads: list[Load]) -> Any:
    """The table as a figure."""
    several = len(runs) > 1
    head = ["pin", "load", "peak", "time (s)"]
    head = (["run", *head] if several else head) + stroke_head(loads)
    cells = []
    for load in loads:
        line = [load.element, load.load, f"{load.value:.5g} {load.unit}", f"{load.time:.4f}"]
        line = [load.run, *line] if several else line
        cells.append(line + ([f"{load.stroke:.4g}"] if stroke_head(loads) else []))
    figure, axes = panels(1, height=0.22 * (len(cells) + 1) + 0.25, width=WIDTH)
    a = axes[0, 0]
    a.axis("off")
    widths = [max(len(row[k]) for row in [head, *cells]) + 3 for k in range(len(head))]
    table = a.table(cells, colLabels=head, loc="center", cellLoc="left", edges="horizontal",
                    colWidths=[w / sum(widths) for w in widths])  # fmt: skip
    table.auto_set_font_size(False)
    table.set_fontsize(8)
    for (row, _), cell in table.get_celld().items():
        cell.set_linewidth(0.9 if row == 0 else 0.3)
        cell.set_height(1.0 / (len(cells) + 1))
        if row == 0:
            cell.set_text_props(weight="bold")
    titled(figure, runs, "Peak loads")
    return figure


def stroke_head(loads: list[Load]) -> list[str]:
    """The column of strokes, where there is a sensor of that name."""
    known = [load for load in loads if np.isfinite(load.stroke)]
    return [f"stroke ({known[0].stroke_unit})"] if known else []
