"""Channels of a result file as a table for other programs: CSV, TSV, XLSX, Parquet, MAT.

A format is a module with `write(columns, out)`, loaded when it is asked for, and what tells its
files from those of others.
"""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import IO, NamedTuple

from trsim.store.export.columns import Columns
from trsim.store.read import Run
from trsim.store.target import TABLE, Kind, file_errors, fresh

XLSX = Kind("sheet that `trsim export` wrote",
            lambda start: start.startswith(b"PK") and b"<Application>trsim<" in start)  # fmt: skip
MAT = Kind("MAT file that `trsim export` wrote", lambda start: start.startswith(b"MATLAB 5.0 MAT-f")
           and b"by trsim" in start[:116])  # fmt: skip
PARQUET = Kind("Parquet file that `trsim export` wrote", lambda end: b"trsim.title" in end,
               at_end=True)  # fmt: skip


class Format(NamedTuple):
    """A format: the module that writes it, and its files."""

    module: str
    kind: Kind


FORMATS = {
    "csv": Format("text", TABLE),
    "tsv": Format("text", TABLE),
    "xlsx": Format("sheet", XLSX),
    "parquet": Format("parquet", PARQUET),
    "mat": Format("mat", MAT),
}


def export(run: Run, names: list[str], target: Path, form: str = "csv") -> int:
    """Write time and the named columns; the number of rows.

    Raises UsageError where the format cannot hold them, or needs a package that is not there.
    """
    write = writer(form)
    with (
        file_errors(target),
        fresh(target, FORMATS[form].kind, [run.path]) as unfinished,
        unfinished.open("wb") as out,
    ):
        write(Columns(run, names), out)
    return run.rows


def stream(run: Run, names: list[str], out: IO[bytes], form: str = "csv") -> int:
    """The same, into an open stream."""
    writer(form)(Columns(run, names), out)
    return run.rows


def writer(form: str) -> Callable[[Columns, IO[bytes]], None]:
    """What writes a format."""
    module = import_module(f"trsim.store.export.{FORMATS[form].module}")
    write: Callable[[Columns, IO[bytes]], None] = getattr(module, form, None) or module.write
    return write
