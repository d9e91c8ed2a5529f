"""Killed at any instant: what is left is known as ours, and the same command goes on.

Folders are copied at every call of a function before which something in them has changed: so would
a kill have left them.
"""

import os
import shutil
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

import h5py
import pytest

from tests.sizes import size
from tests.sweeps.test_go import TEXT, contents
from trsim import store, sweeps
from trsim.assemble.assemble import assemble
from trsim.errors import FileError, UsageError
from trsim.scenario.load import loads
from trsim.solve import simulate as solver
from trsim.store import blank, checkpoint, hdf5, own
from trsim.store.lock import refuse_if_written
from trsim.store.plain import SIZE
from trsim.store.recover import recover
from trsim.store.target import CHECKPOINT, LOCK, PART
from trsim.sweeps import job
from trsim.sweeps.go import go
from trsim.sweeps.plan import plan

ENDING = {".part": PART, ".part.new": PART, ".lock": LOCK, ".checkpoint": CHECKPOINT,
          ".checkpoint.new": CHECKPOINT}  # fmt: skip
SETS = ("joints.B.clearance=[0.4 mm, 0.5 mm]", "solver.end=0.5 ms")


WRITERS = tuple(f"{Path(module.__file__).parent}/" for module in (store, sweeps, h5py))
# the modules and types whose functions of C change no file
HARMLESS = {"builtins", "math", "time", "str", "bytes", "int", "dict", "list", "tuple", "type",
            "ndarray", "numpy._core._multiarray_umath", "HASH"}  # fmt: skip
ENOUGH = 4096  # bytes: what is longer is a file with rows


def looks(folder):
    """What tells two states of a folder apart: names, lengths of what is short, beginnings."""
    found, folders = [], [folder]
    for one in folders:
        with os.scandir(one) as inside:
            for entry in inside:
                start = b""
                with suppress(FileNotFoundError):
                    if entry.is_dir():
                        folders.append(entry.path)
                    else:
                        start = beginning(entry.path)
                found.append((entry.path, len(start), start[:64]))
    return tuple(sorted(found))


def beginning(path):
    """The first bytes of a file; this is called a hundred thousand times."""
    file = os.open(path, os.O_RDONLY)
    start = os.read(file, ENOUGH)
    os.close(file)
    return start


def harmless(function):
    """Whether a function of C changes no file: most calls are of these."""
    of = getattr(function, "__self__", None)
    return getattr(of, "__name__", type(of).__name__) in HARMLESS


@contextmanager
def instants(folder, kept):
    """Copies of a folder in all states it goes through, one after the other, in `kept`."""
    states = set()

    def look(frame, event, function):
        if not frame.f_code.co_filename.startswith(WRITERS):
            return
        if event.startswith("c_") and harmless(function):
            return
        sys.setprofile(None)
        state = looks(folder)
        if state not in states:
            states.add(state)
            shutil.copytree(folder, kept / f"{len(states):04}")
        sys.setprofile(look)

    kept.mkdir()
    sys.setprofile(look)
    try:
        yield
    finally:
        sys.setprofile(None)


def some(folders):
    """The first ones, and of the others as many as there is time for."""
    return [*folders[:8], *folders[8 :: size(9, 1)]]


@pytest.fixture(scope="module")
def scene():
    scenario = loads(TEXT, SETS[1:])
    return scenario, assemble(scenario)


def test_the_first_bytes_of_a_part_file(scene, tmp_path):
    """As HDF5 writes them: a superblock, room, then the first object with its attribute."""
    (tmp_path / "here").mkdir()
    path = tmp_path / "here" / "x.h5"
    running = hdf5.Running(path, *scene)
    with instants(path.parent, tmp_path / "kept"):
        running.begun(running.part).close()
    left = [folder / "x.h5.part" for folder in sorted((tmp_path / "kept").iterdir())]
    states = [part.read_bytes() for part in left if part.exists()]
    assert [len(state) for state in states[:2]] == [0, SIZE]
    first = states[1]
    torn = [first[:n] for n in (8, 20)] + [first + bytes(n) for n in (1, 131, 5000)]
    for state in (*states, *torn, bytes(1), bytes(4096), bytes(1 << 18)):
        assert PART.fits(state), state[:300]


