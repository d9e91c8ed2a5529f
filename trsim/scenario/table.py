"""Tables in CSV files: columns of numbers under titles, which may carry a unit.

    # lines that begin with # and empty ones are left out
    t [ms], force [kN]
    0,      0.5

The unit stands in brackets behind the title, square or round.  A column without one is SI.  A
table that is read as a load or a motion has two columns, and its titles may be missing.
"""

import csv
import re
from typing import Any, NamedTuple

from trsim.errors import Place, ScenarioError, described, known
from trsim.scenario.text import decoded
from trsim.units import titled

_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\s*", re.ASCII)
_A_ROW = re.compile(r"\s*\"?\s*[\d.+-]")  # so begins a row that is not one of titles


class Line(NamedTuple):
    """A line of a table."""

    number: int  # from 1
    text: str
    cells: list[str]


class Table(NamedTuple):
    """The lines of a CSV file that count; `titles` is None where the first has numbers."""

    file: str
    titles: Line | None
    rows: list[Line]

    def place(self, line: Line, column: int) -> Place:
        """Where the cell of a column begins."""
        parts = line.text.split(",")
        begin = sum(len(part) + 1 for part in parts[:column]) if len(parts) > column else 0
        cell = line.text[begin:]
        return Place(self.file, line.number, begin + len(cell) - len(cell.lstrip()) + 1, line.text)

    def title(self, column: int) -> tuple[str, str]:
        """Name and unit of a column; both may be empty.  Raises ScenarioError for a unit."""
        if self.titles is None:
            return "", ""
        try:
            return titled(self.titles.cells[column])
        except ScenarioError as error:
            place = self.place(self.titles, column)
            what = f"{self.file}, column {column + 1}: {error.what}"
            raise ScenarioError(what, error.hint, place=place) from None


def lines(text: str, file: str) -> Table:
    """The lines of a CSV text.  Raises ScenarioError where a line cannot be parted into cells."""
    found: list[Line] = []
    for k, line in enumerate(text.splitlines(), start=1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            cells = next(csv.reader([line], strict=True))
        except csv.Error:
            raise _no_row(file, k, line, []) from None
        found.append(Line(k, line, cells))
    if found and not _A_ROW.match(found[0].text):
        return Table(file, found[0], found[1:])
    return Table(file, None, found)


def number(cell: str) -> float | None:
    """A finite number in decimal digits; None of anything else."""
    value = float(cell) if _NUMBER.fullmatch(cell) else None
    return value if value is not None and abs(value) < 1e300 else None


def rows(content: bytes, file: str, columns: Any = None) -> tuple[list[Any], list[str]]:
    """Rows [x, y] of a file of two columns, and what has no unit, as `column 2 (force)`.

    Where a title has a unit the first row is that of the titles, as they stand in the file.
    columns: titles of two of more columns.
    """
    table = lines(decoded(content, file), file)
    if columns is not None:
        table = chosen(table, columns)
    found: list[Any] = []
    for line in table.rows:
        numbers = [number(cell) for cell in line.cells]
        if len(numbers) != 2 or None in numbers:
            if not found and table.titles and not _A_ROW.match(line.text):
                hint = "A unit stands in brackets behind its title: `t [ms], force [kN]`."
                raise _wrong(table, line, " is a second line of titles", hint)
            raise _no_row(file, line.number, line.text, line.cells)
        found.append(numbers)
    if table.titles is None:
        return found, ["column 1", "column 2"]
    if len(table.titles.cells) != 2:
        hint = "For example `t [ms], force [kN]`; a line of other words begins with #."
        what = f": {len(table.titles.cells)} titles, but 2 columns"
        raise _wrong(table, table.titles, what, hint)
    names, units = zip(table.title(0), table.title(1), strict=True)
    bare = [f"column {k + 1} ({names[k]})" for k in (0, 1) if not units[k]]
    head = [f"{name} [{unit}]" if unit else name for name, unit in zip(names, units, strict=True)]
    return ([head, *found] if any(units) else found), bare


def chosen(table: Table, columns: Any) -> Table:
    """The table with two of its columns alone."""
    if not isinstance(columns, list) or [type(name) for name in columns] != [str, str]:
        raise ScenarioError("columns must be two titles, [of x, of y]")
    if table.titles is None:
        what = f"{table.file} has no titles, and so no column '{columns[0]}'"
        raise ScenarioError(what, "Its first line names the columns: `x [m], y [m]`.")
    names = [table.title(k)[0] for k in range(len(table.titles.cells))]
    places = []
    for name in columns:
        if name not in names:
            raise ScenarioError(f"{table.file} has no column '{name}'", known(name, names))
        places.append(names.index(name))

    def of(line: Line) -> Line:
        cells = [line.cells[k] if k < len(line.cells) else "" for k in places]
        return line._replace(cells=cells)

    return Table(table.file, of(table.titles), [of(line) for line in table.rows])


def between(line: str) -> str:
    """The hint on a line that is parted otherwise than by commas, as spreadsheets of some languages
    save it."""
    if ";" not in line and "\t" not in line:
        return "Columns are separated by commas."
    mark = "semicolons" if ";" in line else "tabs"
    decimal = " and decimal commas" * bool(re.search(r"[0-9],[0-9]", line))
    return (
        f"Columns are separated by commas, and this has {mark}{decimal}: save it with commas and "
        "decimal points."
    )


def _wrong(table: Table, line: Line, what: str, hint: str) -> ScenarioError:
    """What is wrong with a line of titles."""
    found = f"row {line.number} of {table.file}{what}"
    return ScenarioError(found, hint, place=table.place(line, 0))


def _no_row(file: str, at: int, line: str, cells: list[str]) -> ScenarioError:
    """What is wrong with a line of a CSV file, and in which column."""
    what, hint = f"row {at} of {file} is not two numbers", between(line)
    column = next((k for k, cell in enumerate(cells) if number(cell) is None), 0)
    if len(cells) == 2:
        what = f"row {at} of {file}: {described(cells[column].strip())} in column {column + 1}"
        what, hint = f"{what} is not a finite number", "Write each number in full, or drop the row."
    elif cells:
        what += f", but {len(cells)} column{'s' * (len(cells) > 1)}"
    return ScenarioError(what, hint, place=Place(file, at, 1, line))
