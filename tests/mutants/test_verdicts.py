"""What is known of a mutation, and how long it stands."""

import json

import pytest

from . import verdicts
from .operators import mutations
from .verdicts import Verdicts

SOURCE = "def length(a, b):\n    return a + b\n"


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project of one source and one test, and a way to change it."""
    for room in ("trsim", "tests"):
        (tmp_path / room).mkdir()
    (tmp_path / "trsim/line.py").write_text(SOURCE)
    (tmp_path / "tests/test_line.py").write_text("first")
    monkeypatch.setattr(verdicts, "ROOT", tmp_path)
    monkeypatch.setattr(verdicts, "sha", lambda file: (tmp_path / file).read_text())
    monkeypatch.setattr(
        verdicts, "digest", lambda: "".join(p.read_text() for p in tmp_path.rglob("*.py"))
    )
    return tmp_path


def told(verdict, by=""):
    (one,) = (m for m in mutations("trsim/line.py", SOURCE.encode()) if m.operator == "arithmetic")
    return one, {"file": one.file, "start": one.start, "new": one.new, "operator": one.operator,
                 "verdict": verdict, "by": by, "whole": True,
                 "told": one.told(SOURCE.encode())}  # fmt: skip


def known(project, one):
    return Verdicts(project / "verdicts.jsonl").of(one)


def test_killed_stands_until_source_or_test_changes(project):
    one, found = told("killed", "tests/test_line.py::test_sum")
    Verdicts(project / "verdicts.jsonl").add(one, found)
    (project / "tests/test_other.py").write_text("new")
    assert known(project, one)["verdict"] == "killed"
    (project / "trsim/line.py").write_text(f"{SOURCE}\n# another one")
    assert known(project, one) is None
    (project / "trsim/line.py").write_text(SOURCE)
    (project / "tests/test_line.py").write_text("second")
    assert known(project, one) is None


def test_survived_stands_until_anything_changes(project):
    one, found = told("survived")
    Verdicts(project / "verdicts.jsonl").add(one, found)
    assert known(project, one)["verdict"] == "survived"
    (project / "tests/test_other.py").write_text("new")
    assert known(project, one) is None


def test_tidied_file_has_what_stands_once(project):
    file = project / "verdicts.jsonl"
    one, found = told("survived")
    kept = Verdicts(file)
    kept.add(one, found)
    kept.add(one, {**found, "verdict": "killed", "by": "tests/test_line.py::test_sum"})
    file.open("a").write('{"cut o')
    again = Verdicts(file)
    again.tidy([one])
    (line,) = file.read_text().splitlines()
    assert json.loads(line)["verdict"] == "killed"


def test_what_noticed_it_before_is_told_though_lines_have_moved(project):
    one, found = told("killed", "tests/test_line.py::test_sum")
    Verdicts(project / "verdicts.jsonl").add(one, found)
    moved = f'"""A line."""\n{SOURCE}'
    (project / "trsim/line.py").write_text(moved)
    (one,) = (m for m in mutations("trsim/line.py", moved.encode()) if m.operator == "arithmetic")
    kept = Verdicts(project / "verdicts.jsonl")
    assert kept.of(one) is None
    assert kept.before(one)["by"] == "tests/test_line.py::test_sum"
    kept.tidy([one])
    assert Verdicts(project / "verdicts.jsonl").before(one) == kept.before(one)
