"""The look of all figures: sizes for print, light grid, colours that survive a photocopier."""

import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from trsim.arrays import Array
from trsim.report.defaults import Figure, FigureCanvasAgg, matplotlib
from trsim.report.display import Shown
from trsim.store.target import FIGURE, file_errors, fresh

CHARACTER = 0.085  # inch: a letter of a title
WIDTH = 6.3  # inch: the text width of an A4 page
DPI = 150
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("-", "--", "-.", ":")
NO_NUMBER = "without a number"  # label of the crosses of `missed`
STRETCHES = 1500  # of a curve: more than the pixels can show
RC: Any = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-4, 5),
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "lines.linewidth": 0.8,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "figure.constrained_layout.h_pad": 0.06,
    "agg.path.chunksize": 10000,
}


def look() -> Any:
    """A context in which figures are made and saved."""
    return matplotlib.rc_context(RC)


def colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def panels(
    rows: int, columns: int = 1, height: float = 2.0, width: float = WIDTH, **options: Any
) -> tuple[Figure, Any]:
    """A figure and its axes, (rows, columns)."""
    figure = Figure(figsize=(width, rows * height + 0.4), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False, **options)


def save(figure: Figure, path: Path) -> Path:
    """Write the PNG, without anything that changes from day to day."""
    with file_errors(path), fresh(path, FIGURE) as unfinished:
        figure.savefig(unfinished, format="png", metadata={"Software": "trsim"})
    return path


def draw(path: Path, make: Callable[..., Figure], *given: Any, **options: Any) -> Path:
    """Make a figure and write it."""
    with look():
        return save(make(*given, **options), path)


def titled(figure: Figure, runs: list[Shown], text: str) -> None:
    """What is shown, and of which run; a run that did not end well says so."""
    run = runs[0].run
    name = (run.attributes["title"] or run.path.stem) if len(runs) == 1 else ""
    status = run.attributes["status"] if len(runs) == 1 else "done"
    end = "" if status == "done" else f" ({status})"
    wide = int(figure.get_figwidth() / CHARACTER)
    lines = [textwrap.fill(text, wide)] + ([textwrap.fill(name + end, wide)] if name else [])
    figure.suptitle("\n".join(lines), fontsize=10)


def legend(figure: Figure, axes: Any, runs: list[Shown]) -> None:
    """Which curve is which run, under the figure."""
    if len(runs) > 1:
        lines, names = axes.get_legend_handles_labels()
        once = dict(zip(names, lines, strict=True))
        if not once:  # no run has a row
            return
        figure.legend(once.values(), once.keys(), loc="outside lower center",
                      ncols=1 if max(map(len, once)) > 34 else min(3, len(once)))  # fmt: skip


def finished(figure: Figure, axes: Any, runs: list[Shown], text: str) -> Figure:
    """The figure with its title, and with its legend where it shows several runs."""
    figure.align_ylabels()
    titled(figure, runs, text)
    legend(figure, axes, runs)
    return figure


def thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """Fewer points that look the same: first, lowest, highest and last of every stretch of x."""
    if len(x) <= 4 * STRETCHES:
        return x, y
    of = ((x - x[0]) * (STRETCHES / (x[-1] - x[0]))).astype(int)
    first = np.flatnonzero(np.diff(of, prepend=-1))
    last = np.append(first[1:], len(x)) - 1
    order = np.lexsort((y, of))  # by value within each stretch; the stretches stay in place
    kept = np.unique(np.concatenate([first, last, order[first], order[last]]))
    return x[kept], y[kept]


def apart(axes: Any, noise: float = 0.0) -> None:
    """Room above and below a curve that hardly changes: rounding is not shown as a signal.

    noise: what in the units of the axis is no more than rounding.
    """
    low, high = axes.get_ylim()
    largest = max(abs(low), abs(high))
    if largest <= noise:
        axes.set_ylim(-1.0, 1.0)
    elif high - low < 1e-6 * largest:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.05 * largest, middle + 0.05 * largest)


def missed(axes: Any, places: list[float], label: str = NO_NUMBER) -> None:
    """Crosses on the horizontal axis, where there would be something; it reaches as far as they."""
    if places:
        axes.plot(places, np.zeros(len(places)), "x", color="0.45", ms=4.5, clip_on=False,
                  transform=axes.get_xaxis_transform(), label=label)  # fmt: skip
