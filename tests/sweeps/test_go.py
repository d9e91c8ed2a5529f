"""Sweeps made, killed and gone on with: nothing is lost, nothing is run twice."""

import csv
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests import elsewhere, small
from tests.sizes import size
from trsim.analyse.cases import unfinished
from trsim.errors import FileError, UsageError
from trsim.store.checkpoint import sources
from trsim.store.lock import writing
from trsim.store.read import verify
from trsim.sweeps import job, local
from trsim.sweeps.go import WHOLE, Shard, differing, engine, go, needs
from trsim.sweeps.ledger import entries
from trsim.sweeps.plan import plan
from trsim.sweeps.study import study

ROOT = Path(__file__).parents[2]
B = "joints.B.clearance"
# few channels: a file is written in half of the time
TEXT = small.SLIDER_CRANK.replace(
    "every: 0.01 ms", "every: 0.01 ms, channels: [stroke, B.contact_force]"
)
SETS = (f"{B}=[0.2 mm, 0.5 mm]", "contact_laws.pin.restitution=[0.8, 0.9]", "solver.end=1 ms")


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    path = tmp_path_factory.mktemp("scenario") / "crank.yaml"
    path.write_text(TEXT)
    return path


def here(tasks):
    """Cases run in this process: a worker takes a second to start."""
    return ((task, job.run(task, lambda: None)) for task in tasks)


def made(scenario, folder, sets=SETS, by="one", jobs=0, shard=WHOLE):
    """Make a sweep, with so many workers; the names of the cases that were run."""
    planned = plan(str(scenario), sets, by)
    runner = (lambda tasks: local.run(tasks, jobs)) if jobs else here
    running = go(planned, folder, by, runner, shard)
    return [one.case for one in running if not isinstance(one, int)]


def contents(folder):
    return {case.name: case.entry.content for case in study(folder).cases}


@pytest.fixture(scope="module")
def whole(scenario, tmp_path_factory):
    """The folder of a sweep of four cases, never interrupted."""
    folder = tmp_path_factory.mktemp("whole") / "sweep"
    assert len(made(scenario, folder)) == 4
    return folder


@pytest.fixture
def copy(whole, tmp_path):
    """A copy of it, with the times of the files."""
    shutil.copytree(whole, tmp_path / "sweep")
    return tmp_path / "sweep"


