"""Tables of the spatial mechanism: the study's nine peaks beside ours, and when it sticks."""

from pathlib import Path

from trsim.report.asked import table
from trsim.report.page import Block, Cell, Line, Section, Table, Text
from trsim.store.target import headed
from trsim.studies.numbers import number
from trsim.studies.runs import Runs
from trsim.studies.thrust_reverser import content
from trsim.studies.thrust_reverser.claims.spatial import ODD
from trsim.studies.thrust_reverser.figures import sticking
from trsim.studies.thrust_reverser.figures.spatial import ACTUATORS, case

# N: the largest forces of actuators 1, 2, 3 where 1, 2, 3 is the asynchronous one, section 7.2
PUBLISHED = {1: (2258.0, 1370.0, 2017.0), 2: (2782.0, 2310.0, 2712.0), 3: (2068.0, 1348.0, 2227.0)}
HEAD = ("asynchronous", "actuator", "study [N]", "here [N]", "difference [N]", "difference [%]",
        "at [mm/s]")  # fmt: skip
ENDS = ("slower by [mm/s]", "shaft [N*m/rad]", "end [s]", "stroke [mm]", "status", "reason")

Rows = list[tuple[object, ...]]


def peaks(runs: Runs) -> Rows:
    """The nine peaks; none where a run is missing."""
    if not all(runs.has(case(odd, speed)) for odd in PUBLISHED for speed in ODD):
        return []
    rows: Rows = []
    for odd, study in PUBLISHED.items():
        for k, theirs in zip(ACTUATORS, study, strict=True):
            word = f"largest:actuator_{k}.force"
            ours, speed = max((number(runs.stated(case(odd, v)), word).value, v) for v in ODD)
            off = ours - theirs
            rows.append((odd, k, theirs, ours, off, 100.0 * off / theirs, speed))
    return rows


def ends(runs: Runs) -> Rows:
    """How every run of the grid ended; none where one is missing."""
    if not runs.has(*sticking.CASES):
        return []
    rows: Rows = []
    for speed in sticking.SPEEDS:
        for k in sticking.STIFFNESSES:
            run = runs.stated(sticking.case(speed, k)).run
            stroke = 1e3 * float(run.channel("stroke")[-1])
            told = str(run.attributes["reason"]).partition(":")[0]
            rows.append((420 - speed, float(k), float(run.summary["time"]), stroke,
                         str(run.attributes["status"]), told))  # fmt: skip
    return rows


def write(runs: Runs, folder: Path) -> list[Path]:
    """peaks.csv and sticking.csv, where their runs are."""
    found = (("peaks.csv", HEAD, peaks(runs)), ("sticking.csv", ENDS, ends(runs)))
    return [table(folder / name, head, rows, headed(*head)) for name, head, rows in found if rows]


def sections(runs: Runs) -> list[Section]:
    """Both as sections of the page."""
    found = []
    if rows := peaks(runs):
        lines = [Line([Cell(text) for text in peak(row)], first=row[1] == 1) for row in rows]
        blocks: list[Block] = [Text(content.PEAKS), Table(HEAD, lines)]
        found.append(Section("peaks", "Nine peaks of the actuators", blocks))
    if rows := ends(runs):
        head = ("2 slower by", *(f"{k} N\u00b7m/rad" for k in sticking.STIFFNESSES))
        wide = len(sticking.STIFFNESSES)
        lines = [Line([Cell(f"{rows[k][0]} mm/s"), *(end(row) for row in rows[k : k + wide])])
                 for k in range(0, len(rows), wide)]  # fmt: skip
        found.append(Section("sticking", "When it sticks", [Text(content.STICKING),
                                                            Table(head, lines)]))  # fmt: skip
    return found


def peak(row: tuple[object, ...]) -> list[str]:
    """A peak for the reader."""
    odd, k, theirs, ours, off, share, speed = row
    signed = (f"{off:+.0f}".replace("-", "\u2212"), f"{share:+.1f}".replace("-", "\u2212"))
    return [f"{odd}", f"{k}", f"{theirs:.0f}", f"{ours:.0f}", *signed, f"{speed}"]


def end(row: tuple[object, ...]) -> Cell:
    """How a run of the grid ended."""
    _, _, time, stroke, status, _ = row
    return Cell(f"{time:.3f} s, {stroke:.0f} mm" if status == "jammed" else "full stroke")
