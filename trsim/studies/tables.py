"""The claims as tables: claims.csv, and numbers.csv with every number and the file it is from."""

from collections.abc import Sequence
from pathlib import Path

from trsim.report.asked import table
from trsim.report.page import Cell, Ensembles, Line, Table
from trsim.store.target import headed
from trsim.studies.claim import BOOKKEEPING, GEOMETRY, INDEPENDENT, WORTH
from trsim.studies.drawing import Drawn
from trsim.studies.judge import Row, Source
from trsim.studies.rules import CONFIRMED

CLAIMS = ("claim", "section", "figure", "statement", "reading", "verdict", "worth", "rule",
          "numbers", "decided_by", "holds_in", "members", "assumptions", "runs")  # fmt: skip
HEAD = ("claim", "reading", "verdict", "numbers", "decided by", "holds in", "runs")


def write(rows: Sequence[Row], folder: Path) -> list[Path]:
    """Both tables as CSV; run files are named as seen from the folder of the study."""
    claims = [
        (
            *(row.claim.key, row.claim.section, row.claim.figure, row.claim.statement),
            *(row.reading.name, row.judged.verdict, row.worth, row.claim.rule.words),
            *("; ".join(row.numbers), row.judged.told, row.judged.holds, row.judged.of),
            *(assumptions(row), " ".join(row.files)),
        )
        for row in rows
    ]
    numbers = [source for row in rows for source in row.sources]
    tables = (("claims.csv", CLAIMS, claims), ("numbers.csv", Source._fields, numbers))
    return [table(folder / name, head, lines, headed(*head)) for name, head, lines in tables]


def assumptions(row: Row) -> str:
    return "; ".join(text for text in (row.claim.note, row.reading.note) if text)


# --- on the page -----------------------------------------------------------------------------


def shown(rows: Sequence[Row], figures: Sequence[Drawn]) -> Table:
    """The claims of one section; a line for each reading."""
    lines, last = [], ""
    for row in rows:
        claim, first = row.claim, row.claim.key != last
        last = claim.key
        marked = row.judged.verdict == CONFIRMED or row.worth in (GEOMETRY, BOOKKEEPING)
        worth = WORTH[row.worth] if marked else ""
        head = Cell(claim.statement, aside=claim.note) if first else Cell("")
        if first and (anchor := figure(claim.figure, figures)):
            note = f"{claim.note}. " if claim.note else ""
            head = Cell(claim.statement, anchor, aside=f"{note}Figure {claim.figure}")
        judged = row.judged
        cells: list[Cell | Ensembles] = [
            head,
            Cell(row.reading.name, aside=row.reading.note),
            Cell(judged.verdict, kind=judged.verdict, aside=worth),
            Ensembles(row.numbers, members(row)),
            Cell(judged.told, aside=claim.rule.words if claim.rule.words != judged.told else ""),
            Cell(f"{judged.holds} of {judged.of}" if judged.of else ""),
            Cell(cases(row)),
        ]
        lines.append(Line(cells, anchor=f"claim-{claim.key}" if first else "", first=first))
    return Table(HEAD, lines)


def members(row: Row) -> list[list[float]]:
    """The numbers of each case of a row."""
    found: dict[tuple[str, str, str], list[float]] = {}
    for source in row.sources:
        found.setdefault((source.label, source.case, source.word), []).append(source.value)
    return list(found.values())


def cases(row: Row) -> str:
    """The cases a row rests on, and how many runs of each; of those of a grid the grid."""
    count: dict[str, set[int]] = {}
    for source in row.sources:
        count.setdefault(source.case, set()).add(source.member)
    sizes = {len(members) for members in count.values()}
    each = f" ({max(sizes)} each)" if sizes and max(sizes) > 1 else ""
    return ", ".join(dict.fromkeys(case.partition(",")[0] for case in count)) + each


def figure(text: str, figures: Sequence[Drawn]) -> str:
    """The anchor of the figure that a claim names first: 9a is in figure 9."""
    digits = "".join(c for c in text.split(",")[0] if c.isdigit())
    return next((one.anchor for one in figures if one.number == digits), "")


def tally(rows: Sequence[Row]) -> Table:
    """How many readings have which verdict, those apart whose agreement proves nothing."""
    lines = []
    there = {row.worth for row in rows}
    for worth, text in (WORTH | {INDEPENDENT: "independent of our choices"}).items():
        if worth not in there:
            continue
        mine = [row.judged.verdict for row in rows if row.worth == worth]
        found = [str(mine.count(v)) for v in ("confirmed", "contradicted", "undetermined")]
        lines.append(Line([Cell(text), *map(Cell, found)]))
    return Table(("agreement", "confirmed", "contradicted", "undetermined"), lines)
