"""The look of all figures: sizes for print, light grid, colours that survive a photocopier."""

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from trsim.report.display import Shown
from trsim.store.grow import Array

WIDTH = 6.3  # inch: the text width of an A4 page
DPI = 150
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("-", "--", "-.", ":")
MOST = 4000  # points of a curve; more than the pixels can show
RC: dict[str, Any] = {
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
    "lines.linewidth": 1.0,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "figure.constrained_layout.h_pad": 0.06,
    "agg.path.chunksize": 10000,
}


def colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def panels(
    rows: int, columns: int = 1, height: float = 2.0, width: float = WIDTH, **options: Any
) -> tuple[Figure, Any]:
    """A figure and its axes, (rows, columns)."""
    with matplotlib.rc_context(RC):
        figure = Figure(figsize=(width, rows * height + 0.4), dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(rows, columns, squeeze=False, **options)
    return figure, axes


def save(figure: Figure, path: Path) -> Path:
    """Write the PNG, without anything that changes from day to day."""
    with matplotlib.rc_context(RC):
        figure.savefig(path, metadata={"Software": None})
    return path


def titled(figure: Figure, runs: list[Shown], text: str) -> None:
    """What is shown, and of which run; a run that did not end well says so."""
    run = runs[0].run
    name = (run.attributes["title"] or run.path.stem) if len(runs) == 1 else ""
    status = run.attributes["status"] if len(runs) == 1 else "done"
    end = "" if status == "done" else f" ({status})"
    figure.suptitle(f"{text}\n{name}{end}" if name else text, fontsize=10)


def legend(figure: Figure, axes: Any, runs: list[Shown]) -> None:
    """Which curve is which run, under the figure."""
    if len(runs) > 1:
        lines, names = axes.get_legend_handles_labels()
        once = dict(zip(names, lines, strict=True))
        figure.legend(once.values(), once.keys(), loc="outside lower center",
                      ncols=1 if max(map(len, once)) > 34 else min(3, len(once)))  # fmt: skip


def thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """At most MOST points that look the same: the lowest and highest of every stretch."""
    if len(x) <= MOST:
        return x, y
    size = -(-len(x) // (MOST // 2))
    n = len(x) // size * size
    blocks = np.nan_to_num(y[:n]).reshape(-1, size)
    ends = np.sort(np.stack([blocks.argmin(axis=1), blocks.argmax(axis=1)], axis=1), axis=1)
    kept = (ends + size * np.arange(len(blocks))[:, None]).ravel()
    kept = np.unique(np.concatenate([[0], kept, np.arange(n, len(x)), [len(x) - 1]]))
    return x[kept], y[kept]


def apart(axes: Any) -> None:
    """Room above and below a curve that hardly changes, so that rounding is not shown as signal."""
    low, high = axes.get_ylim()
    largest = max(abs(low), abs(high), 1e-300)
    if high - low < 1e-6 * largest:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.05 * largest, middle + 0.05 * largest)
