"""Without what only some systems have, everything but locks and limits of memory works."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from trsim import system

from . import small
from .elsewhere import HERE, ROOT

NAMES = """
import trsim, sys
from trsim import system
from pathlib import Path
with open("file", "w+b") as file:
    file.write(b"begin")
    file.flush()
    system.lock(file.fileno())
    system.lock_byte(file.fileno(), 5, wait=False)
    system.lengthen(file.fileno(), 5, 1000)
    print(system.beginning(file.fileno(), 3), system.LIMITS_MEMORY, system.processors() > 0)
print(Path("file").stat().st_size, system.O_NOFOLLOW, system.user())
"""


@pytest.fixture
def bare(tmp_path):
    """Runs Python on such a system."""
    (tmp_path / "s.yaml").write_text(small.SLIDER_CRANK)
    path = os.pathsep.join([str(HERE), str(ROOT)])
    environment = {**os.environ, "PYTHONPATH": path, "TRSIM_PYTHON": "1"}  # nothing to compile

    def started(*arguments):
        return subprocess.run(  # noqa: S603
            [sys.executable, *arguments],
            cwd=tmp_path, env=environment, capture_output=True, text=True,
        )  # fmt: skip

    return started


def test_each_name_has_something_in_its_place(bare):
    done = bare("-c", NAMES)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["b'beg' False True", "1005 0 0"]


BOTH = """
import sys
from trsim.cli import main
for words in (sys.argv[1:], ["report", "x.h5", "-o", "figures", "--dpi", "40"]):
    try:
        main(words)
    except SystemExit as ended:
        assert ended.code == 0, (words, ended.code)
"""
SHORT = ("--set", "solver.end=0.2 ms", "--set", "output.every=0.1 ms")


def test_runs_and_reports(bare, tmp_path):
    few = ("--set", "output.channels=[stroke, B.contact_force]")  # figures take their time
    done = bare("-c", BOTH, "run", "s.yaml", "-o", "x.h5", *SHORT, *few)
    assert done.returncode == 0, done.stderr
    assert any((tmp_path / "figures").iterdir())


def test_sweeps(bare, tmp_path):
    text = small.SLIDER_CRANK + "sweep: {drives.motor.velocity: [1000 rpm, 2000 rpm]}\n"
    (tmp_path / "sweep.yaml").write_text(text)
    done = bare("-m", "trsim", "sweep", "sweep.yaml", "-o", "cases", *SHORT)
    assert done.returncode == 0, done.stderr
    done = bare("-m", "trsim", "sweep", "sweep.yaml", "-o", "others", "--memory", "1 GB")
    assert done.returncode == 2 and "holds no process to an amount of memory" in done.stderr


def test_names_of_the_system_stand_in_one_file():
    only = ("fcntl", "import resource", "import pwd", "sched_getaffinity", "posix_fallocate",
            "geteuid", "getuid", "os.O_NOFOLLOW", "os.O_NONBLOCK", "os.O_DIRECTORY", "os.O_BINARY",
            "os.pread", "os.fork", "killpg", "preexec_fn", "SIGALRM", "SIGHUP", "SIGQUIT",
            "setitimer", "SIGKILL", "mkfifo", "os.uname")  # fmt: skip
    for path in Path(system.__file__).parent.rglob("*.py"):
        text = path.read_text()
        assert path == Path(system.__file__) or not [name for name in only if name in text], path


KEEPS = """
import resource, sys
import numpy as np
from trsim import system
if len(sys.argv) > 1:
    system.keep_memory()
for again in range(3):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    arrays = [np.ones(1 << 18) for _ in range(10)]
    del arrays
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="of glibc alone")
def test_memory_is_kept():
    """What is freed serves the next arrays: no page of them is asked of the system again."""
    given = {"env": {**os.environ, "PYTHONPATH": str(ROOT)}, "capture_output": True, "text": True}
    pages = [
        int(subprocess.run([sys.executable, "-c", KEEPS, *more], check=True, **given).stdout)  # noqa: S603
        for more in ([], ["keep"])
    ]
    assert pages[0] > 1000 > 100 > pages[1]
