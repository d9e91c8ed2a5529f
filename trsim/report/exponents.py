"""Lyapunov exponents as figures: how neighbours, or two runs, part, and the line through it."""

from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np

from trsim.analyse.growth import of_runs
from trsim.analyse.lyapunov import Exponent, exponent
from trsim.analyse.window import parted, scalar_channel, window
from trsim.report import style
from trsim.report.asked import Found, Value, file_name, nothing
from trsim.report.display import Shown, short
from trsim.report.marks import spaced
from trsim.report.spectra import label
from trsim.report.style import colour, panels, titled

PARTED = "ln(distance / ranges) (-)"  # label of an axis
WIDE = 70  # characters of the legend that fit under the figure


def draw(runs: list[Shown], word: str, folder: Path) -> Found:
    """The exponent of the channel a word names, of each run; of two also how they part."""
    channel, text = parted(word)
    found, each = nothing(), []
    for shown in runs:
        run = shown.run
        inside = window(run, text).of(run.time)
        one = exponent(run.time[inside], scalar_channel(run, channel)[inside])
        each.append(one)
        add(found, label(shown), f"{channel}: largest Lyapunov exponent", one)
    said = f"Neighbours in {spaced(channel)}"
    y = "mean of ln(distance /\nstandard deviation) (-)"
    path = folder / f"{file_name('lyapunov', word)}.png"
    found.files.append(style.draw(path, figure, runs, each, [s.label for s in runs], said, y))
    if len(runs) == 2:
        two = of_runs(runs[0].run, runs[1].run, window(runs[0].run, text))
        add(found, "both runs", "rate at which they part", two)
        path, said, y = folder / f"{file_name('parting', text)}.png", "Distance of two runs", PARTED
        found.files.append(style.draw(path, figure, runs, [two], [""], said, y))
    return found


def add(found: Found, run: str, what: str, one: Exponent) -> None:
    """A rate among the numbers and lines of a report."""
    half = one.half if np.isfinite(one.value) else np.nan
    found.values.append(Value(run, what, one.value, half, "1/s"))
    found.lines.append(f"{run}: {what}: {in_words(one)}")


def in_words(one: Exponent) -> str:
    """A rate, its interval and its region in words; or why there is none."""
    if one.verdict == "undetermined":
        return f"undetermined: {one.reason}"
    if one.verdict == "none":
        return f"no growth: {one.reason}"
    text = f"{one.value:.4g} +- {one.half:.2g} 1/s"
    if one.fit is not None:
        text += f", fitted from {one.time[one.fit.begin]:.3g} to {one.time[one.fit.end - 1]:.3g} s"
    if one.dimension:
        text += f", {one.dimension} dimensions, delay {one.delay:.3g} s, {one.pairs} pairs"
    return text


def figure(runs: list[Shown], each: list[Exponent], labels: list[str], said: str, y: str) -> Any:
    """Curves of the logarithm of a distance, their lines, and the rates in the legend."""
    made, axes = panels(1, height=3.2)
    a = axes[0, 0]
    factor, second = runs[0].display("s")
    title = said
    for k, (one, name) in enumerate(zip(each, labels, strict=True)):
        result = in_short(one)
        text = fill(f"{name}: {result}" if name else result, WIDE)
        if not one.time.size:
            a.plot([], [], color=colour(k), label=text)
            continue
        shown = np.where(one.curve > np.log(1e-200), one.curve, np.nan)
        a.plot(one.time * factor, shown, color=colour(k), label=text)
        if one.fit is not None and one.verdict == "grows":
            t = one.time[[one.fit.begin, one.fit.end - 1]]
            a.plot(t * factor, one.fit.offset + one.fit.slope * t, color="black", lw=1.2, ls="--")
            title = f"{said} (dashed: fitted line)"
    a.set_xlabel(f"time since they were neighbours ({second})")
    a.set_ylabel(y)
    a.margins(x=0.01)
    titled(made, runs, title)
    made.legend(*a.get_legend_handles_labels(), loc="outside lower center", ncols=1)
    return made


def in_short(one: Exponent) -> str:
    """The rate, or the verdict without its reason, which is in the lines of the report."""
    if one.verdict == "grows":
        return f"{short(one.value, 3)} \u00b1 {short(one.half, 2)} 1/s"
    return {"none": "no growth"}.get(one.verdict, one.verdict)
