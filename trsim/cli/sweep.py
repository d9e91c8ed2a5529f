"""trsim sweep: many runs of one scenario, side by side."""

import re
from pathlib import Path
from typing import Any

import click

from trsim.cli.frame import NAMED, Answer, framed
from trsim.cli.resume import Seconds
from trsim.scenario.vary import KEEP, SUMMARY
from trsim.system import LIMITS_MEMORY

BYTES = {"": 1, "b": 1}  # and kb, mb, gb, kib, mib, gib
BYTES |= {f"{letter}b": 1000**k for k, letter in enumerate("kmg", 1)}
BYTES |= {f"{letter}ib": 1024**k for k, letter in enumerate("kmg", 1)}


class Bytes(click.ParamType):
    """An amount of memory: 2 GB, 500MB, 1.5 GiB."""

    name = "size"

    def convert(self, value: Any, param: Any, ctx: Any) -> int:
        if isinstance(value, int):
            return value
        if not LIMITS_MEMORY:
            self.fail("this system holds no process to an amount of memory.", param, ctx)
        match = re.fullmatch(r"\s*([0-9]+(?:\.[0-9]+)?)\s*([kmg]?i?b?)\s*", value.lower())
        if not match or match[2] not in BYTES or not float(match[1]) > 0.0:
            self.fail(f"{value} is no amount of memory: write 2 GB, or 500 MB.", param, ctx)
        return int(float(match[1]) * BYTES[match[2]])


class Share(click.ParamType):
    """One of n parts: 2/5."""

    name = "i/n"

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        if isinstance(value, tuple):
            return value
        match = re.fullmatch(r"([0-9]{1,6})/([0-9]{1,6})", value)
        if not match:
            self.fail(f"{value} is no share: write 1/3 for the first of three.", param, ctx)
        i, n = int(match[1]), int(match[2])
        if not 1 <= i <= n:
            self.fail(f"{value}: the first of {n} shares is 1/{n}, the last {n}/{n}.", param, ctx)
        return i, n


@click.command("sweep")
@click.argument("scenario", type=click.Path())
@click.option("-o", "--output", type=NAMED, help="Folder of the sweep.  [default: runs/NAME]")
@click.option(
    "--set", "sets", multiple=True, metavar="KEY=VALUE",
    help="Override a number; [a, b] or lin(a, b, n) varies it.",
)  # fmt: skip
@click.option("--dry-run", is_flag=True, help="Check every case, run none.")
@click.option("--explain", is_flag=True, help="Say of every case whether it is run, and why.")
@click.option(
    "-j", "--jobs", type=click.IntRange(min=1), help="Runs side by side.  [default: processors]"
)
@click.option(
    "--shard", type=Share(), default=None, metavar="I/N", help="Run this share of the cases."
)
@click.option("--dask", metavar="ADDRESS", help="Run on the workers of a Dask scheduler.")
@click.option(
    "--time-limit", type=Seconds(min=0.0), default=0.0, metavar="SECONDS",
    help="Wall time a case may take.  [default: any]",
)  # fmt: skip
@click.option(
    "--memory", type=Bytes(), default=0, metavar="SIZE", help="Memory a case may take: 2 GB."
)
@click.option(
    "--retries", type=click.IntRange(min=0, max=100), default=2, show_default=True,
    help="Further attempts after the process of a case died.",
)  # fmt: skip
@click.option(
    "--keep", type=click.Choice(KEEP),
    help="Keep every result file, or numbers only.  [default: as the scenario says; else all "
    "of up to 200 cases]",
)  # fmt: skip
@framed
def command(
    answer: Answer, scenario: str, output: str | None, sets: tuple[str, ...], **options: Any
) -> None:
    """Run all cases of a SCENARIO with a `sweep:` or `cases:` block, or with --set KEY=[...].

    Writes FOLDER/cases/NAME.h5, a result file for each case, and FOLDER/index.csv, one row for
    each.  With `until` or `refine` in the `sweep:` only the cases that are needed run.  With
    --keep summary FOLDER/summaries.jsonl.gz takes the place of the result files, with
    20 to 100 kB a case.  The same command again runs what is missing or changed, and nothing else.
    """
    from trsim.api.sweep import How, Work, assembled, keeping, made, planned_of
    from trsim.sweeps.go import engine

    dry_run, explain = options.pop("dry_run"), options.pop("explain")
    identity = engine()
    how = How(**options)
    planned = keeping(planned_of(answer, scenario, sets, identity), how)
    folder = Path(output or f"runs/{Path(scenario).stem}")
    if planned.keep == SUMMARY and not planned.wished:
        answer.say(f"of {len(planned.cases):,} cases the numbers are kept; "
                   "`--keep all` keeps their result files")  # fmt: skip
    answer.data |= {"folder": str(folder), "cases": len(planned.cases), "ran": 0, "counts": {},
                    "chosen": []}  # fmt: skip

    def counted(_: Any) -> None:
        answer.data["ran"] += 1

    work = Work(planned, folder, identity, how, counted)
    if explain or dry_run:
        reasons(answer, work, explain)
    if dry_run:
        assembled(answer, planned, work.part)
        return
    ended = made(answer, work)
    answer.data |= {"counts": ended.counts, "chosen": list(ended.chosen)}
    answer.put(str(folder / "index.csv"))
    for text in ended.told:
        answer.say(text)
    if ended.failed:
        answer.fail(ended.failed)


def reasons(answer: Answer, work: Any, each: bool) -> None:
    """Say what would be run, and why."""
    from trsim.sweeps.adaptive import check_whole
    from trsim.sweeps.go import needs
    from trsim.sweeps.needed import explained

    planned, folder = work.planned, work.folder
    check_whole(planned, work.part.n)
    told = needs(planned, folder, work.identity, work.part)
    wanted = [(case, need) for case, need in told if need.why]
    answer.data["needed"] = [
        {"case": case.name, "why": explained(planned, case, need, folder)} for case, need in wanted
    ]
    if each:
        for one in answer.data["needed"]:
            answer.put(f"{one['case']}: {one['why']}")
    most = "at most " if planned.adaptive else ""
    answer.say(f"{most}{len(wanted)} of {len(told)} cases are to be run")
