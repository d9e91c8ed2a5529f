"""A table beside a scenario: two columns of numbers in a CSV file."""

import csv
import re

from trsim.errors import Place, ScenarioError, described
from trsim.spec.text import decoded


def rows(content: bytes, file: str) -> list[list[float]]:
    """The two columns of a CSV file; a first line of titles and lines after # are skipped."""
    lines = decoded(content, file).splitlines()
    table: list[list[float]] = []
    for k, line in enumerate(lines):
        if not line.strip() or line.startswith("#"):
            continue
        cells: list[str] = []
        try:
            cells = next(csv.reader([line], strict=True))
            x, y = map(float, cells)
            if not abs(x) < 1e300 or not abs(y) < 1e300:
                raise ValueError
        except (ValueError, csv.Error):
            if not table and not re.match(r"\s*[\d.+-]", line):
                continue  # titles
            raise _no_row(file, k + 1, line, cells) from None
        table.append([x, y])
    return table


def _no_row(file: str, number: int, line: str, cells: list[str]) -> ScenarioError:
    """What is wrong with a line of a CSV file, and in which column."""
    what, hint = f"row {number} of {file} is not two numbers", "Columns are separated by commas."
    column = next((k for k, cell in enumerate(cells) if not _is_number(cell)), 0)
    if len(cells) == 2:
        what = f"row {number} of {file}: {described(cells[column].strip())} in column {column + 1}"
        what, hint = f"{what} is not a finite number", "Write each number in full, or drop the row."
    elif cells:
        what += f", but {len(cells)} column{'s' * (len(cells) > 1)}"
    return ScenarioError(what, hint, place=Place(file, number, 1, line))


def _is_number(cell: str) -> bool:
    try:
        return abs(float(cell)) < 1e300
    except ValueError:
        return False
