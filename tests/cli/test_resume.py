"""`trsim run --resume`: what it goes on from, what it refuses, and what it says."""

import dataclasses
import errno
import json
import shutil

import h5py
import pytest

from tests import small
from trsim.cli import main
from trsim.solve import simulate as solver
from trsim.store import checkpoint, hdf5
from trsim.store.checkpoint import load, store
from trsim.store.plain import Plain
from trsim.store.read import read

LONG = ("--set", "output.every=0.2us", "--set", "output.channels=[stroke, B.force]")  # three chunks


@pytest.fixture(scope="module")
def left(tmp_path_factory):
    """What a run leaves that was interrupted near its end."""
    folder = tmp_path_factory.mktemp("left")
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    take = hdf5.Running.take

    def interrupt(run, block):
        take(run, block)
        if block.time > 2.5e-3:
            raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch, pytest.raises(SystemExit) as ended:
        patch.chdir(folder)
        patch.setattr(hdf5.Running, "take", interrupt)
        main(["run", "crank.yaml", *LONG])
    assert ended.value.code == 130
    return folder / "runs"


@pytest.fixture
def interrupted(left, scenario):
    """A run that was interrupted near its end; the path of its checkpoint."""
    shutil.copytree(left, scenario.parent / "runs")
    return scenario.parent / "runs/crank.h5.checkpoint"


def changed(path, **changes):
    store(path, dataclasses.replace(load(path), **changes))


def test_says_what_is_left(scenario, trsim, monkeypatch):
    """Which file holds what until when, and the commands that use it, in the document too."""
    take = hdf5.Running.take

    def interrupt(run, block):
        take(run, block)
        raise KeyboardInterrupt

    monkeypatch.setattr(hdf5.Running, "take", interrupt)
    monkeypatch.setattr("sys.argv", ["trsim", "run", "crank.yaml", "-o", "a b.h5"])
    code, out, err = trsim("run", "crank.yaml", *LONG, "-o", "a b.h5", "--json")
    assert code == 130
    t = load(scenario.parent / "a b.h5.checkpoint").time
    left = (
        f"a b.h5.part holds the run until t = {t:g} s; `trsim recover 'a b.h5.part'` makes it a "
        "result file, `trsim run crank.yaml -o 'a b.h5' --resume` goes on with the run."
    )
    assert f"interrupted: {left}\n" in err
    [error] = json.loads(out)["errors"]
    assert (error["what"], error["hint"]) == ("interrupted by SIGINT", left)


def test_a_full_disk_says_what_is_left(scenario, trsim, monkeypatch):
    take = hdf5.Running.take

    def full(run, block):
        take(run, block)
        run.save()
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(hdf5.Running, "take", full)
    monkeypatch.setattr("sys.argv", ["trsim", "run", "crank.yaml"])
    code, _, err = trsim("run", "crank.yaml", *LONG)
    assert code == 7
    t = load(scenario.parent / "runs/crank.h5.checkpoint").time
    assert f"crank.h5.part holds the run until t = {t:g} s; `trsim recover runs/crank" in err
    assert "`trsim run crank.yaml --resume` goes on with the run." in err


def test_goes_on(interrupted, scenario, answer, at_once):
    kept = load(interrupted)
    code, document = answer("run", "crank.yaml", *LONG, "--resume")
    assert code == 0
    assert document["runs"][0]["resumed_from"] == kept.time > 2.5e-3
    expected = answer("run", "crank.yaml", *LONG, "-o", "x.h5")[1]["runs"][0]
    assert document["runs"][0]["content_sha256"] == expected["content_sha256"]
    assert expected["resumed_from"] is None
    assert not interrupted.exists()


def test_without_resume_it_says_that_it_could(interrupted, trsim):
    t = load(interrupted).time
    code, _, err = trsim("run", "crank.yaml", *LONG)
    assert code == 0
    assert f"starts anew; --resume would go on at t = {t:.6g} s of {interrupted.name}" in (
        err.replace("runs/", "")
    )
    assert not interrupted.exists()


@pytest.mark.parametrize("name", ["y", "mem", "branch", "depth", "length"])
def test_a_start_of_another_shape(name, interrupted, trsim):
    """A checkpoint with a right checksum that is not one of this run."""
    state = load(interrupted).state
    other = state[f"start.{name}"][..., None]
    changed(interrupted, state={**state, f"start.{name}": other})
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7 and f"does not fit this run: start.{name}" in err


def test_a_run_that_was_killed_when_it_had_just_ended(interrupted, scenario, trsim, at_once):
    """Its file is complete and has its name; only the checkpoint was not removed yet."""
    part = interrupted.with_name("crank.h5.part")
    part.rename(interrupted.with_name("crank.h5"))
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 0 and "nothing to resume" in err
    assert [path.name for path in interrupted.parent.iterdir()] == ["crank.h5"]


def test_nothing_to_resume(scenario, trsim):
    code, _, err = trsim("run", "crank.yaml", "--resume")
    assert code == 0
    assert "nothing to resume at runs/crank.h5.checkpoint: starts from the beginning" in err


