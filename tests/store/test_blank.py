"""A file that begins with the bytes of another one is like one that was made object by object."""

import errno
import os

import h5py
import pytest

from tests import small
from trsim.errors import FileError
from trsim.store import blank
from trsim.store.read import read, verify

SETS = ("output.channels=[stroke, B.force]", "solver.end=0.5 ms")
OTHER = (
    "joints.B.clearance=0.4 mm",
    "title=µ",
)  # what is simulated is another, its channels are not


@pytest.fixture
def kept(monkeypatch):
    """The files a process has kept: none yet."""
    monkeypatch.setattr(blank, "kept", {})
    return blank.kept


def test_files_of_one_layout(tmp_path, kept, monkeypatch):
    paths = [tmp_path / f"{k}.h5" for k in range(5)]
    told = [small.run(path, *SETS)["content_sha256"] for path in paths[:3]]
    assert len({*told}) == 1 and len(kept) == 1 and all(kept.values())
    monkeypatch.setattr(blank.Book, "put", None)  # nothing is made anew
    other = small.run(paths[3], *SETS, *OTHER)["content_sha256"]
    monkeypatch.undo()
    blank.kept.clear()
    assert small.run(paths[4], *SETS, *OTHER)["content_sha256"] == other != told[0]
    assert all(map(verify, paths))
    run = read(paths[3])
    assert (run.attributes["title"], run.parts["B"].clearance) == ("µ", 0.4e-3)
    with h5py.File(paths[3]) as file:
        assert file["B.force"].dims[0].keys() == ["time"]
        assert file["phase/stroke/x"] == file["stroke"]


def test_another_layout_is_made_anew(tmp_path, kept):
    for every in ("4 us", "2 us", "1 us"):  # rows of a chunk
        small.run(tmp_path / "a.h5", *SETS, f"output.every={every}")
    small.run(tmp_path / "b.h5", *SETS, "output.channels=[crank.position]")
    assert "crank.position" in read(tmp_path / "b.h5").names and verify(tmp_path / "b.h5")
    assert [*kept.values()] == [b""] * 4


def test_few_are_kept(tmp_path, kept, monkeypatch):
    monkeypatch.setattr(blank, "MOST", 1)
    for channel in ("stroke", "B.force", "stroke"):
        small.run(tmp_path / "x.h5", f"output.channels=[{channel}]", SETS[1])
    assert [*kept.values()] == [b""]


def test_a_disk_that_is_full_from_the_beginning(tmp_path, kept, monkeypatch):
    def full(handle, *_):
        os.close(handle)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(blank.os, "fdopen", full)
    with pytest.raises(FileError, match="No space left"):
        small.run(tmp_path / "x.h5", *SETS)
    assert not list(tmp_path.glob("*.h5*"))
