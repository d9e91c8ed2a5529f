"""Names that trsim uses beside its results: what somebody else has put there stays as it is."""

import os

import pytest

from tests import small
from trsim.errors import FileError
from trsim.solve import simulate as solver
from trsim.store.target import check_writable
from trsim.sweeps import job
from trsim.sweeps.go import sweep_out
from trsim.sweeps.ledger import Ledger, entries

PRECIOUS = b"the only copy of something\n"


def link(path, precious):
    path.symlink_to(precious)


def dangling(path, precious):
    path.symlink_to(precious.with_name("not there"))


def second_name(path, precious):
    os.link(precious, path)


def file(path, precious):
    path.write_bytes(PRECIOUS)


def folder(path, precious):
    path.mkdir()


def pipe(path, precious):
    os.mkfifo(path)


PLANTED = (link, dangling, second_name, file, folder, pipe)


@pytest.fixture
def plant(tmp_path):
    """plant(how, path) puts something under a name; at the end all of it must be as it was."""
    safe = tmp_path / "safe"
    safe.mkdir()
    (safe / "precious").write_bytes(PRECIOUS)
    planted = []

    def put(how, path):
        path.parent.mkdir(parents=True, exist_ok=True)
        how(path, safe / "precious")
        planted.append((path, path.lstat()))

    yield put
    assert (safe / "precious").read_bytes() == PRECIOUS
    assert [path.name for path in safe.iterdir()] == ["precious"]
    for path, before in planted:
        now = path.lstat()
        assert (now.st_ino, now.st_mode, now.st_size, now.st_mtime_ns) == (
            before.st_ino, before.st_mode, before.st_size, before.st_mtime_ns,
        )  # fmt: skip


BESIDE = (".part", ".part.new", ".part.room", ".checkpoint", ".checkpoint.new", ".lock")


@pytest.mark.parametrize("how", PLANTED)
@pytest.mark.parametrize("ending", BESIDE)
def test_run_leaves_what_has_the_name_of_a_side_file(ending, how, plant, scenario, trsim,
                                                     monkeypatch):  # fmt: skip
    monkeypatch.setattr(solver, "VISIT", 15)  # several blocks: a checkpoint after each
    plant(how, scenario.parent / f"x.h5{ending}")
    code, _, err = trsim("run", "crank.yaml", "-o", "x.h5", "--checkpoint", "1e-9")
    assert code == 0 if ending == ".part.room" else code in (2, 7)
    assert code == 0 or f"x.h5{ending}" in err


@pytest.mark.parametrize("how", [link, second_name, file, folder])
@pytest.mark.parametrize("words, target", [
    (("export", "x.h5", "--csv", "-o", "x.csv"), "x.csv"), (("schema", "-o", "x.json"), "x.json"),
])  # fmt: skip
def test_names_that_end_in_the_number_of_the_process(words, target, how, plant, scenario, trsim):
    small.copy(scenario.parent / "x.h5")
    plant(how, scenario.parent / f"{target}.{os.getpid()}")
    assert trsim(*words)[0] == 0
    assert (scenario.parent / target).stat().st_size > 0


@pytest.mark.parametrize("how", PLANTED)
def test_a_folder_is_tried_without_a_name(how, plant, tmp_path):
    plant(how, tmp_path / f".trsim.{os.getpid()}")
    check_writable(tmp_path)


@pytest.mark.parametrize("how", PLANTED)
def test_sweep_leaves_what_has_the_name_of_a_side_file(how, plant, tmp_path):
    """Of a case: the lock of a dead process, a part that no checkpoint goes with; a ledger."""
    cases = tmp_path / "cases"
    plant(how, cases / "one.h5.lock")
    sweep_out(tmp_path)
    plant(how, cases / "two.h5.part")
    with pytest.raises(FileError, match=r"two\.h5\.part"):
        job._checkpoint(cases / "two.h5", None)
    if how not in (file, second_name):  # a ledger is added to
        plant(how, tmp_path / "ledger.jsonl")
        assert entries(tmp_path) == {}
        with pytest.raises(OSError):
            Ledger(tmp_path)


def test_sweep_removes_what_dead_processes_left(tmp_path):
    cases = tmp_path / "cases"
    cases.mkdir()
    (cases / "one.h5.lock").write_text("4711\n")
    (cases / "two.h5.part").write_bytes(bytes(100))
    sweep_out(tmp_path)
    assert job._checkpoint(cases / "two.h5", None) is None
    assert list(cases.iterdir()) == []
