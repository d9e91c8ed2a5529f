"""Cases side by side on this machine, each slot with a process of its own."""

import queue
import threading
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import wait
from typing import Any

from trsim.sweeps.slot import ANY, Limits, Message, Slot, Task
from trsim.sweeps.worker import JOB

LOOK = 0.2  # s between two looks for a signal


def run(
    tasks: Iterable[Task], jobs: int, limits: Limits = ANY, first_alone: bool = False,
    job: str = JOB, kept: list[Slot] | None = None,
) -> Iterator[tuple[Task, dict[str, Any]]]:  # fmt: skip
    """Each task with how it ended, as they end.

    first_alone: the others wait for the first one, which compiles what all need.  kept: slots of
    an earlier call for the same job, or none yet, whose processes stay for the next one; they are
    the caller's to close.  While processes work the next tasks are made, one for each of them, so
    that none waits for its next.  Ended early, by an exception or by closing the generator, it
    leaves no process behind.
    """
    turn, ahead = threading.Lock(), deque[Message]()
    ended: queue.SimpleQueue[Any] = queue.SimpleQueue()
    slots = [] if kept is None else kept
    slots += [Slot(limits, job) for _ in range(jobs - len(slots))]
    messages = map(Message.of, tasks)
    stop, warm = threading.Event(), threading.Event()

    def following() -> Message | None:
        with turn:
            return ahead.popleft() if ahead else next(messages, None)

    def meanwhile() -> None:
        with turn:
            if len(ahead) < len(slots) and (message := next(messages, None)):
                ahead.append(message)

    def work(slot: Slot, leads: bool) -> None:
        try:
            if not leads:
                warm.wait()
            while not stop.is_set() and (message := following()) is not None:
                ended.put((message.task, slot.run(message, meanwhile)))
                warm.set()
        except BaseException as error:  # told where the results are waited for
            ended.put(error)
        finally:
            warm.set()
            if kept is None:
                slot.close()
            ended.put(None)

    # its process ends with the thread that began it, so each slot has one that stays
    threads = [
        slot.thread.submit(work, slot, k == 0 or not first_alone) for k, slot in enumerate(slots)
    ]
    at_work = len(threads)
    try:
        while at_work:
            try:
                found = ended.get(timeout=LOOK)
            except queue.Empty:
                continue
            if isinstance(found, BaseException):
                raise found
            if found is None:
                at_work -= 1
            else:
                yield found
    finally:
        stop.set()
        warm.set()
        if at_work:
            for slot in slots:
                slot.kill()
        wait(threads)
