"""Runs in processes of their own, to be killed, interrupted or kept from writing."""

import os
import subprocess
import sys
import time
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from tests import small
from tests.elsewhere import PATH
from tests.elsewhere import ROOT as ROOT

LONG = "solver.end=1000"

# `trsim run`, telling the simulated time of every block before it is stored; from the first one on
# no file may grow beyond LIMIT (not before: kernels may have to be compiled)
TELLING = """
import os, sys
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
            import resource
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        os.write(1, f"{block.time!r} {len(block.rows)}\\n".encode())
        yield block
module.simulate = told
main(["run", *sys.argv[1:], "-q"])
"""


@cache
def warm():
    """Have the kernels compiled before a clock runs, or an eye is kept on processes."""
    with TemporaryDirectory() as folder:
        small.run(Path(folder) / "run.h5")


def started(folder, *words, stdin=None, stdout=subprocess.PIPE, **environment):
    """Python in a process of its own, with these words on its command line; what it says waits in
    its buffers, whatever the environment of the tests asks for."""
    warm()
    given = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    return subprocess.Popen(  # noqa: S603
        [sys.executable, *words], cwd=folder, text=True,
        env={**given, "PYTHONPATH": PATH, **environment},
        stdin=stdin, stdout=stdout, stderr=subprocess.PIPE,
    )  # fmt: skip


def trsim(folder, *words, **options):
    """A command line in a process of its own."""
    return started(folder, "-m", "trsim", *words, **options)


def begun(folder, *arguments, limit=0):
    """A long run that tells how far it is; the process."""
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    words = ("-c", TELLING, "crank.yaml", "--set", LONG, *arguments)
    return started(folder, *words, LIMIT=str(limit))


def killed(process):
    """The wall time at which a process was killed."""
    process.kill()
    when = time.monotonic()
    process.communicate()
    return when


def blocks_until(process, seconds, told=None):
    """Simulated times and the wall times at which they were told, from the first block on."""
    told = [] if told is None else told
    while not told or time.monotonic() - told[0][1] < seconds:
        line = process.stdout.readline()
        assert line, process.stderr.read()
        told.append((float(line.split()[0]), time.monotonic()))
    return told
