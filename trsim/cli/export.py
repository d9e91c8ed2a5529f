"""trsim export: channels of a result file as a table of text."""

import fnmatch
from pathlib import Path

import click

from trsim.cli.frame import NAMED, Answer, framed
from trsim.errors import UsageError, known


@click.command("export")
@click.argument("run", type=click.Path())
@click.option("--csv", "as_csv", is_flag=True, required=True, help="Comma-separated values.")
@click.option("-o", "--output", type=NAMED, help="File, or folder of it.")
@click.option("--channels", multiple=True, metavar="PATTERN", help="For example 'B.*'; repeatable.")
@framed
def command(
    answer: Answer, run: str, as_csv: bool, output: str | None, channels: tuple[str, ...]
) -> None:
    """Write the channels of the result file RUN as a table, one line per output row.

    The first line names them with their units; components of vectors are NAME.x, NAME.y, NAME.z.
    Default output: RUN.csv beside it.
    """
    from trsim.store.csv import export
    from trsim.store.grow import components
    from trsim.store.read import read

    found = read(run)
    of = {n: channel for channel in found.names for n in components(channel, found.sizes[channel])}
    names = chosen(of, channels)
    target = placed(Path(run), output)
    rows = export(found, names, target)
    answer.data |= {"file": str(target), "rows": rows, "channels": names}
    answer.put(str(target))
    answer.say(f"{target}: {rows} rows of {len(names)} channels")


def chosen(of: dict[str, str], patterns: tuple[str, ...]) -> list[str]:
    """The columns that fit a pattern, or whose channel does; `of`: the channel of each."""
    names = list(of)
    if not patterns:
        return names

    def fits(name: str, pattern: str) -> bool:
        return any(fnmatch.fnmatchcase(each, pattern) for each in (name, of[name]))

    for pattern in patterns:
        if not any(fits(name, pattern) for name in names):
            raise UsageError(f"no channel fits '{pattern}'", known(pattern, names))
    return [name for name in names if any(fits(name, pattern) for pattern in patterns)]


def placed(run: Path, output: str | None) -> Path:
    """The file to write."""
    name = f"{run.name.removesuffix('.part').removesuffix('.h5')}.csv"
    if not output:
        return run.with_name(name)
    target = Path(output)
    return target / name if output.endswith("/") or target.is_dir() else target
