"""Two processes and one result file: the second one is refused, and dead ones lock nothing."""

import os
import shutil
import signal
import subprocess
import time

import pytest

from tests import small
from tests.elsewhere import needs
from tests.store import outside
from trsim import system
from trsim.cli import main
from trsim.errors import FileError
from trsim.store import lock
from trsim.store.lock import refuse_if_written, writing
from trsim.store.read import read

pytestmark = needs("fcntl", "SIGSTOP")

FAST = ("--set", "solver.end=1ms")


@pytest.fixture(scope="module")
def begun(tmp_path_factory):
    """A run that is going on, into runs/crank.h5, and its folder; it holds still meanwhile."""
    folder = tmp_path_factory.mktemp("going")
    process = outside.begun(folder)
    outside.blocks_until(process, 0.5)
    process.send_signal(signal.SIGSTOP)
    yield process, folder
    outside.killed(process)


@pytest.fixture
def going(begun, monkeypatch):
    """The same, from inside its folder."""
    monkeypatch.chdir(begun[1])
    return begun[0]


def trsim(words):
    """The exit code of a command in this process, which is another one than that of the run."""
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    return ended.value.code


@pytest.mark.parametrize(
    "words",
    [
        ("run", "crank.yaml", *FAST),
        ("run", "crank.yaml", "--set", outside.LONG, "--resume"),
        ("recover", "runs/crank.h5.part"),
        ("recover", "runs/crank.h5.part", "-o", "other.h5"),
    ],
)
def test_second_is_refused(words, going, begun, capsys):
    before = {path: path.read_bytes() for path in begun[1].rglob("*") if path.is_file()}
    code = trsim(words)
    err = capsys.readouterr().err
    assert code == 7, err
    assert f"runs/crank.h5 is being written by process {going.pid}" in err
    assert going.poll() is None
    assert {path: path.read_bytes() for path in begun[1].rglob("*") if path.is_file()} == before


def test_recover_into_a_file_that_is_written(going, tmp_path, capsys):
    small.copy(tmp_path / "x.h5")
    assert trsim(("recover", str(tmp_path / "x.h5"), "-o", "runs/crank.h5")) == 7
    assert "is being written by process" in capsys.readouterr().err


def test_the_dead_lock_nothing(running_part, tmp_path, monkeypatch):
    shutil.copytree(running_part.parents[1], tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    assert (tmp_path / "runs/crank.h5.lock").exists()
    refuse_if_written(tmp_path / "runs/crank.h5")
    for words in (("recover", "runs/crank.h5.part"), ("run", "crank.yaml", *FAST)):
        assert trsim(words) == 0
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

    def removed(handle, name):
        if not calls:
            (tmp_path / "x.h5.lock").unlink()
        calls.append(handle)
        original(handle, name)

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
    "import os, time; from trsim.system import end_with_parent; end_with_parent();"
    "open(\\"pid\\", \\"w\\").write(str(os.getpid())); time.sleep(60)'\\n")
os.chmod("slow", 0o755)
recover.sys.executable = os.path.abspath("slow")
from trsim.cli import main
main(["recover", "x.h5", "-o", "y.h5"])
"""


@pytest.mark.parametrize("number, left", [(2, False), (15, False), (9, True)])
def test_recover_that_is_ended_takes_its_helper_along(number, left, tmp_path):
    small.copy(tmp_path / "x.h5")
    process = outside.started(tmp_path, "-c", SLOW)
    pid = tmp_path / "pid"
    begun = time.monotonic()
    while not (pid.exists() and pid.read_text()):
        assert time.monotonic() - begun < 30.0 and process.poll() is None
        time.sleep(0.02)
    child = int(pid.read_text())
    process.send_signal(number)
    process.communicate(timeout=20)
    until = time.monotonic() + 5.0
    while running(child) and time.monotonic() < until:
        time.sleep(0.01)
    assert not running(child)
    found = {path.name for path in tmp_path.iterdir()} - {"slow", "pid", "x.h5"}
    assert found == ({"y.h5.lock", f"y.h5.{process.pid}"} if left else set())


def running(number):
    """Whether a process is there and not only waiting to be asked how it ended."""
    found = subprocess.run(["ps", "-o", "stat=", "-p", str(number)],  # noqa: S603, S607
                           capture_output=True, text=True, check=False)  # fmt: skip
    return bool(found.stdout.strip()) and not found.stdout.startswith("Z")


def test_a_lock_is_that_of_the_file_that_has_the_name(tmp_path, monkeypatch):
    """At the first attempt, or at the second where the last owner removed it in between."""
    for removed in (0, 1):
        handles, locked = [], lock._lock

        def opened(*rest, handles=handles, open_=system.opened):
            handles.append(open_(*rest))
            return handles[-1]

        def taken(handle, final, shared=False, handles=handles, locked=locked, removed=removed):
            assert 0 < len(handles) < 3, "it never ends"
            if len(handles) <= removed:
                (tmp_path / "x.h5.lock").unlink()
            locked(handle, final, shared)

        with monkeypatch.context() as patch:
            patch.setattr(system, "opened", opened)
            patch.setattr(lock, "_lock", taken)
            handle = lock._held(tmp_path / "x.h5.lock", tmp_path / "x.h5")
        assert len(handles) == 1 + removed and handle == handles[-1]
        assert os.path.samestat(os.fstat(handle), os.stat(tmp_path / "x.h5.lock"))
        os.close(handle)
