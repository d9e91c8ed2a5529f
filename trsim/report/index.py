"""index.html of a report: summary, animation, peaks and all figures in one file to be sent."""

import csv
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from trsim.errors import TrsimError
from trsim.report import page
from trsim.report.asked import Found
from trsim.report.display import Shown, short
from trsim.report.page import Block, Cell, Line, Markup, Picture, Points, Section, Table, Text
from trsim.report.tables import Load

NAME = "index.html"
GROUPS = {  # beginning of the name of a figure -> where it stands
    "motion": "Sensors",
    "drive": "Drives",
    "force": "Forces",
    "contact": "Contacts",
    "orbit": "Contacts",
    "impact": "Contacts",
    "body": "Bodies",
    "bar": "Flexible bars",
    "shapes": "Flexible bars",
    "phase": "Phase planes",
    "poincare": "Sections",
    "energy": "Energy",
}
ANIMATED = 3  # runs: more would make the file too large to be sent


def write(
    folder: Path,
    runs: list[Shown],
    loads: Sequence[Load],
    figures: Sequence[Path],
    shots: Mapping[Path, bytes],
) -> Path:
    """The page.  shots: pictures of figures that a browser does not show by themselves, as PNG."""
    first = runs[0].run
    title = first.attributes["title"] or first.path.stem
    sections = [Section("summary", "Summary", [*summary(runs)])]
    sections += animations(runs)
    if loads:
        text = "Largest values of the motion, between steps and rows too."
        sections.append(Section("peaks", "Peak loads", [Text(text), peaks(runs, loads)]))
    sections += pictures(figures, shots)
    names = ", ".join(shown.label or shown.run.path.name for shown in runs)
    lead = [f"Runs: {names}."] if len(runs) > 1 else []
    return page.write(folder / NAME, title, lead, sections)


def of_sweep(folder: Path, title: str, found: Found, shots: Mapping[Path, bytes]) -> Path:
    """The page of a sweep: its cases with their numbers, the figures, and what was told."""
    sections = []
    for path in (path for path in found.files if path.suffix == ".csv"):
        with path.open(newline="", encoding="utf-8") as file:
            head, *rows = csv.reader(file)
        lines = [Line([Cell(number(text)) for text in row]) for row in rows]
        sections.append(Section("cases", "Cases", [Table(head, lines)]))
    drawn = [
        Picture(path.stem, path, caption(path), data=shots.get(path))
        for path in found.files
        if path.suffix != ".csv"
    ]
    sections.append(Section("figures", "Figures", drawn))
    if found.lines:
        sections.append(Section("told", "Notes", [Points(found.lines)]))
    return page.write(folder / NAME, title, [], sections)


def caption(path: Path) -> str:
    return path.stem.removeprefix("sweep_").replace("_", " ").capitalize()


def number(text: str) -> str:
    """A cell of a table for a reader."""
    try:
        return short(float(text)) if text else ""
    except ValueError:
        return text


def summary(runs: list[Shown]) -> Iterator[Block]:
    """What each run is, how it ended, how exact it is, and what was said of it."""
    every = [told(shown) for shown in runs]
    keys = list(dict.fromkeys(key for one in every for key in one))
    lines = [Line([Cell(key), *(Cell(one.get(key, "\u2013")) for one in every)]) for key in keys]
    yield Table(("", *(shown.label or shown.run.path.name for shown in runs)), lines)
    said = [
        f"{shown.label}: {text}" if shown.label else text
        for shown in runs
        for text in shown.run.warnings
    ]
    if said:
        yield Text("Warnings:")
        yield Points(said)


def told(shown: Shown) -> dict[str, str]:
    """A run in words."""
    run = shown.run
    a, solver, found = run.attributes, run.group("solver"), {}
    found["file"] = run.path.name
    found["status"] = a["status"] + (f": {a['reason']}" if a["reason"] else "")
    found["time simulated"] = f"{short(run.reached)} s" if run.rows else "none"
    found["output rows"] = str(run.rows)
    if "steps" in solver:
        found["solver"] = f"{solver['method']}, tolerance {solver['tolerance']:g}"
        found["steps"] = str(solver["steps"])
    if "energy_residual_relative" in solver:
        found["energy book open by"] = f"{solver['energy_residual_relative']:.1e} of the energy"
    if "position_residual" in solver:
        found["joints open by at most"] = f"{solver['position_residual']:.1e} (m or rad)"
    contacts = run.summary["contacts"]
    if contacts:
        found["touches"] = ", ".join(f"{n}: {c['impacts']}" for n, c in contacts.items())
    if run.fired:
        found["events"] = ", ".join(f"{n}: {times}" for n, times in run.fired.items())
    if "content_sha256" in a:
        found["content"] = str(a["content_sha256"])[:16]
    return found


def peaks(runs: list[Shown], loads: Sequence[Load]) -> Table:
    """The table of peaks."""
    several = len(runs) > 1
    factor, second = runs[0].display("s")
    head = [*(["run"] if several else []), "element", "load", "peak", f"time ({second})"]
    lines = []
    for load in loads:
        value = f"{short(load.value, 5)} {load.unit}"
        cells = [load.element, load.load, value, f"{load.time * factor:.4f}"]
        lines.append(Line([Cell(text) for text in [*([load.run] if several else []), *cells]]))
    return Table(head, lines)


def animations(runs: list[Shown]) -> list[Section]:
    """The motion of each run; why there is none where it cannot be drawn."""
    from trsim.report.animation import section

    blocks: list[Block] = []
    for shown in runs[:ANIMATED]:
        if shown.label:
            blocks.append(Text(shown.label))
        try:
            blocks.append(Markup(section(shown.run)))
        except TrsimError as error:  # also a scenario of an older trsim
            blocks.append(Text(f"No animation: {error.problems[0].what}."))
    if len(runs) > ANIMATED:
        more = "`trsim report RUN --animate` makes those of the others."
        blocks.append(Text(f"The first {ANIMATED} runs alone are animated; {more}"))
    return [Section("animation", "Animation", blocks)]


def pictures(figures: Sequence[Path], shots: Mapping[Path, bytes]) -> Iterator[Section]:
    """The figures by what they show, in their order."""
    found: dict[str, list[Any]] = {}
    for path in figures:
        kind, _, of = path.stem.partition("_")
        if kind in GROUPS:
            caption = f"{kind} {of}".replace("_", " ").strip().capitalize()
            one = Picture(path.stem, path, caption, data=shots.get(path))
            found.setdefault(GROUPS[kind], []).append(one)
    order = list(dict.fromkeys(GROUPS.values()))
    for title in sorted(found, key=order.index):
        yield Section(f"of_{title.lower().replace(' ', '_')}", title, found[title])
