"""Slots and workers: what dies costs its own case, and nothing is left behind."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.elsewhere import PATH, needs
from tests.sizes import size
from trsim.sweeps import local
from trsim.sweeps.slot import Limits

JOB = "tests.sweeps.jobs:run"
ROOT = Path(__file__).parents[2]


@pytest.fixture(autouse=True)
def importable(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", PATH)


def tasks(folder, *what):
    return [{"name": f"t{k}", "do": do, "marks": str(folder)} for k, do in enumerate(what)]


def ended(found):
    return {task["name"]: result for task, result in found}


def test_each_task_ends(tmp_path):
    found = ended(local.run(tasks(tmp_path, *["end"] * 7), 3, job=JOB))
    assert sorted(found) == [f"t{k}" for k in range(7)]
    assert all(
        result == {"status": "done", "reason": "", "attempts": 1} for result in found.values()
    )


def test_the_next_task_is_made_while_a_process_works(tmp_path):
    def made():
        for k, task in enumerate(tasks(tmp_path, *["wait"] * 4, "end")):
            (tmp_path / f"made{k}").touch()
            yield task

    found = ended(local.run(made(), 1, job=JOB))
    assert [found[f"t{k}"]["reason"] for k in range(4)] == [f"t{k + 1}" for k in range(4)]


def test_none_are_none():
    assert list(local.run([], 2, job=JOB)) == []


def test_what_dies_is_tried_again(tmp_path):
    """Of many, some die once and some always: all others are there, none is lost."""
    n = size(60, 1000)
    what = ["die once" if k % 20 == 3 else "die" if k % 60 == 7 else "end" for k in range(n)]
    found = ended(local.run(tasks(tmp_path, *what), 2, Limits(retries=2), job=JOB))
    assert len(found) == n
    for k, do in enumerate(what):
        result = found[f"t{k}"]
        assert result["status"] == ("crashed" if do == "die" else "done")
        assert result["attempts"] == {"die": 3, "die once": 2, "end": 1}[do]
    assert "SIGKILL" in found["t7"]["reason"]


def test_a_bug_is_not_tried_again(tmp_path):
    found = ended(local.run(tasks(tmp_path, "raise", "end"), 1, job=JOB))
    assert (found["t0"]["status"], found["t0"]["attempts"]) == ("crashed", 1)
    assert "ZeroDivisionError" in found["t0"]["reason"]
    assert found["t1"]["status"] == "done"


def test_over_time_alone(tmp_path):
    began = time.monotonic()
    found = ended(local.run(tasks(tmp_path, "sleep", "end", "end"), 1, Limits(time=0.5), job=JOB))
    assert (found["t0"]["status"], found["t0"]["attempts"]) == ("over time", 1)
    assert "0.5 s" in found["t0"]["reason"]
    assert [found[name]["status"] for name in ("t1", "t2")] == ["done", "done"]
    assert time.monotonic() - began < 30.0


@needs("resource")
def test_over_memory_alone(tmp_path):
    limits = Limits(memory=300_000_000)
    found = ended(local.run(tasks(tmp_path, "eat", "end", "eat"), 1, limits, job=JOB))
    assert [found[f"t{k}"]["status"] for k in range(3)] == ["over memory", "done", "over memory"]
    assert ended(local.run(tasks(tmp_path, "eat"), 1, job=JOB))["t0"]["status"] == "done"


def test_one_thread_each(tmp_path):
    assert ended(local.run(tasks(tmp_path, "threads"), 1, job=JOB))["t0"]["reason"] == "1"


def test_what_is_printed_is_no_reply(tmp_path):
    assert ended(local.run(tasks(tmp_path, "print"), 1, job=JOB))["t0"]["status"] == "done"


def test_the_first_alone(tmp_path):
    found = list(local.run(tasks(tmp_path, *["end"] * 4), 2, first_alone=True, job=JOB))
    assert found[0][0]["name"] == "t0"
    assert len(found) == 4


@needs("fcntl")
def test_cold_workers_compile_once(tmp_path, monkeypatch):
    """All need the same functions at the same time; each is compiled by one of them."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "marks").mkdir()
    n = size(3, 8)
    found = ended(
        local.run(tasks(tmp_path / "marks", *["x"] * n), n, job="tests.sweeps.jobs:compiling")
    )
    assert [result["status"] for result in found.values()] == ["done"] * n
    made = sorted(path.name.rsplit(".", 1)[0] for path in (tmp_path / "marks").iterdir())
    assert len(made) == 2 == len(set(made))


def workers(marks):
    """Processes of a sweep that left a mark and are alive."""
    found = {int(path.name.split(".")[1]) for path in marks.iterdir()}
    return [pid for pid in found if Path(f"/proc/{pid}").exists() and not _zombie(pid)]


def _zombie(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
    except OSError:
        return True


def gone(marks, within=5.0):
    until = time.monotonic() + within
    while workers(marks) and time.monotonic() < until:
        time.sleep(0.05)
    return not workers(marks)


def test_broken_off_it_leaves_no_process(tmp_path):
    running = local.run(tasks(tmp_path, "end", "sleep", "sleep"), 2, job=JOB)
    next(running)
    running.close()
    assert gone(tmp_path)


PARENT = """
import sys
from trsim.sweeps import local
from tests.sweeps.test_local import JOB, tasks
for one in local.run(tasks(sys.argv[1], *["sleep"] * 4), 2, job=JOB):
    pass
"""


def test_a_killed_parent_leaves_no_process(tmp_path):
    process = subprocess.Popen([sys.executable, "-c", PARENT, str(tmp_path)], cwd=ROOT)
    until = time.monotonic() + 30.0
    while len(workers(tmp_path)) < 2 and time.monotonic() < until:
        time.sleep(0.05)
    assert len(workers(tmp_path)) == 2
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert gone(tmp_path)
