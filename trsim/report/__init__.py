"""Figures and tables of result files; the only place that imports matplotlib."""

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

from trsim.errors import FileError


def report(
    paths: str | PathLike | Sequence[str | PathLike], folder: str | PathLike,
    sections: Sequence[str] = (),
) -> list[Path]:  # fmt: skip
    """Write every figure and table of a run into a folder; several runs are overlaid.

    sections: Poincare sections besides those declared, `when=CHANNEL,crosses=up,plot=X:Y`.
    Returns the files written.  Raises FileError, UsageError.
    """
    from trsim.report import figures, tables
    from trsim.report.display import compared
    from trsim.store.read import read

    given = [paths] if isinstance(paths, str | PathLike) else list(paths)
    runs = compared([read(path) for path in given])
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        written = [*figures.draw(runs, folder), *tables.draw(runs, folder)]
        if sections:
            from trsim.report import sections as asked_for

            written += asked_for.draw(runs, tuple(sections), folder)
        return written
    except OSError as error:
        raise FileError(f"{folder}: {error.strerror or error}") from None
