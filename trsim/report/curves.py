"""Curves of runs and tables: panels, a second axis, equal axes of paths, the stretch enlarged."""

from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.busy import busy, common
from trsim.analyse.plotted import Plotted, Rows
from trsim.analyse.reference import Given
from trsim.analyse.turning import Off, branches
from trsim.analyse.window import between
from trsim.arrays import Array
from trsim.errors import UsageError
from trsim.report import style
from trsim.report.display import Shown
from trsim.report.marks import spaced
from trsim.report.style import DASHES, colour, panels, thinned, titled

COARSE = 200  # rows: a table of fewer is drawn with points, nothing is known between them
COMPONENTS = (".x", ".y", ".z")
SHADE = "0.93"  # of the stretch that is enlarged
Limits = tuple[float, float]
ALL: Limits = (-np.inf, np.inf)


class Curves(NamedTuple):
    """A run, and what is drawn of it."""

    shown: Shown
    rows: Rows


class Apart(NamedTuple):
    """How far a channel of a run is from a table."""

    run: int  # which of the runs
    table: str
    channel: str
    off: Off


class View(NamedTuple):
    """How curves are shown: on one panel with two axes; a stretch enlarged, or to be found."""

    second_axis: bool = False
    zoom: Limits | None = ALL


class Drawn(NamedTuple):
    """All that is drawn: runs, tables, channels, where, and differences."""

    every: list[Curves]
    tables: list[Given]
    of: Plotted
    within: Limits
    apart: list[Apart]

    @property
    def first(self) -> Shown:
        return self.every[0].shown

    @property
    def groups(self) -> dict[str, list[str]]:
        """The channels of each SI unit."""
        found: dict[str, list[str]] = {}
        for channel in self.of.y:
            found.setdefault(self.first.run.unit(channel), []).append(channel)
        return found


def figure(
    every: list[Curves],
    tables: list[Given],
    of: Plotted,
    within: Limits,
    apart: list[Apart],
    view: View = View(),  # noqa: B008
) -> Any:
    """A panel for every unit: the runs, the tables, and dots where they are furthest apart."""
    drawn = Drawn(every, tables, of, within, apart)
    if view.second_axis:
        return two_axes(drawn)
    groups, equal = drawn.groups, is_path(drawn)
    zoom = None if equal and view.zoom == ALL else stretch(drawn, view.zoom)
    height = 4.4 if equal else 3.0 if len(groups) == 1 else 2.1
    made, axes = panels(len(groups), 2 if zoom else 1, height=height, sharex="col",
                        width_ratios=(3, 2) if zoom else None)  # fmt: skip
    for row, channels in zip(axes, groups.values(), strict=True):
        panel(row[0], drawn, channels, within)
        if zoom:
            panel(row[1], drawn, channels, zoom)
            row[1].set_ylabel("")
            factor = drawn.first.display(drawn.first.run.unit(of.x))[0]
            row[0].axvspan(zoom[0] * factor, zoom[1] * factor, color=SHADE, zorder=0)
            row[1].set_xlim(zoom[0] * factor, zoom[1] * factor)
    if equal:
        axes[0, 0].set_aspect("equal", adjustable="datalim")
    for a in axes[-1]:
        a.set_xlabel(abscissa(drawn))
    finish(made, axes.flat, drawn, "; right: the grey part" if zoom else "")
    return made


def panel(axes: Any, drawn: Drawn, channels: list[str], within: Limits) -> None:
    """The channels of one unit in a stretch of the abscissa, and what they are called."""
    factor = drawn.first.display(drawn.first.run.unit(drawn.of.x))[0]
    scale, text = drawn.first.display(drawn.first.run.unit(channels[0]))
    for channel in channels:
        lines(axes, drawn, channel, within, (factor, scale))
    for one in (one for one in drawn.apart if one.channel in channels):
        x, y = np.full(2, one.off.at * factor), one.off.value * scale
        ends = [y, y - one.off.largest * scale]
        axes.plot(x, ends, "-", color="0.3", lw=0.8)
        axes.plot(x[:1], ends[:1], "o", ms=3.5, color="0.2", mec="white", mew=0.5, zorder=5)
    what = spaced(channels[0]) if len(channels) == 1 else ""
    axes.set_ylabel(f"{what}\n({text})" if what else f"({text})")
    axes.margins(x=0.01)
    style.apart(axes)


