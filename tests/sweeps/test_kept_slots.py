"""Batch after batch in the same processes."""

import pytest

from trsim.sweeps import local

from .test_local import JOB, ended, importable, tasks  # noqa: F401 - a fixture


def at_work(folder):
    """The processes that ran a case, by the marks they left."""
    return {int(mark.name.split(".")[1]) for mark in folder.iterdir()}


@pytest.mark.parametrize("kept", [[], None])
def test_the_next_batch_has_the_processes_of_the_last_one(tmp_path, kept):
    folders = [tmp_path / "one", tmp_path / "two"]
    for folder in folders:
        folder.mkdir()
        found = ended(local.run(tasks(folder, *["end"] * 4), 1, job=JOB, kept=kept))
        assert {one["status"] for one in found.values()} == {"done"}
    one, two = map(at_work, folders)
    assert len(one) == len(two) == 1
    assert (one == two) == (kept is not None)
    for slot in kept or ():
        slot.close()


def test_one_that_died_has_a_successor(tmp_path):
    kept = []
    list(local.run(tasks(tmp_path, "die once"), 1, job=JOB, kept=kept))
    kept[0].process.kill()
    kept[0].process.wait()
    found = ended(local.run(tasks(tmp_path, "end"), 1, job=JOB, kept=kept))
    assert found["t0"]["status"] == "done"
    kept[0].close()
