"""A release check that was ended goes on: what has passed is left out, and nothing else."""

from types import SimpleNamespace

import pytest

from tests import resumed
from tests.resumed import LeavesOut, Notes, passed

FILE = "tests/test_one.py"
NAMES = ("first", "second", "third")


@pytest.fixture
def tree(tmp_path):
    """A project with one file of tests."""
    for name, text in {
        "trsim/a.py": "x = 1\n",
        "tests/shared.py": "y = 1\n",
        FILE: "z = 1\n",
    }.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    return tmp_path


@pytest.fixture(autouse=True)
def anew():
    """What is known of sources is that of one process."""
    yield
    forget()


def forget():
    resumed.shared.cache_clear()
    resumed.sources.cache_clear()


def notes(tree):
    return Notes(tree / "passed.jsonl", tree)


def report(name, when, passed=True):
    return SimpleNamespace(nodeid=f"{FILE}::{name}", when=when, passed=passed, duration=0.5,
                           capstdout="told\n")  # fmt: skip


def ran(run, name, call=True, teardown=True):
    for when, well in (("setup", True), ("call", call), ("teardown", teardown)):
        run.pytest_runtest_logreport(report(name, when, well))


def left(tree):
    """The tests that a new process runs, of three."""
    forget()
    items = [SimpleNamespace(nodeid=f"{FILE}::{name}") for name in NAMES]
    gone = []
    config = SimpleNamespace(
        hook=SimpleNamespace(pytest_deselected=lambda items: gone.extend(items))
    )
    LeavesOut(tree / "passed.jsonl", tree).pytest_collection_modifyitems(config, items)
    assert len(gone) + len(items) == len(NAMES)
    return [item.nodeid.rpartition("::")[2] for item in items]


def test_what_passed_is_not_run_again(tree):
    run = notes(tree)
    assert left(tree) == [*NAMES]
    ran(run, "first")
    ran(run, "second", call=False)
    ran(run, "third", teardown=False)
    assert left(tree) == ["second", "third"]
    told = passed(tree / "passed.jsonl")[f"{FILE}::first"]
    assert (told["seconds"], told["printed"]) == (0.5, "told\n")


@pytest.mark.parametrize("name", ["trsim/a.py", "tests/shared.py", FILE])
def test_other_sources_count_for_nothing(tree, name):
    ran(notes(tree), "first")
    path = tree / name
    path.write_text("# why\n" + path.read_text(), encoding="utf-8", newline="\n")
    assert left(tree) == ["second", "third"]
    path.write_text("w = 2\n", encoding="utf-8", newline="\n")
    assert left(tree) == [*NAMES]


def test_other_tests_count_for_themselves(tree):
    ran(notes(tree), "first")
    (tree / "tests" / "test_two.py").write_text("v = 1\n", encoding="utf-8", newline="\n")
    assert left(tree) == ["second", "third"]


def test_a_kill_within_a_line(tree):
    run = notes(tree)
    ran(run, "first")
    ran(run, "second")
    ledger = tree / "passed.jsonl"
    ledger.write_bytes(ledger.read_bytes()[:-20])
    assert left(tree) == ["second", "third"]
    ran(notes(tree), "third")
    assert left(tree) == ["second"]
