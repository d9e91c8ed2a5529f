"""What commands may write over, and of which file they speak when they cannot write."""

import errno
import os
import socket
import stat

import h5py
import pytest

from tests import inside, small
from tests.elsewhere import needs
from tests.store import outside
from trsim.errors import FileError, UsageError
from trsim.store import target as targets
from trsim.store.read import read
from trsim.store.target import RESULT, replaceable

WRITERS = {  # command line, with the file it is asked to write at the end
    "run": ("run", "crank.yaml", "-o"),
    "export": ("export", "x.h5", "--csv", "-o"),
    "recover": ("recover", "x.h5", "-o"),
    "schema": ("schema", "-o"),
}
FIGURES = {"report": "peaks.png", "bench": "work_precision.csv"}
QUICK = ("--methods", "dop853", "--tolerances", "1e-3", "--reference", "dop853:1e-5",
         "--repeats", "1")  # fmt: skip


@pytest.fixture
def folder(scenario, monkeypatch):
    """A scenario, its result, and a table of loads, in the current folder."""
    inside.recovering(monkeypatch)
    small.copy(scenario.parent / "x.h5", *small.FEW)
    (scenario.parent / "load.csv").write_text("time [s],force [N]\n0,1\n1,2\n")
    (scenario.parent / "crlf.csv").write_bytes(b"time [s],force [N]\r\n0,1\r\n1,2\r\n")
    (scenario.parent / "some.json").write_text('{"title": "of mine"}')
    with h5py.File(scenario.parent / "other.h5", "w") as file:
        file["precious"] = [1.0]
    return scenario.parent


# --- what is no file -------------------------------------------------------------------------


@pytest.mark.parametrize("command", WRITERS)
@pytest.mark.parametrize("kind", ["FIFO", "socket"])
def test_neither_fifo_nor_socket_is_replaced(command, kind, folder, trsim):
    if kind == "FIFO":
        os.mkfifo("node")
    else:
        with socket.socket(socket.AF_UNIX) as made:
            made.bind("node")
    code, _, err = trsim(*WRITERS[command], "node")
    assert code == 2
    assert f"node is a {kind}, not a file" in err
    assert not stat.S_ISREG(os.stat("node").st_mode)


def test_a_device_is_not_replaced(tmp_path, monkeypatch):
    node = tmp_path / "node"
    node.write_bytes(b"")
    values = list(node.stat())
    values[0] = stat.S_IFCHR | 0o666
    monkeypatch.setattr(targets.Path, "stat", lambda _: os.stat_result(values))
    with pytest.raises(UsageError, match="is a device, not a file"):
        replaceable(node, RESULT)


@pytest.mark.parametrize("command", [*WRITERS])
def test_a_link_stands_for_its_file(command, folder, trsim):
    (folder / "deep").mkdir()
    os.symlink("deep/y", "link")
    assert trsim(*WRITERS[command], "link")[0] == 0
    assert os.path.islink("link") and (folder / "deep/y").stat().st_size > 100
    assert trsim(*WRITERS[command], "link")[0] == 0  # what it wrote itself
    (folder / "deep/y").write_text("something else")
    assert trsim(*WRITERS[command], "link")[0] == 2
    assert (folder / "deep/y").read_text() == "something else"


# --- files of others -------------------------------------------------------------------------


@pytest.mark.parametrize("command", WRITERS)
@pytest.mark.parametrize("name", ["crank.yaml", "load.csv", "crlf.csv", "some.json", "other.h5"])
def test_files_of_others_are_left_alone(command, name, folder, trsim):
    before = (folder / name).read_bytes()
    code, _, err = trsim(*WRITERS[command], name)
    assert code == 2
    assert f"{name} exists and is not a" in err
    assert (folder / name).read_bytes() == before


@pytest.mark.parametrize("command", ["run", "export", "recover"])
def test_input_is_left_alone(command, folder, trsim):
    before = (folder / "x.h5").read_bytes()
    words = ("run", "x.h5", "-o") if command == "run" else WRITERS[command]
    for name in ("x.h5", "./x.h5"):
        code, _, err = trsim(*words, name)
        assert code == 2, err
    os.link("x.h5", "same.h5")
    assert trsim(*words, "same.h5")[0] == 2
    assert (folder / "x.h5").read_bytes() == before