def two_axes(drawn: Drawn) -> Any:
    """One panel: the channels of one unit on the left axis, those of the other on the right."""
    groups = drawn.groups
    if len(groups) != 2:
        what = f"a second axis is for two units; these channels have {', '.join(groups)}"
        raise UsageError(what, "Without --second-axis each unit has a panel.")
    made, axes = panels(1, height=3.2)
    left = axes[0, 0]
    right = left.twinx()
    right.grid(visible=False)
    right.spines["right"].set_visible(True)
    for a, channels in zip((left, right), groups.values(), strict=True):
        panel(a, drawn, channels, drawn.within)
        text = drawn.first.display(drawn.first.run.unit(channels[0]))[1]
        a.set_ylabel(f"{', '.join(spaced(one) for one in channels)} ({text})")
    left.set_xlabel(abscissa(drawn))
    finish(made, (left, right), drawn, "")
    return made


def abscissa(drawn: Drawn) -> str:
    unit = drawn.first.display(drawn.first.run.unit(drawn.of.x))[1]
    return f"{spaced(drawn.of.x)} ({unit})"


def is_path(drawn: Drawn) -> bool:
    """Whether both axes are lengths along axes of space: components of vectors, in m."""
    names = (drawn.of.x, *drawn.of.y)
    run = drawn.first.run
    return all(
        name.endswith(COMPONENTS) and run.unit(name) == "m" and run.sizes.get(name[:-2]) == 3
        for name in names
    )


def stretch(drawn: Drawn, wanted: Limits | None) -> Limits | None:
    """The stretch of the abscissa to enlarge, of SI values; None where there is none."""
    if wanted is None or wanted != ALL:
        return wanted
    found, ends = [], []
    for one in drawn.every:
        inside = between(one.rows.x, drawn.within)
        x = one.rows.x[inside]
        ends += [float(x.min()), float(x.max())] if len(x) else []
        for y in one.rows.y.values():
            there = busy(x, y[inside])
            if there is None and len(x) and np.ptp(y[inside]) > 0.0:
                return None  # this curve changes all over
            found += [there] if there else []
    return common(found, max(ends) - min(ends)) if ends else None


def lines(
    axes: Any, drawn: Drawn, channel: str, within: Limits, factors: tuple[float, float]
) -> None:
    """One channel of all runs, and of the tables that have it; in a window, in display units."""
    every, of = drawn.every, drawn.of
    number = of.y.index(channel)
    several = len(of.y) > 1
    for k, one in enumerate(every):
        name = ", ".join(filter(None, [channel if several else "", one.shown.label]))
        way = {"color": colour(k if len(every) > 1 else number),
               "ls": DASHES[number % 4 if len(every) > 1 else 0]}  # fmt: skip
        x, y = cut(one.rows.x, one.rows.y[channel], within, factors)
        axes.plot(*sparse(x, y), label=name or channel, rasterized=True, **way)
        if turns(one.rows.x):
            axes.plot(x[:1], y[:1], "o", ms=4, color=way["color"], mec="white", mew=0.6, zorder=5)
    for j, other in enumerate(one for one in drawn.tables if channel in one.y):
        x, y = cut(other.x, other.y[channel], within, factors)
        name = f"{other.name}: {channel}" if several else other.name
        points = {"marker": "o", "ms": 2.5} if len(x) < COARSE else {}
        axes.plot(x, y, ls=":", color=colour(len(every) + len(of.y) - 1 + j + number), label=name,
                  lw=1.0, **points)  # fmt: skip


def cut(x: Array, y: Array, within: Limits, factors: tuple[float, float]) -> tuple[Array, Array]:
    """A curve in a window, broken where it leaves it, in display units."""
    inside = between(x, within)
    return np.where(inside, x, np.nan) * factors[0], np.where(inside, y, np.nan) * factors[1]


def sparse(x: Array, y: Array) -> tuple[Array, Array]:
    """Fewer points that look the same, of a curve that goes one way and has no gaps."""
    plain = len(x) > 1 and np.all(np.isfinite(x + y)) and np.all(np.diff(x) >= 0.0) and x[-1] > x[0]
    return thinned(x, y) if plain else (x, y)


def turns(x: Array) -> bool:
    """Whether an abscissa turns back."""
    return len(branches(x[np.isfinite(x)])) > 1 if len(x) else False


def finish(made: Any, axes: Any, drawn: Drawn, more: str) -> None:
    """Title and legend."""
    of, axes = drawn.of, list(axes)
    dot = "; dot: begin" if any(turns(one.rows.x) for one in drawn.every) else ""
    what = spaced(of.y[0]) if len(of.y) == 1 else ", ".join(of.y)
    over = spaced(of.x) if len(of.y) == 1 else of.x
    titled(made, [one.shown for one in drawn.every], f"{what} over {over}{dot}{more}")
    made.align_ylabels()
    named = {name: line for a in axes
             for line, name in zip(*a.get_legend_handles_labels(), strict=True)}  # fmt: skip
    if len(named) > 1:
        columns = 1 if max(map(len, named)) > 34 else min(3, len(named))
        made.legend(named.values(), named.keys(), loc="outside lower center", ncols=columns)
