"""trsim sweep: many runs of one scenario, side by side."""

import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import click

from trsim.cli.frame import NAMED, Answer, framed
from trsim.cli.progress import Cases, Doing
from trsim.cli.resume import Seconds
from trsim.errors import CasesFailed, Problems, TrsimError, some
from trsim.system import LIMITS_MEMORY, processors

SHOWN = 10  # cases that are told one by one
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


class Wanted(NamedTuple):
    """How the cases of a sweep are to be run, as the command line says."""

    dry_run: bool
    explain: bool
    jobs: int | None
    shard: tuple[int, int] | None
    address: str | None  # of a Dask scheduler
    time_limit: float  # s of wall time for a case, 0: any
    memory: int  # bytes for a case, 0: any
    retries: int


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
@click.option(
    "--dask", "address", metavar="ADDRESS", help="Run on the workers of a Dask scheduler."
)
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
@framed
def command(
    answer: Answer, scenario: str, output: str | None, sets: tuple[str, ...], **options: Any
) -> None:
    """Run all cases of a SCENARIO with a `sweep:` or `cases:` block, or with --set KEY=[...].

    Writes FOLDER/cases/NAME.h5, a result file for each case, and FOLDER/index.csv, one row for
    each.  The same command again runs what is missing or changed, and nothing else.
    """
    from trsim.sweeps.go import Shard, engine, needs
    from trsim.sweeps.plan import plan
    from trsim.sweeps.slot import Limits

    wanted, identity = Wanted(**options), engine()
    with Doing(answer, scenario) as doing:
        doing("making the cases")
        planned = plan(scenario, sets, identity)
        doing(f"checking {len(planned.cases)} cases")
        checked(planned)
    folder = Path(output or f"runs/{Path(scenario).stem}")
    part = Shard(*wanted.shard) if wanted.shard else Shard()
    answer.data |= {"folder": str(folder), "cases": len(planned.cases), "ran": 0, "counts": {}}
    if wanted.explain or wanted.dry_run:
        told = needs(planned, folder, identity, part)
        reasons(answer, planned, folder, told, wanted.explain)
    if wanted.dry_run:
        assembled(answer, planned, part)
        return
    limits = Limits(wanted.time_limit, wanted.memory, wanted.retries)
    run = runner(answer, planned, limits, wanted.jobs, wanted.address)
    ran(answer, planned, folder, identity, part, run)


def checked(planned: Any) -> None:
    """Refuse a sweep of which a case is no scenario, with all that is wrong, each told once."""
    from trsim.sweeps.plan import faults

    found: dict[str, TrsimError] = {}
    for case, error in faults(planned):
        for problem in error.problems:
            shown = problem.show()
            if shown not in found and len(found) < SHOWN:
                problem.hint = f"{problem.hint}\n  Case: {case.name}".strip()
                found[shown] = problem
        if len(found) >= SHOWN:
            break
    unique = {(p.what, p.path, p.place): p for p in found.values()}
    if len(unique) == 1:
        raise next(iter(unique.values()))
    if unique:
        raise Problems(list(unique.values()))


def reasons(answer: Answer, planned: Any, folder: Path, told: Any, each: bool) -> None:
    """Say what would be run, and why."""
    from trsim.sweeps.needed import explained

    wanted = [(case, need) for case, need in told if need.why]
    answer.data["needed"] = [
        {"case": case.name, "why": explained(planned, case, need, folder)} for case, need in wanted
    ]
    if each:
        for one in answer.data["needed"]:
            answer.put(f"{one['case']}: {one['why']}")
    answer.say(f"{len(wanted)} of {len(told)} cases are to be run")


def assembled(answer: Answer, planned: Any, part: Any) -> None:
    """Assemble every case.  Raises what is wrong with the first that cannot be."""
    from trsim.assemble.assemble import assemble
    from trsim.cli.running import placed

    mine = planned.cases[part.i - 1 :: part.n]
    with Doing(answer, "assembling") as doing:
        for k, case in enumerate(mine):
            scenario = planned.scenario(case)
            try:
                assemble(scenario)
            except TrsimError as error:
                told = placed(error, scenario)
                for problem in told.problems:
                    problem.hint = f"{problem.hint}\n  Case: {case.name}".strip()
                raise told from None
            if k % 500 == 499:
                doing(f"{k + 1} of {len(mine)} cases")
    answer.say(f"{len(mine)} cases are well formed and assemble")


def runner(
    answer: Answer, planned: Any, limits: Any, jobs: int | None, address: str | None
) -> Callable[[Any], Any]:
    """What runs cases: processes of this machine, or the workers of a Dask scheduler."""

    def run(tasks: Any) -> Any:
        if address:
            from trsim.sweeps.dask import run as by_dask

            return by_dask(tasks, address, limits)
        from trsim.sweeps import local

        return local.run(tasks, jobs or processors(), limits, warming(answer, planned))

    return run


def ran(
    answer: Answer, planned: Any, folder: Path, identity: str, part: Any, run: Callable[[Any], Any]
) -> None:
    """Run what is needed, and tell how it went."""
    from trsim.sweeps.folder import strays
    from trsim.sweeps.go import differing, go
    from trsim.sweeps.ledger import counts, in_a_line

    if part.n > 1 and (other := differing(planned, folder)):
        text = f"{other} cases of the plan that is there are not in this one: give all shards"
        answer.warn(str(folder), f"{text} the same scenario and the same --set")
    going = go(planned, folder, identity, run, part)
    show, began = None, time.monotonic()
    try:
        for one in going:
            if isinstance(one, int):
                show = Cases(answer, str(folder), one)
                continue
            answer.data["ran"] += 1
            if one.failed:
                answer.say(f"{one.case}: {one.status}: {in_a_line(one.reason)[:300]}")
            assert show is not None  # noqa: S101
            show.ended(one)
    except KeyboardInterrupt:
        again = "the same command goes on with the sweep"
        raise KeyboardInterrupt(f"{folder / 'index.csv'} has what was done; {again}") from None
    finally:
        going.close()
        if show is not None:
            show.close()
    from trsim.sweeps.study import study

    found = study(folder)
    mine = found.cases[part.i - 1 :: part.n]
    answer.data["counts"] = counts(case.status for case in mine)
    answer.put(str(folder / "index.csv"))
    said = ", ".join(f"{n} {status}" for status, n in answer.data["counts"].items())
    wall = time.monotonic() - began
    answer.say(
        f"{folder}: {len(mine)} cases, {answer.data['ran']} run in {wall:.1f} s: {said or 'none'}"
    )
    if left := strays(folder, set(found.named)):
        answer.say(f"note: of an earlier plan: {some(left, 3)} in {folder / 'cases'}")
    bad = [case for case in mine if case.failed]
    if bad:
        told = (f"{c.name}: {c.status}: {in_a_line(c.reason)[:200]}" for c in bad)
        listed = some(told, SHOWN, "\n  ... and {} more", "\n  ")
        what = f"{len(bad)} of {len(mine)} cases failed"
        hint = f"{listed}\n  All are in {folder / 'index.csv'}."
        answer.fail(CasesFailed(what, hint), str(folder))


def warming(answer: Answer, planned: Any) -> bool:
    """Whether nothing was compiled on this machine yet; says so, and begins with it."""
    from trsim.assemble.equations import derivative
    from trsim.cli.progress import compiling, warn_of_shared_code

    warn_of_shared_code(answer)
    if derivative.file.exists():
        return False
    compiling(answer, planned.scenario(planned.cases[0]).solver.method)
    return True
