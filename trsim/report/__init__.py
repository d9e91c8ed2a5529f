"""Figures and tables of result files; the only place that imports matplotlib."""

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from trsim.errors import FileError


def report(paths: str | PathLike | Sequence[str | PathLike], folder: str | PathLike) -> list[Path]:
    """Write every figure and table of a run into a folder; several runs are overlaid.

    Returns the files written.  Raises FileError.
    """
    from trsim.report import figures, tables
    from trsim.report.display import compared
    from trsim.store.read import read

    given = [paths] if isinstance(paths, str | PathLike) else list(paths)
    runs = compared([read(path) for path in given])
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return [*figures.draw(runs, folder), *tables.draw(runs, folder)]
    except OSError as error:
        raise FileError(f"{folder}: {error.strerror or error}") from None
