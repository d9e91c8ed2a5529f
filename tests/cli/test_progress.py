"""What is told while something takes its time, and where nothing can be kept."""

import time

from tests.store import outside
from trsim.api import compiling
from trsim.cli import progress
from trsim.cli.frame import Answer


def test_what_takes_a_while_is_told(capsys, monkeypatch):
    monkeypatch.setattr(progress, "WHILE", 0.5)
    with progress.Doing(Answer("check", False), "x.yaml") as doing:
        doing("the first")
        doing("the second")
        time.sleep(1.5)
        doing("the third")
    assert capsys.readouterr().err == "x.yaml: the second ...\nx.yaml: the third ...\n"


def test_what_is_quick_is_not(scenario, trsim, monkeypatch):
    monkeypatch.setattr(progress, "WHILE", 60.0)  # kernels may have to be compiled
    assert trsim("check", "crank.yaml")[2] == ""


def test_check_tells_its_stages(scenario, trsim, monkeypatch):
    monkeypatch.setattr(progress, "WHILE", 0.0)
    err = trsim("check", "crank.yaml")[2]
    assert "crank.yaml: looking for the start and its time scales ...\n" in err


def test_cache_that_cannot_be_written(scenario, capsys, monkeypatch, tmp_path):
    """Said once, with the reason and the variable, where something has to be compiled."""
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    compiling.warn_of_code_not_kept(Answer("run", False))
    err = capsys.readouterr().err
    assert "every run compiles anew" in err and "file/trsim/code: cannot be written: Not a" in err
    assert "XDG_CACHE_HOME" in err
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "good"))
    compiling.warn_of_code_not_kept(Answer("run", False))
    assert capsys.readouterr().err == ""
    assert list((tmp_path / "good/trsim/code").iterdir()) == []


def test_check_asks_whether_it_can_be_kept(tmp_path):
    """The first command of an installation does."""
    (tmp_path / "crank.yaml").write_text(outside.small.SLIDER_CRANK)
    (tmp_path / "file").write_text("")
    cache = {"XDG_CACHE_HOME": str(tmp_path / "file")}
    process = outside.trsim(tmp_path, "check", "crank.yaml", **cache)
    told = process.stderr.readline()
    outside.killed(process)
    assert told.startswith("warning: machine code cannot be kept")


class Ended:
    failed = False


def test_lines_of_a_run_that_goes_on(capsys, monkeypatch):
    """The time left is that of what is done since it went on."""
    now = iter([0.0, 0.0, 5.0, 20.0])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(now))
    meter = progress.Meter(Answer("run", False), "x.yaml", 2.0)
    for done in (1.0, 1.2, 1.5):
        meter.update(done, "at work", "more")
    meter.close()
    assert capsys.readouterr().err == "x.yaml: more, 20 s left\n"


def test_lines_of_a_sweep(capsys, monkeypatch):
    now = iter([0.0, 11.0, 12.0, 22.0])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(now))
    cases = progress.Cases(Answer("sweep", False), "runs/study", 4)
    for _ in range(4):
        cases.ended(Ended)
    assert capsys.readouterr().err.splitlines() == [
        "runs/study: 1 of 4 cases, 33 s left", "runs/study: 3 of 4 cases, 7 s left",
    ]  # fmt: skip


def test_a_bar_on_a_terminal(capsys, monkeypatch):
    monkeypatch.setattr(progress.sys.stderr, "isatty", lambda: True, raising=False)
    now = iter([0.0, 0.0, 0.5, 2.0, 2.1, 2.5])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(now))
    drawn = []

    class Bar:
        def add_task(self, name, **fields):
            return name

        def update(self, task, **fields):
            drawn.append((task, fields["completed"]))

        def stop(self):
            drawn.append("stopped")

    monkeypatch.setattr(progress, "bar", Bar)
    meter = progress.Meter(Answer("run", False), "a/x.yaml", 2.0)
    for done in (0.0, 0.5, 1.0, 1.1, 1.5):
        meter.update(done, "at work")
    meter.close()
    assert drawn == [("x", 1.0), ("x", 1.5), "stopped"]
