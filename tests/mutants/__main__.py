"""python -m tests.mutants: put faults into the sources, and list those that no test notices.

Mutations are drawn uniformly over the lines of six rooms, and each is tried with the tests nearest
to it first, until one fails or its time is over.  What survives that time counts as a survivor,
though tests that were left might have noticed it.  Goes on where it was ended, with the same
sources and tests.
"""

import argparse
import json
import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from .drawn import ROOT, digest, drawn
from .equivalent import EQUIVALENT
from .operators import Mutation
from .trial import Times, Tree, fresh, tried

FOLDER = ROOT / "runs" / "mutants"
COUNT = 300
ENOUGH = 0.8  # of those that are not equivalent die
SECONDS = 1800.0  # for one mutation

Key = tuple[str, int, str, str]


def key(one: Mutation) -> Key:
    return one.file, one.start, one.new, one.operator


def known(file: Path) -> dict[Key, dict[str, Any]]:
    """Verdicts so far; a line that was cut off counts as none."""
    found = {}
    for text in file.read_text().splitlines() if file.exists() else ():
        try:
            one = json.loads(text)
        except ValueError:
            continue
        found[one["file"], one["start"], one["new"], one["operator"]] = one
    return found


def left(wanted: list[Mutation], file: Path, again: bool) -> list[tuple[int, Mutation]]:
    """What is not known yet; `again`: nor what survived for want of time."""
    done = known(file)
    return [
        (number, one) for number, one in enumerate(wanted)
        if key(one) not in done or (again and not done[key(one)]["whole"])
    ]  # fmt: skip


def run(todo: list[tuple[int, Mutation]], file: Path, workers: int, seconds: float) -> None:
    """Try mutations side by side, each worker in copies of its own."""
    trees: SimpleQueue[Tree] = SimpleQueue()
    times = Times(FOLDER / "seconds.json")
    for k in range(min(workers, len(todo))):
        trees.put(fresh(FOLDER, k, times))
    writing = threading.Lock()

    def one_of(number: int, one: Mutation) -> dict[str, Any]:
        tree = trees.get()
        try:
            found = tried(tree, one, number, seconds)
        finally:
            trees.put(tree)
        with writing, file.open("a") as log:
            log.write(json.dumps(found) + "\n")
            log.flush()
            os.fsync(log.fileno())
        return found

    with ThreadPoolExecutor(workers) as pool:
        for job in as_completed([pool.submit(one_of, *item) for item in todo]):
            found = job.result()
            print(f"{found['verdict']} {found['seconds']:.0f} s {found['told']} {found['by']}",
                  flush=True)  # fmt: skip


def equivalent(one: Mutation) -> str:
    """Why a mutation changes nothing; empty where it is not known to."""
    text = (ROOT / one.file).read_text().splitlines()[one.line - 1].strip()
    return EQUIVALENT.get((one.file, text, one.new), "")


def table(wanted: list[Mutation], file: Path) -> float:
    """Print the survivors; the share of those tried that died, without equivalent ones."""
    done = known(file)
    tried_ones = [one for one in wanted if key(one) in done]
    dead = [one for one in tried_ones if done[key(one)]["verdict"] == "killed"]
    survivors = [one for one in tried_ones if one not in dead]
    same = [one for one in survivors if equivalent(one)]
    for one in survivors:
        found = done[key(one)]
        tests = (
            "all tests" if found["whole"] else f"the nearest {found['tests']} tests, out of time"
        )
        why = f"; equivalent: {equivalent(one)}" if one in same else ""
        print(f"survived {tests}: {found['told']}{why}")
    count = len(tried_ones) - len(same)
    share = len(dead) / count if count else 0.0
    print(f"{len(dead)} of {count} died, {100 * share:.1f} %; {len(same)} more are equivalent; "
          f"{len(wanted) - len(tried_ones)} of {len(wanted)} are still to be tried")  # fmt: skip
    return share


def main() -> None:
    read = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    read.add_argument("--count", type=int, default=COUNT, help="of mutations drawn")
    read.add_argument("--seed", default="trsim", help="of the dice")
    read.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    read.add_argument("--seconds", type=float, default=SECONDS, help="for one mutation")
    read.add_argument("--again", action="store_true", help="also what survived for want of time")
    read.add_argument("--list", action="store_true", help="what is drawn; nothing is tried")
    read.add_argument("--table", action="store_true", help="what is known; nothing is tried")
    a = read.parse_args()
    wanted = drawn(a.count, a.seed)
    if a.list:
        for one in wanted:
            print(one.told((ROOT / one.file).read_bytes()))
        return
    FOLDER.mkdir(parents=True, exist_ok=True)
    file = FOLDER / f"{digest()}.jsonl"
    if not a.table:
        todo = left(wanted, file, a.again)
        print(f"{len(wanted)} mutations, {len(todo)} to try; {file}", flush=True)
        run(todo, file, a.workers, a.seconds)
    share = table(wanted, file)
    sys.exit(0 if share >= ENOUGH and not left(wanted, file, False) else 1)


if __name__ == "__main__":
    main()
