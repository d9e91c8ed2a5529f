"""Start-up: wall time of whole commands, warm (median of 5) and with an empty cache (once), s."""

import os
import subprocess
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.measure import SCENARIOS, trsim, wall

REVERSER = SCENARIOS / "thrust_reverser"


def main() -> None:
    demo = str(REVERSER / "clearance_ab_0.3mm.yaml")
    with TemporaryDirectory() as folder:
        out = str(Path(folder) / "run.h5")
        for label, command in {
            "trsim --help": trsim("--help"),
            "trsim check, reverser": trsim("check", demo),
            "trsim run, reverser, 0.1 ms simulated": trsim(
                "run", demo, "-q", "--set", "solver.end=0.1 ms", "-o", out
            ),
            "trsim run, reverser, 0.3 mm at A and B, 1 s": trsim("run", demo, "-q", "-o", out),
        }.items():
            print(f"  {label:50s} {wall(command):6.2f}")
        environment = {**os.environ, "XDG_CACHE_HOME": folder}
        environment.pop("NUMBA_CACHE_DIR", None)
        start = time.perf_counter()
        subprocess.run(  # noqa: S603
            trsim("run", demo, "-q", "-o", out), check=True, capture_output=True, env=environment
        )
        print(
            f"  {'the same with an empty cache (compiling)':50s} {time.perf_counter() - start:6.2f}"
        )
