"""Poincare sections asked for after a run: figures, and tables with the error of every point."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from trsim.analyse.section import Interpolated, asked, section
from trsim.report import style
from trsim.report.asked import table
from trsim.report.display import Shown, short
from trsim.report.orbits import scattered
from trsim.store.points import surface
from trsim.store.read import Points
from trsim.store.target import headed

HEAD = ("run", "time", "x", "y", "time_error", "x_error", "y_error")
INTERPOLATED = "interpolated from output rows"


def draw(runs: list[Shown], wanted: tuple[str, ...], folder: Path) -> list[Path]:
    """section_CHANNEL.png and .csv of each text such as `when=B.x,crosses=up,plot=B.x:B.y`."""
    written = []
    for text in wanted:
        what = asked(text)
        found = [(shown, section(shown.run, **what)) for shown in runs]
        stem = "_".join(["section", what["when"], what["crosses"], what["x"], what["y"]])
        rows = (row for shown, one in found for row in columns(shown, one))
        written.append(table(folder / f"{stem}.csv", HEAD, rows, headed(*HEAD)))
        written.append(style.draw(folder / f"{stem}.png", figure, runs, found))
    return written


def figure(runs: list[Shown], found: list[tuple[Shown, Interpolated]]) -> Any:
    """The points side by side; the title says how wrong they may be."""
    there = [(shown, points(shown, one)) for shown, one in found]
    definition = found[0][1].definition
    errors = []
    for axis, name in ((1, "x"), (2, "y")):
        worst = max(one.worst[axis] for _, one in found)
        si = found[0][0].run.unit(definition[name])
        shown = found[0][0]
        errors.append(f"{short(shown.scaled(worst, si), 2)} {shown.display(si)[1]}")
    text = f"{surface(definition)}; interpolated, errors up to {errors[0]}, {errors[1]}"
    missed = sum(one.unresolved for _, one in found)
    text += f"; {missed} touches between two rows" if missed else ""
    faint = sum(one.faint for _, one in found)
    text += f"; {faint} swings too small to be resolved" if faint else ""
    return scattered(runs, there, text)


def points(shown: Shown, found: Interpolated) -> Points:
    """Interpolated points in the form of a section that was declared."""
    definition = {**found.definition, "method": INTERPOLATED}
    units = [shown.run.unit(definition[axis]) for axis in "xy"]
    return Points(definition, found.time, found.x, found.y, *units)


def columns(shown: Shown, one: Interpolated) -> Iterator[tuple[Any, ...]]:
    """Points in SI units, each with the error it may have."""
    found = (one.time, one.x, one.y, one.time_error, one.x_error, one.y_error)
    for row in zip(*(column.tolist() for column in found), strict=True):
        yield shown.label, *row
