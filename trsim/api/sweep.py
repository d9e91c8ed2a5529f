"""`sweep`: many runs of one scenario, side by side, and what came of them."""

import os
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict, Unpack

from trsim.api.compiling import compiling, warn_of_shared_code
from trsim.api.hearing import Listener
from trsim.api.running import placed
from trsim.api.source import Given, Sets, called, settings
from trsim.api.stop import listening
from trsim.errors import CasesFailed, Problems, TrsimError, UsageError, described, some
from trsim.scenario.vary import KEEP
from trsim.sweeps.go import Shard, differing, engine, go
from trsim.sweeps.ledger import Entry, counts, in_a_line
from trsim.sweeps.plan import Plan, faults, plan
from trsim.sweeps.slot import Limits, Slot
from trsim.system import LIMITS_MEMORY, processors

if TYPE_CHECKING:
    from trsim.api.study import Sweep

SHOWN = 10  # cases that are told one by one


class Options(TypedDict, total=False):
    """How the cases of a sweep are to be run.

    jobs        runs side by side; None: as many as there are processors
    shard       (2, 5): the second of five parts
    dask        address of a Dask scheduler whose workers run the cases
    time_limit  s of wall time for a case, 0: any
    memory      bytes for a case, 0: any
    retries     further attempts after the process of a case died
    keep        "all": the result file of every case; "summary": its numbers only; None: as the
                scenario says, or all of up to 200 cases and summaries of more
    """

    jobs: int | None
    shard: tuple[int, int]
    dask: str | None
    time_limit: float
    memory: int
    retries: int
    keep: str | None


class How(NamedTuple):
    """The same, with what was left out."""

    jobs: int | None = None
    shard: tuple[int, int] | None = None
    dask: str | None = None
    time_limit: float = 0.0
    memory: int = 0
    retries: int = 2
    keep: str | None = None


class Work(NamedTuple):
    """A sweep to be made."""

    planned: Plan
    folder: Path
    identity: str  # of the program that makes the runs
    how: How
    ended: Callable[[Any], None] = lambda _: None  # told of each case

    @property
    def part(self) -> Shard:
        return Shard(*self.how.shard) if self.how.shard else Shard()


class Made(NamedTuple):
    """How a sweep went."""

    ran: int
    counts: dict[str, int]  # status -> cases
    failed: CasesFailed | None
    told: tuple[str, ...]  # in a line each
    chosen: tuple[str, ...]  # of them, what decided which cases were run


def sweep(
    scenario: Given, output: Any = None, set: Sets | None = None, *, raises: bool = True,
    **options: Unpack[Options],
) -> "Sweep":  # fmt: skip
    """Run all cases of a scenario with a `sweep` or `cases`; what came of them.

    scenario  the name of a scenario file, or a dict
    output    folder of the sweep.  [default: runs/NAME]
    set       what is changed, and varied: {"joints.pin.clearance": "lin(0.1mm, 0.5mm, 9)"}
    raises    whether a case that fails is an error; the error has the sweep as `.result`
    options   see Options

    The same call again runs what is missing or changed, and nothing else.  Raises ScenarioError,
    CasesFailed, FileError, UsageError.
    """
    from trsim.api.study import Sweep

    hears, how = Listener(), sensible(How(**options))
    folder = Path(output or f"runs/{Path(called(scenario)).stem}")
    with listening():
        identity = engine()
        planned = keeping(planned_of(hears, scenario, settings(set), identity), how)
        work = Work(planned, folder, identity, how)
        ended = made(hears, work)
    found = Sweep(folder)
    if raises and ended.failed:
        ended.failed.result = found
        raise ended.failed
    return found


def sensible(how: How) -> How:
    """The same; raises UsageError where it makes no sense."""
    wrong = {
        "jobs": how.jobs is not None and how.jobs < 1,
        "shard": how.shard is not None and not 1 <= how.shard[0] <= how.shard[1],
        "time_limit": not 0.0 <= how.time_limit < float("inf"),
        "memory": how.memory < 0 or (how.memory > 0 and not LIMITS_MEMORY),
        "retries": not 0 <= how.retries <= 100,
        "keep": how.keep not in (None, *KEEP),
    }
    for name in (name for name, is_wrong in wrong.items() if is_wrong):
        hint = "`help(trsim.sweep)` says what it may be."
        if name == "memory" and not LIMITS_MEMORY:
            hint = "This system holds no process to an amount of memory."
        raise UsageError(f"`{name}` makes no sense: {getattr(how, name)!r}", hint)
    return how


