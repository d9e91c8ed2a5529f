"""A trial: which failures count, in a project of three lines."""

import shutil

import pytest

from . import trial
from .operators import mutations
from .trial import Times, Tree, tried

SOURCE = "def length(a, b):\n    return max(a, b) - min(a, b)\n"
TESTS = {
    "test_other.py": "def test_nothing():\n    assert True\n",
    "test_broken.py": "def test_never():\n    assert False\n",
    "test_length.py": "from trsim.room.line import length\n\n\n"
    "def test_one_way():\n    assert length(3, 1) == 2\n",
}


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """A project with a source, tests that see it, that do not, and one that always fails."""
    root = tmp_path / "root"
    (root / "trsim/room").mkdir(parents=True)
    (root / "tests/room").mkdir(parents=True)
    for folder in ("trsim", "trsim/room", "tests", "tests/room"):
        (root / folder / "__init__.py").touch()
    (root / "trsim/room/line.py").write_text(SOURCE)
    for name, text in TESTS.items():
        (root / "tests/room" / name).write_text(text)
    for name in ("mutated", "whole"):
        shutil.copytree(root, tmp_path / name)
    monkeypatch.setattr(trial, "ROOT", root)
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # of which none has a part here
    times = Times(tmp_path / "seconds.json")
    return Tree(tmp_path / "mutated", tmp_path / "whole", tmp_path / "cache", times)


def one(operator, new):
    found = mutations("trsim/room/line.py", SOURCE.encode())
    (mutation,) = (m for m in found if (m.operator, m.new) == (operator, new))
    return mutation


def test_killed_by_a_test_that_sees_it(tree):
    found = tried(tree, one("arithmetic", "+"), 0, 100.0)
    assert (found["verdict"], found["by"]) == (
        "killed", "tests/room/test_length.py::test_one_way",
    )  # fmt: skip
    assert (tree.mutated / "trsim/room/line.py").read_text() == SOURCE


def test_survives_what_fails_anyway(tree):
    kept = SOURCE.replace("max(a, b)", "max(a, a)").encode()
    mutation = type(one("arithmetic", "+"))("trsim/room/line.py", 2, 0, len(SOURCE),
                                            kept.decode(), "by hand")  # fmt: skip
    found = tried(tree, mutation, 0, 100.0)
    assert (found["verdict"], found["whole"], found["tests"]) == ("survived", True, 2)
    assert tree.broken == {"tests/room/test_broken.py::test_never"}
    assert set(tree.times.seconds) == {f"tests/room/{name}" for name in TESTS}


def test_what_does_not_end_is_killed(tree, monkeypatch):
    monkeypatch.setattr(trial, "SILENT", 3.0)
    (tree.mutated / "tests/room/test_other.py").write_text(
        "import time\n\n\ndef test_nothing():\n    time.sleep(60)\n"
    )
    found = tried(tree, one("extreme", "max"), 0, 100.0)
    assert found["verdict"] == "killed"


def test_a_process_that_dies_is_noticed(tree):
    (tree.mutated / "tests/room/test_other.py").write_text(
        "import os\n\n\ndef test_nothing():\n    os.abort()\n"
    )
    found = trial.tested(tree.mutated, tree.cache, ["tests/room/test_other.py"], set(), 100.0)
    assert found.failed == trial.DIED


def test_a_test_named_first_comes_first(tree):
    named = ["tests/room/test_length.py::test_one_way"]
    found = tried(tree, one("arithmetic", "+"), 0, 100.0, named)
    assert (found["verdict"], found["by"], found["tests"]) == ("killed", *named, 1)
