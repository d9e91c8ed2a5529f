"""The laws of a run as it used them: a picture and a table of each, with the range it visited."""

from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.laws_used import Law, laws
from trsim.report import style
from trsim.report.asked import Found, file_name, nothing, table
from trsim.report.display import Shown
from trsim.report.marks import spaced
from trsim.report.spectra import label
from trsim.report.style import colour, finished, panels
from trsim.scenario.load import loads
from trsim.store.target import headed

TITLES = ("law", "what", "of", "gives", "unit of", "unit", "visited from", "visited to", "note")
LOOK = {"law": "-", "at rest": "--", "impact": "-", "visited": "-"}


def draw(runs: list[Shown], folder: Path) -> Found:
    """law_....png and .csv of each law of each run, and laws.csv that lists them."""
    found, lines = nothing(), []
    for k, shown in enumerate(runs):
        of, lost = laws(shown.run)
        found.lines.extend(pairs(shown.run))
        who = f"{label(shown)}: " if len(runs) > 1 else ""
        for law in of:
            name = file_name("law", law.name) + (f"_{k + 1}" if k else "")
            found.files.append(style.draw(folder / f"{name}.png", figure, shown, law))
            found.files.append(written(folder / f"{name}.csv", shown, law))
            lines.append((who + law.name, law.said, *columns(shown, law), law.why))
            found.lines.append(f"{who}{law.name}: {law.said}; {in_words(shown, law)}")
        found.lines.extend(f"{who}{text}: not drawn" for text in lost)
    if not lines:
        found.lines.append("no law that varies, no contact and no curve: nothing is drawn")
    found.files.append(table(folder / "laws.csv", TITLES, lines))
    return found


def pairs(run: Any) -> list[str]:
    """What contact laws took of the table of pairs."""
    given = loads(run.text("scenario/resolved")).contact_laws
    return [f"contact_laws.{name}: {law.taken}" for name, law in given.items() if law.pair]


def columns(shown: Shown, law: Law) -> tuple[Any, ...]:
    """Of what, what it gives, their units, and the range a run visited."""
    (factor, x_unit), (_, y_unit) = shown.told(law.x_unit), shown.told(law.y_unit)
    low, high = law.visited or (np.nan, np.nan)
    return law.x, law.y, x_unit, y_unit, low * factor, high * factor


def in_words(shown: Shown, law: Law) -> str:
    """The range a run visited."""
    if law.visited is None:
        return f"visited range not known: {law.why}" if law.why else "visited range not known"
    of, si = ("length along it", "m") if law.path else (law.x, law.x_unit)
    factor, unit = shown.told(si)
    text = f"visited {of} {law.visited[0] * factor:.6g} to {law.visited[1] * factor:.6g} {unit}"
    return f"{text} ({law.why})" if law.why else text


def written(path: Path, shown: Shown, law: Law) -> Path:
    """All that is drawn: which curve, x, y; numbers in full."""
    groups = {**law.curves}
    groups |= {"data": law.data} if law.data else {}
    groups |= {"steps of the run": law.met} if law.met else {}
    (fx, x_unit), (fy, y_unit) = shown.told(law.x_unit), shown.told(law.y_unit)
    rows = [(name, float(x * fx), float(y * fy)) for name, (xs, ys) in groups.items()
            for x, y in zip(xs, ys, strict=True)]  # fmt: skip
    titles = ("part", f"{law.x} [{x_unit}]", f"{law.y} [{y_unit}]")
    return table(path, titles, rows, headed("part", "", ""))


def figure(shown: Shown, law: Law) -> Any:
    """Curves, the points a law was given by, what the run did, and the range it visited."""
    made, axes = panels(1, height=3.2, width=5.2)
    a = axes[0, 0]
    (fx, x_unit), (fy, y_unit) = shown.display(law.x_unit), shown.display(law.y_unit)
    if law.met is not None and len(law.met[0]):
        a.plot(law.met[0] * fx, law.met[1] * fy, ".", ms=2, color="0.6", label="steps of the run",
               rasterized=True)  # fmt: skip
    for k, (name, (x, y)) in enumerate(law.curves.items()):
        thick = 2.0 if name == "visited" else 1.0
        a.plot(x * fx, y * fy, LOOK.get(name, "-"), color=colour(k), lw=thick, label=name)
    if law.data is not None:
        a.plot(law.data[0] * fx, law.data[1] * fy, "o", ms=3, color="0.2", label="data", zorder=4)
    if law.visited is not None and not law.path:
        a.axvspan(law.visited[0] * fx, law.visited[1] * fx, color=colour(4), alpha=0.15, lw=0,
                  label="visited")  # fmt: skip
    if law.path:
        a.set_aspect("equal", adjustable="datalim")
    a.set_xlabel(f"{spaced(law.x) if law.x != 't' else 'time'} ({x_unit})")
    a.set_ylabel(f"{spaced(law.y)} ({y_unit})")
    style.apart(a)
    handles, names = a.get_legend_handles_labels()
    if len(names) > 1:
        made.legend(handles, names, loc="outside lower center", ncols=4)
    return finished(made, a, [shown], f"{law.name}: {law.said}")
