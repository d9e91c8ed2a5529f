"""Jobs for workers that need no mechanism: a task says what is to become of it."""

import os
import signal
import time
from pathlib import Path


def run(task, begun):
    """Do what `task["do"]` says: end, die (always, or once), take long, or take memory."""
    begun()
    do, marks = task["do"], Path(task["marks"])
    (marks / f"{task['name']}.{os.getpid()}.{time.monotonic_ns()}").touch()
    first = sum(1 for _ in marks.glob(f"{task['name']}.*")) == 1
    if do == "die" or (do == "die once" and first):
        os.kill(os.getpid(), signal.SIGKILL)
    if do == "raise":
        raise ZeroDivisionError("division by zero")
    if do == "sleep":
        time.sleep(60.0)
    if do == "eat":
        return {"status": "done", "reason": str(len(bytearray(1 << 29)))}
    if do == "wait":
        return {"status": "done", "reason": " ".join(made_behind(marks, int(task["name"][1:])))}
    if do == "threads":
        return {"status": "done", "reason": os.environ["OPENBLAS_NUM_THREADS"]}
    if do == "print":
        print("this is no reply")
    return {"status": "done", "reason": ""}


def made_behind(marks, k):
    """Which tasks behind number k were made while it is run, waiting for one of them."""
    late = time.monotonic() + 20.0
    while not (marks / f"made{k + 1}").exists() and time.monotonic() < late:
        time.sleep(0.005)
    time.sleep(0.02)
    return [f"t{n}" for n in range(k + 1, k + 9) if (marks / f"made{n}").exists()]


def compiling(task, begun):
    """Need two compiled functions; whoever compiles one leaves a mark."""
    from trsim.elements import gravity, revolute
    from trsim.kernels import machine

    marks, original = Path(task["marks"]), machine.Compiled._compiled

    def marked(self):
        (marks / f"{self.python.__module__}.{self.__name__}.{os.getpid()}").touch()
        return original(self)

    machine.Compiled._compiled = marked
    for module in (gravity, revolute):
        next(iter(module.ELEMENT.kernels.values())).address()
    return {"status": "done", "reason": ""}
