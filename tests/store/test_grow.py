"""Tables that grow: what waits stands in the file after a flush."""

import h5py
import numpy as np

from trsim.store.grow import Field, Growing
from trsim.store.made import Book


def test_rows_that_wait_are_written_where_they_are_asked_for(tmp_path):
    with h5py.File(tmp_path / "rows.h5", "w") as file:
        fields = [Field("time", "s", "time", 0), Field("x", "m", "place", 1)]
        book = Book(file)
        table = Growing(book, book.group("table"), fields, (2, 10))
        rows = np.array([[0.0, 1.0], [0.5, 2.0], [1.0, 4.0]])
        table.append(rows[:2])
        table.flush()
        table.flush()  # nothing waits: the same again
        assert (table.n, table.n_waiting) == (2, 0)
        table.append(rows[2:])
        table.flush()
        assert table.n == 3
        assert np.array_equal(file["table/time"], rows[:, 0])
        assert np.array_equal(file["table/x"], rows[:, 1])
