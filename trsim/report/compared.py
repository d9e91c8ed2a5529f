"""Runs beside each other, and beside reference tables: overlay above, difference below."""

import fnmatch
from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.compare import (
    Curve,
    Difference,
    channels,
    curve,
    difference,
    parting,
)
from trsim.analyse.reference import reference
from trsim.errors import UsageError, known
from trsim.report import style
from trsim.report.asked import Asked, Found, Value, file_name, nothing, table
from trsim.report.display import Shown, short
from trsim.report.marks import heading, spaced
from trsim.report.spectra import label
from trsim.report.style import apart, colour, panels, thinned, titled

COARSE = 200  # rows: a table of fewer is drawn as points, nothing is known between them
Named = tuple[str, Curve, Difference | None]  # label, curve, what it is apart from the first


def draw(runs: list[Shown], asked: Asked, folder: Path) -> Found:
    """Figures and a table of the differences of the runs to the first one."""
    if len(runs) < 2:
        over = f" --against {asked.against}" if asked.against else ""
        hint = f"Name two result files or more: `trsim report {runs[0].run.path} OTHER.h5 --compare"
        raise UsageError("there is nothing to compare", f"{hint}{over}`.")
    found, rows = nothing(), []
    gone = [parting(runs[0].run, shown.run, asked.against) for shown in runs[1:]]
    for channel in chosen(runs, asked.channels):
        unit = runs[0].run.unit(channel)
        curves = [curve(shown.run, channel, asked.against) for shown in runs]
        named: list[Named] = [(label(runs[0]), curves[0], None)]
        for shown, one, apart_from in zip(runs[1:], curves[1:], gone, strict=True):
            off = difference(channel, unit, curves[0], one, apart_from)
            named.append((label(shown), one, off))
            off = in_units(runs[0], off, asked.against)
            rows.append(row(channel, label(shown), off))
            note(found, label(shown), off, asked.against)
        path = folder / f"{file_name('compare', channel)}.png"
        found.files.append(style.draw(path, figure, runs, channel, asked.against, named))
    found.files.append(table(folder / "compare.csv", titles(runs[0], asked.against), rows))
    return found


def overlay(runs: list[Shown], word: str, against: str, folder: Path) -> Found:
    """The runs over the curve of a table, FILE.csv:CHANNEL, and their difference to it."""
    file, _, channel = word.rpartition(":")
    if not file:
        what = f"'{word}' does not say which channel"
        raise UsageError(what, "An overlay is FILE.csv:CHANNEL, for example old.csv:stroke.rate.")
    unit = runs[0].run.unit(channel) if curve(runs[0].run, channel, against) else "-"
    over = runs[0].run.unit(against) if against else "s"
    given = reference(Path(file), channel, against, (over, unit))
    found, rows = nothing(), []
    named: list[Named] = [(Path(file).name, given, None)]
    for shown in runs:
        one = curve(shown.run, channel, against)
        off = difference(channel, unit, given, one)
        named.append((shown.label or "run", one, off))
        off = in_units(runs[0], off, against)
        rows.append(row(channel, label(shown), off))
        note(found, label(shown), off, against)
    name = file_name("overlay", f"{Path(file).stem} {channel}")
    drawn = style.draw(folder / f"{name}.png", figure, runs, channel, against, named,
                       coarse=len(given.s) < COARSE)  # fmt: skip
    found.files.append(drawn)
    found.files.append(table(folder / f"{name}.csv", titles(runs[0], against), rows))
    return found


def chosen(runs: list[Shown], patterns: tuple[str, ...]) -> list[str]:
    """The channels that are compared; raises UsageError where there are none."""
    plain = [shown.run for shown in runs]
    if not patterns:
        found = channels(plain)
        if not found:
            raise UsageError("the runs share no sensor, drive or contact", "Name --channels.")
        return found
    names = [n for n, size in plain[0].sizes.items() if size == 1]
    names = [n for n in names if all(n in run.units for run in plain)]
    for pattern in patterns:
        if not any(fnmatch.fnmatchcase(name, pattern) for name in names):
            raise UsageError(f"no common channel fits '{pattern}'", known(pattern, names))
    return [n for n in names if any(fnmatch.fnmatchcase(n, p) for p in patterns)]