def test_recover_to_the_name_of_the_run(folder, trsim):
    """The part file of that name is what is being read."""
    (folder / "x.h5").rename("y.h5.part")
    before = (folder / "y.h5.part").read_bytes()
    assert trsim("recover", "y.h5.part", "-o", "y.h5")[0] == 0
    assert read("y.h5").rows == 301
    assert (folder / "y.h5.part").read_bytes() == before


@pytest.mark.parametrize("command", WRITERS)
def test_write_protected(command, folder, trsim):
    (folder / "deep").mkdir()
    assert trsim(*WRITERS[command], "deep/y")[0] == 0
    before = (folder / "deep/y").read_bytes()
    (folder / "deep/y").chmod(0o444)
    code, _, err = trsim(*WRITERS[command], "deep/y")
    assert code == 7
    assert "deep/y is write-protected" in err
    assert (folder / "deep/y").read_bytes() == before


@pytest.mark.parametrize("command", FIGURES)
def test_figures_and_tables_of_others(command, folder, trsim, monkeypatch):
    monkeypatch.setattr("trsim.report.figures.draw", lambda *_: [])  # peaks are enough
    words = ("report", "x.h5") if command == "report" else ("bench", "crank.yaml", *QUICK)
    for _ in range(2):  # their own are replaced
        assert trsim(*words, "-o", "figures")[0] == 0
    other = folder / "figures" / FIGURES[command]
    other.write_bytes(b"\x89PNG\r\n\x1a\n of somebody else")
    code, _, err = trsim(*words, "-o", "figures")
    assert code == 2
    assert f"{other.name} exists and is not a" in err
    assert other.read_bytes().endswith(b"of somebody else")


def test_a_part_of_something_else(folder, trsim):
    (folder / "y.h5.part").write_text("a part in a play")
    code, _, err = trsim("run", "crank.yaml", "-o", "y.h5")
    assert code == 2 and "y.h5.part exists and is not a part of a result file" in err
    assert (folder / "y.h5.part").read_text() == "a part in a play"


def test_empty_name(folder, trsim):
    for words in (*WRITERS.values(), ("report", "x.h5", "-o"), ("bench", "crank.yaml", "-o")):
        code, _, err = trsim(*words, "")
        assert code == 2 and "the name of the output is empty" in err
    assert not (folder / "runs").exists()


def test_bench_sees_its_folder_first(folder, trsim, monkeypatch):
    monkeypatch.setattr("trsim.cli.bench.measured", None)
    monkeypatch.setattr("trsim.store.target.TemporaryFile", failing(errno.EROFS))
    code, _, err = trsim("bench", "crank.yaml", *QUICK, "-o", "figures")
    assert code == 7
    assert "figures: cannot be written: Read-only file system" in err


# --- what is no input ------------------------------------------------------------------------

READERS = {
    "run": (), "check": (), "show": (), "report": (), "export": ("--csv",), "recover": (),
    "bench": QUICK,
}  # fmt: skip


@pytest.mark.parametrize("command", READERS)
def test_folder_and_fifo_as_input(command, folder, answer):
    os.mkfifo("ff")
    for name, kind in ((".", "folder"), ("ff", "FIFO")):
        code, document = answer(command, name, *READERS[command])
        assert code == 7
        [error] = document["errors"]
        if (command, kind) == ("report", "folder"):  # of a sweep, it may be
            assert error["what"] == ".: not the folder of a sweep"
        else:
            assert error["what"] == f"{name} is a {kind}, not a file"
        assert error["file"] == name


@pytest.mark.parametrize("command", READERS)
def test_unreadable_input(command, folder, answer, monkeypatch):
    """As a file with mode 000 is for anybody but the superuser."""
    name = "crank.yaml" if command in ("run", "check", "bench") else "x.h5"
    opened = open

    def refused(path, *rest, **named):
        if os.path.basename(os.fspath(path)) == name:
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return opened(path, *rest, **named)

    monkeypatch.setattr("builtins.open", refused)
    monkeypatch.setattr("io.open", refused)  # of Path.open
    code, document = answer(command, name, *READERS[command])
    [error] = document["errors"]
    assert (code, error["file"]) == (7, name)
    assert error["what"].lower() == f"{name}: permission denied"


# --- what cannot be written ------------------------------------------------------------------


