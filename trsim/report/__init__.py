"""Figures and tables of result files; the only place that imports matplotlib."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from trsim.errors import FileError, UsageError

if TYPE_CHECKING:
    from trsim.report.asked import Asked, Found

SWEEP = ("bifurcation", "sobol", "map", "bars", "envelope")  # what only a study has
RUNS = (
    "plot",
    "laws",
    "section",
    "portrait",
    "spectrum",
    "lyapunov",
    "compare",
    "overlay",
)  # what only runs have


def report(paths: str | PathLike | Sequence[str | PathLike], folder: str | PathLike) -> list[Path]:
    """Write every figure and table of a run into a folder; several runs are overlaid.

    Returns the files written.  Raises FileError.
    """
    from trsim.report import figures, tables
    from trsim.report.display import compared
    from trsim.store.read import read

    given = [paths] if isinstance(paths, str | PathLike) else list(paths)
    runs = compared([read(path) for path in given])
    with made(folder) as folder:
        return [*figures.draw(runs, folder), *tables.draw(runs, folder)]


def analysed(paths: Sequence[str | PathLike], folder: str | PathLike, asked: "Asked") -> "Found":
    """Write what was asked for of result files, or of the folder of one sweep.

    Raises FileError; UsageError where something makes no sense for what was given.
    """
    from trsim.report.asked import words

    check_asked(paths, asked)
    with made(folder) as folder:
        if Path(paths[0]).is_dir():
            from trsim.report import studies
            from trsim.sweeps.study import study

            return studies.draw(study(Path(paths[0])), asked, words(asked.table), folder)
        return of_runs(paths, folder, asked)


def of_runs(paths: Sequence[str | PathLike], folder: Path, asked: "Asked") -> "Found":
    """The analyses of result files."""
    from trsim.report import compared as beside
    from trsim.report import exponents, numbers, plots, portraits, sections, spectra
    from trsim.report import laws as of_laws
    from trsim.report.asked import nothing, words
    from trsim.report.display import compared
    from trsim.store.read import read

    runs, found = compared([read(path) for path in paths]), nothing()
    for word in asked.plot:
        found.add(plots.draw(runs, word, asked.overlay, asked.window, folder, found.files))
    if asked.laws:
        found.add(of_laws.draw(runs, folder))
    if asked.section:
        found.files.extend(sections.draw(runs, asked.section, folder))
    for word in asked.portrait:
        found.add(portraits.draw(runs, word, folder))
    for word in asked.spectrum:
        found.add(spectra.draw(runs, word, folder))
    for word in asked.lyapunov:
        found.add(exponents.draw(runs, word, folder))
    if asked.compare:
        found.add(beside.draw(runs, asked, folder))
    for word in () if asked.plot else asked.overlay:
        found.add(beside.overlay(runs, word, asked.against, folder))
    if asked.table:
        found.add(numbers.draw(runs, words(asked.table), folder))
    return found


def check_asked(paths: Sequence[str | PathLike], asked: "Asked") -> None:
    """Check that what was asked for fits what was given; raises UsageError."""
    studies = [path for path in paths if Path(path).is_dir()]
    if studies and len(paths) > 1:
        what = f"{studies[0]} is the folder of a sweep, and is not the only thing given"
        raise UsageError(what, "Report one sweep, or result files.")
    wrong = [name for name in (RUNS if studies else SWEEP) if getattr(asked, name)]
    if wrong:
        of, rather = ("a sweep", "result files") if studies else ("result files", "a sweep")
        raise UsageError(f"--{wrong[0]} is not for {of}", f"It is for {rather}.")
    if asked.over and not studies:
        raise UsageError("--over is not for result files", "It is for a sweep.")
    if (
        asked.over
        and (asked.sobol or asked.bars or asked.envelope)
        and not (asked.bifurcation or asked.table or asked.map)
    ):
        raise UsageError("--over goes with --bifurcation, --table or --map")
    if asked.window and not asked.plot:
        raise UsageError("--window goes with --plot", "Others take a window as WORD@BEGIN..END.")
    if asked.against and not (asked.compare or (asked.overlay and not asked.plot)):
        raise UsageError("--against goes with --compare or --overlay")
    if not asked.envelope and (asked.at or asked.along):
        raise UsageError(f"--{'at' if asked.at else 'with'} goes with --envelope")
    if asked.channels and not asked.compare:
        raise UsageError("--channels goes with --compare")


@contextmanager
def made(folder: str | PathLike) -> Iterator[Path]:
    """A folder to write to; errors of the file system are told of it."""
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield folder
    except OSError as error:
        raise FileError(f"{folder}: {error.strerror or error}") from None
