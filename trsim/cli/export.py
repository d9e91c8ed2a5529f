"""trsim export: channels of a result file as a table for other programs."""

import fnmatch
import sys
from pathlib import Path
from typing import Any

import click

from trsim.cli.frame import NAMED, Answer, framed, unheard
from trsim.errors import FileError, UsageError, known

FORMATS = ("csv", "tsv", "xlsx", "parquet", "mat", "pvd")  # the last one is no table


@click.command("export")
@click.argument("run", type=click.Path())
@click.option("-o", "--output", type=NAMED, help="File, or folder of it; - is standard output.")
@click.option("--format", "form", type=click.Choice(FORMATS),
              help="Told by the ending of the file unless given.")  # fmt: skip
@click.option("--csv", "as_csv", is_flag=True, help="The same as --format csv.")
@click.option(
    "--channels", multiple=True, metavar="PATTERN", help="For example 'B.*'; several by commas."
)
@framed
def command(
    answer: Answer,
    run: str,
    output: str | None,
    form: str | None,
    as_csv: bool,
    channels: tuple[str, ...],
) -> None:
    """Write the channels of the result file RUN as a table, one line per output row.

    The first line names them with their units; components of vectors are NAME.x, NAME.y, NAME.z.
    The ending of the file says which format: .csv, .tsv, .xlsx, .parquet or .mat; .pvd is the
    motion of bodies and bars for ParaView.
    Default output: RUN.csv beside it.
    """
    from trsim.store.export import export
    from trsim.store.grow import components
    from trsim.store.read import read

    form = format_of(output or "", "csv" if as_csv else form)
    found = read(run)
    if form == "pvd":
        return moving(answer, found, placed(Path(run), output, form), channels)
    of = {n: channel for channel in found.names for n in components(channel, found.sizes[channel])}
    names = chosen(of, channels)
    if output == "-":
        return streamed(answer, found, names, form)
    target = placed(Path(run), output, form)
    rows = export(found, names, target, form)
    answer.data |= {"file": str(target), "rows": rows, "channels": names}
    answer.put(str(target))
    answer.say(f"{target}: {rows} rows of {len(names)} channels")


def format_of(output: str, form: str | None) -> str:
    """The format that is asked for, or told by the ending of a file.

    Raises UsageError where neither says it, or where they say different ones.
    """
    ending = Path(output).suffix.removeprefix(".").lower()
    if form and ending in FORMATS and ending != form and not output.endswith("/"):
        what = f"{output} is asked for in the format {form}"
        raise UsageError(what, "Leave out the format, or name the file after it.")
    if form or output in ("", "-") or output.endswith("/") or Path(output).is_dir():
        return form or "csv"
    if ending in FORMATS:
        return ending
    told = f"{output} does not end like a format of `trsim export`"
    raise UsageError(told, f"Known: .{', .'.join(FORMATS)}.  Or give one with --format.")


def moving(answer: Answer, run: Any, target: Path, channels: tuple[str, ...]) -> None:
    """The motion as files of ParaView."""
    from trsim.report.vtk import write

    if channels:
        raise UsageError("--channels goes with tables, not with .pvd", "Leave it out.")
    if target.name == "-":
        raise UsageError("the files of ParaView are many", "Name one that ends in .pvd with -o.")
    frames, warnings = write(run, target)
    for text in warnings:
        answer.warn(str(run.path), text)
    answer.data |= {"file": str(target), "rows": frames, "channels": []}
    answer.put(str(target))
    answer.say(f"{target}: {frames} frames")


def streamed(answer: Answer, run: Any, names: list[str], form: str) -> None:
    """The table on standard output, and nothing else there."""
    from trsim.store.export import stream

    if answer.as_json:
        raise UsageError("--json and the table cannot both go to standard output", "Name a file.")
    try:
        stream(run, names, sys.stdout.buffer, form)
        sys.stdout.buffer.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        unheard(sys.stdout)
        raise FileError(f"standard output: {error.strerror or error}") from None


def chosen(of: dict[str, str], patterns: tuple[str, ...]) -> list[str]:
    """The columns that fit a pattern, or whose channel does; `of`: the channel of each."""
    names = list(of)
    patterns = tuple(one.strip() for several in patterns for one in several.split(","))
    if not patterns:
        return names

    def fits(name: str, pattern: str) -> bool:
        return any(fnmatch.fnmatchcase(each, pattern) for each in (name, of[name]))

    for pattern in patterns:
        if not any(fits(name, pattern) for name in names):
            raise UsageError(f"no channel fits '{pattern}'", known(pattern, names))
    return [name for name in names if any(fits(name, pattern) for pattern in patterns)]


def placed(run: Path, output: str | None, form: str) -> Path:
    """The file to write."""
    name = f"{run.name.removesuffix('.part').removesuffix('.h5')}.{form}"
    if not output:
        return run.with_name(name)
    target = Path(output)
    return target / name if output.endswith("/") or target.is_dir() else target
