"""The cases of a sweep, as a report asks for them: several times each."""

import os

import h5py
import pytest

from tests import small
from trsim.errors import FileError
from trsim.store import read
from trsim.sweeps.ledger import Entry
from trsim.sweeps.study import Case

LINE = Entry("a", "d", "e", "done", "", 1, "c", 10, 20, 3.0, 0.5, {})


@pytest.fixture
def case(tmp_path):
    small.copy(tmp_path / "a.h5")
    return Case("a", tmp_path / "a.h5", "done", "", {}, LINE)


def test_a_file_is_looked_through_once(case, monkeypatch):
    looked, original = [], read.check_sound
    monkeypatch.setattr(read, "check_sound", lambda file: looked.append(file) or original(file))
    assert case.run().rows == case.run().rows > 0
    assert len(looked) == 1


def test_one_that_changed_is_looked_through_again(case):
    assert case.run().attributes["title"] != "another"
    with h5py.File(case.file, "r+") as file:
        file.attrs["title"] = "another"
    assert case.run().attributes["title"] == "another"


def test_one_that_was_replaced_is_another(case, tmp_path):
    """Of the same time, too: what was copied keeps it."""
    before, at = case.run(), case.file.stat()
    small.copy(tmp_path / "b.h5")
    with h5py.File(tmp_path / "b.h5", "r+") as file:
        file.attrs["title"] = "another"
    os.utime(tmp_path / "b.h5", ns=(at.st_atime_ns, at.st_mtime_ns))
    os.replace(tmp_path / "b.h5", case.file)
    assert before.attributes["title"] != case.run().attributes["title"] == "another"


def test_one_that_was_damaged_is_refused(case):
    case.run()
    case.file.write_bytes(case.file.read_bytes()[:2000])
    with pytest.raises(FileError, match="is truncated"):
        case.run()
    case.file.unlink()
    with pytest.raises(FileError, match="no such file"):
        case.run()