def planned_of(hears: Listener, given: Given, sets: tuple[str, ...], identity: str) -> Plan:
    """The plan of a sweep, with every case checked."""
    name = called(given)
    with hears.doing(name) as doing:
        doing("making the cases")
        if isinstance(given, Mapping):
            from trsim.api.words import tree

            planned = plan(name, sets, identity, lambda _: tree(given, ()))
        elif isinstance(given, str | os.PathLike):
            planned = plan(name, sets, identity)
        else:
            what = f"a sweep is of a scenario file or a dict, not of {described(given)}"
            raise UsageError(what, "What `load` gave is one scenario; give what it was read from.")
        doing(f"checking {len(planned.cases)} cases")
        checked(planned)
    return planned


def keeping(planned: Plan, how: How) -> Plan:
    """The plan with what is to be kept of its cases."""
    return planned._replace(keep=how.keep, wished=True) if how.keep else planned


def checked(planned: Plan) -> None:
    """Refuse a sweep of which a case is no scenario, with all that is wrong, each told once."""
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


def assembled(hears: Listener, planned: Plan, part: Shard) -> None:
    """Assemble every case.  Raises what is wrong with the first that cannot be."""
    from trsim.assemble.assemble import assemble

    mine = planned.cases[part.i - 1 :: part.n]
    with hears.doing("assembling") as doing:
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
    hears.say(f"{len(mine)} cases are well formed and assemble")


@contextmanager
def runner(hears: Listener, work: Work) -> Iterator[Callable[[Any], Any]]:
    """What runs cases: processes of this machine, or the workers of a Dask scheduler.

    The processes stay from batch to batch.
    """
    how, limits = work.how, Limits(work.how.time_limit, work.how.memory, work.how.retries)
    slots: list[Slot] = []

    def run(tasks: Any) -> Any:
        if how.dask:
            from trsim.sweeps.dask import run as by_dask

            return by_dask(tasks, how.dask, limits)
        from trsim.sweeps import local

        alone = warming(hears, work.planned)
        return local.run(tasks, how.jobs or processors(), limits, alone, kept=slots)

    try:
        yield run
    finally:
        for slot in slots:
            slot.close()


def made(hears: Listener, work: Work) -> Made:
    """Run what is needed, and tell how it went."""
    from trsim.sweeps.folder import strays
    from trsim.sweeps.study import study

    planned, folder, part = work.planned, work.folder, work.part
    if part.n > 1 and (other := differing(planned, folder)):
        text = f"{other} cases of the plan that is there are not in this one: give all shards"
        hears.warn(str(folder), f"{text} the same scenario and the same --set")
    began = time.monotonic()
    n = run_cases(hears, work)
    found = study(folder)
    mine = found.cases[part.i - 1 :: part.n]
    counted = counts(case.status for case in mine)
    said = ", ".join(f"{k} {status}" for status, k in counted.items())
    wall = time.monotonic() - began
    told = [f"{folder}: {len(mine)} cases, {n} run in {wall:.1f} s: {said or 'none'}"]
    told += found.chosen
    if left := strays(folder, {*found.named}):
        told.append(f"note: of an earlier plan: {some(left, 3)} in {folder / 'cases'}")
    return Made(n, counted, failures(folder, mine), tuple(told), found.chosen)


def failures(folder: Path, mine: Any) -> CasesFailed | None:
    """What is told of the cases that failed; nothing where none did."""
    bad = [case for case in mine if case.failed]
    if not bad:
        return None
    told = (f"{c.name}: {c.status}: {in_a_line(c.reason)[:200]}" for c in bad)
    listed = some(told, SHOWN, "\n  ... and {} more", "\n  ")
    what = f"{len(bad)} of {len(mine)} cases failed"
    return CasesFailed(what, f"{listed}\n  All are in {folder / 'index.csv'}.", file=str(folder))


def run_cases(hears: Listener, work: Work) -> int:
    """Run what is needed; how many cases that were."""
    with runner(hears, work) as run:
        return _heard(hears, work, go(work.planned, work.folder, work.identity, run, work.part))


def _heard(hears: Listener, work: Work, going: Generator[Entry | int, None, None]) -> int:
    """Tell what comes of cases as they end; how many there were."""
    show, n = None, 0
    try:
        for one in going:
            if isinstance(one, int):  # of an adaptive sweep once for each batch
                if show is not None:
                    show.close()
                show = hears.cases(str(work.folder), one)
                continue
            n += 1
            work.ended(one)
            if one.failed:
                hears.say(f"{one.case}: {one.status}: {in_a_line(one.reason)[:300]}")
            assert show is not None  # noqa: S101
            show.ended(one)
        return n
    except KeyboardInterrupt:
        again = "the same command goes on with the sweep"
        raise KeyboardInterrupt(f"{work.folder / 'index.csv'} has what was done; {again}") from None
    finally:
        going.close()
        if show is not None:
            show.close()


def warming(hears: Listener, planned: Plan) -> bool:
    """Whether nothing was compiled on this machine yet; says so, and begins with it."""
    from trsim.assemble.equations import derivative

    warn_of_shared_code(hears)
    if derivative.file.exists():
        return False
    compiling(hears, planned.scenario(planned.cases[0]).solver.method)
    return True
