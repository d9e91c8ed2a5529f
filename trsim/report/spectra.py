"""Spectral densities as figures: one panel, a curve for each run, lines that stand out named."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from trsim.analyse.spectrum import Spectrum, of_channel
from trsim.analyse.window import parted, window
from trsim.report import style
from trsim.report.asked import Found, Value, file_name, nothing, table
from trsim.report.display import Shown, short
from trsim.report.marks import spaced
from trsim.report.style import colour, legend, panels, titled

NAMED = 3  # peaks written into the figure of one run
DECADES = 7  # below the largest value that are shown


def draw(runs: list[Shown], word: str, folder: Path) -> Found:
    """Figure, table and peaks of the channel a word names."""
    channel, text = parted(word)
    spectra = [of_channel(s.run, channel, window(s.run, text)) for s in runs]
    name, found = file_name("spectrum", word), nothing()
    found.files.append(style.draw(folder / f"{name}.png", figure, runs, spectra, channel))
    factor, unit = runs[0].told(runs[0].run.unit(channel))
    rows = [
        (label(s), f, d)
        for s, one in zip(runs, spectra, strict=True)
        for f, d in zip(one.frequency.tolist(), (one.density * factor).tolist(), strict=True)
    ]
    titles = ("run", "frequency [Hz]", f"{channel} [{unit}/sqrt(Hz)]")
    found.files.append(table(folder / f"{name}.csv", titles, rows))
    for shown, one in zip(runs, spectra, strict=True):
        found.lines.append(
            f"{label(shown)}: {channel}: rms {one.rms * factor:.4g} {unit}, resolution "
            f"{one.resolution:.3g} Hz, {one.segments} segments, Hann window"
        )
        for peak in one.peaks:
            size = peak.amplitude * factor
            found.lines.append(f"  {peak.frequency:.5g} Hz: amplitude {size:.3g} {unit}")
            what = f"{channel}: amplitude at {peak.frequency:.5g} Hz"
            found.values.append(Value(label(shown), what, size, np.nan, unit))
        found.lines.extend(f"  {text}" for text in lacking(one, factor, unit))
        found.lines.extend(f"  warning: {warning}" for warning in one.warnings)
    return found


def lacking(one: Spectrum, factor: float, unit: str) -> Iterator[str]:
    """What of the rows is not in their spectrum."""
    if one.sloped:
        yield (f"without the straight line through the rows, with which their rms is "
               f"{one.rows * factor:.4g} {unit}")  # fmt: skip
    if one.lacks:
        yield (
            f"warning: the spectrum lacks {one.lacks:.0%} of the variance of the rows, whose rms "
            f"about a straight line is {one.bent * factor:.4g} {unit}: it has nothing slower than "
            f"its segments of {one.length:.3g} s, and little of the ends of the rows; run longer, "
            "or take a longer window"
        )


def label(shown: Shown) -> str:
    return shown.label or str(shown.run.path)


def figure(runs: list[Shown], spectra: list[Spectrum], channel: str) -> Any:
    """Densities over frequency, both logarithmic."""
    made, axes = panels(1, height=3.4)
    a = axes[0, 0]
    factor, unit = runs[0].display(runs[0].run.unit(channel))
    for k, (shown, one) in enumerate(zip(runs, spectra, strict=True)):
        f, d = one.frequency[1:], one.density[1:] * factor
        a.plot(f, d, color=colour(k), label=shown.label)
        if len(runs) == 1:
            a.fill_between(f, d * one.low, d * one.high, color=colour(k), alpha=0.18, lw=0,
                           label="95 % interval")  # fmt: skip
            name_peaks(a, one, factor, unit)
    largest = max(float(np.max(one.density[1:])) for one in spectra) * factor
    a.set(xscale="log", yscale="log" if largest > 0.0 else "linear")
    if largest > 0.0:
        low = a.get_ylim()[0]
        a.set_ylim(max(low, largest * 10.0**-DECADES), 6.0 * largest)
    a.set_xlim(min(float(one.frequency[1]) for one in spectra), max(o.nyquist for o in spectra))
    a.set_xlabel("frequency (Hz)")
    a.set_ylabel(f"{spaced(channel)}\n({per_root(unit)})")
    one = spectra[0]
    told = f"{one.segments} segments, Hann window, {short(one.resolution, 3)} Hz of resolution"
    worst = max(spectra, key=lambda each: each.lacks)
    if worst.lacks:
        told += (
            f"; lacks {worst.lacks:.0%} of the variance, in motion slower than {worst.length:.3g} s"
        )
    titled(made, runs, f"Spectral density of {spaced(channel)}: {told}")
    if len(runs) == 1:
        a.legend(loc="lower left")
    legend(made, a, runs)
    return made


def per_root(unit: str) -> str:
    return f"{unit}/\u221aHz" if "/" not in unit else f"({unit})/\u221aHz"


def name_peaks(axes: Any, one: Spectrum, factor: float, unit: str) -> None:
    """Frequency and amplitude of the largest lines, above the curve; none beside another one."""
    told: list[float] = []
    for peak in one.peaks:
        if len(told) == NAMED or any(abs(np.log10(peak.frequency / f)) < 0.28 for f in told):
            continue
        told.append(peak.frequency)
        height = float(np.interp(peak.frequency, one.frequency, one.density)) * factor * one.high
        axes.annotate(
            f"{short(peak.frequency)} Hz\n{short(peak.amplitude * factor, 3)} {unit}",
            (peak.frequency, height),
            xytext=(0, 5),
            textcoords="offset points",
            ha="center",
            va="bottom",
            fontsize=7,
        )
