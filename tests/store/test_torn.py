"""Killed between two writes, or within one: the rows of the last flush can be read.

What HDF5 writes while a run goes on is recorded, and the file put together again write by write.  A
kill ends a write at the end of a page, if it ends it at all.
"""

import io
import os
import shutil

import h5py
import pytest

from tests import small
from tests.elsewhere import needs
from trsim.assemble.assemble import assemble
from trsim.errors import FileError
from trsim.scenario.load import loads
from trsim.solve import simulate as solver
from trsim.store import grow, hdf5, torn
from trsim.store.plain import checksum
from trsim.store.read import SWMR, opened, read
from trsim.store.recover import copy

PAGE = 4096  # bytes
CHUNK = 256  # rows
HEADER = 400  # bytes, more than the largest header of a dataset
WRITING = 0x01  # in byte 11 of a file
SETS = ("output.channels=[stroke, B.force]", "output.every=4us", "solver.end=1.3ms")


class Recorded(io.FileIO):
    """A file that remembers what is written to it."""

    def __init__(self, path):
        super().__init__(path, "w+")
        self.writes = []

    def write(self, data):
        data = bytes(data)
        if self.tell() == 0 and data[11] & SWMR:  # HDF5 says less of a file that Python writes
            data = data[:11] + bytes([data[11] | WRITING]) + data[12:44]
            data += checksum(data).to_bytes(4, "little")
        self.writes.append((self.tell(), data))
        return super().write(data)


@pytest.fixture(scope="module")
def story(tmp_path_factory):
    """The file before its first rows, the writes after that, and (writes, rows) at each flush."""
    path = tmp_path_factory.mktemp("torn") / "run.h5"
    scenario = loads(small.SLIDER_CRANK, SETS)
    mechanism = assemble(scenario)
    files, flushes = [], []
    original, begun, flush = h5py.File, hdf5.Running.begun, hdf5.Running.flush

    def made(name, mode="r", **options):
        if mode != "w":
            return original(name, mode, **options)
        files.append(Recorded(name))
        return original(files[-1], mode, **options)

    def noted(run):
        rows = {d.name: t.n for t in run.tables for d in t.datasets}
        flushes.append((len(files[0].writes), rows))

    def opened_for_rows(run, *given):
        file = begun(run, *given)
        noted(run)
        return file

    def flushed(run):
        flush(run)
        noted(run)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(solver, "VISIT", 20)  # steps of a block
        patch.setattr(hdf5, "FLUSHED", -1.0)
        patch.setattr(grow, "LONGEST", CHUNK)
        patch.setattr(hdf5.h5py, "File", made)
        patch.setattr(hdf5.Running, "begun", opened_for_rows)
        patch.setattr(hdf5.Running, "flush", flushed)
        patch.setattr(hdf5.Running, "finish", lambda run, *_: run.file.close() or {})
        blocks = solver.simulate(scenario, mechanism)
        hdf5.write(path, scenario, mechanism, blocks)
    return files[0].writes, flushes


def states(path, story):
    """The file as a kill may leave it: write by write, page by page of rows; rows of the flush."""
    writes, flushes = story
    with path.open("wb", buffering=0) as file:
        for k, (at, data) in enumerate(writes):
            pages = range(PAGE - at % PAGE, len(data), PAGE) if len(data) > HEADER else ()
            for end in [0, *pages] if k >= flushes[0][0] else ():
                os.pwrite(file.fileno(), data[:end], at)
                yield end, [rows for n, rows in flushes if n <= k][-1]
            os.pwrite(file.fileno(), data, at)
    yield 0, flushes[-1][1]


def whole(path, rows, expected):
    """Check that these rows of all datasets are there; those whose last chunk HDF5 refuses."""
    refused = []
    with opened(path) as file:
        for name, n in rows.items():
            try:
                found = file[name][:n]
            except OSError:
                found = torn.rows(file[name], 0, n)
                refused.append(name)
            assert found.tobytes() == expected[name][:n].tobytes(), name
    return refused


@pytest.fixture(scope="module")
def expected(story, tmp_path_factory):
    """All rows of all datasets."""
    path = tmp_path_factory.mktemp("torn") / "run.h5.part"
    *_, (_, rows) = states(path, story)
    with opened(path) as file:
        return {name: file[name][:] for name in rows}


@needs("pwrite")
def test_killed_at_every_write(story, expected, tmp_path):
    """Between the flushes the rows fill a chunk and begin another."""
    path, refused, ends = tmp_path / "run.h5.part", 0, []
    for end, rows in states(path, story):
        names = whole(path, rows, expected)
        assert len(names) <= (end > 0)
        refused += len(names)
        ends.append(end)
        if names:
            run = read(path)
            assert run.rows >= rows["/time"]
            assert len(run.steps("B")["time"]) >= rows["/steps/B/time"]
            shutil.copy(path, tmp_path / "last")
    within = sum(end > 0 for end in ends)
    print(f"{len(ends)} states, {within} within a write; HDF5 refuses a chunk in {refused}")
    assert refused > 20
    assert rows["/time"] > CHUNK + 50
    copy(tmp_path / "last", tmp_path / "x.h5")
    assert read(tmp_path / "x.h5").rows > CHUNK


@needs("pwrite")
def test_what_no_flush_left_is_damage(story, expected, tmp_path):
    """A torn chunk whose first rows are others than at the flush before is not mended."""
    path = tmp_path / "run.h5.part"
    for end, rows in states(path, story):
        if end and rows["/time"] and "/B.force" in whole(path, rows, expected):
            break
    with opened(path) as file:
        place = file["B.force"].id.get_chunk_info(0).byte_offset
    with path.open("r+b") as file:
        file.seek(place + 3)
        file.write(b"?")
    with opened(path) as file, pytest.raises(OSError, match="filter"):
        torn.rows(file["B.force"], 0, 1)
    with pytest.raises(FileError, match="damaged"):
        read(path)


@pytest.mark.parametrize("status, kept", [("running", 7), ("done", 7), ("running", 0)])
def test_only_a_file_that_was_written_to_is_torn(status, kept, tmp_path):
    """In a finished file rows would be lost without a word; so would all text of a chunk with a
    checksum of zeros, which a lost page leaves, and which is that of no rows."""
    with h5py.File(tmp_path / "x.h5", "w") as file:
        file.attrs["status"] = status
        table = file.create_dataset("kind", (64,), "S8", chunks=(64,), fletcher32=True)
        table[:kept] = b"onset"
        table.flush()
        before = table.id.read_direct_chunk((0,))[1] if kept else bytes(torn.CHECKSUM)
        table[:] = b"onset"
        table.flush()
        after = table.id.read_direct_chunk((0,))[1]
        table.id.write_direct_chunk((0,), after[: -torn.CHECKSUM] + before[-torn.CHECKSUM :])
    with h5py.File(tmp_path / "x.h5") as file:
        if status == "running" and kept:
            assert torn.rows(file["kind"], 0, 64).tolist() == [b"onset"] * 7 + [b""] * 57
        else:
            with pytest.raises(OSError, match="filter"):
                torn.rows(file["kind"], 0, 64)
