"""A published study: its figures, and a verdict on each of its claims, on one page."""

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path

from trsim.errors import FileError, UsageError, some
from trsim.report.page import Block, Markup, Picture, Points, Section, Text
from trsim.report.page import write as write_page
from trsim.studies import tables
from trsim.studies.claim import Claim
from trsim.studies.drawing import UNITS, Drawn
from trsim.studies.judge import Law, Reference, Row, judged
from trsim.studies.numbers import Number
from trsim.studies.rules import CONFIRMED, CONTRADICTED
from trsim.studies.runs import BOOK, Runs


@dataclass(frozen=True)
class Moving:
    """The case that is animated, and how large play in its joints is drawn."""

    case: str
    magnified: float = 1.0


def no_law(word: str) -> Number:
    raise KeyError(word)


@dataclass(frozen=True)
class Study:
    """What a page is made of, besides the runs of the study."""

    title: str
    lead: Sequence[str]
    verdicts: Sequence[str]  # how they are found
    assumptions: Sequence[str]
    contradictions: Sequence[str]
    sections: Mapping[str, str]  # of the study: number -> title on the page
    claims: Sequence[Claim]
    figures: Sequence[Drawn]
    moving: Moving
    grids: Sequence[str] = ()  # cases whose runs are no ensemble
    references: Mapping[str, str] = field(default_factory=dict)  # of `apart`, where not the first
    book: float = BOOK  # J, what an energy book may miss
    reference: str = ""  # case from which `apart` measures all others
    law: Law = no_law
    write: Callable[[Runs, Path], list[Path]] = lambda runs, folder: []  # tables of its own
    more: Callable[[Runs], list[Section]] = lambda runs: []  # and sections

    @property
    def cases(self) -> set[str]:
        """All that claims and figures speak of."""
        series = (s for c in self.claims for reading in c.readings for s in reading.series)
        return {s.case for s in series} | {case for one in self.figures for case in one.names}

    def origin(self, case: str) -> str:
        """The case from which `apart` of another one is measured."""
        return self.references.get(case, self.reference)


def paper(
    study: Study, sweep: str | os.PathLike, folder: str | os.PathLike,
    figures: Sequence[Drawn] | None = None,
) -> list[Path]:  # fmt: skip
    """Write the figures, the tables as CSV and index.html of a study into a folder.

    sweep: the folder that `trsim sweep` made of the cases of the study.  What is missing there is
    missing in the figures, and undetermined among the claims.  figures: all unless given.  Returns
    the files written.  Raises FileError, UsageError.
    """
    from trsim.report.display import written
    from trsim.report.style import draw

    runs, folder = Runs(Path(sweep), study.grids, study.book), Path(folder)
    if not study.cases & {*runs.planned}:
        hint = f"It has {some(sorted(runs.planned), 3, ' and {} more')}."
        raise UsageError(f"{sweep} has no case of this study", hint)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder}: {error.strerror or error}") from None
    figures = study.figures if figures is None else figures
    reference: Reference = study.origin
    rows = list(judged(runs, study.claims, lambda si: UNITS.get(si, (1.0, written(si))),
                       study.law, reference))  # fmt: skip
    drawn = [(one, draw(folder / f"{one.anchor}.png", one.made, runs))
             for one in figures if runs.has(*one.names)]  # fmt: skip
    absent = [one for one in figures if not runs.has(*one.names)]
    files = [*tables.write(rows, folder), *study.write(runs, folder)]
    page = write_page(folder / "index.html", study.title, study.lead,
                      sections(study, runs, rows, (drawn, absent)))  # fmt: skip
    return [page, *files, *(path for _, path in drawn)]


def sections(
    study: Study, runs: Runs, rows: Sequence[Row],
    figures: tuple[Sequence[tuple[Drawn, Path]], Sequence[Drawn]],
) -> list[Section]:  # fmt: skip
    """The page, section by section of the study.

    figures: those that are drawn, with their files, and those for which runs are missing.
    """
    drawn, absent = figures
    summary: list[Block] = [Points(study.verdicts), tables.tally(rows), Text(extent(runs))]
    if any(row.judged.of > 1 for row in rows):
        summary.insert(2, Text(strict(rows)))
    if runs.aside:
        summary.append(Text(aside(runs)))
    if absent:
        names = ", ".join(one.number for one in absent)
        summary.append(Text(f"Not drawn, as runs are missing: figures {names}."))
    found = [Section("verdicts", "Verdicts", summary)]
    there = [one for one, _ in drawn]
    for title, group in groupby(rows, key=lambda row: study.sections[row.claim.section]):
        found.append(Section(anchor(title), title, [tables.shown(list(group), there)]))
    pictures = [
        Picture(one.anchor, path, f"Figure {one.number}. {one.caption}", links(one, rows))
        for one, path in drawn
    ]
    return [
        *found,
        *study.more(runs),
        Section("figures", "Figures", pictures),
        *moving(study.moving, runs),
        Section("assumptions", "What is assumed", [Points(study.assumptions)]),
        Section("contradictions", "Where the study contradicts itself or mechanics",
                [Points(study.contradictions)]),
    ]  # fmt: skip


def moving(shown: Moving, runs: Runs) -> list[Section]:
    """The mechanism in motion, where its bodies were recorded."""
    if not (runs.has(shown.case) and "door.position" in runs.stated(shown.case).run.units):
        return []
    from trsim.report.animation import section

    member = runs.stated(shown.case)
    play = f", its play drawn {shown.magnified:g} times" if shown.magnified != 1.0 else ""
    told = Text(f"{runs.named(member)}{play}; drag to turn.")
    return [Section("animation", "Animation", [told, Markup(section(member.run, shown.magnified))])]


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
        f"{1e3 * runs.book:g} mJ, a fault of the run and no property of the mechanism."
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
