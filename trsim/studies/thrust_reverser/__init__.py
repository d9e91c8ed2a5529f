"""The published study of the thrust reverser: its figures, and a verdict on each of its claims."""

import os
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path

from trsim.errors import FileError
from trsim.report.page import Block, Markup, Picture, Points, Section, Text
from trsim.report.page import write as write_page
from trsim.studies.thrust_reverser import content, peaks, tables
from trsim.studies.thrust_reverser.claims import CLAIMS
from trsim.studies.thrust_reverser.figures import FIGURES
from trsim.studies.thrust_reverser.figures.drawing import UNITS, Drawn
from trsim.studies.thrust_reverser.judge import Row, judged
from trsim.studies.thrust_reverser.rules import CONFIRMED, CONTRADICTED
from trsim.studies.thrust_reverser.runs import BOOK, Runs

SECTIONS = {
    "3.1": "Section 3: contact and friction laws",
    "3.2": "Section 3: contact and friction laws",
    "6.2": "Section 6.2: verification",
    "7.1.1": "Section 7.1.1: value of the clearance",
    "7.1.2": "Section 7.1.2: place of the clearance",
    "7.1.3": "Section 7.1.3: driving speed",
    "7.1.4": "Section 7.1.4: flexible rod",
    "7.2": "Section 7.2: five doors and three actuators",
    "8": "Section 8: conclusions beyond section 7",
}

MOVING, MAGNIFIED = "ab_03", 30.0  # the case of the animation, and how large its play is drawn


def paper(
    study: str | os.PathLike, folder: str | os.PathLike, figures: Sequence[Drawn] | None = None
) -> list[Path]:
    """Write the figures, the tables as CSV and index.html of a study into a folder.

    study: what `trsim sweep scenarios/thrust_reverser/paper.yaml` made.  What is missing there is
    missing in the figures, and undetermined among the claims.  figures: all unless given.  Returns
    the files written.  Raises FileError, UsageError.
    """
    from trsim.report.display import written
    from trsim.report.style import draw

    runs, folder = Runs(Path(study)), Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder}: {error.strerror or error}") from None
    figures = FIGURES if figures is None else figures
    rows = list(judged(runs, CLAIMS, lambda si: UNITS.get(si, (1.0, written(si)))))
    drawn = [(one, draw(folder / f"{one.anchor}.png", one.made, runs))
             for one in figures if runs.has(*one.names)]  # fmt: skip
    absent = [one for one in figures if not runs.has(*one.names)]
    files = [*tables.write(rows, folder), *peaks.write(runs, folder)]
    page = write_page(folder / "index.html", content.TITLE, content.LEAD,
                      sections(runs, rows, drawn, absent))  # fmt: skip
    return [page, *files, *(path for _, path in drawn)]


def sections(
    runs: Runs, rows: Sequence[Row], drawn: Sequence[tuple[Drawn, Path]], absent: Sequence[Drawn]
) -> list[Section]:
    """The page, section by section of the study."""
    figures = [one for one, _ in drawn]
    summary: list[Block] = [
        Points(content.VERDICTS),
        tables.tally(rows),
        Text(strict(rows)),
        Text(extent(runs)),
    ]
    if runs.aside:
        summary.append(Text(aside(runs)))
    if absent:
        names = ", ".join(one.number for one in absent)
        summary.append(Text(f"Not drawn, as runs are missing: figures {names}."))
    found = [Section("verdicts", "Verdicts", summary)]
    for title, group in groupby(rows, key=lambda row: SECTIONS[row.claim.section]):
        found.append(Section(anchor(title), title, [tables.shown(list(group), figures)]))
    pictures = [
        Picture(one.anchor, path, f"Figure {one.number}. {one.caption}", links(one, rows))
        for one, path in drawn
    ]
    return [
        *found,
        *peaks.sections(runs),
        Section("figures", "Figures", pictures),
        *moving(runs),
        Section("assumptions", "What is assumed", [Points(content.ASSUMPTIONS)]),
        Section("contradictions", "Where the study contradicts itself or mechanics",
                [Points(content.CONTRADICTIONS)]),
    ]  # fmt: skip


def moving(runs: Runs) -> list[Section]:
    """The mechanism in motion, where its bodies were recorded."""
    if not (runs.has(MOVING) and "door.position" in runs.stated(MOVING).run.units):
        return []
    from trsim.report.animation import section

    member = runs.stated(MOVING)
    told = Text(f"{runs.named(member)}, its play drawn {MAGNIFIED:g} times; drag to turn.")
    return [Section("animation", "Animation", [told, Markup(section(member.run, MAGNIFIED))])]


def anchor(title: str) -> str:
    return "section-" + title.split(":")[0].removeprefix("Section ").replace(".", "-")


def links(one: Drawn, rows: Sequence[Row]) -> list[tuple[str, str]]:
    """The claims that a figure shows."""
    keys = dict.fromkeys(
        row.claim.key for row in rows if tables.figure(row.claim.figure, (one,)) == one.anchor
    )
    return [(key.replace("_", " "), f"claim-{key}") for key in keys]


def extent(runs: Runs) -> str:
    """How much was run, and what of it is missing."""
    done = sum(map(len, runs.members.values()))
    missing = [f"{case} ({n} of {runs.planned[case]})" for case, n in runs.missing.items()]
    text = (
        f"{done} runs of {len(runs.planned)} cases. Every number, with its run file, channel and "
        "window, is in numbers.csv; the tables below are in claims.csv."
    )
    return text + (f" Missing: {', '.join(missing)}." if missing else "")


def aside(runs: Runs) -> str:
    """The runs that count in no verdict."""
    found = [f"{runs.named(m)} (misses {1e3 * m.missed:.3g} mJ)" for m in runs.aside]
    return (
        f"Set aside, in no verdict: {', '.join(found)}. Their energy books miss more than "
        f"{1e3 * BOOK:g} mJ, a fault of the run and no property of the mechanism."
    )


def strict(rows: Sequence[Row]) -> str:
    """What a stricter rule would change; the rule was settled when first runs had been seen."""
    ordered = [row.judged for row in rows if row.judged.of > 1]
    yes = sum(j.verdict == CONFIRMED and j.holds < j.of for j in ordered)
    no = sum(j.verdict == CONTRADICTED and j.holds > 0 for j in ordered)
    return (
        "Intervals, and differences of 1 %, were taken to decide after first runs had been seen. "
        f"If a claim had to hold, or fail, in every member as well, {yes} of the confirmed and "
        f"{no} of the contradicted readings would be undetermined."
    )
