"""Numbers of a sweep as bars: a group for each load case, a colour for each number or value."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.cases import Numbers, reasons
from trsim.errors import UsageError
from trsim.report import case_table, style
from trsim.report.asked import Found, Value, file_name, nothing
from trsim.report.display import Shown, short
from trsim.report.keys import Units, in_words, named_value, readable
from trsim.report.style import NO_NUMBER, colour, panels
from trsim.statuses import WELL

MOST = 400  # bars of a figure: more cannot be told apart
NUMBERED = 60  # bars that have their number written beside
BAR, LEAST = 0.16, 1.2  # inch
LONGEST = 150  # letters of the name of a file


class Bar(NamedTuple):
    """One bar, and where it belongs."""

    group: str  # load case
    series: str
    value: float  # nan: none
    end: str  # how the run ended, where not as it should; nothing else


def draw(study: Any, one: Shown, of: list[Numbers], folder: Path) -> Found:
    """The figure and the table of some numbers of all cases."""
    found, name = nothing(), file_name("bars", " ".join(each.word for each in of))[:LONGEST]
    if len(of) * len(study.cases) > MOST:
        what = f"{len(of) * len(study.cases)} bars in a figure cannot be told apart"
        raise UsageError(what, f"At most {MOST}: ask for fewer at a time, or for --table.")
    found.files.append(style.draw(folder / f"{name}.png", figure, study, one, of))
    found.files.append(case_table.written(folder / f"{name}.csv", study, one, of))
    for each in of:
        found.lines.extend(reasons(each.why))
        factor, unit = one.told(each.unit)
        found.values.extend(
            Value(case.name, each.word, each.values[case.name] * factor, np.nan, unit)
            for case in study.cases
        )
    return found


def bars(study: Any, one: Shown, of: list[Numbers]) -> list[Bar]:
    """The bars of numbers of one unit, in the order of the cases.

    Where cases have a name and vary other keys as well, cases of one name are a group.
    """
    units = Units(study.units, study.written)
    named = all("case" in case.values for case in study.cases) and len(study.keys) > 1
    found = []
    for case in study.cases:
        others = [key for key in study.keys if key != "case" and key in case.values]
        values = ", ".join(told(one, units, key, case.values[key]) for key in others)
        end = "" if case.status == "done" else case.status
        for each in of:
            words = [in_words(each.word)] if len(of) > 1 else []
            series = ", ".join([*words, values] if named and values else words)
            group = str(case.values["case"]) if named else case.name
            found.append(Bar(group, series, each.values[case.name], end))
    return found


def told(one: Shown, units: Units, key: str, value: Any) -> str:
    """A key and its value, a number or a word."""
    return (
        f"{readable(key)} {value}"
        if isinstance(value, str)
        else named_value(one, units, key, value)
    )


def figure(study: Any, one: Shown, of: list[Numbers]) -> Any:
    """A panel for every unit, the load cases from above to below."""
    units: dict[str, list[Numbers]] = {}
    for each in of:
        units.setdefault(each.unit, []).append(each)
    panel = [bars(study, one, group) for group in units.values()]
    heights = [LEAST + BAR * (len(own) + len({bar.group for bar in own})) for own in panel]
    made, axes = panels(len(panel), height=sum(heights) / len(panel), height_ratios=heights)
    for a, group, (si, words) in zip(axes[:, 0], panel, units.items(), strict=True):
        factor, unit = one.display(si)
        filled(a, group, factor)
        a.set_xlabel(f"{in_words(words[0].word)} ({unit})" if len(words) == 1 else f"({unit})")
        names = a.get_legend_handles_labels()[1]
        if len(names) > 1 or NO_NUMBER in names:
            a.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0))
    text = " and ".join(dict.fromkeys(in_words(each.word) for each in of)) if len(of) < 3 else ""
    made.suptitle(text or f"{len(of)} numbers of {len(study.cases)} cases", fontsize=10)
    return made


def filled(axes: Any, given: list[Bar], factor: float) -> None:
    """The bars of one unit; a cross where there is no number."""
    series = list(dict.fromkeys(bar.series for bar in given))
    place: dict[int, float] = {}
    ticks, at = {}, 0.0
    for group in dict.fromkeys(bar.group for bar in given):
        own = [k for k, bar in enumerate(given) if bar.group == group]
        place |= {k: at + n for n, k in enumerate(own)}
        ticks[group] = at + 0.5 * (len(own) - 1)
        at += len(own) + 1.0
    y = [place[k] for k in range(len(given))]
    for k, name in enumerate(series):
        of = [j for j, bar in enumerate(given) if bar.series == name]
        axes.barh([y[j] for j in of], [given[j].value * factor for j in of], height=0.9,
                  color=colour(k), label=name or None)  # fmt: skip
    for j, bar in enumerate(given):
        told = [] if np.isnan(bar.value) else [short(bar.value * factor, 3)]
        told += [bar.end] if bar.end in WELL else []
        if len(given) <= NUMBERED and told:
            right = bar.value >= 0.0
            axes.annotate(", ".join(told), (bar.value * factor, y[j]), (3 if right else -3, 0),
                          textcoords="offset points", va="center", fontsize=6.5,
                          ha="left" if right else "right")  # fmt: skip
    lost = [y[j] for j, bar in enumerate(given) if np.isnan(bar.value)]
    if lost:
        axes.plot(np.zeros(len(lost)), lost, "x", color="0.45", ms=4.5, clip_on=False,
                  transform=axes.get_yaxis_transform(), label=NO_NUMBER)  # fmt: skip
    axes.set_yticks(list(ticks.values()), list(ticks))
    axes.set_ylim(at - 1.0, -1.0)
    axes.axvline(0.0, color="0.3", lw=0.7)
    axes.margins(x=0.14)
