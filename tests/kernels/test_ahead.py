"""Compiling in two processes: one at a time at each function, and nothing left behind."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.elsewhere import PATH, needs
from trsim import system
from trsim.kernels.lock import turn

KEY, OTHER = "a" * 20, "b" * 20
PATIENCE = 60.0  # s

HOLDS = """
import sys, time
from pathlib import Path
from trsim.kernels.lock import turn
with turn(Path(sys.argv[1]), sys.argv[2]) as ours:
    print(ours, flush=True)
    time.sleep(600)
"""
BEGINS = """
import time
from trsim.kernels import ahead
ahead.begin("trsim.solve.march.complete")
print(ahead._at_work[0].pid, flush=True)
time.sleep(600)
"""


@pytest.fixture
def started(tmp_path):
    """Starts Python with an empty cache and some code; all are killed in the end."""
    running = []

    def start(code, *arguments):
        environment = {**os.environ, "PYTHONPATH": PATH, "XDG_CACHE_HOME": str(tmp_path)}
        command = [sys.executable, "-c", code, *map(str, arguments)]
        running.append(
            subprocess.Popen(  # noqa: S603
                command, stdout=subprocess.PIPE, env=environment, preexec_fn=interruptible
            )
        )
        return running[-1], running[-1].stdout.readline().split()[0]

    yield start
    for process in running:
        process.kill()
        process.communicate()


def interruptible():
    """As from a terminal: what a shell runs in the background ignores SIGINT."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def alive(pid):
    """Whether a process is there and no zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@needs("fcntl")
def test_one_process_at_a_time(started, tmp_path):
    lock = tmp_path / "lock"
    process, told = started(HOLDS, lock, KEY)
    assert told == b"True"
    with turn(lock, KEY, wait=False) as ours, turn(lock, OTHER, wait=False) as another:
        assert not ours and another
    process.kill()
    with turn(lock, KEY) as ours:  # the lock dies with its process
        assert ours


def test_no_lock_where_there_can_be_none(tmp_path):
    (tmp_path / "file").write_text("")
    with turn(tmp_path / "file" / "lock", KEY, wait=False) as ours:
        assert ours


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
@pytest.mark.skipif(system.processors() < 2, reason="there is no second process")
def test_the_second_process_ends_with_the_first(end, started, tmp_path):
    process, pid = started(BEGINS)
    assert alive(int(pid))
    waited = time.monotonic()
    while not (tmp_path / "trsim").exists() and time.monotonic() - waited < PATIENCE:
        time.sleep(0.02)
    time.sleep(0.5)  # it is compiling, which takes some seconds
    process.send_signal(end)
    waited = time.monotonic()
    while alive(int(pid)) and time.monotonic() - waited < PATIENCE:
        time.sleep(0.05)
    assert not alive(int(pid))
    assert not list((tmp_path / "trsim").glob("code/*.code"))  # it did not come to an end
