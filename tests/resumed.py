"""A release check goes on where it was ended: a test that passed with the same sources is not run
again.

runs/release/passed.jsonl has a line for each: the test, the digest of the sources it passed with,
how long it took and what it printed.  `python -m tests.resumed` prints what stands there.
"""

import json
from functools import cache
from pathlib import Path
from typing import Any

from benchmarks.docs.marks import digest

ROOT = Path(__file__).parents[1]
LEDGER = ROOT / "runs" / "release" / "passed.jsonl"
TRIED = "test_"  # first letters of files of tests: what others share is a source of all


@cache
def shared(root: Path = ROOT) -> str:
    """Of the program, and of what tests share."""
    every = (path.relative_to(root).as_posix() for path in sorted((root / "tests").rglob("*.py")))
    return digest(
        ("trsim", *(name for name in every if not Path(name).name.startswith(TRIED))), root
    )


@cache
def sources(name: str, root: Path = ROOT) -> str:
    """Of a file of tests."""
    return f"{shared(root)}.{digest((name,), root)}"


def file_of(test: str) -> str:
    """The file of a test, by its id."""
    return test.partition("::")[0]


def passed(ledger: Path = LEDGER) -> dict[str, dict[str, Any]]:
    """The last line of each test; a line that a kill cut short counts as none."""
    found: dict[str, dict[str, Any]] = {}
    lines = ledger.read_text(encoding="utf-8").splitlines() if ledger.exists() else []
    for line in lines:
        try:
            told = json.loads(line)
        except ValueError:
            continue
        found[told["test"]] = told
    return found


class LeavesOut:
    """Plugin of pytest: what has passed is not run."""

    def __init__(self, ledger: Path = LEDGER, root: Path = ROOT) -> None:
        self.ledger, self.root = ledger, root

    def pytest_collection_modifyitems(self, config: Any, items: list[Any]) -> None:
        """All workers read the ledger before the first test runs, and so leave out the same."""
        known = passed(self.ledger)
        done = [
            item for item in items
            if known.get(item.nodeid, {}).get("of") == sources(file_of(item.nodeid), self.root)
        ]  # fmt: skip
        if done:
            config.hook.pytest_deselected(items=done)
            gone = {item.nodeid for item in done}
            items[:] = [item for item in items if item.nodeid not in gone]


class Notes:
    """Plugin of pytest: a line for each test that passes; it counts when it is torn down."""

    def __init__(self, ledger: Path = LEDGER, root: Path = ROOT) -> None:
        self.ledger, self.root = ledger, root
        self.calls: dict[str, Any] = {}  # what has run and is not torn down yet
        self.begun = False

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.when == "call" and report.passed:
            self.calls[report.nodeid] = report
        if report.when != "teardown":
            return
        if (call := self.calls.pop(report.nodeid, None)) and report.passed:
            self.note(call)

    def note(self, call: Any) -> None:
        """A line of the ledger; a last line that a kill cut short is ended before the first."""
        torn = not self.begun and self.ledger.exists() and self.ledger.read_bytes()[-1:] != b"\n"
        self.begun = True
        self.ledger.parent.mkdir(parents=True, exist_ok=True)
        told = {"test": call.nodeid, "of": sources(file_of(call.nodeid), self.root),
                "seconds": round(call.duration, 2), "printed": call.capstdout}  # fmt: skip
        with self.ledger.open("a", encoding="utf-8", newline="\n") as lines:
            lines.write("\n" * torn + json.dumps(told) + "\n")


def begun(config: Any) -> None:
    """Take part in a run of pytest: what workers run is noted by the process that began them."""
    config.pluginmanager.register(LeavesOut())
    if not hasattr(config, "workerinput"):
        config.pluginmanager.register(Notes())


def main() -> None:
    """Print what tests printed, and how many have passed with the sources as they are."""
    known = passed()
    now = [one for one in known.values() if one["of"] == sources(file_of(one["test"]))]
    for one in now:
        for line in one["printed"].splitlines():
            print(f"{one['test']}: {line}")
    took = sum(one["seconds"] for one in now)
    others = len(known) - len(now)
    print(f"{len(now)} passed with these sources, in {took:.0f} s; {others} with others")


if __name__ == "__main__":
    main()
