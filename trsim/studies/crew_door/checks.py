"""How every case ended, what holds in each, and the critical envelopes over all of them."""

import math
from functools import lru_cache
from pathlib import Path

import numpy as np

from trsim.analyse.envelope import envelope
from trsim.report.asked import table
from trsim.report.page import Cell, Line, Section, Table, Text
from trsim.store.target import headed
from trsim.studies.crew_door import content
from trsim.studies.numbers import number
from trsim.studies.runs import Member, Runs
from trsim.sweeps.study import study

ENDED = ("case", "status", "time [s]", "energy residual [1]", "wire least [N]", "reason")
TIGHT = (  # (case, the same a hundred times tighter, numbers that are compared)
    ("lift_inner", "lift_inner_tight", ("handle.force", "fwd_guide.normal_force",
                                        "fwd_stop1.normal_force")),
    ("lift_inner_op", "lift_inner_op_tight", ("handle.force", "fwd_guide.normal_force",
                                              "fwd_stop1.normal_force")),
    ("open", "open_tight", ("cb_rod_force", "hinge.locating_load", "hinge.floating_load")),
    ("jettison", "jettison_tight", ("opening.rate", "opening.acceleration", "hinge.locating_load",
                                    "hinge.floating_load")),
)  # fmt: skip
CHANGE = ("case", "number", "tolerance 1e-6", "1e-8", "change [%]")
WANTED = ("handle.force", "P2P6", "P7P10", "cb_rod_force", "wire.force", "hinge.locating_load",
          "hinge.floating_load", "latch_section.bending", "*_stop1.normal_force",
          "*_guide.normal_force")  # fmt: skip
CRITICAL = ("quantity", "extreme", "value", "unit", "case", "time [s]", "latch [deg]",
            "hinge [deg]")  # fmt: skip

Rows = list[tuple[object, ...]]


@lru_cache(maxsize=1)  # the tables and the page both ask
def ends(runs: Runs) -> Rows:
    """How every run ended, and what its books say."""
    return [ended(member) for members in runs.members.values() for member in members]


def ended(member: Member) -> tuple[object, ...]:
    run = member.run
    residual = float(run.group("solver").get("energy_residual_relative", math.nan))
    wire = float(np.min(member.channel("wire.force"))) if "wire.force" in run.units else math.nan
    name = member.case if member.index == 0 else member.file.stem
    found = (name, str(run.attributes["status"]), float(run.summary["time"]), residual, wire,
             str(run.attributes["reason"]))  # fmt: skip
    member.forget()
    return found


@lru_cache(maxsize=1)
def changes(runs: Runs) -> Rows:
    """What a hundredth of the tolerance changes of peaks."""
    rows: Rows = []
    for case, tight, channels in TIGHT:
        if not runs.has(case, tight):
            continue
        for channel in channels:
            first, second = (number(runs.stated(name), f"peak:{channel}").value
                             for name in (case, tight))  # fmt: skip
            rows.append((case, channel, first, second, 100.0 * abs(second / first - 1.0)))
    return rows


@lru_cache(maxsize=1)
def critical(runs: Runs) -> Rows:
    """The extremes of what parts are sized by, over all cases, and when they are met."""
    rows: Rows = []
    for each in envelope(study(runs.folder), WANTED, "latch_angle", ["opening"]):
        met = each.cases[each.worst]
        angles = (np.degrees(met.at), np.degrees(met.acting.get("opening", math.nan)))
        rows.append((each.name, each.extreme, met.value, each.unit, each.worst, met.time, *angles))
    return rows


def write(runs: Runs, folder: Path) -> list[Path]:
    """cases.csv, tolerances.csv and critical.csv."""
    found = (("cases.csv", ENDED, ends(runs)), ("tolerances.csv", CHANGE, changes(runs)),
             ("critical.csv", CRITICAL, critical(runs)))  # fmt: skip
    return [table(folder / name, head, rows, headed(*head)) for name, head, rows in found if rows]


def sections(runs: Runs) -> list[Section]:
    """All as sections of the page."""
    found = []
    if rows := critical(runs):
        lines = [Line([Cell(text) for text in met(row)]) for row in rows]
        found.append(Section("critical", "Critical values over all cases",
                             [Text(content.CRITICAL), Table(CRITICAL, lines)]))  # fmt: skip
    if rows := ends(runs):
        lines = [Line([Cell(text) for text in told(row)]) for row in rows]
        found.append(Section("cases", "How every case ended", [Text(content.ENDS),
                                                               Table(ENDED, lines)]))  # fmt: skip
    if rows := changes(runs):
        lines = [Line([Cell(str(row[0])), Cell(str(row[1])), *(Cell(f"{x:.5g}") for x in row[2:4]),
                       Cell(f"{row[4]:.2g}")]) for row in rows]  # fmt: skip
        found.append(Section("tolerance", "A hundredth of the tolerance", [Table(CHANGE, lines)]))
    return found


def met(row: tuple[object, ...]) -> list[str]:
    """An extreme, for the reader."""
    name, extreme, value, unit, case, time, latch, hinge = row
    numbers = (f"{time:.4g}", f"{latch:.4g}", f"{hinge:.4g}")
    return [str(name), str(extreme), f"{value:.5g}", str(unit), str(case), *numbers]


def told(row: tuple[object, ...]) -> list[str]:
    """How a run ended, for the reader."""
    case, status, time, residual, wire, reason = row
    shown = "" if math.isnan(float(str(wire))) else f"{wire:.4g}"
    return [str(case), str(status), f"{time:.3f}", f"{residual:.1e}", shown, str(reason)]