def test_what_is_somebody_elses_is_not_ours(tmp_path):
    with h5py.File(tmp_path / "others.h5", "w", libver=blank.LIBVER) as file:
        file["numbers"] = [1.0, 2.0]
    assert not PART.fits((tmp_path / "others.h5").read_bytes())
    assert not PART.fits(bytes(4096) + b"a disk")


def begun(folder, scene, ends=None):
    """A run with a checkpoint after every block, that is broken off or not."""
    blocks = solver.simulate(*scene)

    def some():
        for k, block in enumerate(blocks):
            yield block
            if k + 1 == ends:
                raise KeyboardInterrupt

    around = hdf5.Around(every=1e-9)
    return hdf5.write(folder / "x.h5", *scene, some() if ends else blocks, around)


def again(folder, scene):
    """The same run anew, or from its checkpoint if it has one that can be read."""
    path, kept = folder / "x.h5", None
    if checkpoint.waiting(path):
        kept = checkpoint.load(checkpoint.beside(path))
    blocks = solver.simulate(*scene, kept.state if kept else None)
    return hdf5.write(path, *scene, blocks, hdf5.Around(kept=kept))


def test_a_run_killed_at_any_instant(scene, tmp_path, monkeypatch, at_once):
    """Begun, gone on with from a checkpoint, or recovered from."""
    monkeypatch.setattr(solver, "VISIT", 15)  # steps of a block
    here, kept = tmp_path / "here", tmp_path / "kept"
    here.mkdir()
    with pytest.raises(KeyboardInterrupt):
        begun(here, scene, 2)
    with instants(here, kept):
        whole = again(here, scene)["content_sha256"]
    (here / "x.h5").unlink()
    with instants(here, tmp_path / "more"):
        assert begun(here, scene)["content_sha256"] == whole
    folders = [*sorted(kept.iterdir()), *sorted((tmp_path / "more").iterdir())]
    assert len(folders) > 20
    for folder in folders:
        for path in folder.iterdir():
            kind = ENDING.get(path.name.removeprefix("x.h5"))
            assert kind is None or own.exists(path, kind), (folder, path)
    parts = set()
    for folder in some(folders):
        refuse_if_written(folder / "x.h5")
        part = folder / "x.h5.part"
        content = part.read_bytes() if part.exists() else None
        if content is not None and content not in parts:  # recovered in a process of its own
            parts.add(content)
            try:
                recover(part, tmp_path / "recovered.h5")
            except FileError as error:
                assert "recover" in str(error)
        summary = again(folder, scene)
        assert summary["content_sha256"] == whole
        assert [path.name for path in folder.iterdir()] == ["x.h5"]


def named(folder):
    """All names but of what was to take the place of a plan or an index: it has a number."""
    return sorted(path.name for path in folder.rglob("*") if not path.name[-1].isdigit())


def test_a_sweep_killed_at_any_instant(tmp_path):
    def run(tasks):
        for task in tasks:
            yield task, job.run(task, lambda: None)

    (tmp_path / "crank.yaml").write_text(TEXT)
    planned = plan(str(tmp_path / "crank.yaml"), SETS, "one")
    here, kept = tmp_path / "here", tmp_path / "kept"
    here.mkdir()
    with instants(here, kept):
        list(go(planned, here, "one", run))
    whole, names = contents(here), named(here)
    folders = sorted(kept.iterdir())
    assert len(folders) > 20
    for folder in some(folders):
        try:
            list(go(planned, folder, "one", run))
        except (FileError, UsageError) as error:
            raise AssertionError(f"{folder}: {error}") from error
        assert contents(folder) == whole
        assert named(folder) == names
