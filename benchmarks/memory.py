"""Peak memory of whole processes (resident set, MB), with and without a long record."""

import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.measure import ROOT, SCENARIOS, trsim
from benchmarks.problems import chain, windows


def peak(command: list[str]) -> float:
    """Peak resident set of a process, MB (Linux counts in kB, macOS in bytes)."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, cwd=ROOT) as process:  # noqa: S603
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return used.ru_maxrss / (1e6 if sys.platform == "darwin" else 1024)


def main() -> None:
    reverser = str(SCENARIOS / "thrust_reverser" / "clearance_ab_0.3mm.yaml")
    with TemporaryDirectory() as folder:
        out = str(Path(folder) / "run.h5")
        large = {"windows, N = 40": windows(40), "chain, n = 160": chain(160)}
        for k, text in enumerate(large.values()):
            (Path(folder) / f"{k}.yaml").write_text(text)
        commands = {
            "trsim --help": trsim("--help"),
            "trsim check, reverser": trsim("check", reverser),
            "trsim run, reverser, 1 000 rows": trsim("run", reverser, "-q", "-o", out),
            "trsim run, reverser, 100 000 rows": trsim(
                "run", reverser, "-q", "--set", "output.every=10 us", "-o", out
            ),
        } | {
            f"trsim run, {name}": trsim("run", f"{folder}/{k}.yaml", "-q", "-o", out)
            for k, name in enumerate(large)
        }
        for label, command in commands.items():
            print(f"  {label:40s} {peak(command):6.0f}", flush=True)
