"""trsim run: simulate scenarios, each into its result file."""

from pathlib import Path
from typing import Any

import click

from trsim.api.source import same, stem
from trsim.cli.frame import NAMED, Answer, framed
from trsim.cli.redundancy import redundancy
from trsim.cli.resume import Seconds
from trsim.errors import TrsimError, UsageError
from trsim.statuses import ILL


@click.command("run")
@click.argument("scenarios", nargs=-1, required=True, type=click.Path())
@click.option("-o", "--output", type=NAMED, help="Result file; a folder for several.")
@click.option("--set", "sets", multiple=True, metavar="KEY=VALUE", help="Override a number.")
@click.option("--resume", is_flag=True, help="Go on where an interrupted or killed run was.")
@click.option(
    "--checkpoint", type=Seconds(min=0.0), metavar="SECONDS",
    help="Wall time between two checkpoints, 0 for none.  [default: 60]",
)  # fmt: skip
@click.option(
    "--certify", is_flag=True,
    help="Run a twin as well, by another method at a tighter tolerance, and say how both differ.",
)  # fmt: skip
@click.option("--certify-with", metavar="METHOD:TOL", help="The same, with this twin.")
@framed
def command(
    answer: Answer, scenarios: tuple[str, ...], output: str | None, certify: bool,
    certify_with: str | None, **options: Any,
) -> None:  # fmt: skip
    """Simulate SCENARIO files and write result files (HDF5).

    Default output: runs/NAME.h5.  A result file in place of a scenario runs its scenario again,
    into runs/NAME.again.h5.

    A run that was interrupted or killed leaves FILE.part and, every 60 s, FILE.checkpoint: the same
    command with --resume goes on there, and ends with the result of an unbroken run.

    `trsim run FOLDER CASE ...`, of a sweep that kept numbers only, runs these cases again and keeps
    their result files.

    With --certify the twin comes first, into FILE.twin.h5, and is removed when both are compared.
    """
    from trsim.api.run import failed, wanted

    answer.data["runs"] = []
    how = wanted(**options, certify=certify_with or certify, option="--certify-with")
    if (Path(scenarios[0]) / "plan.json").is_file():
        if output or how.sets or how.certify:
            what = f"{scenarios[0]} is the folder of a sweep, whose cases are run as they are"
            raise UsageError(what, "Leave out -o, --set and --certify.")
        cases(answer, Path(scenarios[0]), scenarios[1:], how)
        return
    for source, target in targets(scenarios, output):
        try:
            summary = one(answer, source, target, how)
        except TrsimError as error:
            answer.fail(error, about=source)
            continue
        answer.data["runs"].append(summary)
        answer.put(summary["file"])
        if summary["status"] in ILL:
            answer.fail(failed(source, summary), about=source)


def cases(answer: Answer, folder: Path, names: tuple[str, ...], how: Any) -> None:
    """Run cases of a sweep again."""
    from trsim.api.cases import again
    from trsim.api.run import failed

    if not names:
        hint = (
            f"Name cases of it: trsim run {folder} CASE.  {folder / 'index.csv'} has their names."
        )
        raise UsageError(f"{folder} is the folder of a sweep", hint)
    for summary in again(answer, folder, names, how):
        answer.say(line(summary))
        if summary.get("as_kept"):
            answer.say("its numbers are those that the sweep kept")
        answer.data["runs"].append(summary)
        answer.put(summary["file"])
        if summary["status"] in ILL:
            answer.fail(failed(summary["file"], summary), about=summary["file"])


def targets(scenarios: tuple[str, ...], output: str | None) -> list[tuple[str, Path]]:
    """Each scenario with the file its results go to."""
    folder = Path(output or "runs")
    single = output and len(scenarios) == 1 and not (output.endswith("/") or folder.is_dir())
    if single:
        return [(scenarios[0], folder)]
    found: dict[Path, str] = {}
    for source in scenarios:
        target = folder / f"{stem(source)}.h5"
        if target in found:
            what = f"{found[target]} and {source} would both be written to {target}"
            raise UsageError(what, "Run them one by one with -o.")
        found[target] = source
    return [(source, target) for target, source in found.items()]


def one(answer: Answer, source: str, target: Path, how: Any) -> dict[str, Any]:
    """Run one scenario; the summary of its result."""
    from trsim.api.run import Work, made

    summary = made(answer, Work(source, target, how))
    answer.say(line(summary))
    if not answer.quiet:
        from trsim.cli.solved import solved

        answer.say(f"{source}: {solved(summary)}")
    remark(answer, source, summary)
    if "certificate" in summary:
        from trsim.cli.certify import print_certificate

        print_certificate(answer, Path(summary["file"]), summary["certificate"])
    return summary


def remark(answer: Answer, source: str, summary: dict[str, Any]) -> None:
    """Say what is worth knowing of a result: doubts, redundancy, the same content as before."""
    for text in summary["warnings"]:
        answer.warn(source, text)
    if summary["redundant"]:
        answer.say(f"{source}: {redundancy(summary)}")
    numbers = summary["statistics"]
    if "inertia_ratio" in numbers:
        at = f"at t = {numbers['inertia_ratio_time']:.6g} s"
        answer.say(
            f"{source}: inertia ratio {numbers['inertia_ratio']:.3g} {at}: so much of the largest "
            "force of a drive would inertia change"
        )
    if "settled" in summary:
        answer.say(f"{source}: note: {summary['settled']}")
    for name, times in summary["fired"].items():
        if times == 0 and summary["status"] == "done":
            answer.say(f"{source}: note: the event '{name}' never happened")
    if (identical := same(source, summary)) is not None:
        summary["identical"] = identical
        answer.say(f"the content {'is identical to' if identical else 'differs from'} {source}")


def line(summary: dict[str, Any]) -> str:
    """The result in one line."""
    steps = summary["statistics"].get("steps", 0)
    why = f" ({summary['reason']})" if summary["reason"] else ""
    return (
        f"{summary['file']}: {summary['status']} at t = {summary['time']:.6g} s{why}, "
        f"{summary['rows']} rows, {steps} steps, {summary['events']} events"
    )