def test_what_is_there(whole):
    found = study(whole)
    assert found.keys == (B, "contact_laws.pin.restitution")
    assert found.units[B] == "m"
    assert [case.values[B] for case in found.cases] == [2e-4, 2e-4, 5e-4, 5e-4]
    for case in found.cases:
        assert (case.status, case.failed, case.there) == ("done", False, True)
        run = case.run()
        assert run.scenario["joints"]["B"]["clearance"] == f"{1e3 * case.values[B]:g} mm"
        assert run.attributes["content_sha256"] == case.entry.content
        assert verify(case.file)
    assert len(set(contents(whole).values())) == 4
    with (whole / "index.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["name"] for row in rows] == [case.name for case in found.cases]
    assert [float(row[f"{B} [m]"]) for row in rows] == [2e-4, 2e-4, 5e-4, 5e-4]
    peak = found.cases[2].run().summary["contacts"]["B"]["peak_force"]
    assert float(rows[2]["B.peak_force"]) == peak > 0.0
    assert rows[2]["content_sha256"] == found.cases[2].entry.content


def test_the_same_as_a_run(whole, scenario, tmp_path):
    """A case holds what `trsim run` with the same numbers would have written."""
    summary = small.run(tmp_path / "x.h5", f"{B}=0.5 mm", "solver.end=1 ms")
    with_text = study(whole).named["clearance=0.5mm,restitution=0.9"].run()
    assert (
        summary["contacts"]["B"]["peak_force"] == with_text.summary["contacts"]["B"]["peak_force"]
    )
    assert summary["statistics"]["steps"] == with_text.group("solver")["steps"]


def test_again_runs_nothing(copy, scenario):
    assert made(scenario, copy) == []
    text = TEXT.replace("solver:", "# a comment\nsolver:  ")
    other = copy.parent / "crank.yaml"
    other.write_text(text)
    assert made(other, copy) == []


def test_one_number_runs_one_case(copy, scenario):
    sets = (f"{B}=[0.2 mm, 0.6 mm]", *SETS[1:])
    assert made(scenario, copy, sets) == [
        "clearance=0.6mm,restitution=0.8",
        "clearance=0.6mm,restitution=0.9",
    ]
    sets = (SETS[0], "contact_laws.pin.restitution=[0.8, 0.9]", "solver.end=1 ms")
    assert made(scenario, copy, sets) == []


def test_another_trsim_runs_all(copy, scenario):
    planned = plan(str(scenario), SETS, "two")
    assert [need.why for _, need in needs(planned, copy, "two")] == ["trsim itself changed"] * 4


def test_files_that_are_gone_or_changed(copy, scenario):
    gone, broken, touched, _ = [case.file for case in study(copy).cases]
    gone.unlink()
    broken.write_bytes(broken.read_bytes()[:1000])
    os.utime(touched)  # as a copy of the folder would have it
    planned = plan(str(scenario), SETS, "one")
    told = [need.why for _, need in needs(planned, copy, "one")]
    assert told == ["its file is gone", "its file was changed", "", ""]
    before = contents(copy)
    assert len(made(scenario, copy)) == 2
    assert contents(copy) == before
    assert made(scenario, copy) == []


def test_a_ledger_that_is_lost(copy, scenario):
    """The files say themselves what they are."""
    before = contents(copy)
    rows = (copy / "index.csv").read_text().splitlines()
    (copy / "ledger.jsonl").unlink()
    assert made(scenario, copy) == []
    assert contents(copy) == before
    after = (copy / "index.csv").read_text().splitlines()
    for old, new in zip(rows, after, strict=True):  # but for wall times
        mine, other = old.split(","), new.split(",")
        assert mine[:-2] + mine[-1:] == other[:-2] + other[-1:]


def test_a_line_cut_short(copy, scenario):
    path = copy / "ledger.jsonl"
    path.write_bytes(path.read_bytes()[:-30])
    assert made(scenario, copy) == []
    assert len(entries(copy)) == 4


def test_shards(scenario, whole, tmp_path):
    folder = tmp_path / "sweep"
    first = made(scenario, folder, shard=Shard(1, 3))
    assert len(first) == 2
    assert [case.status for case in study(folder).cases] == ["done", "missing", "missing", "done"]
    rest = made(scenario, folder, shard=Shard(2, 3)) + made(scenario, folder, shard=Shard(3, 3))
    assert len(rest) == 2
    assert contents(folder) == contents(whole)
    assert made(scenario, folder) == []


@pytest.mark.parametrize("jobs", [2, size(3, 8)])
def test_as_many_workers_as_one_likes(scenario, whole, tmp_path, jobs):
    made(scenario, tmp_path / "sweep", jobs=jobs)
    assert contents(tmp_path / "sweep") == contents(whole)


@elsewhere.needs("fcntl")
def test_one_parent(copy, scenario):
    from trsim.store.lock import writing

    with writing(copy / "ledger.jsonl"), pytest.raises(FileError, match="being written"):
        made(scenario, copy)


@elsewhere.needs("fcntl")
def test_shards_of_another_plan(scenario, tmp_path):
    """While one shard works no other plan comes into its folder, nor a sweep of all."""
    folder = tmp_path / "sweep"
    planned, other = plan(str(scenario), SETS, "one"), plan(str(scenario), FINE, "one")
    running = go(planned, folder, "one", here, Shard(1, 2))
    next(running)
    for wrong in (go(other, folder, "one", None, Shard(2, 2)), go(planned, folder, "one", None)):
        with pytest.raises(FileError, match="being written"):
            next(wrong)
    beside = go(planned, folder, "one", lambda tasks: (), Shard(2, 2))
    assert next(beside) == 2
    beside.close()
    running.close()
    assert differing(other, folder) == 4
    assert differing(planned, folder) == 0


def test_a_study_whose_ledger_is_lost(copy):
    before = contents(copy)
    (copy / "ledger.jsonl").unlink()
    assert contents(copy) == before


def test_a_study_reads_no_file_that_is_of_something_else(copy):
    """In the place of a case: that of another, of a run of other numbers, or half of one."""
    taken, other, broken, touched = study(copy).cases
    before = contents(copy)
    os.replace(other.file, taken.file)
    broken.file.write_bytes(broken.file.read_bytes()[:1000])
    os.utime(touched.file)
    cases = study(copy).cases
    assert [case.status for case in cases] == ["missing", "missing", "missing", "done"]
    changed = "its file was changed"
    assert [case.reason for case in cases] == [changed, "", changed, ""]
    assert [case.there for case in cases] == [False, False, False, True]
    assert unfinished(study(copy)) == [
        f"2 of 4 cases have a file that was changed and are left out: {taken.name}, {broken.name}",
        f"1 of 4 cases have no result and are left out: {other.name}",
    ]
    with pytest.raises(FileError, match="no result, missing: its file was changed"):
        cases[0].run()
    small.run(taken.file, "solver.end=1 ms")
    assert study(copy).cases[0].reason == changed
    assert contents(copy) == before


def test_damaged_plans(copy):
    for text in ('{"format": "trsim sweep", "version": 1}', '{"format": "trsim sweep"}', "[]"):
        (copy / "plan.json").write_text(text)
        with pytest.raises(FileError, match=r"damaged|not the plan"):
            study(copy)
    with pytest.raises(FileError, match="not the folder of a sweep"):
        study(copy / "plan.json")


def test_a_foreign_index(copy, scenario):
    (copy / "index.csv").write_text("mine\n")
    with pytest.raises(UsageError, match=r"index\.csv exists and is not"):
        made(scenario, copy)


def test_a_folder_with_figures_of_a_run(scenario, tmp_path):
    """A sweep takes the folder of `report` (tests/cli/test_sweep.py), not others' pictures."""
    folder = tmp_path / "play_0.3mm"
    folder.mkdir()
    (tmp_path / "play_0.3mm.h5").write_bytes(b"")
    (folder / "x.png").write_bytes(b"\x89PNG\r\n\x1a\nmine")
    with pytest.raises(UsageError, match="a folder of other files, not of a sweep"):
        made(scenario, folder)
    assert [path.name for path in folder.iterdir()] == ["x.png"]


def test_folders_of_others(scenario, tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(UsageError, match="of other files"):
        made(scenario, tmp_path)
    with pytest.raises(FileError, match="not the folder of a sweep"):
        study(tmp_path)
    with pytest.raises(FileError, match="no such folder"):
        study(tmp_path / "none")
    (tmp_path / "plan.json").write_text("{")
    with pytest.raises(FileError, match="damaged"):
        study(tmp_path)


def test_cases_that_fail(scenario, tmp_path):
    """Each for its reason; the others are not touched by it."""
    folder = tmp_path / "sweep"
    sets = ("solver.max_steps=[3, 1000000]", "joints.B.at.0=[0.17, 0.18]", "solver.end=1 ms")
    made(scenario, folder, sets)
    told = {case.name: (case.status, case.there) for case in study(folder).cases}
    assert sorted(told.values()) == [
        ("done", True),
        ("done", True),
        ("failed", True),
        ("failed", True),
    ]
    assert made(scenario, folder, sets) == []  # it would fail again
    bad = ("bodies.rod.mass=[0.2, 0]", "solver.end=1 ms")
    made(scenario, tmp_path / "bad", bad)
    status = {case.name: case for case in study(tmp_path / "bad").cases}
    assert status["mass=0.2"].status == "done"
    refused = status["mass=0"]
    assert (refused.status, refused.there, refused.failed) == ("refused", False, True)
    assert "rod" in refused.reason
    with pytest.raises(FileError, match="the case has no result, refused"):
        refused.run()


# --- killed ----------------------------------------------------------------------------------

SWEEP = [sys.executable, "-m", "trsim", "sweep"]
KILLS = size(4, 20)
FINE = (f"{B}=lin(0.2 mm, 0.5 mm, 6)", "solver.end=2 ms")


def children(pid):
    """The processes that a process began."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(fields[1]) == pid and fields[0] != "Z":
            found.append(int(path.parent.name))
    return found


def alive(pids):
    return [
        pid
        for pid in pids
        if Path(f"/proc/{pid}/cmdline").exists() and Path(f"/proc/{pid}/cmdline").read_bytes()
    ]


def one_more(process, folder):
    """Wait until a case more is stored than there were: others are at work then."""
    before = len(entries(folder))
    while len(entries(folder)) <= before and process.poll() is None:
        time.sleep(0.002)


def test_killed_at_any_time(scenario, tmp_path):
    """Parent or worker killed, the same command again: the same set; no orphans."""
    calm, stormy = tmp_path / "calm", tmp_path / "stormy"
    arguments = [str(scenario), *(word for one in FINE for word in ("--set", one)), "-q", "-j", "2"]
    made(scenario, calm, FINE)
    dice = random.Random(1)
    for kill in range(KILLS):
        process = subprocess.Popen(
            [*SWEEP, *arguments, "-o", str(stormy)], cwd=ROOT, stdout=subprocess.DEVNULL
        )
        if kill % 4 == 3:  # wherever it is
            time.sleep(dice.uniform(0.2, 2.0))
        elif kill % 4 == 2:  # while its workers begin
            while not children(process.pid) and process.poll() is None:
                time.sleep(0.01)
            time.sleep(dice.uniform(0.0, 0.5))
        else:
            one_more(process, stormy)
            time.sleep(dice.uniform(0.0, 0.1))
        workers = children(process.pid)
        if kill % 2 == 0 and workers:
            os.kill(dice.choice(workers), signal.SIGKILL)
            assert process.wait(timeout=120) == 0  # one attempt more, and nothing else
            assert contents(stormy) == contents(calm)
            shutil.rmtree(stormy)
            continue
        process.kill()
        process.wait()
        until = time.monotonic() + 5.0
        while alive(workers) and time.monotonic() < until:
            time.sleep(0.01)
        assert not alive(workers)
    again = subprocess.run(
        [*SWEEP, *arguments, "-o", str(stormy), "--json", "-j", "1"],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    done = json.loads(again.stdout)
    assert done["counts"] == {"done": 6}
    assert contents(stormy) == contents(calm)
    left = sorted(path.name for path in (stormy / "cases").iterdir())
    assert left == sorted(path.name for path in (calm / "cases").iterdir())


@elsewhere.needs("fcntl")
def test_what_a_killed_sweep_left_unfinished_is_removed(copy, scenario):
    """Plans and indices are written under another name: it is the kill that leaves them."""
    plan_text, index = (copy / "plan.json").read_bytes(), (copy / "index.csv").read_bytes()
    left = {"plan.json.4711": plan_text[:50], "plan.json.4711-1": plan_text, "plan.json.12": b"",
            "index.csv.99": index[:5], "index.csv.98-2": index}  # fmt: skip
    others = {"plan.json.2": b"mine", "plan.json.old": plan_text, "index.csv.7": b"other,table\n"}
    for name, text in (left | others).items():
        (copy / name).write_bytes(text)
    (copy / "plan.json.3").symlink_to(copy / "plan.json")
    with writing(copy / "ledger-2of2.jsonl"):  # another shard, which may be writing them
        made(scenario, copy, shard=Shard(1, 2))
    assert all((copy / name).exists() for name in left)
    made(scenario, copy)
    assert not any((copy / name).exists() for name in left)
    assert all((copy / name).read_bytes() == text for name, text in others.items())
    assert (copy / "plan.json.3").is_symlink()


def test_interrupted(scenario, tmp_path):
    """Ctrl-C: the code of an interrupt, what was done is kept, no worker is left."""
    folder = tmp_path / "sweep"
    process = subprocess.Popen(
        [*SWEEP, str(scenario), "--set", f"{B}=lin(0.2 mm, 0.5 mm, 40)", "-o", str(folder)],
        cwd=ROOT, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True,
    )  # fmt: skip
    until = time.monotonic() + 60.0
    while len(entries(folder)) < 2 and time.monotonic() < until:
        time.sleep(0.01)
    workers = children(process.pid)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=10)
    assert process.returncode == 130
    assert "the same command goes on" in said
    assert not alive(workers)
    assert 2 <= len(entries(folder)) < 40
    assert (folder / "index.csv").read_text().count(",done,") >= 2


def test_pages_have_no_part_in_a_run(tmp_path):
    """What only reads results changes none: a page may be improved without running all again."""
    for folder in ("solve", "studies"):
        (tmp_path / folder).mkdir()
    page, method = tmp_path / "studies" / "page.py", tmp_path / "solve" / "method.py"
    found = []
    for path in (page, page, method, method):
        path.write_text(f"a = {len(found)}\n")
        found.append(sources(tmp_path))
    assert found[0] == found[1] != found[2] != found[3]


def test_an_engine():
    assert engine() == engine()
    assert len(engine()) > 16
