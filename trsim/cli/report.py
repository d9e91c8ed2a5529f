"""trsim report: figures and tables of result files."""

import os
from pathlib import Path

import click

from trsim.cli.frame import NAMED, Answer, framed


@click.command("report")
@click.argument("runs", nargs=-1, required=True, type=click.Path())
@click.option("-o", "--output", type=NAMED, help="Folder of the figures.")
@click.option(
    "--section", "sections", multiple=True, metavar="when=CHANNEL,crosses=up,plot=X:Y",
    help="A Poincare section that was not declared, interpolated, with its errors.",
)  # fmt: skip
@framed
def command(
    answer: Answer, runs: tuple[str, ...], output: str | None, sections: tuple[str, ...]
) -> None:
    """Draw the figures and tables of result files RUN.

    Several runs are compared in the same figures.  Default output: the folder of the first result
    file, named after it.
    """
    from trsim.report import report

    folder = Path(output or os.path.splitext(runs[0])[0])
    written = report(runs, folder, sections)
    answer.data |= {"folder": str(folder), "files": [str(path) for path in written]}
    for path in written:
        answer.put(str(path))
