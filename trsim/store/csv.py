"""Channels of a result file as comma-separated values."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from trsim.store import torn
from trsim.store.grow import components
from trsim.store.read import Run, opened
from trsim.store.target import TABLE, file_errors, fresh

ROWS = 4096  # rows handled together


def export(run: Run, names: list[str], target: Path) -> int:
    """Write time and the named columns; the number of rows."""
    places = {n: (c, k) for c, s in run.sizes.items() for k, n in enumerate(components(c, s))}
    units = [run.units[places[name][0]] for name in names]
    heads = ["time [s]", *(f"{n} [{u}]" for n, u in zip(names, units, strict=True))]
    with (
        file_errors(target),
        fresh(target, TABLE, [run.path]) as unfinished,
        unfinished.open("w", encoding="utf-8", newline="") as out,
    ):
        out.write(",".join(f'"{head}"' if "," in head else head for head in heads) + "\r\n")
        for table in _tables(run, [places[name] for name in names]):
            out.writelines(",".join(map(repr, row)) + "\r\n" for row in table.tolist())
    return run.rows


def _tables(run: Run, places: list[tuple[str, int]]) -> Iterator[np.ndarray]:
    """Rows handled together; errors of reading are those of the result file."""
    with opened(run.path) as file:
        for begin in range(0, run.rows, ROWS):
            end = min(begin + ROWS, run.rows)
            stored = {c: torn.rows(file[c], begin, end).reshape(end - begin, -1) for c, _ in places}
            time = torn.rows(file["time"], begin, end)
            yield np.column_stack([time, *(stored[c][:, k] for c, k in places)])
