"""What the figures of a study are put together from: panels with a letter, on common scales."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from trsim.arrays import Array
from trsim.report.display import DEFAULT, Shown, display_units
from trsim.report.style import colour
from trsim.studies.claim import Cases
from trsim.studies.runs import Runs

UNITS = display_units(DEFAULT)


class Drawn(NamedTuple):
    """A figure of the study, and what it is drawn from."""

    number: str  # of the study, with a letter of ours where it has several versions
    panels: str  # the letters of the study
    caption: str
    cases: Cases
    draw: Callable[[list[Shown]], Any]  # of the runs as stated, with the labels of the cases

    @property
    def anchor(self) -> str:
        """Its name as a file and as a place on the page."""
        return f"figure_{self.number.replace(' ', '_')}"

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(case for _, case in self.cases)

    def made(self, runs: Runs) -> Any:
        """The figure."""
        return self.draw([Shown(runs.stated(case).run, label, UNITS) for label, case in self.cases])


def lettered(axes: Any, letter: str, text: str) -> None:
    axes.set_title(f"({letter}) {text}" if letter else text, loc="left")


def fluctuates(x: Array) -> float:
    """How far a curve jumps from row to row."""
    return float(np.max(np.abs(np.diff(x)), initial=0.0))


def overlaid(
    axes: Any, runs: Sequence[Shown], paths: Sequence[tuple[Array, Array]],
    widths: Sequence[float], colours: Sequence[int] = (), **style: Any,
) -> None:  # fmt: skip
    """A path of each run; the widest behind the others."""
    for k in np.argsort(np.negative(widths), kind="stable").tolist():
        shade = colour(colours[k] if colours else k)
        axes.plot(*paths[k], color=shade, label=runs[k].label, **style)


def with_legend(figure: Any, axes: Any, runs: Sequence[Shown], most: int = 3) -> Any:
    """The figure, with its legend below, in the order of the runs, `most` to a line."""
    lines, names = axes.get_legend_handles_labels()
    found = dict(zip(names, lines, strict=True))
    labels = [shown.label for shown in runs if shown.label in found]
    columns = 1 if max(map(len, labels)) > 34 else min(most, len(labels))
    shown = figure.legend([found[n] for n in labels], labels, loc="outside lower center",
                          ncols=columns)  # fmt: skip
    for line in shown.get_lines():
        line.set_linewidth(1.6)
    return figure


def enlarged(axes: Any, begin: float, end: float) -> None:
    """A stretch of the curves, with the room in height that they take there."""
    inside = [y[(x >= begin) & (x <= end)] for x, y in
              (np.array(line.get_data(), dtype=float) for line in axes.get_lines())]  # fmt: skip
    found = np.concatenate([y for y in inside if y.size])
    room = 0.05 * (np.ptp(found) or 1.0)
    axes.set_xlim(begin, end)
    axes.set_ylim(found.min() - room, found.max() + room)


def alike(rows: Sequence[Sequence[Any]], x: bool = True) -> None:
    """One scale along each row of panels."""
    for row in rows:
        for axis in ("x", "y") if x else ("y",):
            limits = [getattr(a, f"get_{axis}lim")() for a in row]
            low, high = min(one[0] for one in limits), max(one[1] for one in limits)
            for a in row:
                getattr(a, f"set_{axis}lim")(low, high)
