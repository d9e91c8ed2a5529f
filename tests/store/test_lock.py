"""Two processes and one result file: the second one is refused, and dead ones lock nothing."""

import os
import subprocess
import time

import pytest

from tests import small
from tests.store import outside
from trsim.errors import FileError
from trsim.store.lock import refuse_if_written, writing
from trsim.store.read import read

FAST = ("--set", "solver.end=1ms")


@pytest.fixture
def going(tmp_path):
    """A run that is going on, into runs/crank.h5."""
    process = outside.begun(tmp_path)
    outside.blocks_until(process, 0.5)
    yield process
    outside.killed(process)


@pytest.mark.parametrize(
    "words",
    [
        ("run", "crank.yaml", *FAST),
        ("run", "crank.yaml", "--set", outside.LONG, "--resume"),
        ("recover", "runs/crank.h5.part"),
        ("recover", "runs/crank.h5.part", "-o", "other.h5"),
    ],
)
def test_second_is_refused(words, going, tmp_path):
    part = tmp_path / "runs/crank.h5.part"
    size = part.stat().st_size
    second = outside.trsim(tmp_path, *words)
    _, err = second.communicate(timeout=60)
    assert second.returncode == 7, err
    assert f"runs/crank.h5 is being written by process {going.pid}" in err
    assert going.poll() is None
    assert part.stat().st_size >= size
    assert not (tmp_path / "runs/crank.h5").exists() and not (tmp_path / "other.h5").exists()


def test_recover_into_a_file_that_is_written(going, tmp_path):
    small.run(tmp_path / "x.h5")
    second = outside.trsim(tmp_path, "recover", "x.h5", "-o", "runs/crank.h5")
    assert "is being written by process" in second.communicate(timeout=60)[1]
    assert second.returncode == 7


def test_the_dead_lock_nothing(going, tmp_path):
    outside.killed(going)
    assert (tmp_path / "runs/crank.h5.lock").exists()
    refuse_if_written(tmp_path / "runs/crank.h5")
    for words in (("recover", "runs/crank.h5.part"), ("run", "crank.yaml", *FAST)):
        process = outside.trsim(tmp_path, *words)
        assert process.communicate(timeout=60) and process.returncode == 0
    assert not (tmp_path / "runs/crank.h5.lock").exists()
    assert read(tmp_path / "runs/crank.h5").attributes["status"] == "done"


def test_same_instant(tmp_path):
    """Of many that take the lock at once one has it; the others are told of it."""
    code = (
        "from pathlib import Path; from trsim.store.lock import writing\n"
        "print('ready', flush=True); input()\n"
        "try:\n"
        "    with writing(Path('x.h5')): print('mine', flush=True); input()\n"
        "except Exception as error: print(error, flush=True)\n"
    )
    many = [outside.started(tmp_path, "-c", code, stdin=subprocess.PIPE) for _ in range(5)]
    assert [process.stdout.readline() for process in many] == ["ready\n"] * 5
    for process in many:
        process.stdin.write("\n")
        process.stdin.flush()
    told = sorted(process.stdout.readline() for process in many)
    assert told[:1] == ["mine\n"] and told[1:2] != ["mine\n"], told
    assert all("x.h5 is being written by process" in text for text in told[1:])
    for process in many:
        process.communicate("\n", timeout=30)


def test_one_after_the_other(tmp_path):
    final = tmp_path / "x.h5"
    for _ in range(2):
        with writing(final):
            with pytest.raises(FileError, match=f"written by process {os.getpid()}"):
                refuse_if_written(final)
            with (
                pytest.raises(FileError, match=f"written by process {os.getpid()}"),
                writing(final),
            ):
                pass
        refuse_if_written(final)
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_was_removed_is_taken_again(tmp_path, monkeypatch):
    """Between opening and locking the owner before may remove the name, so nobody would see us."""
    from trsim.store import lock

    final, original, calls = tmp_path / "x.h5", lock._lock, []

    def removed(handle, how, name):
        if not calls:
            (tmp_path / "x.h5.lock").unlink()
        calls.append(handle)
        original(handle, how, name)

    with monkeypatch.context() as patch:
        patch.setattr(lock, "_lock", removed)
        with writing(final):
            assert len(calls) == 2
            assert (tmp_path / "x.h5.lock").read_text() == f"{os.getpid()}\n"


def test_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    told = "x.h5: cannot be written: Not a directory"
    with pytest.raises(FileError, match=told), writing(tmp_path / "file" / "x.h5"):
        pass


# --- what is left when recover is ended --------------------------------------------------------

SLOW = """
import os, sys, time
from pathlib import Path
from trsim.store import recover
original = recover.sys.executable
Path("slow").write_text("#!/bin/sh\\nexec " + sys.executable + " -c '"
    "import os, time; from trsim.store.disk import end_with_parent; end_with_parent();"
    "open(\\"pid\\", \\"w\\").write(str(os.getpid())); time.sleep(60)'\\n")
os.chmod("slow", 0o755)
recover.sys.executable = os.path.abspath("slow")
from trsim.cli import main
main(["recover", "x.h5", "-o", "y.h5"])
"""


@pytest.mark.parametrize("number, left", [(2, False), (15, False), (9, True)])
def test_recover_that_is_ended_takes_its_helper_along(number, left, tmp_path):
    small.run(tmp_path / "x.h5")
    process = outside.started(tmp_path, "-c", SLOW)
    pid = tmp_path / "pid"
    begun = time.monotonic()
    while not (pid.exists() and pid.read_text()):
        assert time.monotonic() - begun < 30.0 and process.poll() is None
        time.sleep(0.02)
    child = int(pid.read_text())
    process.send_signal(number)
    process.communicate(timeout=20)
    for _ in range(100):
        if not running(child):
            break
        time.sleep(0.05)
    assert not running(child)
    found = {path.name for path in tmp_path.iterdir()} - {"slow", "pid", "x.h5"}
    assert found == ({"y.h5.lock", f"y.h5.{process.pid}"} if left else set())


def running(number):
    """Whether a process is there and not only waiting to be asked how it ended."""
    found = subprocess.run(["ps", "-o", "stat=", "-p", str(number)],  # noqa: S603, S607
                           capture_output=True, text=True, check=False)  # fmt: skip
    return bool(found.stdout.strip()) and not found.stdout.startswith("Z")
