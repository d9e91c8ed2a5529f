"""Start-up: wall and CPU seconds of whole commands, warm (median of 5) and with an empty cache.

The overhead of a run is its wall time without the CPU time of its integration, which is that of
the warm run for the first run too: a first run also compiles while it integrates.
"""

import json
import os
import resource
import statistics
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from benchmarks.measure import ROOT, SCENARIOS, trsim
from benchmarks.tables import head, row

REVERSER = SCENARIOS / "thrust_reverser" / "clearance_ab_0.3mm.yaml"
REPEATS = 5


class Took(NamedTuple):
    """Seconds of one process."""

    wall: float
    cpu: float
    integration: float  # CPU, of a run


def took(command: list[str], code: int = 0, **variables: str) -> Took:
    """One process, with variables of its environment; `code` is the exit expected."""
    environment = {**os.environ, **variables}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # modules stay translated, as for any user
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True)  # noqa: S603
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert done.returncode == code, done.stderr.decode()
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    runs = json.loads(done.stdout).get("runs", []) if "--json" in command else []
    return Took(wall, cpu, runs[0]["statistics"]["integration_cpu"] if runs else 0.0)


def median(command: list[str], code: int = 0) -> Took:
    """Of several processes, the first one not counted."""
    took(command, code)
    columns = zip(*(took(command, code) for _ in range(REPEATS)), strict=True)
    return Took(*map(statistics.median, columns))


def told(label: str, took: Took, aim: str = "") -> None:
    """A line: what is aimed at is the overhead of runs, the wall time of other commands."""
    overhead = f"{took.wall - took.integration:.2f}" if took.integration else ""
    row(label, f"{took.wall:.2f}", f"{took.cpu:.2f}", overhead, aim)


def main() -> None:
    """Print the table."""
    with TemporaryDirectory() as folder:
        wrong = Path(folder) / "wrong.yaml"
        wrong.write_text(REVERSER.parent.joinpath("mechanism.yaml").read_text() + "\nsolvr: {}\n")
        run = trsim("run", str(REVERSER), "-q", "--json", "-o", f"{folder}/run.h5")
        head("", "wall s", "CPU s", "not integration s", "aim s")
        told("python -c pass, for the speed of the machine", median([sys.executable, "-c", "pass"]))
        told("trsim --help", median(trsim("--help")), "0.1")
        told("a schema error", median(trsim("check", str(wrong)), 3), "0.4")
        told("trsim check, reverser", median(trsim("check", str(REVERSER))), "0.8")
        warm, cold = median(run), took(run, XDG_CACHE_HOME=f"{folder}/cache")
        told("trsim run, reverser, 1 s", warm, "1.0")
        told("the same, compiling (empty cache)", cold._replace(integration=warm.integration), "15")
