"""What is told while something takes its time, and where nothing can be kept."""

import time

from tests.store import outside
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
    progress.see_kept(Answer("run", False))
    err = capsys.readouterr().err
    assert "every run compiles anew" in err and "file/trsim/code: cannot be written: Not a" in err
    assert "XDG_CACHE_HOME" in err
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "good"))
    progress.see_kept(Answer("run", False))
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
