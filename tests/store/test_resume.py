"""A run that ended early goes on from its checkpoint: the result is that of an unbroken run."""

import contextlib
import errno
import io
import json
import os
import re
import shutil
import signal
from pathlib import Path

import h5py
import numpy as np
import pytest

from tests import small
from tests.elsewhere import needs
from tests.sizes import size
from tests.store import outside
from trsim.assemble.assemble import assemble
from trsim.assemble.instances import Column
from trsim.cli import main
from trsim.errors import FileError
from trsim.scenario.load import loads
from trsim.solve import simulate as solver
from trsim.store import checkpoint, describe, hdf5, peaks
from trsim.store.hdf5 import write
from trsim.store.read import read, verify

CUTS = 20
TRIED = size(4, 1)  # each kind goes on from every so many cuts, not from the same ones
ALWAYS = 1e-9  # s between two checkpoints: one after every block
INERTIAS = [f"bodies.{b}.inertia=[1e-4, 2e-4, 2e-4]" for b in ("crank", "rod", "slider")]
SPATIAL = ("planar=false", *INERTIAS)
RK4 = ("solver.method=rk4", "solver.step=4us")
# all channels of one kind: what a file does with one it does with each
KINDS = {"dop853": (), "dop853 spatial": (*small.FEW, *SPATIAL), "rk4": (*small.FEW, *RK4),
         "rk4 spatial": (*small.FEW, *RK4, *SPATIAL)}  # fmt: skip


def cut(path, scenario, mechanism, blocks, closed=False):
    """A run that ends after some blocks; its file is closed, or as a kill would leave it."""
    running = solver.simulate(scenario, mechanism)

    def some():
        for _ in range(blocks):
            yield next(running)
        raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch:
        if not closed:
            patch.setattr(hdf5.Running, "finish", lambda run, *_: run.abandon())
        with pytest.raises(KeyboardInterrupt):
            write(path, scenario, mechanism, some(), hdf5.Around(every=1e9))


def resumed(path, scenario, mechanism):
    """The rest of a run; its summary."""
    kept = checkpoint.load(checkpoint.beside(path))
    running = solver.simulate(scenario, mechanism, kept.state)
    return write(path, scenario, mechanism, running, hdf5.Around(kept=kept))


