"""trsim bench: work against precision of a scenario, method by method."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import click

from trsim.api.given import chosen, known_method, seconds, tolerance
from trsim.api.running import placed
from trsim.api.source import loaded, stem
from trsim.api.stop import Stop, look
from trsim.cli.frame import NAMED, Answer, framed
from trsim.errors import ScenarioError, TrsimError
from trsim.scenario.methods import METHODS

MEASURED = "auto,dop853,radau"
NOT_TOLD = ("setting", "run", "rows")  # as such, of references and points
MARK = "<"  # beside an error that the reference does not resolve


@click.command("bench")
@click.argument("scenario", type=click.Path())
@click.option("--methods", default=MEASURED, metavar="A,B", help=f"[default: {MEASURED}]")
@click.option("--tolerances", metavar="X,Y", help="[default: 1e-3,1e-4 ... 1e-8]")
@click.option("--steps", metavar="X,Y", help="Of rk4.  [default: end/1000 ... end/30000]")
@click.option(
    "--reference", metavar="METHOD:TOL",
    help="[default: radau, or dop853 for radau alone, 100 times tighter than the tightest]",
)  # fmt: skip
@click.option(
    "--quantity", "quantities", multiple=True, metavar="CHANNEL",
    help="Name or pattern of channels compared; repeatable.  "
    "[default: sensors and their rates, or else positions of bodies]",
)  # fmt: skip
@click.option("--repeats", type=click.IntRange(min=1), default=3, show_default=True)
@click.option("--set", "sets", multiple=True, metavar="KEY=VALUE", help="Override a number.")
@click.option("-o", "--output", type=NAMED, help="Folder of the figure and the table.")
@framed
def command(answer: Answer, scenario: str, output: str | None, **options: Any) -> None:
    """Measure error and CPU time of methods and tolerances on SCENARIO.

    Writes work_precision.png and work_precision.csv into runs/NAME.bench, or the folder of -o.
    Errors are against a reference, whose own uncertainty is told.  Ctrl-C ends the measurement and
    keeps what was measured.
    """
    folder = Path(output or f"runs/{stem(scenario)}.bench")
    study = one(answer, scenario, folder, Options(**options))
    answer.data |= {"file": scenario, "folder": str(folder), **described(study)}
    for text in lines(study):
        answer.put(text)
    if study.points:
        from trsim.report.precision import draw

        written = draw(study, folder)
        answer.data["files"] = [str(path) for path in written]
        for path in written:
            answer.put(str(path))
    if Stop.number:
        raise KeyboardInterrupt


class Options(NamedTuple):
    """What is to be measured, as the command line says."""

    methods: str
    tolerances: str | None
    steps: str | None
    reference: str | None
    quantities: tuple[str, ...]
    repeats: int
    sets: tuple[str, ...]


def one(answer: Answer, source: str, folder: Path, given: Options) -> Any:
    """The study of a scenario; what was measured until a signal, if one came."""
    from trsim.api.compiling import compiling

    scenario = loaded(source, given.sets)
    if scenario.solver.end is None:
        what = "field required: end (s)"
        raise placed(ScenarioError(what, "Write for example `end: 1 s`.", ("solver",)), scenario)
    compiling(answer, "auto")
    from trsim.analyse import precision
    from trsim.report.precision import check_room

    named = [known_method(name) for name in given.methods.split(",")]
    tolerances: Sequence[float] = precision.TOLERANCES
    if given.tolerances:
        tolerances = [tolerance(text) for text in given.tolerances.split(",")]
    steps = [scenario.solver.end / n for n in precision.FIXED]
    if given.steps:
        steps = [seconds(text) for text in given.steps.split(",")]
    against = precision.reference_setting(named, tolerances)
    if given.reference:
        against = chosen(given.reference)
    check_room(folder)
    try:
        settings = precision.plan(named, tolerances, steps)
        return measured(answer, scenario, settings, against, given.quantities, given.repeats)
    except TrsimError as error:
        raise placed(error, scenario) from None


def measured(
    answer: Answer, scenario: Any, settings: list[Any], against: Any, quantities: tuple[str, ...],
    repeats: int,
) -> Any:  # fmt: skip
    """The study, told row by row while it grows; a signal ends it between two blocks of a run."""
    from trsim.analyse import precision
    from trsim.analyse.trajectory import problem

    of = problem(scenario, quantities)
    found: list[Any] = []
    Stop.patient = True
    try:
        reference = precision.reference(of, against, look)
        for setting in settings:
            point = precision.point(of, reference, setting, repeats, look)
            found.append(point)
            answer.say(f"{len(found)} of {len(settings)}: {row(point)}")
    except KeyboardInterrupt:
        if not found:
            raise
        answer.say(f"interrupted: {len(found)} of {len(settings)} settings were measured")
    finally:
        Stop.patient = False
    slopes = precision.slopes(found, reference)
    return precision.Study(scenario.title, reference, tuple(found), slopes)


# --- what is told ----------------------------------------------------------------------------


def described(study: Any) -> dict[str, Any]:
    """The study as a document."""
    r = study.reference
    return {
        "title": study.title,
        "reference": {
            "method": r.setting.method,
            "tolerance": r.setting.tolerance,
            **{key: value for key, value in vars(r).items() if key not in NOT_TOLD},
        },
        "points": [
            {
                **p.setting._asdict(),
                "status": "failed" if p.reason else "done",
                **{key: value for key, value in vars(p).items() if key not in NOT_TOLD},
            }
            for p in study.points
        ],
        "slopes": study.slopes,
        "files": [],
    }


def lines(study: Any) -> list[str]:
    """The table for a reader, and what is to be known about it."""
    r = study.reference
    first = f"reference  {r.setting.method}, tolerance {r.setting.tolerance:.0e}"
    out = [
        first
        + (
            f"; {r.second_method} failed: {r.second_failed}"
            if r.second_failed
            else f", beside {r.second_method}"
        )
    ]
    out.append(f"  uncertainty {size(r.uncertainty)}, of peaks {size(r.peak_uncertainty)}")
    out += [f"  compared    {', '.join(r.ranges)}"]
    out += [f"  left out    {', '.join(r.still)}: no motion"] if r.still else []
    if r.apart is not None:
        out.append(f"  from t = {r.apart:.6g} s on the two references differ by more than 1 %: "
                   "pointwise errors mean nothing there")  # fmt: skip
        out.append("  errors below are over the rows before that; compare the peaks")
    out += ["", HEAD, *map(row, study.points), ""]
    if any(p.unresolved or p.peak_unresolved for p in study.points):
        out.append(f"{MARK}: not above the uncertainty of the reference")
    of = "error" if r.apart is None else "peak error"
    for method, value in study.slopes.items():
        over = METHODS[method].control
        told = f"{value:.2f}" if value == value else "- (fewer than two resolved errors)"
        out.append(f"slope of {of} over {over}, {method}: {told}")
    return out


HEAD = (f"{'method':<18} {'tolerance':>9} {'step s':>9}   {'error':>8}    {'worst':>8}   "
        f"{'peaks':>8}     {'CPU ms':>9} {'steps':>8} {'evaluations':>11}")  # fmt: skip


def row(p: Any) -> str:
    """One line of the table."""
    setting = p.setting
    text = f"{setting.method:<18} {size(setting.tolerance):>9} {size(setting.step):>9}   "
    if p.reason:
        return f"{text}failed: {p.reason}"
    mark, peak_mark = (MARK if below else " " for below in (p.unresolved, p.peak_unresolved))
    return (f"{text}{size(p.error):>8} {mark}  {size(p.worst):>8}   {size(p.peak_error):>8} "
            f"{peak_mark}   {1e3 * p.cpu:9.3f} {p.steps:8d} {p.evaluations:11d}")  # fmt: skip


def size(value: float | None) -> str:
    return "-" if value is None or value != value else f"{value:.1e}"
