"""References: curves in tables of numbers, CSV files whose first line names the columns.

Titles may carry a unit, `time [ms]`, as those that `export` writes; numbers without one are SI.
The column of the abscissa is the one named so, or else the first one.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from trsim.analyse.compare import Curve
from trsim.arrays import Array
from trsim.errors import FileError, ScenarioError, UsageError, known, unreadable
from trsim.scenario.table import Line, Table, between, lines, number
from trsim.units import fits, titled, unit


class Given(NamedTuple):
    """The rows of a table in their order, SI."""

    name: str  # of the file
    time: Array | None
    x: Array  # abscissa
    y: dict[str, Array]  # by channel: those that have a column
    bare: tuple[str, ...]  # columns that say no unit


def given(path: Path, x: str, channels: dict[str, str], x_unit: str) -> Given:
    """The columns of some channels of a table; channels: their SI units.

    Of two columns the second one is that of the only channel, whatever its name.  Raises FileError,
    and UsageError where there is a column of none of them.
    """
    table = _table(path)
    names = _names(table, path)
    own = names.index(x) if x in names else 0
    places = {c: names.index(c) for c in channels if c in names and names.index(c) != own}
    if not places and len(names) == 2 and len(channels) == 1:
        places = {next(iter(channels)): 1 - own}
    if not places:
        words = [name for k, name in enumerate(names) if k != own]
        what = f"{path}: no column named '{next(iter(channels))}'"
        raise UsageError(what, known(next(iter(channels)), words))
    at = names.index("time") if "time" in names and x != "time" else -1
    units = {own: x_unit, **{k: channels[c] for c, k in places.items()}}
    units |= {at: "s"} if at >= 0 else {}
    columns = {k: _column(table, k, units[k]) for k in units}
    bare = tuple(names[k] for k in units if not table.title(k)[1] and units[k] != "-")
    y = {channel: columns[k] for channel, k in places.items()}
    return Given(path.name, columns.get(at), columns[own], y, bare)


def _names(table: Table, path: Path) -> list[str]:
    """The names of the columns, each once."""
    if table.titles is None or len(table.rows) < 2 or len(table.titles.cells) < 2:
        what = f"{path} has no table of at least two columns and two rows below their names"
        hint = "The first line names the columns: `time [s],stroke [mm]`."
        first = table.rows[0].text if table.rows else ""
        if ";" in first or "\t" in first:
            hint = between(first)
        raise FileError(what, hint, file=str(path))
    names = [_name(cell) for cell in table.titles.cells]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        what = f"{path} has two columns named '{twice}'"
        raise FileError(what, "Every column has a name of its own.", file=str(path))
    return names


def _column(table: Table, place: int, si: str) -> Array:
    """The numbers of a column in the unit."""
    numbers = np.array([_number(table, line, place) for line in table.rows])
    return np.asarray(numbers * _factor(table, place, si))


def reference(path: Path, column: str, against: str, si: tuple[str, str]) -> Curve:
    """The curve of a CSV file with titles; si: units of abscissa and values.

    The column is the one named so, or the second of two.  Raises FileError, UsageError.
    """
    table = _table(path)
    names = _names(table, path)
    if column not in names and len(names) > 2:
        raise UsageError(f"{path}: no column named '{column}'", known(column, names))
    over = against or "time"
    places = [names.index(over) if over in names else 0]
    places.append(names.index(column) if column in names else 1 - places[0])
    if places[0] == places[1]:
        what = f"{path}: column '{names[places[0]]}' would be '{over}' and '{column}' at once"
        raise UsageError(what, f"Name one column '{over}' and another one '{column}'.")
    values = [_column(table, place, text) for place, text in zip(places, si, strict=True)]
    order = np.argsort(values[0], kind="stable")
    return Curve(values[0][order], values[1][order])


def _table(path: Path) -> Table:
    """The lines of a file."""
    if (missing := unreadable(path)) is not None:
        raise missing
    try:
        table = lines(path.read_bytes().decode("utf-8-sig"), str(path))
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path} cannot be read as a table: {error}", file=str(path)) from None
    except ScenarioError as error:
        raise FileError(error.what, error.hint, place=error.place, file=str(path)) from None
    if table.titles is None and not table.rows:
        raise FileError(f"{path} has no table", "The first line names the columns.", file=str(path))
    return table


def _name(cell: str) -> str:
    """The name in a title; of a title that makes no sense all of it."""
    try:
        return titled(cell)[0]
    except ScenarioError:
        return cell.partition("[")[0].strip()


def _number(table: Table, line: Line, place: int) -> float:
    found = number(line.cells[place]) if place < len(line.cells) else None
    if found is None:
        what = f"{table.file}: no number in column {place + 1} of the line {line.text[:60]}"
        hint = "Every line has as many numbers as the first has names."
        raise FileError(what, hint, place=table.place(line, place), file=table.file)
    return found


def _factor(table: Table, place: int, si: str) -> float:
    """What the numbers of a column are multiplied by."""
    assert table.titles is not None  # noqa: S101
    where = table.place(table.titles, place)
    try:
        text = table.title(place)[1]
    except ScenarioError as error:
        raise UsageError(error.what, error.hint, place=where) from None
    if not text or fits(text, si):
        return float(unit(text)[0])
    raise UsageError(f"{table.file}: '{text}' is no unit of what is in {si}", place=where)