@pytest.mark.parametrize("kind", KINDS)
def test_bit_identical_from_every_cut(kind, tmp_path, monkeypatch, at_once):
    """One run, its folder copied after every block: so would a kill have left it."""
    path = tmp_path / "run.h5"
    unbroken = small.run(path, *KINDS[kind])["content_sha256"]
    assert read(path).phase and len(read(path).poincare["journal"].x) > 2
    monkeypatch.setattr(solver, "VISIT", read(path).group("solver")["steps"] // (CUTS + 2))
    path.unlink()
    scenario = loads(small.SLIDER_CRANK, KINDS[kind])
    mechanism = assemble(scenario)

    def some():
        running = solver.simulate(scenario, mechanism)
        for k in range(CUTS):
            yield next(running)
            shutil.copytree(path.parent, f"{tmp_path}.{k}")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write(path, scenario, mechanism, some(), hdf5.Around(every=ALWAYS))
    for k in range([*KINDS].index(kind) % TRIED, CUTS, TRIED):
        left = Path(f"{tmp_path}.{k}/run.h5")
        assert resumed(left, scenario, mechanism)["content_sha256"] == unbroken, k
        assert [p.name for p in left.parent.iterdir()] == ["run.h5"]


def test_cut_again_and_again(tmp_path, monkeypatch, scenario, mechanism):
    """Each attempt comes two blocks further, with checkpoints of its own."""
    path = tmp_path / "run.h5"
    unbroken = small.run(path)["content_sha256"]
    monkeypatch.setattr(solver, "VISIT", 15)
    cut(path, scenario, mechanism, 2)
    for _ in range(3):
        kept = checkpoint.load(checkpoint.beside(path))
        running = solver.simulate(scenario, mechanism, kept.state)

        def some(running=running):
            yield next(running)
            yield next(running)
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            write(path, scenario, mechanism, some(), hdf5.Around(every=ALWAYS, kept=kept))
        assert read(tmp_path / "run.h5.part").attributes["status"] == "interrupted"
    assert resumed(path, scenario, mechanism)["content_sha256"] == unbroken
    assert verify(path)
    told = read(path).group("provenance")
    assert told["resumed"] == 4
    assert len(told["resumed_at"].split("; ")) == 4
    assert f"t = {kept.time:g} s on 20" in told["resumed_at"]


def test_rows_in_many_chunks(tmp_path):
    """Full chunks come from the part file, the rest from the checkpoint."""
    path, sets = tmp_path / "run.h5", ("output.every=0.2us", "solver.end=4ms")
    unbroken = small.run(path, *sets)["content_sha256"]
    scenario = loads(small.SLIDER_CRANK, sets)
    mechanism = assemble(scenario)
    cut(path, scenario, mechanism, 18, closed=True)
    kept = checkpoint.load(checkpoint.beside(path))
    assert kept.rows["/"] > 8192 and 0 < len(kept.tail["/time"]) < 4096
    damage = tmp_path / "run.h5.part"
    with h5py.File(damage, "r+") as file:  # what comes after a checkpoint may be anything
        file["B.force"][8192:] = np.nan
        file["time"].resize(8192, axis=0)
    assert resumed(path, scenario, mechanism)["content_sha256"] == unbroken


def test_of_equal_extremes_the_first_counts():
    """Wherever the rows between them are cut into blocks."""
    column = Column("O.reaction", "N", "", 0, 3, wanted=True)
    for vector in np.random.default_rng(3).normal(size=(50, 3)):
        magnitudes, impacts = peaks.Magnitudes((column,)), describe.Impacts(1)
        for t in (1.0, 2.0, 3.0):
            magnitudes.update(np.array([[t, *vector]]))
            impacts.press(0, np.array([[t, 0.0, 7.0]]), 2)
        value, when = magnitudes.of("O.reaction")
        assert value == pytest.approx(np.linalg.norm(vector), rel=1e-15) and when == 1.0
        assert impacts.of[0, impacts.WHEN] == 1.0


def test_no_checkpoint_unless_asked_for(tmp_path, scenario, mechanism, monkeypatch):
    """Neither while a run goes on, nor after an interrupt; one of another run does not stay."""
    path = tmp_path / "run.h5"
    monkeypatch.setattr(solver, "VISIT", 15)
    cut(path, scenario, mechanism, 1)
    assert checkpoint.beside(path).exists()

    def begun():
        yield next(solver.simulate(scenario, mechanism))
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write(path, scenario, mechanism, begun())
    assert not checkpoint.beside(path).exists()


def full(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_disk_without_room_to_go_on(tmp_path, monkeypatch, scenario, mechanism, at_once):
    """Before the old part is replaced, or at the next checkpoint: it is told how to go on."""
    path = tmp_path / "run.h5"
    monkeypatch.setattr(solver, "VISIT", 15)
    cut(path, scenario, mechanism, 2, closed=True)
    kept = checkpoint.load(checkpoint.beside(path))
    left = r"run\.h5\.part holds the run until t = \S+ s; `trsim recover .*` makes it a result "
    left += "file, `trsim run x.yaml --resume` goes on with the run"
    for module, name in ((hdf5, "check_room"), (checkpoint, "synced")):
        running = solver.simulate(scenario, mechanism, kept.state)
        with monkeypatch.context() as patch, pytest.raises(FileError) as error:
            patch.setattr(module, name, full)
            around = hdf5.Around("", ALWAYS, kept, again="trsim run x.yaml --resume")
            write(path, scenario, mechanism, running, around)
        assert "No space left on device" in error.value.what and error.value.file
        assert re.search(left, error.value.hint), error.value.hint
    resumed(path, scenario, mechanism)
    assert verify(path)


# --- ended in processes of their own, and gone on with in this one ---


def trsim(folder, *arguments):
    """`trsim run` of the long scenario, in this process; code, document, stderr."""
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err),
        pytest.raises(SystemExit) as ended,
    ):  # fmt: skip
        main(["run", "crank.yaml", "--json", *arguments])
    assert "Traceback" not in err.getvalue()
    return ended.value.code, json.loads(out.getvalue()), err.getvalue()


END = ("--set", "solver.end=0.12")


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory):
    """The hash of the run that the following ones end early."""
    folder = tmp_path_factory.mktemp("unbroken")
    (folder / "crank.yaml").write_text(small.SLIDER_CRANK)
    return trsim(folder, *END)[1]["runs"][0]["content_sha256"]


@pytest.mark.parametrize("number, code", [
    (signal.SIGKILL, -9), (signal.SIGTERM, 143), (signal.SIGINT, 130),
])  # fmt: skip
def test_signal_and_resume(number, code, tmp_path, unbroken):
    process = outside.begun(tmp_path, *END, "--checkpoint", str(ALWAYS))
    while not (tmp_path / "runs/crank.h5.checkpoint").exists():
        outside.blocks_until(process, 0.0)
    process.send_signal(number)
    process.communicate(timeout=20)
    assert process.returncode == code
    assert (tmp_path / "runs/crank.h5.checkpoint").exists()
    last = read(tmp_path / "runs/crank.h5.part").time[-1]
    code, document, err = trsim(tmp_path, *END, "--resume")
    assert code == 0, err
    (summary,) = document["runs"]
    assert summary["content_sha256"] == unbroken
    assert 0.0 < summary["resumed_from"] <= last + 1e-5
    if number != signal.SIGKILL:  # a last checkpoint: not a row is lost
        assert last <= summary["resumed_from"]
    assert f"goes on at t = {summary['resumed_from']:.6g} s" in err
    assert read(tmp_path / "runs/crank.h5").group("provenance")["resumed"] == 1
    assert {p.name for p in (tmp_path / "runs").iterdir()} == {"crank.h5"}


@needs("resource")
def test_full_disk_and_resume(tmp_path, unbroken):
    process = outside.begun(tmp_path, *END, "--checkpoint", str(ALWAYS), limit=5_000_000)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 7 and "cannot be written beyond" in err
    code, document, err = trsim(tmp_path, *END, "--resume")
    assert code == 0, err
    assert document["runs"][0]["content_sha256"] == unbroken
    assert document["runs"][0]["resumed_from"] > 0.0
