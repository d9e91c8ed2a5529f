"""Any channels over any other one, beside the curves of tables, and how far they are from these."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from trsim.analyse.plotted import Plotted, Rows, limits, plotted, rows
from trsim.analyse.reference import Given, given
from trsim.analyse.turning import Off, branches, differences
from trsim.arrays import Array
from trsim.report import style
from trsim.report.asked import Found, Value, file_name, nothing, table
from trsim.report.display import Shown
from trsim.report.marks import spaced
from trsim.report.spectra import label
from trsim.report.style import DASHES, colour, panels, thinned, titled

TITLES = ("run", "table", "channel", "unit", "compared", "largest difference", "at", "unit of at",
          "value of the run there", "rms", "of range", "rows", "rows in the window")  # fmt: skip
COARSE = 200  # rows: a table of fewer is drawn with points, nothing is known between them
LONGEST = 150  # letters of the name of a file
Limits = tuple[float, float]


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


def draw(
    runs: list[Shown], word: str, tables: tuple[str, ...], text: str, folder: Path,
    taken: Sequence[Path] = (),
) -> Found:  # fmt: skip
    """The figure of a word `Y, Y2 : X`, its numbers, and the differences to tables.

    text: the window of the abscissa, empty for all of it.  Raises UsageError, FileError.
    """
    of, first = plotted(word), runs[0].run
    within = limits(text, first.unit(of.x) if first.stores(of.x) else "-")
    every = [Curves(shown, rows(shown.run, of)) for shown in runs]
    units = {channel: first.unit(channel) for channel in of.y}
    others = [given(Path(file), of.x, units, first.unit(of.x)) for file in tables]
    apart = list(compared(every, others, of, within))
    found, name = nothing(), named(word, text)
    while name in {path.stem for path in taken}:  # another word of the same letters
        name += "_too"
    path = folder / f"{name}.png"
    found.files.append(style.draw(path, figure, every, others, of, within, apart))
    for k, one in enumerate(every):
        own = folder / f"{name}{f'_{k + 1}' if k else ''}.csv"
        found.files.append(written(own, one, of, within, tables))
    if others:
        found.files.append(told(folder / f"{name}_difference.csv", every, of, apart, tables))
        note(found, every, others, of, apart)
    return found


def named(word: str, text: str) -> str:
    """The name of the files of a word in a window."""
    return file_name("plot", f"{word} {text}")[:LONGEST].rstrip("_")


def compared(
    every: list[Curves], tables: list[Given], of: Plotted, within: Limits
) -> Iterator[Apart]:
    """Every channel of every run beside every table that has it."""
    for other in tables:
        for k, one in enumerate(every):
            for channel in other.y:
                run = one.rows.time, one.rows.x, one.rows.y[channel]
                for off in differences(of.x, run, other, channel, within):
                    yield Apart(k, other.name, channel, off)


# --- what is written -------------------------------------------------------------------------


def written(
    path: Path, one: Curves, of: Plotted, within: Limits, tables: tuple[str, ...]
) -> Path:  # fmt: skip
    """The rows that are drawn, as `export` writes them, the abscissa first: numbers in full."""
    names = list(dict.fromkeys([of.x, "time", *of.y]))
    columns = {"time": one.rows.time, **one.rows.y, of.x: one.rows.x}
    inside = (one.rows.x >= within[0]) & (one.rows.x <= within[1])
    units = [one.shown.told(one.shown.run.unit(name)) for name in names]
    titles = [f"{name} [{text}]" for name, (_, text) in zip(names, units, strict=True)]
    factors = [factor for factor, _ in units]
    lines = (np.column_stack([columns[name][inside] for name in names]) * factors).tolist()
    return table(path, titles, lines, given=tables)


def told(
    path: Path, every: list[Curves], of: Plotted, apart: list[Apart], tables: tuple[str, ...]
) -> Path:  # fmt: skip
    """The differences: a line for each run, table, channel and branch, in SI units."""
    over = every[0].shown.run.unit(of.x)
    lines = []
    for one in apart:
        shown, off = every[one.run].shown, one.off
        lines.append((label(shown), one.table, one.channel, shown.run.unit(one.channel), off.how,
                      off.largest, off.at, over, off.value, off.rms, off.of_range, off.rows,
                      off.asked))  # fmt: skip
    return table(path, TITLES, lines, given=tables)


def note(
    found: Found, every: list[Curves], tables: list[Given], of: Plotted, apart: list[Apart]
) -> None:
    """The differences among the numbers and lines of a report, and what speaks against them."""
    over = every[0].shown.run.unit(of.x)
    for one in apart:
        shown, off = every[one.run].shown, one.off
        unit = shown.run.unit(one.channel)
        text = f"{label(shown)} less {one.table}, {one.channel} over {of.x}, {off.how}: "
        text += f"largest difference {off.largest:.4g} {unit} at {of.x} = {off.at:.4g} {over}"
        text += f" ({off.of_range:.2%} of its range), rms {off.rms:.3g} {unit}"
        found.lines.append(f"{text}; compared at {off.rows} of {off.asked} rows")
        what = f"{one.channel} less {one.table}, {off.how}"
        found.values.append(Value(label(shown), what, off.largest, np.nan, unit))
    for other in tables:
        lost = [channel for channel in of.y if channel not in other.y]
        if lost:
            found.lines.append(f"{other.name} has no column {', '.join(lost)}: not compared")
        if other.bare:
            said = f"{other.name}: {', '.join(other.bare)} without a unit in its title: taken as SI"
            found.lines.append(said)


# --- what is drawn ---------------------------------------------------------------------------


def figure(
    every: list[Curves], tables: list[Given], of: Plotted, within: Limits, apart: list[Apart]
) -> Any:
    """A panel for every unit: the runs, the tables, and dots where they are furthest apart."""
    first = every[0].shown
    groups: dict[str, list[str]] = {}
    for channel in of.y:
        groups.setdefault(first.run.unit(channel), []).append(channel)
    made, axes = panels(len(groups), height=3.0 if len(groups) == 1 else 2.1, sharex=True)
    factor, unit = first.display(first.run.unit(of.x))
    for a, (si, channels) in zip(axes[:, 0], groups.items(), strict=True):
        scale, text = first.display(si)
        for channel in channels:
            lines(a, (every, tables), channel, of, (within, (factor, scale)))
        for one in (one for one in apart if one.channel in channels):
            x, y = np.full(2, one.off.at * factor), one.off.value * scale
            ends = [y, y - one.off.largest * scale]
            a.plot(x, ends, "-", color="0.3", lw=0.8)
            a.plot(x[:1], ends[:1], "o", ms=3.5, color="0.2", mec="white", mew=0.5, zorder=5)
        what = spaced(channels[0].strip("|")) if len(channels) == 1 else ""
        a.set_ylabel(f"{what}\n({text})" if what else f"({text})")
        a.margins(x=0.01)
        style.apart(a)
    axes[-1, 0].set_xlabel(f"{spaced(of.x)} ({unit})")
    finish(made, axes[:, 0], every, of)
    return made


def lines(
    axes: Any, curves: tuple[list[Curves], list[Given]], channel: str, of: Plotted,
    window: tuple[Limits, tuple[float, float]],
) -> None:  # fmt: skip
    """One channel of all runs, and of the tables that have it; in a window, in display units."""
    (every, tables), (within, factors) = curves, window
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
    for j, other in enumerate(one for one in tables if channel in one.y):
        x, y = cut(other.x, other.y[channel], within, factors)
        name = f"{other.name}: {channel}" if several else other.name
        points = {"marker": "o", "ms": 2.5} if len(x) < COARSE else {}
        axes.plot(x, y, ls=":", color=colour(len(every) + len(of.y) - 1 + j + number), label=name,
                  lw=1.0, **points)  # fmt: skip


def cut(x: Array, y: Array, within: Limits, factors: tuple[float, float]) -> tuple[Array, Array]:
    """A curve in a window, broken where it leaves it, in display units."""
    inside = (x >= within[0]) & (x <= within[1])
    return np.where(inside, x, np.nan) * factors[0], np.where(inside, y, np.nan) * factors[1]


def sparse(x: Array, y: Array) -> tuple[Array, Array]:
    """Fewer points that look the same, of a curve that goes one way and has no gaps."""
    plain = len(x) > 1 and np.all(np.isfinite(x + y)) and np.all(np.diff(x) >= 0.0) and x[-1] > x[0]
    return thinned(x, y) if plain else (x, y)


def turns(x: Array) -> bool:
    """Whether an abscissa turns back."""
    return len(branches(x[np.isfinite(x)])) > 1 if len(x) else False


def finish(made: Any, axes: Any, every: list[Curves], of: Plotted) -> None:
    """Title and legend."""
    dot = "; dot: begin" if any(turns(one.rows.x) for one in every) else ""
    what = spaced(of.y[0]) if len(of.y) == 1 else ", ".join(of.y)
    over = spaced(of.x) if len(of.y) == 1 else of.x
    titled(made, [one.shown for one in every], f"{what} over {over}{dot}")
    made.align_ylabels()
    drawn = {name: line for a in axes
             for line, name in zip(*a.get_legend_handles_labels(), strict=True)}  # fmt: skip
    if len(drawn) > 1:
        columns = 1 if max(map(len, drawn)) > 34 else min(3, len(drawn))
        made.legend(drawn.values(), drawn.keys(), loc="outside lower center", ncols=columns)
