"""Runs in processes of their own, to be killed, interrupted or kept from writing."""

import os
import subprocess
import sys
import time
from pathlib import Path

from tests import small

ROOT = Path(__file__).parents[2]
LONG = "solver.end=1000"

# `trsim run`, telling the simulated time of every block before it is stored; from the first one on
# no file may grow beyond LIMIT (not before: kernels may have to be compiled)
TELLING = """
import os, resource, sys
from trsim.cli import main
from trsim.solve import simulate as module
original = module.simulate
def told(*given):
    running = original(*given)
    while True:
        try:
            block = next(running)
        except StopIteration as stop:
            return stop.value
        if limit := int(os.environ.get("LIMIT", 0)):
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        os.write(1, f"{block.time!r} {len(block.rows)}\\n".encode())
        yield block
module.simulate = told
main(["run", *sys.argv[1:], "-q"])
"""


def begun(folder, *arguments, limit=0):
    """A long run that tells how far it is; the process."""
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    command = [sys.executable, "-c", TELLING, "crank.yaml", "--set", LONG, *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "LIMIT": str(limit)}
    return subprocess.Popen(  # noqa: S603
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True,
    )  # fmt: skip


def blocks_until(process, seconds):
    """Simulated times and the wall times at which they were told, from the first block on."""
    told = []
    while not told or time.monotonic() - told[0][1] < seconds:
        line = process.stdout.readline()
        assert line, process.stderr.read()
        told.append((float(line.split()[0]), time.monotonic()))
    return told
