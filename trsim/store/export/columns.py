"""The columns of a table: time, and the channels and components that were asked for."""

from collections.abc import Iterator

import numpy as np

from trsim.arrays import Array
from trsim.store import torn
from trsim.store.grow import components
from trsim.store.read import Run, opened

ROWS = 4096  # rows handled together


class Columns:
    """Time and the named columns of a run, in blocks of rows."""

    def __init__(self, run: Run, names: list[str]) -> None:
        places = {n: (c, k) for c, s in run.sizes.items() for k, n in enumerate(components(c, s))}
        self.run = run
        self.places = [places[name] for name in names]
        self.names = ["time", *names]
        self.units = ["s", *(run.units[channel] for channel, _ in self.places)]

    @property
    def titles(self) -> list[str]:
        """Names with units, `stroke [m]`."""
        return [f"{name} [{unit}]" for name, unit in zip(self.names, self.units, strict=True)]

    def blocks(self, rows: int = ROWS) -> Iterator[Array]:
        """Rows handled together; errors of reading are those of the result file."""
        run, wanted = self.run, list(dict.fromkeys(channel for channel, _ in self.places))
        with opened(run.path) as file:
            for begin in range(0, run.rows, rows):
                end = min(begin + rows, run.rows)
                stored = {c: torn.rows(file[c], begin, end).reshape(end - begin, -1)
                          for c in wanted}  # fmt: skip
                time = torn.rows(file["time"], begin, end)
                yield np.column_stack([time, *(stored[c][:, k] for c, k in self.places)])

    def whole(self) -> Array:
        """All rows, (rows, columns)."""
        return np.concatenate([np.empty((0, len(self.names))), *self.blocks()])
