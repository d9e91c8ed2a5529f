"""Measurements in turn: whatever else the machine does meets all trees alike."""

import json
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from math import comb
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, TypeVar

from benchmarks.trees import Refused, Tree

WORKER = Path(__file__).with_name("worker.py")
TOGETHER = 2  # rounds of one process of each tree: where it lies in memory changes its speed
LEAST = 0.03  # s of CPU of one measurement: shorter ones are repeated
TURN = 2.0  # s that a whole command works before another one does
CERTAIN = 6  # so many measurements have an interval of 95 %
T = TypeVar("T")
Ask = Callable[[int, int], Any]  # which task, how many times -> the answer
Task = tuple[str, dict[str, Any]]  # how it is done, and what that takes (worker.py)


def turns(calls: Sequence[Callable[[], T]], rounds: int) -> list[list[T]]:
    """What each gives in every round; each begins a round in its turn."""
    found: list[list[T]] = [[] for _ in calls]
    for k in range(rounds):
        for j in range(len(calls)):
            at = (j + k) % len(calls)
            found[at].append(calls[at]())
    return found


@contextmanager
def worker(tree: Tree, tasks: Sequence[Task]) -> Iterator[Ask]:
    """A process of a tree that does tasks when it is asked to."""
    process = subprocess.Popen(  # noqa: S603
        [tree.python, "-P", str(WORKER)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        text=True, cwd=tree.folder, env=tree.environment,
    )  # fmt: skip
    to, back = process.stdin, process.stdout
    assert to is not None and back is not None

    def say(what: Any) -> Any:
        try:
            to.write(json.dumps(what) + "\n")
            to.flush()
            return json.loads(back.readline())
        except (BrokenPipeError, json.JSONDecodeError) as error:
            raise Refused(tree, "its process ended, see above") from error

    try:
        if not Path(found := say(tasks)).is_relative_to(tree.folder):
            raise RuntimeError(f"{tree.name}: trsim is that of {found}")
        yield lambda task, times: say([task, times])
    finally:
        with suppress(BrokenPipeError):
            to.close()
        process.wait()


def measured(
    trees: Sequence[Tree], tasks: Sequence[Sequence[Task]], rounds: int, beside: Sequence[Ask] = ()
) -> list[list[list[Any]]]:
    """Answers of tasks that tell CPU s: found[tree][task][round].

    tasks: of each tree its own, as many.  beside: asked in the same turns, after the trees.
    """
    found: list[list[list[Any]]] = [[[] for _ in tasks[0]] for _ in (*trees, *beside)]
    for first in range(0, rounds, TOGETHER):
        with ExitStack() as stack:
            asks = [stack.enter_context(worker(*pair)) for pair in zip(trees, tasks, strict=True)]
            asks += beside
            times = [often(asks, k) for k in range(len(tasks[0]))]
            for _ in range(min(TOGETHER, rounds - first)):
                for k, n in enumerate(times):
                    done = len(found[0][k])
                    order = [(j + done) % len(asks) for j in range(len(asks))]
                    for j in order:
                        found[j][k].append(asks[j](k, n))
    return found


def often(asks: Sequence[Ask], task: int) -> int:
    """How many times a task is done at once; what is loaded or compiled once is so after this."""
    for ask in asks:
        ask(task, 1)
    return max(1, round(LEAST / min(ask(task, 1)[0] for ask in asks)))


class Command:
    """A command with its processes, which works only in its turns; wall and CPU s of these."""

    def __init__(self, tree: Tree, words: Sequence[str]) -> None:
        self.tree, self.words = tree, words
        self.wall = self.cpu = 0.0
        self.said = ""
        self.done = False
        self._process: subprocess.Popen | None = None
        self._folder = TemporaryDirectory()
        self._out = Path(self._folder.name) / "out.txt"

    def turn(self, seconds: float | None) -> None:
        """Go on for so long, or to the end."""
        before, began = children(), time.perf_counter()
        if self._process is None:
            with self._out.open("wb") as out:
                self._process = subprocess.Popen(  # noqa: S603
                    self.words, stdout=out, start_new_session=True, env=self.tree.environment
                )
        else:
            os.killpg(self._process.pid, signal.SIGCONT)
        try:
            code = self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGSTOP)
            self.wall += time.perf_counter() - began
            return
        self.wall += time.perf_counter() - began
        self.cpu, self.done = children() - before, True
        self.said = self.printed()
        if code:
            raise Refused(self.tree, f"exit code {code} of {' '.join(self.words)}")

    def printed(self) -> str:
        """What it has printed so far."""
        return self._out.read_text(encoding="utf-8")

    def close(self) -> None:
        """End it where it is."""
        if self._process is not None and not self.done:
            with suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        self._folder.cleanup()


def commands(each: Sequence[tuple[Tree, Sequence[str]]]) -> list[Command]:
    """Whole commands of minutes, side by side: one works, the others stand still.

    Where processes cannot be held (Windows), one after the other.
    """
    long = TURN if hasattr(signal, "SIGSTOP") and len(each) > 1 else None
    with ExitStack() as stack:
        all_of = [Command(*one) for one in each]
        for one in all_of:
            stack.callback(one.close)
        while left := [one for one in all_of if not one.done]:
            for one in left:
                one.turn(long if len(left) > 1 else None)
    return all_of


def children() -> float:
    """CPU time of the processes that have ended, s."""
    times = os.times()
    return times.children_user + times.children_system


def interval(ratios: Sequence[float]) -> tuple[float, float]:
    """Bounds of the median at 95 %: the k-th smallest and largest.

    k is the largest with P(Binomial(n, 1/2) < k) <= 2.5 %, so that nothing is assumed of how they
    are distributed.
    """
    n, k, below = len(ratios), 0, 0.0
    while below + comb(n, k) / 2**n <= 0.025:
        below += comb(n, k) / 2**n
        k += 1
    ordered = sorted(ratios)
    return ordered[max(k - 1, 0)], ordered[min(n - k, n - 1)]


def ratio(first: Sequence[float], second: Sequence[float]) -> tuple[str, str]:
    """How much the second is of the first: the median of each pair's, and its 95 % interval."""
    return told([two / one for one, two in zip(first, second, strict=True)])


def told(ratios: Sequence[float]) -> tuple[str, str]:
    """The median and its interval, where there are enough for one."""
    low, high = interval(ratios)
    around = f"{low:.3f}..{high:.3f}" if len(ratios) >= CERTAIN else ""
    return f"{median(ratios):.3f}", around