def failing(number):
    def fails(*_, **__):
        raise OSError(number, os.strerror(number))

    return fails


@needs("resource")
def test_export_to_a_full_disk(folder):
    """Told of the table, not of the file it is made of; nothing is left of it."""
    limited = "import resource as r; r.setrlimit(r.RLIMIT_FSIZE, (20000, 20000))\n"
    code = limited + "from trsim.cli import main; main(['export', 'x.h5', '--csv', '-o', 't.csv'])"
    process = outside.started(folder, "-c", code)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 7
    assert err == "error: t.csv: cannot be written: File too large\n"
    assert not [path for path in folder.iterdir() if path.name.startswith("t.csv")]


def test_export_that_is_interrupted_leaves_nothing(folder, trsim, monkeypatch):
    before = set(folder.iterdir())

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("trsim.store.export.columns.Columns.blocks", interrupted)
    assert trsim("export", "x.h5", "--csv")[0] == 130
    assert set(folder.iterdir()) == before


@needs("resource")
@pytest.mark.parametrize("limit", [40_000, 150_000])
def test_recover_to_a_full_disk(limit, folder):
    limited = f"import resource as r; r.setrlimit(r.RLIMIT_FSIZE, ({limit}, {limit}))\n"
    code = limited + "from trsim.cli import main; main(['recover', 'x.h5', '-o', 'y.h5', '-q'])"
    process = outside.started(folder, "-c", code)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 7
    assert err.startswith("error: y.h5: ") and "File too large" in err and "damaged" not in err
    assert not [path for path in folder.iterdir() if path.name.startswith("y.h5")]


@needs("resource")
def test_report_to_a_full_disk(folder):
    limited = "import resource as r; r.setrlimit(r.RLIMIT_FSIZE, (4000, 4000))\n"
    code = limited + "from trsim.cli import main; main(['report', 'x.h5', '-o', 'figures', '-q'])"
    process = outside.started(folder, "-c", code, MPLCONFIGDIR=str(folder))
    _, err = process.communicate(timeout=60)
    assert process.returncode == 7
    assert "cannot be written: File too large" in err and "error: figures/" in err
    assert not (folder / "figures").exists()


def test_folder_that_cannot_be_written_to(folder, answer, monkeypatch):
    monkeypatch.setattr(targets, "make", failing(errno.EROFS))
    for words in (WRITERS["export"], WRITERS["recover"], WRITERS["schema"]):
        code, document = answer(*words, "deep/y")
        assert code == 7
        [error] = document["errors"]
        assert error["what"] == "deep/y: cannot be written: Read-only file system"
        assert error["file"] == "deep/y"


# --- nobody listens --------------------------------------------------------------------------


@pytest.mark.parametrize(
    "words, closed, code",
    [
        (("show", "x.h5"), ">&-", 0),
        (("show", "none.h5"), ">&-", 7),
        (("check", "crank.yaml"), ">&-", 0),
        (("run", "crank.yaml"), "2>&-", 0),
        (("show", "x.h5", "--json"), ">&- 2>&- <&-", 0),
        (("check", "none.yaml"), "2>/dev/full", 7),
    ],
)
def test_closed_streams(words, closed, code, folder):
    shell = outside.started(
        folder, "-c", "import os, sys; os.execv('/bin/sh', ['sh', '-c', sys.argv[1]])",
        f'"{outside.sys.executable}" -m trsim {" ".join(words)} {closed}',
    )  # fmt: skip
    out, err = shell.communicate(timeout=60)
    assert shell.returncode == code, err
    assert "Traceback" not in out + err and "Exception" not in err


@pytest.mark.parametrize("words", ["schema", "--version", "--help"])
def test_a_full_disk_behind_standard_output_is_named(words, tmp_path):
    with open("/dev/full", "w") as full:
        process = outside.trsim(tmp_path, words, stdout=full)
        assert process.communicate(timeout=60)[1].startswith("error: standard output: No space")
        assert process.returncode == 7


def test_file_errors_keep_their_file():
    assert FileError("x", file="f").at("a").file == "f"


def test_a_scenario_without_bodies(folder, answer):
    (folder / "empty.yaml").write_text("solver: {end: 1}\n")
    code, document = answer("check", "empty.yaml")
    assert (code, document["scenarios"][0]["bodies"]) == (0, [])
