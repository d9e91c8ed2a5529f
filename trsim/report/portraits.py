"""Portraits: any channel over any other, however often that one turns back."""

from pathlib import Path
from typing import Any

from trsim.analyse.window import parted, scalar_channel, window
from trsim.errors import UsageError
from trsim.report import style
from trsim.report.asked import Found, file_name, nothing
from trsim.report.display import Shown
from trsim.report.marks import spaced
from trsim.report.style import colour, finished, panels


def draw(runs: list[Shown], word: str, folder: Path) -> Found:
    """The figure of a word X:Y, or X:Y@WINDOW: a point for each row, joined in their order."""
    channels, text = parted(word)
    x, _, y = channels.partition(":")
    if not x or not y:
        what = f"'{word}' does not say what is over what"
        raise UsageError(what, "A portrait is X:Y, for example stroke:stroke.rate.")
    found = nothing()
    path = folder / f"{file_name('portrait', word)}.png"
    found.files.append(style.draw(path, figure, runs, (x, y), text))
    return found


def figure(runs: list[Shown], channels: tuple[str, str], text: str) -> Any:
    """The rows of every run in a window of time; a dot where they begin."""
    made, axes = panels(1, height=3.6, width=4.8)
    a = axes[0, 0]
    for k, shown in enumerate(runs):
        run = shown.run
        inside = window(run, text).of(run.time)
        x, y = (shown.scaled(scalar_channel(run, c)[inside], run.unit(c)) for c in channels)
        a.plot(x, y, color=colour(k), lw=0.6, label=shown.label, rasterized=True)
        a.plot(x[:1], y[:1], "o", ms=4, color=colour(k), mec="white", mew=0.6, zorder=5)
    for channel, name in zip(channels, (a.set_xlabel, a.set_ylabel), strict=True):
        name(f"{spaced(channel)} ({runs[0].display(runs[0].run.unit(channel))[1]})")
    return finished(made, a, runs, f"{spaced(channels[1])} over {spaced(channels[0])}, dot: begin")
