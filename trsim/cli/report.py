"""trsim report: figures and tables of result files and sweeps."""

import os
from pathlib import Path
from typing import Any

import click

from trsim.cli.frame import NAMED, Answer, framed
from trsim.errors import UsageError
from trsim.report.looks import FORMATS, Looks
from trsim.studies import STUDIES, load


@click.command("report")
@click.argument("runs", nargs=-1, required=True, type=click.Path())
@click.option("-o", "--output", type=NAMED, help="Folder of the figures.")
@click.option("--plot", multiple=True, metavar="'Y, Y2 : X'",
              help="Channels over any other one, or over time.")  # fmt: skip
@click.option("--window", default="", metavar="A..B", help="Of X in --plot: 0..110deg.")
@click.option("--zoom", default="", metavar="A..B|off",
              help="The stretch of X that --plot enlarges; found unless given.")  # fmt: skip
@click.option("--second-axis", is_flag=True, help="Two units of --plot in one panel.")
@click.option("--magnitude", is_flag=True, help="Vectors in --plot as their magnitudes.")
@click.option("--laws", is_flag=True, help="Every law as used, and the range that was visited.")
@click.option("--section", multiple=True, metavar="when=CHANNEL,crosses=up,plot=X:Y",
              help="A Poincare section that was not declared, with its errors.")  # fmt: skip
@click.option("--portrait", multiple=True, metavar="X:Y",
              help="A channel over any other, however that turns back.")  # fmt: skip
@click.option("--spectrum", multiple=True, metavar="CHANNEL", help="Its spectral density.")
@click.option("--lyapunov", multiple=True, metavar="CHANNEL",
              help="Its largest Lyapunov exponent.")  # fmt: skip
@click.option("--compare", is_flag=True, help="Differences of the runs to the first one.")
@click.option("--channels", multiple=True, metavar="PATTERN", help="What --compare compares.")
@click.option("--against", default="", metavar="CHANNEL",
              help="In place of the time in --compare and --overlay.")  # fmt: skip
@click.option("--overlay", multiple=True, metavar="FILE.csv:CHANNEL",
              help="The runs over the curve of a table; with --plot FILE.csv.")  # fmt: skip
@click.option("--table", multiple=True, metavar="WORD,...",
              help="Numbers, such as peak:B.contact_force@0.3..0.9.")  # fmt: skip
@click.option("--bifurcation", multiple=True, metavar="SECTION[:AXIS]",
              help="Points of a section over what was swept.")  # fmt: skip
@click.option("--sobol", multiple=True, metavar="WORD", help="Sobol indices of a number.")
@click.option("--map", multiple=True, metavar="WORD", help="A number over two swept keys.")
@click.option("--bars", multiple=True, metavar="WORD,...",
              help="Numbers of a sweep, a bar for each case.")  # fmt: skip
@click.option("--envelope", is_flag=False, flag_value="forces", default="", metavar="[PATTERN,...]",
              help="Extremes over the cases of a sweep, and what acted then.")  # fmt: skip
@click.option("--at", default="", metavar="CHANNEL", help="Abscissa told by --envelope.")
@click.option("--with", "along", multiple=True, metavar="CHANNEL,...",
              help="What else --envelope tells.")  # fmt: skip
@click.option("--over", metavar="KEY", help="The swept key that figures of a sweep are over.")
@click.option("--units", multiple=True, metavar="'KIND: UNIT, ...'",
              help="Of figures and tables: 'angle: deg, speed: rpm'.")  # fmt: skip
@click.option("--format", "form", type=click.Choice(FORMATS), default="png", show_default=True,
              help="Of the figures.")  # fmt: skip
@click.option("--size", default="", metavar="WIDTHxHEIGHT", help="Of the figures, mm: 120x80.")
@click.option("--dpi", type=int, help="Dots per inch of the figures, 150 unless given.")
@click.option("--style", default="", metavar="slides|FILE.mplstyle", help="Of the figures.")
@click.option(
    "--paper", type=click.Choice(tuple(STUDIES)), help="Judge a published study by its sweep."
)
@click.option("--animate", is_flag=True, help="The motion of one run: animation.glb, .html.")
@click.option("--magnify-clearance", type=float, metavar="TIMES",
              help="How large --animate draws the play in bearings.")  # fmt: skip
@framed
def command(
    answer: Answer, runs: tuple[str, ...], output: str | None, paper: str | None, **options: Any
) -> None:
    """Draw the figures and tables of result files RUN, or of the folder of a sweep.

    Several runs are compared in the same figures.  With options only what they ask for is made;
    CHANNEL, SECTION and WORD may end in a window, @BEGIN..END in seconds or @stroke=BEGIN..END.
    With --paper RUN is the folder of a sweep: one page with the figures of a study and a verdict on
    each of its claims.  With --animate a page plays the motion of RUN.  Default output: the folder
    of the first result file, named after it; SWEEP/figures, or SWEEP/paper, of a sweep.
    """
    from trsim import report

    swept = os.path.isdir(runs[0])
    own = os.path.join(runs[0], "figures") if swept else os.path.splitext(runs[0])[0]
    folder = Path(output or own)
    animate, magnified = options.pop("animate"), options.pop("magnify_clearance")
    looks = Looks(**{name: options.pop(name) for name in Looks._fields})
    if (paper or animate) and looks != Looks():
        raise UsageError("--units, --format, --size, --dpi and --style are for figures of runs")
    if magnified is not None and not animate:
        raise UsageError("--magnify-clearance goes with --animate")
    if paper:
        folder = Path(output or os.path.join(runs[0], "paper"))
        written = judged(paper, runs, folder, options | {"animate": animate})
    elif animate:
        written = animated(answer, runs, folder, magnified, options)
    elif not swept and not any(options.values()):
        written = report.report(runs, folder, looks)
    else:
        from trsim.report.asked import Asked

        found = report.analysed(runs, folder, Asked(**options), looks)
        written = found.files
        for text in found.lines:
            answer.put(text)
        values = [one._asdict() for one in found.values]
        answer.data |= {"values": values, "told": found.lines}
    answer.data |= {"folder": str(folder), "files": [str(path) for path in written]}
    for path in written:
        answer.put(str(path))


def judged(word: str, sweeps: tuple[str, ...], folder: Path, options: dict[str, Any]) -> list[Path]:
    """The files of a published study, made from the folder of its sweep."""
    from trsim.studies.study import paper

    if len(sweeps) > 1:
        raise UsageError("--paper takes the folder of one sweep")
    if any(options.values()):
        raise UsageError("--paper goes with no other option than -o")
    return paper(load(word), sweeps[0], folder)


def animated(
    answer: Answer,
    runs: tuple[str, ...],
    folder: Path,
    magnified: float | None,
    options: dict[str, Any],
) -> list[Path]:
    """The animation of a run."""
    from trsim.report.animation import write

    if len(runs) > 1 or os.path.isdir(runs[0]):
        raise UsageError("--animate takes one result file")
    if any(options.values()):
        raise UsageError("--animate goes with no other option than -o and --magnify-clearance")
    written, warnings = write(runs[0], folder, 1.0 if magnified is None else magnified)
    for text in warnings:
        answer.warn(runs[0], text)
    return written
