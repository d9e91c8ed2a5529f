"""One mutation in a copy of the tree, and the tests on it until one fails.

A test that fails on the mutation and on the sources as they are says nothing: it is left out, and
the others go on.  Every failure must come twice, since a busy machine makes some of its own; so
must the end of a process, and tests that do not end.
"""

import json
import os
import re
import select
import shutil
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from trsim.kernels import kept

from .drawn import ROOT
from .nearest import stages
from .operators import Mutation

KEPT = ("trsim", "tests", "scenarios", "benchmarks", "docs")
SAID = re.compile(rb"(\S+::.*?) (PASSED|FAILED|ERROR|SKIPPED|XFAIL|XPASS)")
COLLECTED = re.compile(rb"ERROR (tests/\S+)")
DIED = "the process"  # of the tests
SILENT = 300.0  # s without a test that ends: it hangs
# a mutation may fill memory or disk: bytes a process may have, and a file; tests end with us
LIMITED = """
import ctypes, os, resource, signal, sys
PDEATHSIG = 1
if sys.platform == "linux":
    ctypes.CDLL(None).prctl(PDEATHSIG, signal.SIGKILL)
resource.setrlimit(resource.RLIMIT_DATA, (8 << 30, 8 << 30))
resource.setrlimit(resource.RLIMIT_FSIZE, (4 << 30, 4 << 30))
os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
"""


class Times:
    """How long test files took: those soon done are tried first, unknown ones before them."""

    def __init__(self, file: Path) -> None:
        self.file, self.writing = file, threading.Lock()
        self.seconds: dict[str, float] = {}
        with suppress(OSError, ValueError):
            self.seconds = json.loads(file.read_text())

    def note(self, seconds: dict[str, float]) -> None:
        """Files of which tests were run to a failure took less than they do."""
        with self.writing:
            for file, took in seconds.items():
                self.seconds[file] = max(took, self.seconds.get(file, 0.0))
            self.file.write_text(json.dumps(self.seconds, indent=1))

    def sorted(self, tests: list[str]) -> list[str]:
        return sorted(tests, key=lambda test: self.seconds.get(test, 0.0))


@dataclass
class Tree:
    """A copy of the project that is mutated, one that is not, and machine code for both."""

    mutated: Path
    whole: Path
    cache: Path  # each piece is kept under a key of what it was made of
    times: "Times"  # of test files
    sound: set[str] = field(default_factory=set)  # tests that pass on the sources as they are
    broken: set[str] = field(default_factory=set)  # and those that fail there


@dataclass
class Found:
    """What became of some tests."""

    ended: list[str]
    failed: str | None  # the first test, or file, that failed
    silent: bool  # no test ended for long
    late: bool  # the time given was over
    seconds: dict[str, float]  # of each file

    @property
    def noticed(self) -> bool:
        return self.failed is not None or self.silent


def fresh(folder: Path, k: int, times: Times) -> Tree:
    """The k-th pair of copies, with the machine code that is at hand."""
    tree = Tree(folder / f"mutated_{k}", folder / f"whole_{k}", folder / f"cache_{k}", times)
    for target in (tree.mutated, tree.whole):
        copied(target)
    warm = kept.folder()
    shutil.rmtree(tree.cache, ignore_errors=True)
    tree.cache.mkdir(parents=True)
    if warm.is_dir():
        shutil.copytree(warm.parent, tree.cache / warm.parent.name)
    return tree


def copied(target: Path, root: Path = ROOT) -> None:
    """A fresh copy of the project, without what is made of it."""
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    for name in KEPT:
        skipped = shutil.ignore_patterns("__pycache__")
        shutil.copytree(root / name, target / name, ignore=skipped)
    for path in root.iterdir():
        if path.is_file() and path.name != ".git":
            shutil.copy2(path, target / path.name)


def put(tree: Tree, one: Mutation, number: int) -> None:
    """Change the file in the copy; its time is one that no bytecode was made of."""
    path = tree.mutated / one.file
    path.write_bytes(one.of((ROOT / one.file).read_bytes()))
    os.utime(path, (1e9 + number, 1e9 + number))


def restored(tree: Tree, one: Mutation) -> None:
    shutil.copy2(ROOT / one.file, tree.mutated / one.file)


def tested(at: Path, cache: Path, tests: list[str], less: set[str], seconds: float) -> Found:
    """Run tests in a copy, to the first that fails."""
    scratch = at / "scratch"
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir()
    environment = {**os.environ, "PYTHONPATH": str(at), "XDG_CACHE_HOME": str(cache),
                   "TMPDIR": str(scratch), "HOME": str(scratch)}  # fmt: skip
    for name in ("PYTHONUNBUFFERED", "PYTHONDONTWRITEBYTECODE", "TRSIM_SIZE"):
        environment.pop(name, None)
    command = [sys.executable, "-c", LIMITED, "-u", "-m", "pytest", "-p", "no:xdist",
               "-p", "no:cacheprovider", "-o", "addopts=", "-v", "-x", "--tb=no", "--color=no",
               f"--rootdir={at}",
               *(f"--deselect={test}" for test in sorted(less)), *tests]  # fmt: skip
    process = subprocess.Popen(  # noqa: S603
        command, cwd=at, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, start_new_session=True,
    )  # fmt: skip
    try:
        return followed(process, time.monotonic() + seconds)
    finally:
        ended(process)
        shutil.rmtree(scratch, ignore_errors=True)


