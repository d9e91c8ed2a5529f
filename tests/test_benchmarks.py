"""Measurements are made by hand: that each can begin is seen here, and what two trees share."""

import signal
import sys
import time
from importlib import import_module

import pytest

from benchmarks import beside, trees
from benchmarks.__main__ import LONG, NAMES
from benchmarks.measure import SCENARIOS
from benchmarks.trees import HERE, turns

CRANK = str(SCENARIOS / "validation" / "slider_crank_frictionless.yaml")
SLOWLY = "import time\nfor k in range(300): print(k, flush=True); time.sleep(0.002)"


@pytest.mark.parametrize("name", (*NAMES, *LONG))
def test_each_can_begin(name):
    module = import_module(f"benchmarks.{name}")
    assert callable(module.main)
    assert module.__doc__


def test_each_begins_a_round_in_its_turn():
    order = []
    found = turns.turns([lambda k=k: order.append(k) or k for k in range(3)], 4)
    assert order == [0, 1, 2, 1, 2, 0, 2, 0, 1, 0, 1, 2]
    assert found == [[k] * 4 for k in range(3)]


def test_bounds_of_a_median():
    """The 4th and 12th of 15, as tables of the sign test have them."""
    assert turns.interval([float(k) for k in range(15, 0, -1)]) == (4.0, 12.0)


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="processes cannot be held")
def test_a_command_stands_still_between_its_turns():
    one = turns.Command(HERE, [sys.executable, "-c", SLOWLY])
    try:
        one.turn(0.2)
        time.sleep(0.05)
        before = one.printed()
        time.sleep(0.1)
        assert one.printed() == before and not one.done
        one.turn(None)
        assert one.done and one.printed().split() == [str(k) for k in range(300)]
    finally:
        one.close()


def test_commands_come_to_their_ends(monkeypatch):
    monkeypatch.setattr(turns, "TURN", 0.05)
    command = [sys.executable, "-c", SLOWLY]
    done = turns.commands([(HERE, command), (HERE, [sys.executable, "-c", "print(7)"])])
    assert [len(one.said.split()) for one in done] == [300, 1]
    with pytest.raises(trees.Refused, match="this tree: exit code 3"):
        turns.commands([(HERE, [sys.executable, "-c", "raise SystemExit(3)"]), (HERE, command)])


def test_a_tree_comes_from_git(tmp_path, monkeypatch):
    monkeypatch.setattr(trees, "KEPT", tmp_path)
    try:
        commit = trees.revision("HEAD")
    except LookupError:
        pytest.skip("there is no history here")
    tree = trees.there("HEAD")
    assert tree.folder == tmp_path / commit and (tree.folder / "trsim" / "version.py").exists()
    (tree.folder / "mine").touch()
    assert trees.there("HEAD") == tree and (tree.folder / "mine").exists()
    assert [path.name for path in tmp_path.iterdir()] == [commit]
    assert trees.there(str(tree.folder)).folder == tree.folder


def test_without_the_state_before(capsys):
    """One sentence, and columns that are empty."""
    assert beside.trees_of("no-such-commit") == [HERE]
    assert "no-such-commit is neither a folder with trsim nor in the history that is here: only "\
        "this tree is measured.\n" in capsys.readouterr().out  # fmt: skip
    beside.Line("what", "1 s", ["2 s"], [[2.0] * 9]).told()
    beside.Line("what", "1 s", ["4 s", "2 s"], [[4.0] * 9, [2.0] * 9]).told()
    assert capsys.readouterr().out == (
        "| what | 1 s | | 2 s | |\n| what | 1 s | 4 s | 2 s | 0.500 (0.500..0.500) |\n"
    )


def test_what_is_not_known_is_named(capsys):
    with pytest.raises(SystemExit):
        beside.main(["four pins", "five pins"])
    assert "no measurement five pins; known: reverser, " in capsys.readouterr().err


def test_a_process_does_what_it_is_asked_to():
    sets = ["solver.end=1 ms", "solver.tolerance=1e-3"]
    known = [[0.0, 5e-4, 1e-3], [0.0] * 3]
    of = {"source": CRANK, "runs": [sets, sets]}
    tasks = [
        ("integrated", of),
        ("whole", {"source": CRANK, "sets": sets}),
        ("off", {**of, "channel": "slider.velocity", "known": known}),
    ]
    (found,) = turns.measured([HERE], [tasks[:2]], 1)
    (cpu, counts), (whole, _) = (of_task[0] for of_task in found)
    assert cpu > 0.0 and whole > 0.0 and counts["evaluations"] > counts["steps"] > 0
    with turns.worker(HERE, tasks[2:]) as ask:
        first, second = ask(0, 1)
    assert first == second and first[1] == counts["evaluations"]
    with (
        pytest.raises(trees.Refused, match="this tree: its process ended"),
        turns.worker(HERE, [("whole", {"source": "no.yaml", "sets": []})]),
    ):
        pass
