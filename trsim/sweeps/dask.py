"""Cases on the workers of a Dask scheduler, which see the same folder as this machine.

Each thread of a worker runs its cases in a slot of its own (slot.py), so limits, retries and what a
case costs when it dies are those of a sweep on one machine.  A task carries a batch of cases, as
many as take AIM at the pace of the last ones: what Dask takes for a task is then little beside
them.  A thread that was given too much hands the rest back.

The results of a batch come with its task: a worker that dies loses those of the batches it has, and
others run these again.  If workers die of a batch, its cases are sent one by one.
"""

import math
import statistics
import threading
import time
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import suppress
from itertools import islice
from typing import Any, NamedTuple

from trsim.errors import FileError, UsageError
from trsim.sweeps.slot import Limits, Message, Slot
from trsim.sweeps.worker import JOB

CONNECTING = 10.0  # s
LOOK = 1.0  # s between two looks at what was lost, and at who is there
ENDED = ("finished", "error", "cancelled")
AHEAD = 2  # batches for each thread: one is run, one is there when that has ended
AIM, ENOUGH = 1.5, 2.0  # s of work in a batch; s after which a thread begins no more of it
MOST = 100  # cases in a batch
RECENT = 15  # cases whose median says how long one takes: the first may have compiled
Task = dict[str, Any]
Batch = list[Task]

_here = threading.local()  # the slot of a thread of a worker


class Pace(NamedTuple):
    """How cases are put together."""

    aim: float = AIM
    enough: float = ENOUGH


PACE = Pace()


def attempt(
    batch: Batch, limits: tuple, job: str = JOB, enough: float = ENOUGH
) -> list[tuple[float, dict[str, Any]]]:
    """How the first cases of a batch ended on the worker that this is, and the seconds each took.

    One case at least; none is begun after `enough`.
    """
    kept = getattr(_here, "slot", None)
    if kept is None or (kept.limits, kept.job) != (Limits(*limits), job):
        if kept is not None:
            kept.close()
        _here.slot = kept = Slot(Limits(*limits), job)
    found, began = [], time.monotonic()
    for task in batch:
        at = time.monotonic()
        ended = kept.run(Message.of(task))
        now = time.monotonic()
        found.append((now - at, ended))
        if now - began > enough:
            break
    return found


class Batches:
    """What is still to be sent, in batches."""

    def __init__(self, tasks: Iterable[Task], aim: float) -> None:
        self.tasks, self.aim = iter(tasks), aim
        self.ready: deque[Task] = deque()  # a few more than are sent next, to see the end come
        self.again: deque[Batch] = deque()  # handed back, or lost
        self.took: deque[float] = deque(maxlen=RECENT)

    def following(self, places: int) -> Batch:
        """The next one; places: batches that are sent at a time.  Empty if nothing is left.

        Towards the end batches are smaller, so that all threads end at about the same time.
        """
        if self.again:
            return self.again.popleft()
        one = statistics.median(self.took) if self.took else math.inf  # the first go alone
        size = MOST if one * MOST <= self.aim else max(1, int(self.aim / one))
        self.ready.extend(islice(self.tasks, max(size * places - len(self.ready), 0)))
        size = min(size, math.ceil(len(self.ready) / places))
        return [self.ready.popleft() for _ in range(size)]

    def ended(self, batch: Batch, found: list[tuple[float, Any]]) -> None:
        """The first cases of a batch ended."""
        self.took.extend(seconds for seconds, _ in found)
        if rest := batch[len(found) :]:
            self.again.append(rest)


def run(
    tasks: Iterable[Task], address: str, limits: Limits, job: str = JOB, pace: Pace = PACE
) -> Iterator[tuple[Task, dict[str, Any]]]:
    """Each task with how it ended, as they end.

    Raises UsageError where Dask is not installed, FileError where the scheduler does not answer.
    """
    try:
        from distributed import Client, wait
    except ImportError:
        hint = "`pip install trsim[dask]` installs it."
        raise UsageError("--dask needs the package distributed", hint) from None
    try:
        client = Client(address, timeout=CONNECTING)
    except (OSError, ValueError, TypeError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        hint = "`dask scheduler` prints its address: tcp://HOST:PORT."
        raise FileError(f"no Dask scheduler at {address}: {reason}", hint) from None
    with client:
        batches, going, places = Batches(tasks, pace.aim), dict[Any, Batch](), AHEAD

        def more() -> None:
            while len(going) < places and (batch := batches.following(places)):
                future = client.submit(
                    attempt, batch, tuple(limits), job, pace.enough,
                    pure=False, retries=limits.retries,
                )  # fmt: skip
                going[future] = batch

        while client.status == "running":
            with suppress(OSError):  # workers come and go
                places = AHEAD * max(sum(client.nthreads().values()), 1)
            more()
            if not going:
                return
            with suppress(TimeoutError, CancelledError):
                wait(list(going), timeout=LOOK, return_when="FIRST_COMPLETED")
            told: list[tuple[Task, dict[str, Any]]] = []
            # a result that was lost with its worker is made again: the future is pending then
            for future in [future for future in going if future.status in ENDED]:
                ended = _ended(future)
                if ended is not None and client.status == "running":
                    told += _told(going.pop(future), ended, batches)
            if client.status == "running":
                more()  # before whoever waits for results is at work with them
            yield from told
        hint = "The same command goes on with the sweep."
        raise FileError(f"the Dask scheduler at {address} is gone", hint)


def _told(batch: Batch, ended: Any, batches: Batches) -> list[tuple[Task, dict[str, Any]]]:
    """The cases of a batch that have ended; the others are sent again."""
    if not isinstance(ended, str):
        batches.ended(batch, ended)
        return [(task, how) for task, (_, how) in zip(batch, ended, strict=False)]
    if len(batch) == 1:
        return [(batch[0], {"status": "crashed", "reason": ended})]
    batches.again.extend([task] for task in batch)  # it may be one of them that workers die of
    return []


def _ended(future: Any) -> list[tuple[float, dict[str, Any]]] | str | None:
    """How cases ended, or why they have no end; None where that was lost on the way."""
    if future.status == "finished":
        with suppress(Exception):
            told: list[tuple[float, dict[str, Any]]] = future.result(timeout=CONNECTING)
            return told
        return None
    if future.status == "cancelled":
        return "the scheduler gave it up"
    error = future.exception()
    if type(error).__name__ == "KilledWorker":
        return "the workers that it was on died"
    return f"on a worker: {type(error).__name__}: {error}".splitlines()[0][:500]
