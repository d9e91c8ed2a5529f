"""python -m tests.mutants: put faults into the sources, and list those that no test notices.

Mutations are drawn uniformly over the lines of six rooms, and each is tried with the tests nearest
to it first, until one fails or its time is over.  What survives that time counts as a survivor,
though tests that were left might have noticed it.  Goes on where it was ended; what
is known is kept in verdicts.jsonl.
"""

import argparse
import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor, as_completed
from queue import SimpleQueue
from typing import Any

from .drawn import ROOT, drawn
from .equivalent import EQUIVALENT
from .operators import Mutation
from .trial import Times, Tree, fresh, tried
from .verdicts import KILLED, Verdicts, test_of

FOLDER = ROOT / "runs" / "mutants"
COUNT = 300
ENOUGH = 0.8  # of those that are not equivalent die
SECONDS = 1800.0  # for one mutation


def left(wanted: list[Mutation], known: Verdicts, again: bool) -> list[tuple[int, Mutation]]:
    """What is not known yet; `again`: nor what survived for want of time."""
    return [
        (number, one) for number, one in enumerate(wanted)
        if not (found := known.of(one)) or (again and not found["whole"])
    ]  # fmt: skip


def first_tests(one: Mutation, known: Verdicts, named: list[str]) -> list[str]:
    """The tests to try before all others: those named, or the one that noticed it before."""
    before = known.before(one)
    return named or ([before["by"]] if before and exists(before["by"]) else [])


def exists(test: str) -> bool:
    return bool(file := test_of(test)) and (ROOT / file).is_file()


def run(todo: list[tuple[int, Mutation]], known: Verdicts, a: argparse.Namespace) -> None:
    """Try mutations side by side, each worker in copies of its own."""
    trees: SimpleQueue[Tree] = SimpleQueue()
    times = Times(FOLDER / "seconds.json")
    for k in range(min(a.workers, len(todo))):
        trees.put(fresh(FOLDER, k, times))
    writing = threading.Lock()

    def one_of(number: int, one: Mutation) -> dict[str, Any]:
        tree = trees.get()
        try:
            found = tried(tree, one, number, a.seconds, first_tests(one, known, a.tests))
        finally:
            trees.put(tree)
        with writing:
            known.add(one, found)
        return found

    with ThreadPoolExecutor(a.workers) as pool:
        for job in as_completed([pool.submit(one_of, *item) for item in todo]):
            found = job.result()
            print(f"{found['verdict']} {found['seconds']:.0f} s {found['told']} {found['by']}",
                  flush=True)  # fmt: skip


def equivalent(one: Mutation) -> str:
    """Why a mutation changes nothing; empty where it is not known to."""
    text = (ROOT / one.file).read_text().splitlines()[one.line - 1].strip()
    return EQUIVALENT.get((one.file, text, one.new), "")


def table(wanted: list[Mutation], known: Verdicts) -> float:
    """Print what did not die; the share of those drawn that died, without equivalent ones.

    What is not tried, or was before something changed, counts as a survivor.
    """
    found = {one: known.of(one) for one in wanted}
    dead = [one for one in wanted if (told := found[one]) and told["verdict"] == KILLED]
    others = [one for one in wanted if one not in dead]
    same = [one for one in others if equivalent(one)]
    for one in others:
        tried_one, told = found[one], one.told((ROOT / one.file).read_bytes())
        if one in same:
            print(f"equivalent: {told}: {equivalent(one)}")
        elif tried_one is None:
            print(f"not tried, or not since something changed: {told}")
        else:
            out = f"the nearest {tried_one['tests']} tests, out of time"
            print(f"survived {'all tests' if tried_one['whole'] else out}: {told}")
    count = len(wanted) - len(same)
    share = len(dead) / count if count else 0.0
    print(f"{len(dead)} of {count} died, {100 * share:.1f} %; {len(same)} more are equivalent")
    return share


def main() -> None:
    read = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    read.add_argument("--count", type=int, default=COUNT, help="of mutations drawn")
    read.add_argument("--seed", default="trsim", help="of the dice")
    read.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    read.add_argument("--seconds", type=float, default=SECONDS, help="for one mutation")
    read.add_argument("--again", action="store_true", help="also what survived for want of time")
    read.add_argument("--only", type=int, nargs="+", default=(), help="numbers, as --list has them")
    read.add_argument("--tests", nargs="+", default=[], help="to try before all others")
    read.add_argument(
        "--list", action="store_true", help="what is drawn and known; nothing is tried"
    )
    read.add_argument("--table", action="store_true", help="what is known; nothing is tried")
    a = read.parse_args()
    wanted, known = drawn(a.count, a.seed), Verdicts()
    if a.list:
        for number, one in enumerate(wanted):
            found = known.of(one) or {"verdict": "not known"}
            print(number, found["verdict"], one.told((ROOT / one.file).read_bytes()))
        return
    FOLDER.mkdir(parents=True, exist_ok=True)
    if not a.table:
        todo = left(wanted, known, a.again)
        if a.only:
            todo = [(number, wanted[number]) for number in a.only]
        print(f"{len(wanted)} mutations, {len(todo)} to try", flush=True)
        run(todo, known, a)
        known.tidy(wanted)
    share = table(wanted, known)
    sys.exit(0 if share >= ENOUGH else 1)


if __name__ == "__main__":
    main()
