"""A process that runs cases, one after the other; begun by slot.py.

Tasks come as lines of JSON on standard input; for each it answers how the case ended, and before
that {"begun": true} once results arrive, where cases are timed.  It ends with the process that
began it, and takes no signal of a terminal: that process knows what to do.
"""

import gc
import json
import os
import signal
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

from trsim.system import end_with_parent, keep_memory, limit_memory

JOB = "trsim.sweeps.job:run"
TIMED = "timed"
MEMORY = "the memory allowed for a case may have been used up"


def main(memory: int, job: str, timed: bool) -> None:
    """Work until there are no more tasks.  timed: somebody waits for the first results."""
    end_with_parent()
    keep_memory()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8", newline="\n")
    os.dup2(2, 1)  # whatever else is printed is no reply
    module, _, name = job.partition(":")
    loaded = import_module(module)
    run: Callable[..., dict[str, Any]] = getattr(loaded, name)
    getattr(loaded, "prepare", lambda: None)()
    gc.freeze()  # what every case needs stays: nothing is found by looking it through for each
    gc.set_threshold(20_000)
    if memory:
        limit_memory(memory)

    def reply(told: dict[str, Any]) -> None:
        replies.write(json.dumps(told) + "\n")
        replies.flush()

    def begun() -> None:
        if timed:
            reply({"begun": True})

    for line in sys.stdin:
        task = json.loads(line)
        try:
            ended = run(task, begun)
        except MemoryError:
            reply({"status": "over memory", "reason": "the memory allowed for a case was used up"})
            os._exit(0)  # whatever was at work may be half done
        except Exception as error:
            told = f"error in trsim: {type(error).__name__}: {error}".splitlines()[0][:500]
            told += f"; {MEMORY}" if memory else ""
            ended = {"status": "crashed", "reason": told, "final": True}
        reply(ended)


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2], sys.argv[3:] == [TIMED])
