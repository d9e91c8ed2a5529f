"""python -m benchmarks.stress: run what is missing, case by case on two cores; then report."""

import json
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from benchmarks.docs.made import MADE
from benchmarks.docs.marks import digest_of
from benchmarks.measure import ROOT
from benchmarks.stress.cells import CASES, Case, cases
from trsim.version import __version__

FILE = ROOT / "runs" / "stress" / "cells.jsonl"
WORKERS = 2


def answered(case: Case) -> list[dict]:
    from benchmarks.stress.judge import verdicts

    return verdicts(case)


def known(file: Path) -> dict[str, list[dict]]:
    """Cases judged so far; a line that was cut off counts as none."""
    found: dict[str, list[dict]] = {}
    for line in file.read_text().splitlines() if file.exists() else ():
        try:
            cells = json.loads(line)
        except ValueError:
            continue
        found[cells[0]["case"]] = cells
    return found


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else CASES
    FILE.parent.mkdir(parents=True, exist_ok=True)
    every = list(cases(count))
    sources = digest_of(MADE["stress"])
    left = [case for case in every if case.name not in known(FILE)]
    print(f"{len(every)} cases, {len(left)} left; {FILE.relative_to(ROOT)}", flush=True)
    started = time.monotonic()
    with ProcessPoolExecutor(WORKERS) as pool, FILE.open("a") as log:
        jobs = {pool.submit(answered, case): case for case in left}
        for k, job in enumerate(as_completed(jobs), 1):
            cells = [{**cell, "from": sources} for cell in job.result()]
            log.write(json.dumps(cells) + "\n")
            log.flush()
            os.fsync(log.fileno())
            told = ", ".join(f"{cell['method']} {cell['verdict']}" for cell in cells)
            spent = time.monotonic() - started
            print(f"{k}/{len(left)} {spent:5.0f} s  {jobs[job].name}: {told}", flush=True)
    from benchmarks.stress.report import DOC, MAP, write

    found = known(FILE)
    write([cell for case in every for cell in found[case.name]], __version__)
    print(DOC.relative_to(ROOT), MAP.relative_to(ROOT))


if __name__ == "__main__":
    main()
