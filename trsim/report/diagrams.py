"""Bifurcation diagrams: the points of a section over what was swept, and their number."""

from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.bifurcation import Diagram, period_in_words
from trsim.analyse.cases import numeric, reasons
from trsim.report.asked import Found, Value, file_name, nothing, table
from trsim.report.case_table import scaled
from trsim.report.display import Shown
from trsim.report.keys import Units, axis, named_value
from trsim.report.marks import spaced
from trsim.report.style import colour, draw, missed, panels
from trsim.store.target import headed

DRAWN = 60_000  # points
FEW = 200  # points of a case that are drawn large
TICKS = 6  # periods that are written


def bifurcation(one: Shown, of: Diagram, folder: Path) -> Found:
    """The diagram, its points and the period of each case."""
    found = nothing()
    name = file_name("bifurcation", f"{of.section} {of.axis}")
    found.files.append(draw(folder / f"{name}.png", bifurcated, one, of))
    factor, text = one.told(of.units.get(of.over, "-"))
    rows = [
        (each.case, scaled(each.over, factor), each.period, x, y)
        for each in of.cases
        for x, y in zip(each.x.tolist(), each.y.tolist(), strict=True)
    ]
    titles = ("case", f"{of.over} [{text}]", "period", "x", "y")
    found.files.append(table(folder / f"{name}.csv", titles, rows, headed("case", "", "period")))
    for each in of.cases:
        what = f"{of.section}: {period_in_words(each.period)}"
        found.lines.append(f"{each.case}: {what}, {len(each.x)} points")
        value = float(each.period) if each.period >= 0 else np.nan
        found.values.append(Value(each.case, f"{of.section}: period", value, np.nan, "-"))
    for name in of.why:
        found.values.append(Value(name, f"{of.section}: period", np.nan, np.nan, "-"))
    found.lines.extend(reasons(of.why))
    return found


def bifurcated(one: Shown, of: Diagram) -> Any:
    """All points over the swept key; below it the period of each case."""
    made, (upper, lower) = panels(2, height=2.3, sharex=True, height_ratios=(4, 1))
    a, b = upper[0], lower[0]
    factor, unit = one.display(of.unit)
    units = Units(of.units, of.written)
    words = not numeric(of.places.values())
    names = list(dict.fromkeys(map(str, of.places.values())))
    scale = 1.0 if words else units.display(one, of.over)[0]

    def place(over: Any) -> float:
        return float(names.index(str(over))) if words else float(over) * scale

    families = list(dict.fromkeys(each.series for each in of.cases))
    each_drawn = max(1, DRAWN // max(len(of.cases), 1))
    size = 3.5 if max(len(each.x) for each in of.cases) < FEW else 1.5
    for each in of.cases:
        k = families.index(each.series)
        at = place(each.over)
        y = getattr(each, of.axis)[-each_drawn:] * factor
        a.plot(np.full(len(y), at), y, ".", ms=size, mew=0, color=colour(k))
        if each.period >= 0:
            mark = "x" if each.period == 0 else "s"
            b.plot([at], [each.period], mark, ms=3.0, color=colour(k))
    for k, series in enumerate(families if len(families) > 1 else []):
        text = ", ".join(named_value(one, units, key, value) for key, value in series)
        a.plot([], [], "o", ms=3.5, color=colour(k), label=text)
    with_points = {each.case for each in of.cases if len(each.x)}
    bare = [place(over) for case, over in of.places.items() if case not in with_points]
    missed(a, bare, "without points")
    a.set_ylabel(f"{spaced(of.channel)}\n({unit})")
    highest = max([1, *(each.period for each in of.cases)])
    b.set_ylim(-0.6, highest + 0.6)
    ticks = sorted({0, *(e.period for e in of.cases if e.period > 0)})[:TICKS]
    b.set_yticks(ticks, ["scattered" if tick == 0 else str(tick) for tick in ticks])
    b.set_ylabel("period")
    b.set_xlabel(axis(one, units, of.over))
    if words:
        b.set_xticks(range(len(names)), names)
        b.set_xlim(-0.5, len(names) - 0.5)
    made.suptitle(f"Bifurcation: section {of.section}", fontsize=10)
    if len(families) > 1 or bare:
        made.legend(*a.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    made.align_ylabels()
    return made
