"""Any channels over any other one, beside the curves of tables, and how far they are from these."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from trsim.analyse.plotted import Plotted, check_reached, limits, plotted, rows
from trsim.analyse.reference import Given, given
from trsim.analyse.turning import differences
from trsim.analyse.window import between
from trsim.errors import UsageError
from trsim.report import style
from trsim.report.asked import Found, Value, file_name, nothing, table
from trsim.report.curves import Apart, Curves, Limits, View, figure
from trsim.report.display import Shown
from trsim.report.spectra import label
from trsim.store.read import Run

TITLES = ("run", "table", "channel", "unit", "compared", "largest difference", "at", "unit of at",
          "value of the run there", "rms", "of range", "rows", "rows in the window")  # fmt: skip
LONGEST = 150  # letters of the name of a file


class Wanted(NamedTuple):
    """What else is asked of a plot, by the words of options."""

    tables: tuple[str, ...] = ()  # files
    window: str = ""  # of the abscissa, empty for all of it
    zoom: str = ""  # off, or a window; where most happens unless given
    second_axis: bool = False
    magnitude: bool = False


def draw(
    runs: list[Shown], word: str, wanted: Wanted, folder: Path, taken: Sequence[Path] = ()
) -> Found:
    """The figure of a word `Y, Y2 : X`, its numbers, and the differences to tables.

    Raises UsageError, FileError.
    """
    of, first = plotted(word), runs[0].run
    if wanted.second_axis and wanted.zoom not in ("", "off"):
        raise UsageError("--zoom does not go with --second-axis", "Ask for one of the two.")
    if wanted.magnitude:
        of = magnitudes(of, first)
    tables, text = wanted.tables, wanted.window
    within = limits(text, first.unit(of.x) if first.stores(of.x) else "-")
    zoom = enlarged(wanted.zoom, first, of)
    every = [Curves(shown, rows(shown.run, of)) for shown in runs]
    for one in every:
        check_reached(one.shown.run, of.x, one.rows.x, text, within)
        if zoom:
            check_reached(one.shown.run, of.x, one.rows.x, wanted.zoom, zoom)
    units = {channel: first.unit(channel) for channel in of.y}
    others = [given(Path(file), of.x, units, first.unit(of.x)) for file in tables]
    apart = list(compared(every, others, of, within))
    found, name = nothing(), named(word, text)
    while name in {path.stem for path in taken}:  # another word of the same letters
        name += "_too"
    path = folder / f"{name}.png"
    view = View(wanted.second_axis, zoom)
    found.files.append(style.draw(path, figure, every, others, of, within, apart, view))
    for k, one in enumerate(every):
        own = folder / f"{name}{f'_{k + 1}' if k else ''}.csv"
        found.files.append(written(own, one, of, within, tables))
    if others:
        found.files.append(told(folder / f"{name}_difference.csv", every, of, apart, tables))
        note(found, every, others, of, apart)
    return found


def magnitudes(of: Plotted, run: Run) -> Plotted:
    """The same with the magnitudes of vectors in their place."""

    def plain(name: str) -> str:
        return f"|{name}|" if run.sizes.get(name) == 3 else name

    return Plotted(tuple(map(plain, of.y)), plain(of.x), of.within)


def enlarged(text: str, run: Run, of: Plotted) -> Limits | None:
    """The stretch of the abscissa to enlarge: to be found unless given, none where it is off."""
    if text == "off":
        return None
    return limits(text, run.unit(of.x) if run.stores(of.x) else "-")


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
    inside = between(one.rows.x, within)
    units = [one.shown.told(one.shown.run.unit(name)) for name in names]
    titles = [f"{name} [{text}]" for name, (_, text) in zip(names, units, strict=True)]
    factors = [factor for factor, _ in units]
    lines = (np.column_stack([columns[name][inside] for name in names]) * factors).tolist()
    return table(path, titles, lines, given=tables)


def told(
    path: Path, every: list[Curves], of: Plotted, apart: list[Apart], tables: tuple[str, ...]
) -> Path:  # fmt: skip
    """The differences: a line for each run, table, channel and branch, in the units of the rows."""
    first, lines = every[0].shown, []
    wide, over = first.told(first.run.unit(of.x))
    for one in apart:
        shown, off = every[one.run].shown, one.off
        factor, unit = shown.told(shown.run.unit(one.channel))
        lines.append((label(shown), one.table, one.channel, unit, off.how, off.largest * factor,
                      off.at * wide, over, off.value * factor, off.rms * factor, off.of_range,
                      off.rows, off.asked))  # fmt: skip
    return table(path, TITLES, lines, given=tables)


def note(
    found: Found, every: list[Curves], tables: list[Given], of: Plotted, apart: list[Apart]
) -> None:
    """The differences among the numbers and lines of a report, and what speaks against them."""
    first = every[0].shown
    wide, over = first.told(first.run.unit(of.x))
    for one in apart:
        shown, off = every[one.run].shown, one.off
        factor, unit = shown.told(shown.run.unit(one.channel))
        largest, at = off.largest * factor, off.at * wide
        text = f"{label(shown)} less {one.table}, {one.channel} over {of.x}, {off.how}: "
        text += f"largest difference {largest:.4g} {unit} at {of.x} = {at:.4g} {over}"
        text += f" ({off.of_range:.2%} of its range), rms {off.rms * factor:.3g} {unit}"
        found.lines.append(f"{text}; compared at {off.rows} of {off.asked} rows")
        what = f"{one.channel} less {one.table}, {off.how}"
        found.values.append(Value(label(shown), what, largest, np.nan, unit))
    for other in tables:
        lost = [channel for channel in of.y if channel not in other.y]
        if lost:
            found.lines.append(f"{other.name} has no column {', '.join(lost)}: not compared")
        if other.bare:
            said = f"{other.name}: {', '.join(other.bare)} without a unit in its title: taken as SI"
            found.lines.append(said)
