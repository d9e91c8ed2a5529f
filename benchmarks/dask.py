"""Sweeps on Dask: what a case takes beside its integration, one case a task and in batches.

Two worker processes of this machine, 10 ms of a pendulum, of which numbers are kept: there is
little to integrate, so what is left is processes and messages.  Wall time is that of both workers;
CPU time is that of all processes, with those of Dask.  Medians of rounds, in turn.  Hashes are
compared with those of a sweep without Dask.
"""

import os
import signal
import statistics
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import psutil
from distributed import LocalCluster

from benchmarks.measure import SCENARIOS
from trsim.scenario.vary import SUMMARY
from trsim.sweeps import dask, local
from trsim.sweeps.go import engine, go
from trsim.sweeps.ledger import entries
from trsim.sweeps.plan import Plan, plan
from trsim.sweeps.slot import ANY

SCENARIO = str(SCENARIOS / "gallery" / "pendulum.yaml")
SETS = ("bodies.rod.mass=lin(1 kg, 2 kg, 300)", "solver.end=10 ms", "output.every=1 ms")
WORKERS, ROUNDS = 2, 3
ALONE = dask.Pace(aim=0.0)
Ended = Iterator[tuple[dict[str, Any], dict[str, Any]]]


class Cost(NamedTuple):
    """Of a case, ms, and what came of all."""

    wall: float
    cpu: float
    contents: dict[str, str]


@contextmanager
def cluster() -> Iterator[LocalCluster]:
    """Two processes of one thread, with whatever Python finds trsim by."""
    with LocalCluster(
        n_workers=WORKERS, threads_per_worker=1, processes=True, dashboard_address=None
    ) as found:
        yield found


def cpu() -> float:
    """CPU seconds of this process and of all below it, also of those that were waited for."""
    me = psutil.Process()
    found = 0.0
    for process in (me, *me.children(recursive=True)):
        try:
            told = process.cpu_times()
        except psutil.NoSuchProcess:
            continue
        found += told.user + told.system + told.children_user + told.children_system
    return found


def cost(
    planned: Plan, run: Callable[[Iterable[dict[str, Any]]], Ended],
    ended: Callable[[int], None] = lambda n: None,
) -> Cost:  # fmt: skip
    """What the cases of a plan take; ended: told how many have ended, with each."""
    with TemporaryDirectory() as name:
        folder, n = Path(name) / "sweep", 0
        before, began = cpu(), time.perf_counter()
        for one in go(planned, folder, engine(), run):
            if not isinstance(one, int):
                n += 1
                ended(n)
        wall, used = time.perf_counter() - began, cpu() - before
        found = entries(folder).values()
        inside = sum(one.summary["integration_cpu"] for one in found)
        per = 1e3 / len(found)
        contents = {one.case: f"{one.status} {one.content}" for one in found}
        return Cost(per * (WORKERS * wall - inside), per * (used - inside), contents)


def main() -> None:
    planned = plan(SCENARIO, SETS, engine())._replace(keep=SUMMARY)
    with cluster() as found:
        ways: dict[str, Callable[[Any], Ended]] = {
            "without Dask": lambda tasks: local.run(tasks, WORKERS),
            "a task for each case": lambda tasks: dask.run(
                tasks, found.scheduler_address, ANY, pace=ALONE
            ),
            "in batches": lambda tasks: dask.run(tasks, found.scheduler_address, ANY),
        }
        for way in ways.values():  # processes of workers begin, and code is compiled
            cost(planned._replace(cases=planned.cases[:4]), way)
        rounds = [{name: cost(planned, way) for name, way in ways.items()} for _ in range(ROUNDS)]
        calm = rounds[0]["without Dask"].contents

        def killing(n: int) -> None:
            if n == len(planned.cases) // 2:
                nanny = next(iter(found.workers.values()))
                os.kill(nanny.process.process.pid, signal.SIGKILL)

        stormy = cost(planned, ways["in batches"], killing)
    print(f"| {len(planned.cases)} cases, {WORKERS} workers | ms of wall time a case |"
          " ms of CPU time a case | hashes |")  # fmt: skip
    print("|---|---|---|---|")
    for name in ways:
        told = [one[name] for one in rounds]
        wall, used = (
            statistics.median(each) for each in zip(*(one[:2] for one in told), strict=True)
        )
        print(
            f"| {name} | {wall:.0f} | {used:.0f} | {same([one.contents for one in told], calm)} |"
        )
    told = same([stormy.contents], calm)
    print(f"| in batches, one worker killed half way | {stormy.wall:.0f} | | {told} |")


def same(found: list[dict[str, str]], calm: dict[str, str]) -> str:
    """How many are those of a sweep without Dask."""
    n = min(sum(one.get(name) == told for name, told in calm.items()) for one in found)
    return f"{n} of {len(calm)} equal"


if __name__ == "__main__":
    main()
