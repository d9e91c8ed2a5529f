"""Cases on the workers of a Dask scheduler, which see the same folder as this machine.

Each thread of a worker runs its cases in a slot of its own (slot.py), so limits, retries and what a
case costs when it dies are those of a sweep on one machine; a worker that dies gives its cases to
the others, as often as cases are tried again.
"""

import threading
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import islice
from typing import Any

from trsim.errors import FileError, UsageError
from trsim.sweeps.slot import Limits, Slot
from trsim.sweeps.worker import JOB

CONNECTING = 10.0  # s
LOOK = 1.0  # s between two looks at what was lost
ENDED = ("finished", "error", "cancelled")
AHEAD = 4  # tasks a worker's thread may hold; the rest wait here
Task = dict[str, Any]

_here = threading.local()  # the slot of a thread of a worker


def attempt(task: Task, limits: tuple, job: str = JOB) -> dict[str, Any]:
    """Run a case on the worker that this is."""
    kept = getattr(_here, "slot", None)
    if kept is None or (kept.limits, kept.job) != (Limits(*limits), job):
        if kept is not None:
            kept.close()
        _here.slot = kept = Slot(Limits(*limits), job)
    return kept.run(task)


def run(
    tasks: Iterable[Task], address: str, limits: Limits, job: str = JOB
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
        threads = max(sum(client.nthreads().values()), 1)
        waiting, going = iter(tasks), {}  # future -> task

        def more(n: int) -> None:
            for task in islice(waiting, n):
                future = client.submit(
                    attempt, task, tuple(limits), job, pure=False, retries=limits.retries
                )
                going[future] = task

        more(AHEAD * threads)
        while going:
            with suppress(TimeoutError):
                wait(list(going), timeout=LOOK, return_when="FIRST_COMPLETED")
            # a result that was lost with its worker is made again: the future is pending then
            for future in [future for future in going if future.status in ENDED]:
                ended = _ended(future)
                if ended is not None:
                    yield going.pop(future), ended
                    more(1)


def _ended(future: Any) -> dict[str, Any] | None:
    """How a case ended; None where that was lost on the way."""
    if future.status == "finished":
        with suppress(Exception):
            told: dict[str, Any] = future.result(timeout=CONNECTING)
            return told
        return None
    return {"status": "crashed", "reason": _told(future)}


def _told(future: Any) -> str:
    """Why a case has no end of its own."""
    if future.status == "cancelled":
        return "the scheduler gave it up"
    error = future.exception()
    if type(error).__name__ == "KilledWorker":
        return "the workers that it was on died"
    return f"on a worker: {type(error).__name__}: {error}".splitlines()[0][:500]
