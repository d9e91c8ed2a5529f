"""Cases side by side on this machine, each slot with a process of its own."""

import os
import queue
import threading
from collections.abc import Iterable, Iterator
from typing import Any

from trsim.sweep.slot import ANY, Limits, Slot
from trsim.sweep.worker import JOB

LOOK = 0.2  # s between two looks for a signal
Task = dict[str, Any]


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0))


def run(
    tasks: Iterable[Task], jobs: int, limits: Limits = ANY, first_alone: bool = False,
    job: str = JOB,
) -> Iterator[tuple[Task, dict[str, Any]]]:  # fmt: skip
    """Each task with how it ended, as they end.

    first_alone: the others wait for the first one, which compiles what all need.  Ended early, by
    an exception or by closing the generator, it leaves no process behind.
    """
    waiting: queue.SimpleQueue[Task] = queue.SimpleQueue()
    ended: queue.SimpleQueue[Any] = queue.SimpleQueue()
    expected = 0
    for task in tasks:
        waiting.put(task)
        expected += 1
    slots = [Slot(limits, job) for _ in range(min(jobs, max(expected, 1)))]
    stop, warm = threading.Event(), threading.Event()

    def work(slot: Slot, leads: bool) -> None:
        try:
            if not leads:
                warm.wait()
            while not stop.is_set():
                task = waiting.get_nowait()
                ended.put((task, slot.run(task)))
                warm.set()
        except queue.Empty:
            pass
        except BaseException as error:  # told where the results are waited for
            ended.put(error)
        finally:
            slot.close()

    threads = [
        threading.Thread(target=work, args=(slot, k == 0 or not first_alone), daemon=True)
        for k, slot in enumerate(slots)
    ]
    for thread in threads:
        thread.start()
    try:
        while expected:
            try:
                found = ended.get(timeout=LOOK)
            except queue.Empty:
                continue
            if isinstance(found, BaseException):
                raise found
            expected -= 1
            yield found
    finally:
        stop.set()
        warm.set()
        if expected:
            for slot in slots:
                slot.kill()
        for thread in threads:
            thread.join()