def followed(process: subprocess.Popen, end: float) -> Found:
    """Read what the tests say, to their end or that of their time."""
    assert process.stdout is not None
    found = Found([], None, False, False, {})
    said, last = b"", time.monotonic()
    while not (found.silent or found.late):
        if select.select([process.stdout], [], [], 1.0)[0]:
            part = os.read(process.stdout.fileno(), 1 << 16)
            if not part:
                break
            *lines, said = (said + part).split(b"\n")
            for text in lines:
                if noted(found, text, time.monotonic() - last):
                    last = time.monotonic()
        found.silent, found.late = time.monotonic() - last > SILENT, time.monotonic() > end
    whole = not (found.silent or found.late)
    if whole and found.failed is None and status(process) not in (0, 5):  # 5: nothing to do
        found.failed = DIED
    return found


def noted(found: Found, text: bytes, took: float) -> bool:
    """Note the test that a line is about, and whether it failed; False for any other line."""
    if name := COLLECTED.match(text):
        found.failed = found.failed or name[1].decode()
    if not (said := SAID.match(text)):
        return False
    test, word = said[1].decode(), said[2]
    found.ended.append(test)
    file = test.split("::")[0]
    found.seconds[file] = found.seconds.get(file, 0.0) + took
    if word in (b"FAILED", b"ERROR"):
        found.failed = found.failed or test
    return True


def status(process: subprocess.Popen) -> int:
    """How a process ended, which keeps its number until `ended`."""
    told = os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    assert told is not None
    return told.si_status


def ended(process: subprocess.Popen) -> None:
    """End the process and those it began, which are a group of their own."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    if process.stdout:
        process.stdout.close()


def tried(
    tree: Tree, one: Mutation, number: int, seconds: float, first: list[str] | None = None
) -> dict[str, Any]:
    """What became of a mutation: killed by which test, or after how many tests it survived.

    first: tests that are tried before those nearest to it.
    """
    begun, seen, doubtful = time.monotonic(), 0, set[str]()
    put(tree, one, number)
    try:
        nearest = map(tree.times.sorted, stages(ROOT, one.file))
        for stage in [[test] for test in first or ()] + list(nearest):
            while True:
                left = seconds - (time.monotonic() - begun)
                less = tree.broken | doubtful
                found = tested(tree.mutated, tree.cache, stage, less, left)
                tree.times.note(found.seconds)
                if not found.noticed:
                    break
                again = repeated(found, stage)
                if confirmed(tree, again):
                    by = found.failed or f"a test behind {found.ended[-1:]} does not end"
                    return line(one, "killed", by, seen + len(found.ended), True, begun)
                if set(again) <= less:
                    break  # there is nothing more to leave out
                doubtful |= set(again)
            seen += len(found.ended)
            if found.late:
                return line(one, "survived", "", seen, False, begun)
        return line(one, "survived", "", seen, True, begun)
    finally:
        restored(tree, one)


def repeated(found: Found, stage: list[str]) -> list[str]:
    """The tests to run again: the one that failed, or those it died or hung in."""
    if found.failed and found.failed != DIED:
        return [found.failed]
    if "::" in stage[0]:
        return stage
    at = stage.index(found.ended[-1].split("::")[0]) if found.ended else 0
    return stage[at : at + 2]


def confirmed(tree: Tree, again: list[str]) -> bool:
    """Whether it was the mutation that these tests noticed: without it they pass, with it never."""
    if not set(again) <= tree.sound:
        found = tested(tree.whole, tree.cache, again, set(), 4 * SILENT)
        if found.noticed or found.late:
            tree.broken |= set(again)
            print(f"no test: {', '.join(again)} on the sources as they are", flush=True)
            return False
        tree.sound |= set(again)
    return tested(tree.mutated, tree.cache, again, set(), 4 * SILENT).noticed


def line(one: Mutation, verdict: str, by: str, tests: int, whole: bool, begun: float) -> dict:
    """What is kept of a trial; whole: all tests were tried, or as many as it took."""
    return {
        "file": one.file, "line": one.line, "start": one.start, "new": one.new,
        "operator": one.operator, "verdict": verdict, "by": by, "tests": tests, "whole": whole,
        "seconds": round(time.monotonic() - begun, 1),
        "told": one.told((ROOT / one.file).read_bytes()),
    }  # fmt: skip