def titles(first: Shown, against: str) -> tuple[str, ...]:
    """Of the columns; places on the abscissa are SI unless they say their unit."""
    si = abscissa(first, against)
    text = first.told(si)[1]
    unit = f" [{text}]" if text != si else ""
    return ("channel", "run", "unit", "largest difference", f"at{unit}", "rms", "of range",
            f"apart from{unit}", "mean of first", "mean", "rms of first", "rms of run")  # fmt: skip


def abscissa(first: Shown, against: str) -> str:
    """The SI unit of what runs are compared over."""
    return first.run.unit(against) if against else "s"


def in_units(first: Shown, off: Difference, against: str) -> Difference:
    """The numbers of a difference in the units of tables."""
    factor, unit = first.told(off.unit)
    over = first.told(abscissa(first, against))[0]
    a, b = off.means
    c, d = off.levels
    return off._replace(unit=unit, largest=off.largest * factor, rms=off.rms * factor,
                        at=off.at * over, apart=off.apart * over,
                        means=(a * factor, b * factor),
                        levels=(c * factor, d * factor))  # fmt: skip


def row(channel: str, name: str, off: Difference) -> tuple[Any, ...]:
    return (channel, name, off.unit, off.largest, off.at, off.rms, off.of_range, off.apart,
            *off.means, *off.levels)  # fmt: skip


def note(found: Found, name: str, off: Difference, against: str) -> None:
    """A difference among the numbers and lines of a report."""
    at = f"{against} =" if against else "t ="
    text = f"{name}: {off.channel}: off by {off.largest:.4g} {off.unit} at {at} {off.at:.4g}"
    text += f" ({off.of_range:.2%} of its range), rms {off.rms:.3g}"
    if np.isfinite(off.apart):
        text += (
            f"; apart from {at} {off.apart:.4g} on: rms {off.levels[0]:.4g}, {off.levels[1]:.4g}"
        )
    found.lines.append(text)
    found.values.append(Value(name, f"{off.channel}: largest difference", off.largest, np.nan,
                              off.unit))  # fmt: skip


def figure(
    runs: list[Shown], channel: str, against: str, named: list[Named], coarse: bool = False
) -> Any:
    """All curves on one scale; below what each is more than the first.

    coarse: the first one and the differences, taken at its rows, are points.
    """
    made, axes = panels(2, height=2.2, sharex=True, height_ratios=(3, 2))
    upper, lower = axes[:, 0]
    first, points = runs[0], {"ls": "", "marker": "o", "ms": 2.5}
    over, over_unit = first.display(abscissa(first, against))
    factor, unit = first.display(first.run.unit(channel))
    for k, (name, one, off) in enumerate(named):
        line = points if coarse and not k else {"ls": "--" if k and not coarse else "-"}
        upper.plot(*thinned(one.s * over, one.x * factor), color=colour(k), label=name, **line)
        if off is None:
            continue
        lower.plot(*thinned(off.rest.s * over, off.rest.x * factor), color=colour(k),
                   **(points if coarse else {}))  # fmt: skip
        lower.plot([off.at * over], [off.largest * factor], "o", ms=3.5, color=colour(k),
                   mec="white", mew=0.5, zorder=5)  # fmt: skip
        if np.isfinite(off.apart):
            for a in (upper, lower):
                a.axvline(off.apart * over, color=colour(k), lw=0.8, ls=":")
    offs = [off for _, _, off in named if off is not None]
    worst = max(offs, key=lambda off: abs(off.largest))
    upper.set_ylabel(f"{spaced(channel)}\n({unit})")
    lower.set_ylabel(f"difference\n({unit})")
    lower.set_xlabel(f"{spaced(against) or 'time'} ({over_unit})")
    lower.axhline(0.0, color="0.5", lw=0.6)
    upper.margins(x=0.01)
    apart(lower)
    told = f"largest difference {short(worst.largest * factor, 3)} {unit}"
    if any(np.isfinite(off.apart) for off in offs):
        told += " until chance parts them (dotted)"
    titled(made, runs if len(named) > 2 else runs[:1], f"{heading(channel)}: {told}")
    made.align_ylabels()
    handles = upper.get_legend_handles_labels()
    made.legend(*handles, loc="outside lower center",
                ncols=1 if max(map(len, handles[1])) > 34 else 3)  # fmt: skip
    return made
