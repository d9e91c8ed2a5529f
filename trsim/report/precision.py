"""Work against precision as a figure and a table: error to the right, CPU time upwards."""

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from trsim.report.asked import table
from trsim.report.display import raised
from trsim.scenario.methods import METHODS
from trsim.store.target import FIGURE, check_writable, headed, replaceable

if TYPE_CHECKING:
    from trsim.analyse.precision import Point, Study

NAME = "work_precision"
MARKS = "osD^vP*X"
FIELDS = ("error", "worst", "peak_error", "unresolved", "peak_unresolved", "cpu", "steps",
          "evaluations", "reason")  # fmt: skip
TITLES = ("method", "tolerance", "step [s]",
          *(f"{name} [s]" if name == "cpu" else name for name in FIELDS))  # fmt: skip
TABLE = headed(*TITLES)


def draw(study: "Study", folder: Path) -> list[Path]:
    """work_precision.png and work_precision.csv; raises FileError."""
    from trsim.report import style

    picture = style.draw(folder / f"{NAME}.png", figure, study)
    rows = [(*p.setting, *(getattr(p, name) for name in FIELDS)) for p in study.points]
    return [picture, table(folder / f"{NAME}.csv", TITLES, rows, TABLE)]


def check_room(folder: Path) -> None:
    """Check that both can be written, before anything is measured; raises FileError, UsageError."""
    check_writable(folder)
    replaceable(folder / f"{NAME}.png", FIGURE)
    replaceable(folder / f"{NAME}.csv", TABLE)


def figure(study: "Study") -> Any:
    """Errors of the motion and, where there are contacts, of their peaks; hollow: unresolved."""
    from trsim.report.style import WIDTH, panels

    peaks = any(np.isfinite(p.peak_error) for p in study.points)
    made, axes = panels(1, 1 + peaks, height=3.6, width=WIDTH, sharey=True)
    to = study.reference
    end = "" if to.apart is None else f", until {to.apart:.4g} s"
    curves(axes[0, 0], study, "error", "unresolved", to.uncertainty)
    axes[0, 0].set_xlabel(f"largest error / range{end} (-)")
    axes[0, 0].set_ylabel("CPU time of the integration (ms)")
    if peaks:
        curves(axes[0, 1], study, "peak_error", "peak_unresolved", to.peak_uncertainty)
        axes[0, 1].set_xlabel("relative error of peak contact forces (-)")
    made.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    head = textwrap.fill("Work against precision" + (study.title and f": {study.title}"), 74)
    told = f"reference {to.setting.method}, tolerance {to.setting.tolerance:.0e}"
    made.suptitle(f"{head}\n{told}", fontsize=10)
    return made


def curves(axes: Any, study: "Study", field: str, below: str, uncertainty: float) -> None:
    """A curve per method, from its loosest setting to its tightest."""
    from trsim.report.style import colour

    axes.set(xscale="log", yscale="log")
    for k, (method, slope) in enumerate(study.slopes.items()):
        there = [p for p in study.points if p.setting.method == method and shown(p, field)]
        x = np.array([getattr(p, field) for p in there])
        y = np.array([1e3 * p.cpu for p in there])
        filled = np.array([not getattr(p, below) for p in there], bool)
        over = METHODS[method].control
        of = "error" if study.reference.apart is None else "peak error"
        label = f"{method}, {of} ~ {over}{raised(f'{slope:.2f}')}" if np.isfinite(slope) else method
        label += "" if there else " (nothing to show)"
        axes.plot(x, y, color=colour(k))
        mark, size = MARKS[k % len(MARKS)], 4.5
        axes.plot(x[~filled], y[~filled], mark, ms=size, color=colour(k), mfc="white")
        axes.plot(x[filled], y[filled], mark, ms=size, color=colour(k))
        axes.plot([], [], f"{mark}-", ms=size, color=colour(k), label=label)
    if uncertainty > 0.0:
        axes.axvline(uncertainty, color="0.5", ls="--",
                     label="uncertainty of the reference; hollow: not above it")  # fmt: skip
    decades(axes)
    axes.invert_xaxis()


def decades(axes: Any) -> None:
    """Whole decades of error, so that ticks have room."""
    from matplotlib.ticker import NullFormatter

    axes.xaxis.set_minor_formatter(NullFormatter())
    low, high = axes.dataLim.intervalx
    if 0.0 < low <= high < np.inf:  # else nothing is shown
        low = np.floor(np.log10(low))
        axes.set_xlim(10.0**low, 10.0 ** max(np.ceil(np.log10(high)), low + 1.0))


def shown(p: "Point", field: str) -> bool:
    """Whether a point has a place on logarithmic axes."""
    return not p.reason and bool(getattr(p, field) > 0.0) and p.cpu > 0.0
