"""Tables of a few rows come back as they were put in."""

from typing import NamedTuple

import h5py
import pytest

from trsim.store import rows
from trsim.store.made import Book


class Row(NamedTuple):
    """One row, of all kinds there are."""

    name: str
    value: float
    count: int
    told: bool


@pytest.mark.parametrize("table", [[], [Row("µ", 0.1, -3, True), Row("", float("inf"), 0, False)]])
def test_rows_come_back(tmp_path, table):
    with h5py.File(tmp_path / "rows.h5", "w") as file:
        book = Book(file)
        rows.store(book, book.group("rows"), Row, table)
        found = rows.stored(file["rows"], Row)
    assert found == table
    assert all([type(x) for x in row] == [str, float, int, bool] for row in found)
