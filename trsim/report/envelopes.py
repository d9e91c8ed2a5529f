"""The envelope of a sweep: what is largest and smallest in which case, and what acted then."""

from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.cases import reasons, shorter
from trsim.analyse.envelope import AXES, Met, Quantity, envelope, lost
from trsim.analyse.extremes import SMALLEST
from trsim.errors import listed
from trsim.report import style
from trsim.report.asked import Asked, Found, Value, nothing, table, words
from trsim.report.display import Shown, short
from trsim.report.style import colour, panels

ROOM = 40  # quantities of a picture
BAR, LEAST = 0.24, 1.0  # inch


def draw(study: Any, one: Shown, asked: Asked, folder: Path) -> Found:
    """envelope.csv, envelope_cases.csv with the extremes of every case, and the pictures."""
    others = words(asked.along)
    patterns = words([asked.envelope])
    found, of = nothing(), envelope(study, patterns, asked.at, others)
    drawn_names = {each.name for each in of if not each.zero}
    there = [each for each in of if each.name in drawn_names]
    found.files.extend(pictures(one, there, folder))
    found.files.append(worst(one, of, asked.at, others, folder))
    found.files.append(every(study, one, of, folder))
    for each in there:
        met = each.cases[each.worst]
        what = f"{each.extreme} {each.name} in {each.worst} at {met.time:.6g} s"
        factor, text = one.told(each.unit)
        value = met.value * factor
        found.values.append(Value(each.worst, f"{each.name}: {each.extreme}", value, np.nan, text))
        found.lines.append(f"{what}: {value:.6g} {text}")
    zero = [name for name in dict.fromkeys(each.name for each in of) if name not in drawn_names]
    found.lines.extend([f"zero in every case: {', '.join(zero)}"] if zero else [])
    found.lines.extend(doubted(of))
    found.lines.extend(absent(of))
    found.lines.extend(lost(study, [asked.at, *others] if asked.at else others))
    found.lines.extend(shorter(study))
    return found


def doubted(of: list[Quantity]) -> list[str]:
    """Extremes that lie between two rows which know nothing of them."""
    names = [f"{q.name} ({q.extreme})" for q in of if not q.cases[q.worst].trusted]
    if not names:
        return []
    return [f"{listed(names)}: the rows around miss more than 5 % of the extreme, so what they say "
            "acted with it is no better; a shorter `output: {every: ...}` tells more"]  # fmt: skip


def absent(of: list[Quantity]) -> list[str]:
    """Cases that have not all quantities; each reason once."""
    why: dict[str, dict[str, str]] = {}
    for each in of:
        for case, text in each.why.items():
            why.setdefault(text, {})[case] = text
    return [line for group in why.values() for line in reasons(group)]


# --- tables ----------------------------------------------------------------------------------


def worst(one: Shown, of: list[Quantity], at: str, others: list[str], folder: Path) -> Path:
    """A line for each extreme: where it is met, and what acted then."""
    units = {name: one.told(unit(one, name)) for name in ("time", at, *others) if name}
    over = [f"{at} [{units[at][1]}]"] if at else []
    beside = [f"{name} [{units[name][1]}]" for name in others]
    titles = ["quantity", "extreme", "unit", "value", "case", f"time [{units['time'][1]}]", *over,
              "known from", "in rows", *AXES, *beside]  # fmt: skip
    rows = []
    for each in of:
        met, (factor, text) = each.cases[each.worst], one.told(each.unit)
        place = [met.at * units[at][0]] if at else []
        acting = [met.acting[axis] * factor if axis in met.acting else "" for axis in AXES]
        rows.append((each.name, each.extreme, text, met.value * factor, each.worst,
                     met.time * units["time"][0], *place, met.of, met.rows * factor, *acting,
                     *(met.acting[name] * units[name][0] for name in others)))  # fmt: skip
    return table(folder / "envelope.csv", titles, rows)


def unit(one: Shown, channel: str) -> str:
    """The unit of a channel in the first run that could be read, or nothing."""
    return one.run.unit(channel) if one.run.stores(channel) else "-"


def every(study: Any, one: Shown, of: list[Quantity], folder: Path) -> Path:
    """The extremes of every case, of those without a result too."""
    second, s = one.told("s")
    titles = ("case", "quantity", "extreme", "unit", "value", f"time [{s}]", "status")
    none = Met(np.nan, np.nan, "", np.nan, np.nan, {})
    rows = []
    for case in study.cases:
        for each in of:
            met = each.cases.get(case.name, none)
            factor, text = one.told(each.unit)
            rows.append((case.name, each.name, each.extreme, text, met.value * factor,
                         met.time * second, case.status))  # fmt: skip
    return table(folder / "envelope_cases.csv", titles, rows)


# --- pictures --------------------------------------------------------------------------------


def pictures(one: Shown, of: list[Quantity], folder: Path) -> list[Path]:
    """Of each unit: the range of each quantity over all cases, a tick for each case."""
    out: list[Path] = []
    for si in dict.fromkeys(each.unit for each in of):
        names = list(dict.fromkeys(each.name for each in of if each.unit == si))
        for k in range(0, len(names), ROOM):
            part = [each for each in of if each.unit == si and each.name in names[k : k + ROOM]]
            name = f"envelope{f'_{len(out) + 1}' if out else ''}.png"
            out.append(style.draw(folder / name, figure, one, part, si))
    return out


def figure(one: Shown, of: list[Quantity], si: str) -> Any:
    """Bars from the smallest to the largest; on the right the cases in which these are met."""
    names = list(dict.fromkeys(each.name for each in of))
    made, axes = panels(1, height=LEAST + BAR * len(names))
    a, (factor, text) = axes[0, 0], one.display(si)
    beside = []
    for y, name in enumerate(names):
        own = [each for each in of if each.name == name]
        ends = [each.cases[each.worst].value * factor for each in own]
        low, high = (min(ends), max(ends)) if len(own) > 1 else (0.0, ends[0])
        a.barh([y], [high - low], left=[low], height=0.5, color=colour(0), alpha=0.35)
        for each in own:
            ticks = [met.value * factor for met in each.cases.values()]
            mark = colour(1 if each.extreme == SMALLEST else 0)
            a.plot(ticks, [y] * len(ticks), "|", ms=7, color=mark, mew=0.8)
        beside.append("\n".join(f"{short(end, 3)}: {each.worst}"
                                for each, end in zip(own, ends, strict=True)))  # fmt: skip
    a.set_yticks(range(len(names)), names)
    a.set_ylim(len(names) - 0.4, -0.6)
    right = a.secondary_yaxis("right")
    right.set_yticks(range(len(names)), beside, fontsize=6)
    right.tick_params(length=0)
    a.axvline(0.0, color="0.3", lw=0.7)
    a.use_sticky_edges = False
    a.margins(x=0.04)
    a.set_xlabel(f"smallest to largest over all cases ({text}); a tick: one case")
    a.grid(axis="y", visible=False)
    made.suptitle("Envelope", fontsize=10)
    return made
