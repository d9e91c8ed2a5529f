"""What a tree of trsim does when it is asked to: a process of that tree.

    PYTHONPATH=TREE python -P worker.py

The first line it reads is a list of tasks, each with how it is done and what that takes; it answers
where trsim was found.  Each line after that is the place of a task and how many times it is to be
done; the answer is what one time takes, or gives.  All lines are JSON.

Older trees are asked too, so little of trsim is used, by its older name where it has one.
"""

import json
import sys
import time
import warnings
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

Task = Callable[[int], Any]  # how many times -> the answer
COUNTS = ("steps", "rejected_steps", "evaluations")


def read(source: str, sets: list[str]) -> Any:
    """The scenario of a file, or of a text."""
    try:
        of = import_module("trsim.scenario.load")
    except ModuleNotFoundError:  # as it was called in trees before November 2026
        of = import_module("trsim.spec.load")
    return of.loads(source, sets) if "\n" in source else of.load(Path(source), sets)


def assembled(source: str, runs: list[list[str]]) -> list[tuple[Any, Any]]:
    """Scenario and mechanism of each run."""
    from trsim.assemble.assemble import assemble

    scenarios = [read(source, sets) for sets in runs]
    return [(scenario, assemble(scenario)) for scenario in scenarios]


def integrated(source: str, runs: list[list[str]]) -> Task:
    """CPU time of the integrations of some runs together, s, and counts, means of them."""
    from trsim.analyse.trajectory import marched

    ready = assembled(source, runs)

    def task(times: int) -> tuple[float, dict[str, float]]:
        total, counts = 0.0, dict.fromkeys(COUNTS, 0.0)
        for _ in range(times):
            for scenario, mechanism in ready:
                numbers = marched(scenario, mechanism)[1].statistics
                total += numbers["integration_cpu"]
                for k in counts:
                    counts[k] += numbers[k]
        n = times * len(ready)
        return total / times, {k: count / n for k, count in counts.items()}

    return task


def whole(source: str, sets: list[str]) -> Task:
    """CPU time of a run from the scenario as read to its result, s."""
    import trsim

    scenario = read(source, sets)

    def task(times: int) -> tuple[float, dict[str, float]]:
        began = time.process_time()
        for _ in range(times):
            trsim.run(scenario)
        return (time.process_time() - began) / times, {}

    return task


def off(source: str, runs: list[list[str]], channel: str, known: list[list[float]]) -> Task:
    """Of each run: how far a channel is off what is known of it at some times, and evaluations."""
    import numpy as np

    from trsim.analyse.trajectory import marched

    ready, (t, right) = assembled(source, runs), known

    def task(_: int) -> list[tuple[float, int]]:
        found = []
        for scenario, mechanism in ready:
            rows, outcome = marched(scenario, mechanism)
            at = next(c.start for c in mechanism.columns if c.name == channel)
            away = np.abs(np.interp(t, rows[:, 0], rows[:, 1 + at]) - right).max()
            found.append((float(away), outcome.statistics["evaluations"]))
        return found

    return task


HOW = {"integrated": integrated, "whole": whole, "off": off}


def main() -> None:
    warnings.simplefilter("ignore")  # of what the scenario records
    tasks = [HOW[how](**of) for how, of in json.loads(sys.stdin.readline())]
    found = import_module("trsim").__file__
    print(json.dumps(found), flush=True)
    for line in sys.stdin:
        k, times = json.loads(line)
        print(json.dumps(tasks[k](times)), flush=True)


if __name__ == "__main__":
    main()
