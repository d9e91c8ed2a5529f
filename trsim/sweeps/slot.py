"""A place where cases run, one at a time, in a process of their own.

A process that dies costs its case one attempt: the next attempt has a fresh process.
"""

import json
import os
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

from trsim import child
from trsim.sweeps.worker import JOB, MEMORY, TIMED

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
TAIL = 400  # characters of what a dead process said
Task = dict[str, Any]


class Limits(NamedTuple):
    """What a case may take."""

    time: float = 0.0  # s of wall time from the first results on; 0: any
    memory: int = 0  # bytes, beside those of a process at rest; 0: any
    retries: int = 2  # after a process died


class Message(NamedTuple):
    """A task, and the line that tells a process of it."""

    task: Task
    line: bytes

    @classmethod
    def of(cls, task: Task) -> "Message":
        return cls(task, json.dumps(task).encode() + b"\n")


ANY = Limits()


class Slot:
    """One process at a time; `run` is called by one thread, `kill` by any."""

    def __init__(self, limits: Limits, job: str = JOB) -> None:
        self.limits, self.job = limits, job
        self.process: subprocess.Popen[bytes] | None = None
        self.said: Any = None
        self.dead = False
        self.thread = ThreadPoolExecutor(1)  # for who calls `run` from many

    def run(self, message: Message, meanwhile: Callable[[], None] | None = None) -> dict[str, Any]:
        """How a case ended, with the number of attempts; meanwhile: called as one is at work."""
        attempts = 0
        while True:
            attempts += 1
            ended = self.attempt(message.line, meanwhile or (lambda: None))
            chance = ended["status"] == "crashed" and not ended.get("final")
            if not chance or self.dead or attempts > self.limits.retries:
                return {**ended, "attempts": attempts}

    def attempt(self, line: bytes, meanwhile: Callable[[], None]) -> dict[str, Any]:
        """One attempt in a process that is there, or a fresh one."""
        process = self.started()
        assert process.stdin and process.stdout  # noqa: S101
        late = threading.Event()
        watch: threading.Timer | None = None
        try:
            process.stdin.write(line)
            process.stdin.flush()
            meanwhile()
            for answer in process.stdout:
                told = json.loads(answer)
                if "begun" not in told:
                    return told
                if watch is None:
                    watch = threading.Timer(self.limits.time, _end, (process, late))
                    watch.daemon = True
                    watch.start()
        except (BrokenPipeError, ValueError):  # cut short: it died
            pass
        finally:
            if watch is not None:
                watch.cancel()
        return self.died(process, late.is_set())

    def died(self, process: "subprocess.Popen[bytes]", late: bool) -> dict[str, Any]:
        """What a process that gave no answer died of."""
        process.kill()
        code = process.wait()
        self.process = None
        if late:
            return {"status": "over time", "reason": f"not done after {self.limits.time:g} s"}
        self.said.seek(0)
        words = self.said.read().decode(errors="replace").strip()[-TAIL:].splitlines()
        how = f"by {signal.Signals(-code).name}" if code < 0 else f"with code {code}"
        told = f"its process was ended {how}" + (f": {words[-1]}" if words else "")
        if self.limits.memory:
            told += f"; {MEMORY}"
        return {"status": "crashed", "reason": told}

    def started(self) -> "subprocess.Popen[bytes]":
        """The process, made unless it is there."""
        if self.process is None or self.process.poll() is not None:
            self.let_go()
            timed = [TIMED] if self.limits.time else []
            command = child.command(
                "trsim.sweeps.worker", str(self.limits.memory), self.job, *timed
            )
            environment = {**os.environ, **dict.fromkeys(ONE_THREAD, "1")}
            self.said = tempfile.TemporaryFile()  # noqa: SIM115 - closed with the process
            self.process = subprocess.Popen(  # noqa: S603
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.said,
                env=environment, start_new_session=True,
            )  # fmt: skip
        return self.process

    def kill(self) -> None:
        """End the process, and take no more attempts."""
        self.dead = True
        process = self.process
        if process is not None:
            process.kill()

    def close(self) -> None:
        """Let process and thread end; no call of `run` follows."""
        self.thread.shutdown(wait=False)
        self.let_go()

    def let_go(self) -> None:
        """Let the process end."""
        process, self.process = self.process, None
        if process is not None:
            assert process.stdin and process.stdout  # noqa: S101
            for pipe in (process.stdin, process.stdout):
                pipe.close()
            process.wait()
        if self.said is not None:
            self.said.close()
            self.said = None


def _end(process: "subprocess.Popen[bytes]", late: threading.Event) -> None:
    late.set()
    process.kill()
