"""Figures and tables of result files; the only place that imports matplotlib."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from trsim.errors import FileError, UsageError

if TYPE_CHECKING:
    from trsim.report.asked import Asked, Found

from trsim.report.looks import Looks, chosen
from trsim.report.wanted import check_given

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


def report(
    paths: str | PathLike | Sequence[str | PathLike],
    folder: str | PathLike,
    looks: Looks = Looks(),  # noqa: B008
) -> list[Path]:
    """Write every figure and table of a run into a folder; several runs are overlaid.

    Returns the files written.  Raises FileError, and UsageError for looks that make no sense.
    """
    from trsim.report import figures, index, style, tables
    from trsim.report.display import compared
    from trsim.store.read import read
    from trsim.store.target import together

    given = [paths] if isinstance(paths, str | PathLike) else list(paths)
    check_given(given)
    runs = compared([read(path) for path in given], chosen(looks.units))
    with style.asked(looks) as sheet, made(folder) as folder:
        with together():
            drawn = figures.draw(runs, folder)
            written = [*drawn, *tables.draw(runs, folder)]
        loads = [load for shown in runs for load in tables.peak_loads(shown)]
        return [*written, index.write(folder, runs, loads, drawn, sheet.shots)]


def analysed(
    paths: Sequence[str | PathLike],
    folder: str | PathLike,
    asked: "Asked",
    looks: Looks = Looks(),  # noqa: B008
) -> "Found":
    """Write what was asked for of result files, or of the folder of one sweep.

    Raises FileError; UsageError where something makes no sense for what was given.
    """
    from trsim.report import index, style
    from trsim.report.asked import Asked, words
    from trsim.store.target import together

    paths, asked = with_tables(paths, asked)
    check_given(paths)
    check_asked(paths, asked)
    units = chosen(looks.units)
    with style.asked(looks) as sheet, made(folder) as folder:
        if not Path(paths[0]).is_dir():
            with together():
                return of_runs(paths, folder, asked, units)
        from trsim.report import studies
        from trsim.sweeps.study import study

        swept = study(Path(paths[0]))
        with together():
            found = studies.draw(swept, asked, words(asked.table), folder, units)
        if asked == Asked():
            title = f"{Path(swept.source).stem}: {len(swept.cases)} cases"
            found.files.append(index.of_sweep(folder, title, found, sheet.shots))
        return found


def of_runs(
    paths: Sequence[str | PathLike],
    folder: Path,
    asked: "Asked",
    units: Mapping[str, tuple[float, str]],
) -> "Found":
    """The analyses of result files."""
    from trsim.report import compared as beside
    from trsim.report import exponents, numbers, plots, portraits, sections, spectra
    from trsim.report import laws as of_laws
    from trsim.report.asked import nothing, words
    from trsim.report.display import compared
    from trsim.store.read import read

    runs, found = compared([read(path) for path in paths], units), nothing()
    wanted = plots.Wanted(asked.overlay, asked.window, asked.zoom, asked.second_axis,
                          asked.magnitude)  # fmt: skip
    for word in asked.plot:
        found.add(plots.draw(runs, word, wanted, folder, found.files))
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


def with_tables(
    paths: Sequence[str | PathLike], asked: "Asked"
) -> tuple[list[str | PathLike], "Asked"]:
    """The runs, and what was asked for with the tables among them laid over its plots."""
    tables = [path for path in paths if Path(path).suffix.lower() == ".csv"]
    if not tables:
        return list(paths), asked
    if not asked.plot:
        what = f"{tables[0]} is a table"
        raise UsageError(what, "--plot 'Y : X' draws it beside the runs, by the names of columns.")
    runs = [path for path in paths if path not in tables]
    if not runs:
        what = "tables alone have nothing to be laid over"
        raise UsageError(what, "Name a result file before them.")
    return runs, asked._replace(overlay=(*asked.overlay, *map(str, tables)))


def check_asked(paths: Sequence[str | PathLike], asked: "Asked") -> None:
    """Check that what was asked for fits what was given; raises UsageError."""
    studies = [path for path in paths if Path(path).is_dir()]
    if studies and len(paths) > 1:
        what = f"{studies[0]} is the folder of a sweep, and is not the only thing given"
        raise UsageError(what, "Report one sweep, or result files.")
    wrong = [name for name in (RUNS if studies else SWEEP) if getattr(asked, name)]
    if wrong:
        files = f"result files, such as {Path(studies[0]) / 'cases' / '*.h5'}" if studies else ""
        of, rather = ("a sweep", files) if studies else ("result files", "a sweep")
        hint = f"It is for {rather}."
        if studies and not any(Path(studies[0]).glob("cases/*.h5")):
            hint += f" This sweep kept none; `trsim run {studies[0]} CASE` makes one."
        raise UsageError(f"--{wrong[0]} is not for {of}", hint)
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
    of_plots = [name for name in ("zoom", "second_axis", "magnitude") if getattr(asked, name)]
    if of_plots and not asked.plot:
        raise UsageError(f"--{of_plots[0].replace('_', '-')} goes with --plot")
    if asked.against and not (asked.compare or (asked.overlay and not asked.plot)):
        first = paths[0]
        raise UsageError(
            "--against goes with --compare or --overlay",
            f"`trsim report {first} OTHER.h5 --compare --against {asked.against}` compares two; "
            f"of one, --plot 'CHANNEL : {asked.against}' draws any channel over it.",
        )
    if not asked.envelope and (asked.at or asked.along):
        raise UsageError(f"--{'at' if asked.at else 'with'} goes with --envelope")
    if asked.channels and not asked.compare:
        raise UsageError("--channels goes with --compare")


@contextmanager
def made(folder: str | PathLike) -> Iterator[Path]:
    """A folder to write to; errors of the file system are told of it."""
    folder = Path(folder)
    new = not folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        yield folder
    except OSError as error:
        raise FileError(f"{folder}: {error.strerror or error}") from None
    finally:
        if new:  # unless there is something in it
            with suppress(OSError):
                folder.rmdir()