def test_other_scenario(interrupted, trsim):
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume", "--set", "solver.tolerance=1e-7",
                         "--set", "bodies.rod.mass=0.22")  # fmt: skip
    assert code == 2
    assert "bodies.rod.mass is 0.22, was 0.21; solver.tolerance is 1e-07, was 1e-06" in err
    assert "Without --resume the run starts anew." in err
    assert interrupted.exists()  # nothing was lost
    code, _, err = trsim("run", "crank.yaml")
    assert code == 0 and "--resume" not in err


@pytest.mark.parametrize("key", ["trsim", "sources", "python", "numpy", "numba", "processor"])
def test_other_surroundings(key, interrupted, trsim):
    changed(interrupted, keys={**load(interrupted).keys, key: "other"})
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 2
    assert f'{key} is "' in err and 'was "other"' in err


@pytest.mark.parametrize("k", [0, 30, 200, -1])
def test_damaged_checkpoint(k, interrupted, trsim):
    content = bytearray(interrupted.read_bytes())
    content[k] ^= 0x10
    interrupted.write_bytes(content)
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7
    assert "crank.h5.checkpoint is" in err and "Without --resume the run starts anew." in err
    code, _, err = trsim("run", "crank.yaml", *LONG)
    assert code == 0 and "--resume" not in err


def test_torn_checkpoint(interrupted, trsim):
    content = interrupted.read_bytes()
    for size in (0, 10, len(content) // 2, len(content) - 1):
        interrupted.write_bytes(content[:size])
        assert trsim("run", "crank.yaml", *LONG, "--resume")[0] == 7


def test_missing_part(interrupted, trsim):
    interrupted.with_suffix(".part").unlink()
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7
    assert "crank.h5.part: no such file, although its checkpoint is there" in err


def test_part_shorter_than_the_checkpoint_says(interrupted, trsim):
    part = interrupted.with_suffix(".part")
    with h5py.File(part, "r+") as file:
        file["B.force"].resize(5000, axis=0)
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7
    assert "/B.force has 5000 rows, 12288 at the checkpoint" in err
    assert {p.name for p in part.parent.iterdir()} == {"crank.h5.part", "crank.h5.checkpoint"}


def test_rows_that_were_never_written(interrupted, trsim):
    part = interrupted.with_suffix(".part")
    with h5py.File(part, "r+") as file:
        n = len(file["B.force"])
        file["B.force"].resize(5000, axis=0)  # gives back its last chunks
        file["B.force"].resize(n, axis=0)
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7
    assert "/B.force has 8192 rows, 12288 at the checkpoint" in err


@pytest.mark.parametrize("share", [0.02, 0.3, 0.8])
def test_part_cut_short(share, interrupted, trsim):
    part = interrupted.with_suffix(".part")
    content = part.read_bytes()
    part.write_bytes(content[: int(share * len(content))])
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7
    assert "crank.h5.part cannot be resumed" in err


def test_flipped_bit_in_a_full_chunk(interrupted, trsim):
    part = interrupted.with_suffix(".part")
    with h5py.File(Plain(part), "r") as file:
        place = file["B.force"].id.get_chunk_info(1).byte_offset
    content = bytearray(part.read_bytes())
    content[place + 100] ^= 1
    part.write_bytes(content)
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7
    assert "crank.h5.part cannot be resumed" in err


def test_part_that_stops_its_reader(interrupted, trsim, monkeypatch):
    monkeypatch.setattr("trsim.store.resume.PATIENCE", 0.0)
    monkeypatch.setattr("trsim.store.resume.PACE", 1e12)
    code, _, err = trsim("run", "crank.yaml", *LONG, "--resume")
    assert code == 7
    assert "HDF5 could not read it within 0 s" in err


def test_scipy_knows_no_checkpoints(scenario, trsim):
    short = ("--set", "solver.method=scipy:RK45", "--set", "solver.end=0.02 ms")
    code, _, err = trsim("run", "crank.yaml", *short, "--checkpoint", "1", "--resume")
    assert code == 0
    assert "no checkpoints: scipy:RK45 keeps a state of its own" in err
    assert "nothing to resume" in err
    assert "no checkpoints" not in trsim("run", "crank.yaml", *short)[2]


def test_never(scenario, trsim, monkeypatch):
    """--checkpoint 0 writes none, not even after an interrupt."""
    monkeypatch.setattr(checkpoint, "store", None)
    take = hdf5.Running.take

    def interrupt(run, block):
        take(run, block)
        raise KeyboardInterrupt

    monkeypatch.setattr(hdf5.Running, "take", interrupt)
    assert trsim("run", "crank.yaml", *LONG, "--checkpoint", "0")[0] == 130
    assert not (scenario.parent / "runs/crank.h5.checkpoint").exists()


def test_checkpoint_that_cannot_be_written(scenario, trsim, monkeypatch):
    """A write fault like any other: what was flushed before can be read."""
    monkeypatch.setattr(solver, "VISIT", 15)
    (scenario.parent / "runs/crank.h5.checkpoint.new").mkdir(parents=True)
    code, _, err = trsim("run", "crank.yaml", "--checkpoint", "1e-9")
    assert code == 7
    assert "runs/crank.h5.checkpoint.new is in the way: it is a folder" in err
    assert read(scenario.parent / "runs/crank.h5.part").rows > 0


def test_wrong_interval(scenario, trsim):
    for wrong in ("-1", "nan", "inf"):
        assert trsim("run", "crank.yaml", "--checkpoint", wrong)[0] == 2
