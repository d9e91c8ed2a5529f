"""A number over two swept keys: a cell for each case of a grid, its number, and how it ended."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from trsim.analyse.bifurcation import check_swept
from trsim.analyse.cases import Numbers, reasons
from trsim.errors import UsageError
from trsim.report import case_table
from trsim.report.asked import Found, file_name, nothing
from trsim.report.display import Shown, short
from trsim.report.keys import Units, axis, in_words
from trsim.report.style import look, panels, save
from trsim.statuses import NOT_NEEDED

MOST = 14  # cells of a line: more have no room for numbers
DARK = 0.55  # of the colour scale: below it letters are white


class Grid(NamedTuple):
    """Cases by their places: values (rows, columns), nan where there is none."""

    keys: tuple[str, str]  # across, up
    across: list[Any]
    up: list[Any]
    values: NDArray[np.float64]
    ends: list[list[str]]  # "jammed" where a run was; else nothing
    filled: NDArray[np.bool_]  # cells that were not needed and are as the nearest one that was


def drawn(study: Any, one: Shown, of: Numbers, over: str | None, folder: Path) -> Found:
    """The map of one number, as figure and table."""
    grid, found = gridded(study, of, over), nothing()
    factor, unit = one.display(of.unit)
    if grid.filled.any():
        found.lines.append(f"{grid.filled.sum():,} of {grid.filled.size:,} cells were not run and "
                           "have the colour of the nearest one that was")  # fmt: skip
    units = Units(study.units, study.written)
    with look():
        made, axes = panels(1, height=0.6 + 0.42 * max(len(grid.up), 4))
        names = [named(one, units, key, values) for key, values in
                 zip(grid.keys, (grid.across, grid.up), strict=True)]  # fmt: skip
        shade = cells(axes[0, 0], names[0], names[1], factor * grid.values, grid.ends,
                      grid.filled)  # fmt: skip
        axes[0, 0].set_xlabel(axis(one, units, grid.keys[0]))
        axes[0, 0].set_ylabel(axis(one, units, grid.keys[1]))
        made.colorbar(shade, label=f"{in_words(of.word)} ({unit})")
        found.files.append(save(made, folder / f"{file_name('map', of.word)}.png"))
    path = folder / f"{file_name('map', of.word)}.csv"
    found.files.append(case_table.written(path, study, one, [of]))
    found.lines.extend(reasons(of.why))
    return found


def gridded(study: Any, of: Numbers, over: str | None) -> Grid:
    """The cases of a study of two keys; raises UsageError for any other.

    A case that was not needed is as the nearest one that was, in steps of the grid.
    """
    keys = list(study.keys)
    check_swept(study, over)
    if len(keys) != 2:
        what = f"a map is over two keys, the study varies {len(keys)}: {', '.join(keys)}"
        raise UsageError(what, "Sweep two keys, and give the others one value each with --set.")
    across = over or keys[0]
    up = keys[1 - keys.index(across)]
    xs, ys = (ordered(case.values[key] for case in study.cases) for key in (across, up))
    values, ends = np.full((len(ys), len(xs)), np.nan), [[""] * len(xs) for _ in ys]
    taken, filled = set(), np.zeros(values.shape, bool)
    for case in study.cases:
        place = ys.index(case.values[up]), xs.index(case.values[across])
        if place in taken:
            raise UsageError(
                f"several cases have the same {across} and {up}", "A map is of a grid."
            )
        taken.add(place)
        filled[place] = case.status == NOT_NEEDED
        values[place] = of.values.get(case.name, np.nan)
        ends[place[0]][place[1]] = case.status if case.status != "done" else ""
    if filled.any():
        from scipy.ndimage import distance_transform_edt

        near = distance_transform_edt(filled, return_distances=False, return_indices=True)
        values = values[tuple(near)]
        ends = [[ends[y][x] for y, x in zip(*row, strict=True)]
                for row in np.moveaxis(near, 0, 1).tolist()]  # fmt: skip
    return Grid((across, up), xs, ys, values, ends, filled)


def ordered(values: Any) -> list[Any]:
    """Different values: numbers by size, words as they come."""
    found = list(dict.fromkeys(values))
    return found if any(isinstance(v, str) for v in found) else sorted(found)


def named(one: Shown, units: Units, key: str, values: Sequence[Any]) -> list[str]:
    """The values of a key in the unit of its axis."""
    factor = units.display(one, key)[0]
    return [v if isinstance(v, str) else short(v * factor) for v in values]


def cells(
    axes: Any, across: Sequence[str], up: Sequence[str], values: NDArray[np.float64],
    ends: Sequence[Sequence[str]], filled: NDArray[np.bool_] | None = None,
) -> Any:  # fmt: skip
    """Coloured cells with their numbers and ends; what tells the colours.

    Cells that are filled have the colour alone: on a map without numbers the others have a dot.
    """
    x, y = np.arange(len(across) + 1) - 0.5, np.arange(len(up) + 1) - 0.5
    shade = axes.pcolormesh(x, y, np.ma.masked_invalid(values), cmap="cividis", ec="white", lw=1.0)
    axes.set_xticks(range(len(across)), list(across))
    axes.set_yticks(range(len(up)), list(up))
    axes.grid(visible=False)
    axes.set_facecolor("0.88")  # of cells without a number
    if max(len(across), len(up)) > MOST:
        if filled is not None and filled.any():
            rows, columns = np.nonzero(~filled)
            axes.plot(columns, rows, ".", ms=1.5, mew=0, color="0.5")
        return shade
    for y, x in np.ndindex(values.shape):
        if filled is not None and filled[y, x]:
            continue
        value = float(values[y, x])
        number = "" if np.isnan(value) else short(value, 3)
        text = "\n".join(part for part in (number, ends[y][x]) if part)
        bright = np.isnan(value) or shade.norm(value) > DARK
        axes.text(x, y, text, ha="center", va="center", fontsize=7, linespacing=1.1,
                  color="black" if bright else "white")  # fmt: skip
    return shade
