"""Six components of a load in a CSV file: seven of its columns.

    # t in the first column, then forces and moments
    t [ms], Fx [N], Fy [N], Fz [kN], Mx [N*m], My [N*m], Mz [N*m]
    0,      0,      0,      0.2,     0,        1.5,      0

Which columns these are is said by `columns`, by titles Fx to Mz, or by their order in a file that
has seven and no such titles.
"""

from typing import Any

from trsim.elements.components import ALLOWED, TITLES, WIDTH
from trsim.errors import Place, ScenarioError, closest, described, known
from trsim.scenario.table import Line, Table, lines, number
from trsim.scenario.text import decoded
from trsim.units import check_dimension

MEANT = ("x", *TITLES)


def rows(content: bytes, file: str, columns: Any = None) -> tuple[list[Any], list[str]]:
    """Rows of seven numbers, and what has no unit, like `rows` of table.py."""
    table = lines(decoded(content, file), file)
    if not table.rows:
        raise ScenarioError(f"{file} has no rows of numbers", place=Place(file, 1, 1, ""))
    places = chosen(table, columns)
    width = len((table.titles or table.rows[0]).cells)
    names, units = zip(*(_title(table, place, k) for k, place in enumerate(places)), strict=True)
    found: list[Any] = []
    for line in table.rows:
        numbers = _numbers(table, line, places, width)
        if found and numbers[0] <= found[-1][0]:
            what = f"row {line.number} of {file}: {names[0] or 'x'} must rise"
            what += f", got {numbers[0]:g} after {found[-1][0]:g}"
            raise ScenarioError(what, "Sort the rows.", place=table.place(line, places[0]))
        found.append(numbers)
    if len(found) < 2:
        what = f"{file} has one row of numbers, and a table needs two"
        raise ScenarioError(what, place=table.place(table.rows[0], 0))
    told = zip(places, names, MEANT, units, strict=True)
    bare = [f"{place + 1} ({name or meant})" for place, name, meant, unit in told if not unit]
    bare = [f"column{'s' * (len(bare) > 1)} {', '.join(bare)}"] if bare else []
    head = [f"{name} [{unit}]" if unit else name for name, unit in zip(names, units, strict=True)]
    return ([head, *found] if any(units) else found), bare


def _title(table: Table, place: int, k: int) -> tuple[str, str]:
    """Name and unit of a column, which is one of its kind."""
    name, unit = table.title(place)
    if unit:
        try:
            check_dimension(unit, ALLOWED[k])
        except ScenarioError as error:
            what = f"{table.file}, column {place + 1} ({name}), read as {MEANT[k]}: {error.what}"
            raise ScenarioError(what, error.hint, place=_of_titles(table, place)) from None
    return name, unit


def _of_titles(table: Table, column: int) -> Place:
    return table.place(table.titles or table.rows[0], column)


def _numbers(table: Table, line: Line, places: list[int], width: int) -> list[float]:
    """The seven numbers of a line."""
    row = f"row {line.number} of {table.file}"
    if len(line.cells) != width:
        what = f"{row} has {len(line.cells)} column{'s' * (len(line.cells) != 1)}, not {width}"
        hint = "Columns are separated by commas; write 0 where there is nothing."
        raise ScenarioError(what, hint, place=table.place(line, 0))
    found = []
    for k, place in enumerate(places):
        value = number(line.cells[place])
        if value is None:
            cell = described(line.cells[place].strip())
            what = f"{row}: {cell} in column {place + 1} ({MEANT[k]}) is not a finite number"
            hint = "Write each number in full, or drop the row."
            raise ScenarioError(what, hint, place=table.place(line, place))
        found.append(value)
    return found


# --- which columns -----------------------------------------------------------------------------


def chosen(table: Table, columns: Any) -> list[int]:
    """The places, from 0, of the seven columns."""
    width = len((table.titles or table.rows[0]).cells)
    names = [table.title(k)[0] for k in range(width)] if table.titles else []
    if columns is not None:
        return _told(table, names, width, columns)
    lower = [name.lower() for name in names]
    found = [title for title in TITLES if title.lower() in lower]
    if found:
        return _named(table, lower, found, width)
    if width != WIDTH:
        what = f"{table.file} has {width} column{'s' * (width != 1)}, not seven: {', '.join(MEANT)}"
        hint = "Name seven of them: `columns: [t, Fx, Fy, Fz, Mx, My, Mz]`, titles or numbers."
        raise ScenarioError(what, hint, place=_of_titles(table, 0))
    return list(range(WIDTH))


def _named(table: Table, lower: list[str], found: list[str], width: int) -> list[int]:
    """The columns that have the titles Fx to Mz, and the one that is left."""
    hint = "Say which columns are meant: `columns: [t, Fx, Fy, Fz, Mx, My, Mz]`."
    if missing := [title for title in TITLES if title not in found]:
        what = f"{table.file} has no column '{missing[0]}', but '{found[0]}'"
        raise ScenarioError(what, hint, place=_of_titles(table, 0))
    twice = next((title for title in TITLES if lower.count(title.lower()) > 1), None)
    if twice:
        raise ScenarioError(f"{table.file} has two columns '{twice}'", hint,
                            place=_of_titles(table, 0))  # fmt: skip
    places = [lower.index(title.lower()) for title in TITLES]
    rest = [k for k in range(width) if k not in places]
    if len(rest) != 1:
        what = f"{table.file} has {len(rest)} columns beside {', '.join(TITLES)}"
        raise ScenarioError(f"{what}: which is x?", hint, place=_of_titles(table, 0))
    return rest + places


def _told(table: Table, names: list[str], width: int, columns: Any) -> list[int]:
    """The columns that `columns` says, by title or number."""
    if not isinstance(columns, list) or len(columns) != WIDTH:
        count = f", got {len(columns)}" if isinstance(columns, list) else ""
        raise ScenarioError(f"columns must be seven titles or numbers, {', '.join(MEANT)}{count}")
    places: list[int] = []
    for one in columns:
        place = _place(table, names, width, one)
        if place in places:
            raise ScenarioError(f"columns names column {described(one)} twice")
        places.append(place)
    return places


def _place(table: Table, names: list[str], width: int, one: Any) -> int:
    if isinstance(one, int) and not isinstance(one, bool):
        if not 1 <= one <= width:
            raise ScenarioError(f"{table.file} has columns 1 to {width}, and no column {one}")
        return one - 1
    if not isinstance(one, str):
        raise ScenarioError(f"a column is a title or a number, got {described(one)}")
    if not names:
        hint = "Its first line names the columns, or give numbers: `columns: [1, 2, ...]`."
        raise ScenarioError(f"{table.file} has no titles, and so no column '{one}'", hint)
    if names.count(one) != 1:
        what = f"{table.file} has {'two columns' if one in names else 'no column'} {described(one)}"
        raise ScenarioError(what, known(one, names, closest(one, names)))
    return names.index(one)
